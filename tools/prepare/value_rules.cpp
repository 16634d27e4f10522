// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/value_rules.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Fields of tets that belong to an image, without that of its own name.
std::vector<std::string> further_fields(const std::string& name, const ValueOptions& options) {
  std::vector<std::string> fields;
  if (options.minimum) fields.push_back(name + "_min");
  if (options.maximum) fields.push_back(name + "_max");
  if (options.deviation) fields.push_back(name + "_deviation");
  for (const ValueBins& bins : options.bins)
    if (bins.of == name) fields.push_back(name + "_bin");
  return fields;
}

void check_names_of_fields(const ValueOptions& options) {
  std::map<std::string, std::string> image_of;
  for (const ValueImage& image : options.images) image_of.emplace(image.name, image.name);
  for (const ValueImage& image : options.images)
    for (const std::string& field : further_fields(image.name, options))
      if (const auto [other, added] = image_of.emplace(field, image.name); !added)
        throw UsageError("the field '" + field + "' would belong both to the values " +
                         in_quotes(other->second) + " and to the values " + in_quotes(image.name) +
                         "; call one of them something else");
}

void check_rule(const BinRule& rule, const std::string& of) {
  const std::string option = "--bins " + of;
  if (rule.count == 0 && rule.edges.empty())
    throw UsageError(option + " needs a number of bins, or the values between them");
  if (rule.count > 0 && !rule.edges.empty())
    throw UsageError(option + " has a number of bins, and values between them; give one of these");
  if (std::max(rule.count, rule.edges.size() + 1) > max_bins)
    throw UsageError(option + ": more than " + std::to_string(max_bins) + " bins");
  for (const double edge : rule.edges)
    if (!std::isfinite(edge))
      throw UsageError(option + ": the value " + short_number(edge) + " between bins is not finite");
  const auto wrong = std::adjacent_find(rule.edges.begin(), rule.edges.end(), std::greater_equal<>());
  if (wrong != rule.edges.end())
    throw UsageError(option + ": the values between bins must ascend, and " + short_number(wrong[1]) +
                     " follows " + short_number(wrong[0]));
}

void check_law(const ModulusLaw& law, const std::string& of) {
  const std::string option = "--modulus " + of;
  if (!(law.factor > 0) || !std::isfinite(law.factor))
    throw UsageError(option + ": the factor " + short_number(law.factor) +
                     " of the law must be a number above 0");
  for (const double x : {law.exponent, law.scale, law.offset})
    if (!std::isfinite(x))
      throw UsageError(option + ": " + short_number(x) + " in the law is not finite; give a number");
  if (!(law.minimum >= 0) || !std::isfinite(law.minimum))
    throw UsageError("--min-modulus " + short_number(law.minimum) + " is not a number above 0");
  constexpr double least = -1, most = 0.5;  // of a stable isotropic material
  if (!(law.poisson > least && law.poisson < most))
    throw UsageError(option + ": Poisson's ratio " + short_number(law.poisson) +
                     " is not between -1 and 0.5");
}

void check_bins(const ValueOptions& options, const std::set<std::string>& names) {
  std::set<std::string> seen;
  const ValueBins* with_modulus = nullptr;
  for (const ValueBins& bins : options.bins) {
    if (!names.contains(bins.of))
      throw UsageError("--bins " + bins.of + ": no image has this name; give --values " + bins.of + "=IMAGE");
    if (!seen.insert(bins.of).second)
      throw UsageError("--bins " + bins.of + " was given twice; give it once, or the image a second time " +
                       "with another name");
    check_rule(bins.rule, bins.of);
    if (!bins.modulus) continue;
    if (with_modulus)
      throw UsageError("--modulus " + with_modulus->of + " and --modulus " + bins.of +
                       ": only one is possible in a call, since an element has one section with one "
                       "material; leave one out");
    with_modulus = &bins;
    check_law(*bins.modulus, bins.of);
  }
}

}  // namespace

void check_value_options(Task task, const ValueOptions& options) {
  std::set<std::string> names;
  std::map<std::string, std::string> file_of_name;
  for (const ValueImage& image : options.images) {
    if (image.name.empty())
      throw UsageError("the values of " + image.file + " need a name; give NAME=" + image.file);
    names.insert(image.name);
    if (const auto [same, added] = file_of_name.emplace(image.name, image.file); !added)
      throw UsageError(same->second + " and " + image.file + " are two images called '" + image.name +
                       "'; give each its own name, such as " + image.name + "_1=" + same->second + " and " +
                       image.name + "_2=" + image.file);
  }
  if (options.images.empty()) {
    if (task == Task::values) throw UsageError("there is no image; give NAME=IMAGE after the mesh");
    const char* const other = !options.mask_file.empty() || options.own_label ? "--values-mask"
                              : options.minimum || options.maximum || options.deviation
                                  ? "--values-statistics"
                              : !options.bins.empty() ? "--bins"
                                                      : nullptr;
    if (other)
      throw UsageError(std::string(other) + " is for the values of an image; give --values NAME=IMAGE");
  }
  if (options.own_label && task != Task::prepare && task != Task::mesh)
    throw UsageError(
        "--values-mask labels is for the segmented volume that 'prepare' and 'mesh' read; give a volume, "
        "--values-mask FILE");
  check_bins(options, names);
  check_names_of_fields(options);
}

void check_modulus(const ModulusLaw& law, const std::string& name, const CountedVoxels& counted,
                   Progress& progress) {
  const double low = modulus_of(law, counted.lowest), high = modulus_of(law, counted.highest);
  const auto possible = [](double modulus) { return modulus > 0 && std::isfinite(modulus); };
  if (possible(low) && possible(high)) return;
  const std::string range = "values from " + short_number(counted.lowest) + " to " +
                            short_number(counted.highest) + " have moduli from " + short_number(low) +
                            " to " + short_number(high);
  // Where one end is too small and the other one too large, those between may do.
  if (!possible(low) && !possible(high) && (low > 0) == (high > 0))
    throw UsageError("--modulus " + name + ": " + range +
                     ", which must be finite and above 0; check the law, or give --min-modulus");
  progress.announce("--modulus " + name + ": " + range +
                    "; a bin whose mean has none that is finite and above 0 would end the call after " +
                    "meshing; --min-modulus helps");
}

void check_field_names(const TetMesh& mesh, const PrepareRun& run) {
  const auto has = [&](const std::string& name) {
    return std::any_of(mesh.cell_fields.begin(), mesh.cell_fields.end(),
                       [&](const MeshField& field) { return field.name == name; });
  };
  const ValueOptions& options = run.options.values;
  for (const ValueImage& image : options.images) {
    if (has(image.name)) continue;
    for (const std::string& field : further_fields(image.name, options))
      if (has(field))
        throw UsageError(run.report.inputs.front() + " has a field '" + field +
                         "' already, which would be replaced by that of the values " + in_quotes(image.name) +
                         "; give the image another name, such as " + image.name + "_2=" + image.file);
  }
}

void throw_no_voxel_counts(const std::string& image) {
  throw InputError(image, 0,
                   "has no voxel that counts: all are outside the mask, or not finite; check the mask");
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tetwright/value_bins.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <utility>

#include "common/material_names.h"
#include "common/message_text.h"
#include "common/number_text.h"
#include "common/unique_names.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

double volume_of(const TetMesh& mesh, const Tet& t) {
  const Vec3& a = mesh.points[t[0]];
  return std::abs((mesh.points[t[1]] - a).cross(mesh.points[t[2]] - a).dot(mesh.points[t[3]] - a)) / 6;
}

/// Rounds to 12 digits, since the last ones of std::pow() depend on the machine.
double rounded(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.12g", x);
  return std::strtod(text, nullptr);
}

/// Name with the bin's number, which has at least three digits, so that names sort by it.
std::string numbered(const std::string& name, std::size_t number) {
  char digits[24];
  std::snprintf(digits, sizeof digits, "_%03zu", number);
  return name + digits;
}

/// Bounds of the bins of a material, from the lowest to the highest one.
std::vector<double> bounds_of(const BinRule& rule, double low, double high) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<double> bounds;
  if (!rule.edges.empty()) {
    bounds.push_back(-infinity);
    bounds.insert(bounds.end(), rule.edges.begin(), rule.edges.end());
    bounds.push_back(infinity);
    return bounds;
  }
  const std::size_t bins = low < high ? rule.count : 1;
  const auto count = static_cast<double>(bins);
  for (std::size_t i = 0; i < bins; ++i)
    bounds.push_back(low + (high - low) * (static_cast<double>(i) / count));
  bounds.push_back(high);
  return bounds;
}

}  // namespace

TetBins bin_tets(const TetMesh& mesh, const std::string& field, const std::vector<double>& values,
                 const BinRule& rule) {
  TetBins result;
  result.field = field;
  std::map<MaterialTag, std::pair<double, double>> ranges;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    auto& [low, high] = ranges.try_emplace(mesh.materials[t], values[t], values[t]).first->second;
    low = std::min(low, values[t]);
    high = std::max(high, values[t]);
  }
  UniqueNames names([](const std::string& name) { return name; });
  for (const auto& [tag, range] : ranges) (void)names.add(material_name(mesh.material_names, tag));
  std::map<MaterialTag, std::vector<double>> bounds;
  for (const auto& [tag, range] : ranges) bounds[tag] = bounds_of(rule, range.first, range.second);
  // Index of each bin among all, also those without tets.
  std::map<MaterialTag, std::size_t> first;
  std::vector<ValueBin> all;
  for (const auto& [tag, of_material] : bounds) {
    first[tag] = all.size();
    for (std::size_t i = 0; i + 1 < of_material.size(); ++i)
      all.push_back({tag, i + 1, {}, of_material[i], of_material[i + 1], 0, 0, 0});
  }
  result.of_tets.resize(mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const std::vector<double>& of_material = bounds.at(mesh.materials[t]);
    // Inner bounds belong to the bin above.
    const auto above = std::upper_bound(of_material.begin() + 1, of_material.end() - 1, values[t]);
    const std::size_t bin =
        first.at(mesh.materials[t]) + static_cast<std::size_t>(above - of_material.begin()) - 1;
    result.of_tets[t] = static_cast<std::uint32_t>(bin);
    const double volume = volume_of(mesh, mesh.tets[t]);
    ++all[bin].tets;
    all[bin].volume += volume;
    all[bin].mean += volume * values[t];
  }
  std::vector<std::uint32_t> kept(all.size());
  std::vector<double> plain(all.size());  // of bins whose tets are all flat
  for (std::size_t t = 0; t < mesh.tets.size(); ++t)
    plain[result.of_tets[t]] += values[t] / static_cast<double>(all[result.of_tets[t]].tets);
  for (std::size_t i = 0; i < all.size(); ++i) {
    ValueBin& bin = all[i];
    if (bin.tets == 0) continue;
    // Rounding must not bring the mean outside the bin.
    bin.mean = std::clamp(bin.volume > 0 ? bin.mean / bin.volume : plain[i], bin.low, bin.high);
    bin.name = names.add(numbered(material_name(mesh.material_names, bin.material), bin.number));
    kept[i] = static_cast<std::uint32_t>(result.bins.size());
    result.bins.push_back(std::move(bin));
  }
  for (std::uint32_t& bin : result.of_tets) bin = kept[bin];
  return result;
}

void name_apart(const TetMesh& mesh, std::span<TetBins> divisions) {
  if (divisions.size() < 2) return;
  UniqueNames names([](const std::string& name) { return name; });
  for (const TetBins& bins : divisions)
    for (const ValueBin& bin : bins.bins)
      if (const std::string name = material_name(mesh.material_names, bin.material); !names.has(name))
        (void)names.add(name);
  for (TetBins& bins : divisions)
    for (ValueBin& bin : bins.bins)
      bin.name = names.add(
          numbered(material_name(mesh.material_names, bin.material) + "_" + bins.field, bin.number));
}

std::size_t leading_division(std::span<const TetBins> divisions) {
  const auto with_moduli = std::find_if(divisions.begin(), divisions.end(),
                                        [](const TetBins& bins) { return bins.poisson.has_value(); });
  return with_moduli == divisions.end() ? 0 : static_cast<std::size_t>(with_moduli - divisions.begin());
}

double modulus_of(const ModulusLaw& law, double value) {
  const double calibrated = std::max(0.0, law.scale * value + law.offset);
  return rounded(std::max(law.minimum, law.factor * std::pow(calibrated, law.exponent)));
}

void set_moduli(const ModulusLaw& law, TetBins& bins) {
  for (ValueBin& bin : bins.bins) {
    const double modulus = modulus_of(law, bin.mean);
    if (!(modulus > 0) || !std::isfinite(modulus))
      throw UsageError("--modulus " + bins.field + ": the bin " + bin.name + " with the mean " +
                       short_number(bin.mean) + " gets the modulus " + short_number(modulus) +
                       ", which must be finite and above 0; check the law, or give --min-modulus");
    bin.modulus = modulus;
  }
  bins.poisson = law.poisson;
}

MeshField field_of_bins(const TetBins& bins) {
  MeshField field{bins.field + "_bin", 1, true, {}};
  field.values.reserve(bins.of_tets.size());
  for (const std::uint32_t bin : bins.of_tets)
    field.values.push_back(static_cast<double>(bins.bins[bin].number));
  return field;
}

std::string table_of_bins(const TetMesh& mesh, std::span<const TetBins> divisions) {
  const auto quoted = [](const std::string& name) {
    if (name.find_first_of(",\"\n") == std::string::npos) return name;
    std::string out = "\"";
    for (const char c : name) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
  };
  const bool several = divisions.size() > 1;
  const bool moduli = std::any_of(divisions.begin(), divisions.end(),
                                  [](const TetBins& bins) { return bins.poisson.has_value(); });
  std::string out = several ? "name,values,material,bin,low,high,tets,volume,mean"
                            : "name,material,bin,low,high,tets,volume,mean";
  out += moduli ? ",modulus,poisson\n" : "\n";
  const auto add = [&](bool there, double x) {
    out += ',';
    if (there) append_number(out, x);
  };
  for (const TetBins& bins : divisions)
    for (const ValueBin& bin : bins.bins) {
      out += quoted(bin.name) + ",";
      if (several) out += quoted(bins.field) + ",";
      out += quoted(material_name(mesh.material_names, bin.material)) + ",";
      append_number(out, bin.number);
      for (const double x : {bin.low, bin.high}) add(std::isfinite(x), x);
      out += ',';
      append_number(out, bin.tets);
      for (const double x : {bin.volume, bin.mean}) add(true, x);
      if (moduli) {
        add(bin.modulus.has_value(), bin.modulus.value_or(0));
        add(bins.poisson.has_value(), bins.poisson.value_or(0));
      }
      out += '\n';
    }
  return out;
}

}  // namespace tetwright

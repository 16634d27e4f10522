// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/implant_input.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "tetwright/error.h"

namespace tetwright {

namespace {

/// The names of labels, for messages.
std::string names_of(const LabelInput& labels) {
  constexpr std::size_t max_named = 20;
  std::string text;
  for (std::size_t i = 0; i < std::min(labels.materials.size(), max_named); ++i)
    text += (i ? ", " : "") + std::to_string(labels.materials[i].tag) + " '" + labels.materials[i].name + "'";
  return labels.materials.size() > max_named ? text + ", ..." : text;
}

/// The labels that are protected, ascending.
std::vector<MaterialTag> protected_tags(const LabelInput& labels, const LabelOptions& options) {
  std::set<MaterialTag> tags;
  const auto add = [&](const std::string& asked, const auto& is_meant) {
    bool any = false;
    for (const LabelMaterial& m : labels.materials)
      if (is_meant(m)) any = true, tags.insert(m.tag);
    if (!any)
      throw UsageError("--protect-labels names " + asked + ", which " + labels.file +
                       " does not have; its labels are " + names_of(labels));
  };
  for (const auto& [first, last] : options.protected_labels)
    add(first == last ? "the label " + std::to_string(first)
                      : "labels from " + std::to_string(first) + " to " + std::to_string(last),
        [&, low = first, high = last](const LabelMaterial& m) { return low <= m.tag && m.tag <= high; });
  for (const std::string& name : options.protected_names)
    add("'" + name + "'", [&](const LabelMaterial& m) { return m.name == name; });
  return {tags.begin(), tags.end()};
}

/// Gives bodies tags that no label of the file has, also if it is not meshed: the next ones above them while
/// there are any.
void renumber(const LabelInput& labels, MesherInput& bodies) {
  std::set<MaterialTag> taken{outside_tag};
  for (const LabelMaterial& m : labels.materials) taken.insert(m.tag);
  constexpr MaterialTag max_tag = std::numeric_limits<MaterialTag>::max();
  const auto count = static_cast<MaterialTag>(bodies.bodies.size());
  MaterialTag next = std::max({MaterialTag{0}, labels.largest_label, *taken.rbegin()});
  if (next > max_tag - count) next = 0;
  for (MesherInput::Body& body : bodies.bodies) {
    while (taken.contains(++next)) continue;
    body.tag = next;
  }
}

}  // namespace

std::vector<Input> take_implants(std::vector<Input>& inputs, const Input* label_file) {
  const auto is_volume = [&](const Input& input) {
    return input.kind() == FileKind::volume || &input == label_file;
  };
  const auto first = std::find_if_not(inputs.begin(), inputs.end(), is_volume);
  const auto late = std::find_if(first, inputs.end(), is_volume);
  if (late != inputs.end())
    throw UsageError("the surface " + first->name + " comes before the volume " + late->name +
                     ", but surfaces carve the labels of volumes; give volumes first");
  std::vector<Input> surfaces(std::make_move_iterator(first), std::make_move_iterator(inputs.end()));
  inputs.erase(first, inputs.end());
  return surfaces;
}

ImplantedVolume join_implants(LabelInput labels, MesherInput bodies, PrepareRun& run) {
  renumber(labels, bodies);
  // A table of colours may name labels that do not occur.
  for (const MesherInput::Body& body : bodies.bodies) run.report.material_colours.erase(body.tag);
  std::vector<MaterialTag> kept = protected_tags(labels, run.options.labels);
  const std::size_t known = bodies.findings.size();
  ImplantedVolume volume = make_implanted_volume(std::move(labels), std::move(bodies), std::move(kept));
  run.report.volume->contacts = volume.labels.contacts;
  const std::vector<Diagnostic>& findings = volume.bodies.findings;
  run.report.diagnostics.insert(run.report.diagnostics.end(),
                                findings.begin() + static_cast<std::ptrdiff_t>(known), findings.end());
  return volume;
}

void report_carving(const CarvedLabels& carved, VolumeReport& volume) {
  const auto taken_of = [&](const MaterialOrOutside& label) {
    const auto known = carved.voxels.find(label);
    return known == carved.voxels.end() ? 0 : known->second;
  };
  for (LabelMaterial& m : volume.labels) m.carved = taken_of(m.tag);
  for (LabelContact& c : volume.contacts)
    if (const auto faces = carved.faces.find(std::minmax(c.first, c.second)); faces != carved.faces.end())
      c.faces -= std::min(c.faces, faces->second);
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/label_changes.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/message_text.h"

namespace tetwright {

namespace {

/// Share of a label's voxels that merging may change without being a shortfall.
constexpr double max_merged_share = 0.02;
/// Maximum number of changes listed in a message.
constexpr std::size_t max_changes_named = 5;

/// Collects changes for a message, of which the first few are listed.
class Changes {
 public:
  void add(const std::string& text, const Vec3* place) {
    if (++count_ > max_changes_named) return;
    text_ += (text_.empty() ? "" : "; ") + text;
    if (place) places_.push_back(*place);
  }
  std::size_t count() const { return count_; }
  const std::vector<Vec3>& places() const { return places_; }
  std::string text() const {
    return count_ > max_changes_named
               ? text_ + "; and " + std::to_string(count_ - max_changes_named) + " more"
               : text_;
  }

 private:
  std::size_t count_ = 0;
  std::string text_;
  std::vector<Vec3> places_;
};

std::string name_of(const MaterialOrOutside& label, const VolumeReport& volume) {
  if (!label) return "the outside";
  for (const LabelMaterial& m : volume.labels)
    if (m.tag == *label) return "'" + m.name + "'";
  for (const LostLabel& lost : volume.lost)
    if (lost.tag == *label) return "'" + lost.name + "'";
  return std::to_string(*label);
}

using Pair = std::pair<MaterialOrOutside, MaterialOrOutside>;

Pair pair_of(MaterialOrOutside a, MaterialOrOutside b) {
  return b < a ? Pair(b, a) : Pair(a, b);  // the outside comes first
}

}  // namespace

void find_changed_labels(PrepareRun& run) {
  if (!run.report.volume) return;
  const VolumeReport& volume = *run.report.volume;
  Changes changes;
  for (const LabelMaterial& m : volume.labels) {
    const auto before = static_cast<double>(m.voxels_in_file), after = static_cast<double>(m.voxels);
    if (std::fabs(after - before) <= max_merged_share * before) continue;
    char share[40];
    std::snprintf(share, sizeof share, " (%+.3g %%)", 100 * (after / before - 1));
    changes.add("'" + m.name + "' has " + std::to_string(m.voxels) + " voxels instead of " +
                    std::to_string(m.voxels_in_file) + share,
                nullptr);
  }
  for (const FusedParts& f : volume.fused)
    changes.add("two parts of " + name_of(f.label, volume) + " became one at " + place_text(f.place),
                &f.place);
  if (changes.count() == 0) return;
  run.report.diagnostics.push_back(
      {.code = DiagnosticCode::labels_changed,
       .file = run.report.inputs.front(),
       .what = "merging islands changed labels: " + changes.text(),
       .remedy = "give a smaller --min-voxels (0 keeps all islands), or accept it with --accept-changes",
       .asked = 0,
       .reached = static_cast<double>(changes.count()),
       .limited_by = "--min-voxels",
       .places = changes.places()});
}

void find_changed_contacts(const TetMesh& mesh, PrepareRun& run) {
  if (!run.report.volume || !run.report.mesher) return;
  const VolumeReport& volume = *run.report.volume;
  const bool kept_outside = run.options.cells.keep_outside;
  std::set<MaterialOrOutside> meshed{MaterialOrOutside()};
  for (const LabelMaterial& m : volume.labels) meshed.insert(m.tag);
  // Surfaces in a volume touch what is around them.
  const auto is_body = [&](const MaterialOrOutside& m) {
    return run.report.mesher->carved && !meshed.contains(m);
  };
  std::map<Pair, Vec3> touching;  // in the mesh
  for (const InterfaceTriangle& t : mesh.interfaces) {
    // The volume ends there.
    if (!t.other && (t.patch != 0 || kept_outside)) continue;
    const auto label = [&](MaterialOrOutside material) {
      return kept_outside && material == outside_tag ? MaterialOrOutside() : material;
    };
    const Pair pair = pair_of(label(t.material), label(t.other));
    if (is_body(pair.first) || is_body(pair.second)) continue;
    if (touching.contains(pair)) continue;
    touching[pair] = (mesh.points[t.ids[0]] + mesh.points[t.ids[1]] + mesh.points[t.ids[2]]) / 3;
  }
  std::set<Pair> in_voxels;
  Changes changes;
  const std::size_t min_faces = run.options.labels.min_voxels.value_or(default_min_voxels);
  for (const LabelContact& c : volume.contacts) {
    const Pair pair = pair_of(c.first, c.second);
    in_voxels.insert(pair);
    if (c.faces <= min_faces || touching.contains(pair) || !meshed.contains(c.first) ||
        !meshed.contains(c.second))
      continue;
    changes.add(name_of(pair.first, volume) + " and " + name_of(pair.second, volume) + " share " +
                    std::to_string(c.faces) + " voxel faces, the first at " + place_text(c.place) +
                    ", and do not touch",
                &c.place);
  }
  // Between nested thresholds an image may have layers that no voxel centre is in.
  for (const auto& [pair, place] : touching)
    if (!in_voxels.contains(pair) && volume.isos.size() < 2)
      changes.add(name_of(pair.first, volume) + " touches " + name_of(pair.second, volume) + " at " +
                      place_text(place) + ", and no voxels of them do",
                  &place);
  if (changes.count() == 0) return;
  run.report.diagnostics.push_back(
      {.code = DiagnosticCode::contacts_changed,
       .file = run.report.inputs.front(),
       .what = "not the contacts of the input: " + changes.text(),
       .remedy =
           "use smaller cells, with a smaller --voxel-size or a higher --target-tets, or accept it with "
           "--accept-changes",
       .asked = static_cast<double>(volume.contacts.size()),
       .reached =
           static_cast<double>(volume.contacts.size() - std::min(volume.contacts.size(), changes.count())),
       .limited_by = "the size of the cells",
       .places = changes.places()});
}

}  // namespace tetwright

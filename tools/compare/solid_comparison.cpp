// SPDX-License-Identifier: Apache-2.0
#include "tetwright/compare.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <unordered_map>
#include <utility>

namespace tetwright {

namespace {

/// Relative change of a volume at which a solid counts as a different one.
constexpr double same_volume = 0.01;
/// Maximum relative difference in volume between matching shells.
constexpr double alike_volume = 0.1;
/// Maximum relative difference in volume of labels. For labels of few voxels: how far the surface of a cube
/// of the same volume may move, in voxels.
constexpr double label_volume = 0.02, label_shift = 0.06, cube_sides = 6;

using Solids = std::unordered_map<MaterialTag, std::vector<Triangle>>;

/// Faces of each material to other materials and to outside, oriented outwards.
Solids solids_of(const TetMesh& mesh) {
  Solids solids;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    if (t.is_sheet()) continue;
    solids[t.material].push_back(t.ids);
    if (t.other) solids[*t.other].push_back({t.ids[0], t.ids[2], t.ids[1]});
  }
  return solids;
}

/// Shells with at least the minimum volume, largest first.
std::vector<SolidShell> shells_of(const SolidShape& solid, double min_volume) {
  std::vector<SolidShell> shells = solid.shells;
  std::erase_if(shells, [&](const SolidShell& s) { return std::fabs(s.volume) < min_volume; });
  std::stable_sort(shells.begin(), shells.end(), [](const SolidShell& a, const SolidShell& b) {
    return std::fabs(a.volume) > std::fabs(b.volume);
  });
  return shells;
}

SolidNumbers numbers_of(const SolidShape& solid, const std::vector<SolidShell>& shells) {
  SolidNumbers numbers{.volume = solid.volume()};
  for (const SolidShell& s : shells) {
    ++(s.volume > 0 ? numbers.components : numbers.cavities);
    numbers.handles += s.handles;
  }
  return numbers;
}

template <class Count>
void add_difference(std::string& to, Count is, Count should, const char* one, const char* many) {
  if (is == should) return;
  to += (to.empty() ? "" : ", ") + std::to_string(is) + " " + (is == 1 ? one : many) + " instead of " +
        std::to_string(should);
}

void add_volume(SolidComparison& f) {
  const double change = f.result.volume / f.expected.volume - 1;
  char text[80];
  if (f.expected.volume > 0)
    std::snprintf(text, sizeof text, "volume %.3g %% %s", 100 * std::fabs(change),
                  change > 0 ? "more" : "less");
  else
    std::snprintf(text, sizeof text, "volume %.6g instead of %.6g", f.result.volume, f.expected.volume);
  f.difference += (f.difference.empty() ? "" : ", ") + std::string(text);
}

/// Whether the shells may match each other.
bool alike(const SolidShell& a, const SolidShell& b) {
  return a.handles == b.handles && std::fabs(a.volume - b.volume) <= alike_volume * std::fabs(a.volume);
}

/// A point of the largest shell that only one of the solids has.
std::optional<Vec3> first_difference(const std::vector<SolidShell>& expected,
                                     const std::vector<SolidShell>& result) {
  std::vector<char> found(result.size(), 0);
  for (const SolidShell& shell : expected) {
    std::size_t i = 0;
    while (i < result.size() && (found[i] || !alike(shell, result[i]))) ++i;
    if (i == result.size()) return shell.place;
    found[i] = 1;
  }
  const auto extra = std::find(found.begin(), found.end(), 0);
  if (extra == found.end()) return {};
  return result[static_cast<std::size_t>(extra - found.begin())].place;
}

bool is_within(double volume, double meant, double slack) {
  return is_same_volume(volume, meant) || std::fabs(volume - meant) <= slack;
}

/// Compares a material with `shape`, one of the shapes that may be intended for it.
SolidComparison compare(const ExpectedSolid& expected, const SolidShape& shape, const SolidShape& result) {
  SolidComparison f;
  f.name = expected.name;
  f.tag = expected.tag;
  f.flaw = expected.flaw;
  const std::vector<SolidShell> was = shells_of(shape, expected.min_volume),
                                is = shells_of(result, expected.min_volume);
  f.expected = numbers_of(shape, was);
  f.result = numbers_of(result, is);
  // A material may touch itself in an edge where others meet; its counts are then meaningless.
  f.counted = shape.manifold && result.manifold;
  if (f.counted) {
    add_difference(f.difference, f.result.components, f.expected.components, "component", "components");
    add_difference(f.difference, f.result.handles, f.expected.handles, "handle", "handles");
    add_difference(f.difference, f.result.cavities, f.expected.cavities, "cavity", "cavities");
  }
  if (!is_within(f.result.volume, f.expected.volume, expected.volume_slack)) add_volume(f);
  if (f.counted && !f.same_counts()) f.place = first_difference(was, is);
  return f;
}

SolidComparison compare(const ExpectedSolid& expected, const SolidShape& result) {
  SolidComparison f = compare(expected, expected.shape, result);
  if (expected.flaw == SurfaceFlaw::none) return f;
  f.against = SolidComparison::Against::distances;
  f.certain = false;
  if (!expected.by_flawed_surface) return f;
  SolidComparison by_surface = compare(expected, *expected.by_flawed_surface, result);
  by_surface.certain = f.certain =
      f.expected.same_counts(by_surface.expected) &&
      is_within(f.expected.volume, by_surface.expected.volume, expected.volume_slack);
  return !f.same() && by_surface.same() ? by_surface : f;
}

/// Adds a difference such as "12 components instead of 2 to 4".
void add_components(SolidComparison& f, const char* one, const char* many) {
  add_difference(f.difference, f.result.components, f.expected.components, one, many);
  if (f.max_components > f.expected.components) f.difference += " to " + std::to_string(f.max_components);
}

SolidComparison compare(const LabelMaterial& label, double voxel_volume, const SolidShape& result) {
  SolidComparison f;
  f.name = label.name;
  f.tag = label.tag;
  f.against = SolidComparison::Against::voxels;
  const double voxels = expected_volume(label);
  f.expected = {.volume = voxel_volume * voxels, .components = label.parts.touching};
  f.max_components = label.parts.by_faces;
  if (label.carved.value_or(0) > 0) {  // bodies may divide it, or take parts
    f.expected.components = 1;
    f.max_components = std::numeric_limits<std::size_t>::max();
  }
  const std::vector<SolidShell> shells = shells_of(result, 0);
  f.result = numbers_of(result, shells);
  // A label may touch itself in an edge where others meet; its count is then meaningless.
  if (result.manifold && !f.same_counts()) {
    add_components(f, "component", "components");
    f.place = label.parts.smallest_place;
    if (f.result.components > f.expected.components)
      f.place = std::find_if(shells.rbegin(), shells.rend(), [](const SolidShell& s) {
                  return s.volume > 0;
                })->place;
  }
  const double slack = std::max(label_volume * voxels, label_shift * cube_sides * std::cbrt(voxels * voxels));
  if (std::fabs(f.result.volume - f.expected.volume) > slack * voxel_volume) add_volume(f);
  return f;
}

}  // namespace

double expected_volume(const LabelMaterial& label) {
  const auto voxels = static_cast<double>(label.voxels);
  // Voxels that merging took off or added count whole.
  const double whole =
      label.image_volume ? *label.image_volume + voxels - static_cast<double>(label.voxels_in_file) : voxels;
  return whole - label.carved.value_or(0);
}

bool is_same_volume(double volume, double meant) {
  return std::fabs(volume - meant) <= same_volume * std::fabs(meant);
}

std::vector<SolidComparison> compare_solids(const std::vector<ExpectedSolid>& expected, const TetMesh& mesh) {
  std::vector<SolidComparison> all;
  all.reserve(expected.size());
  Solids solids = solids_of(mesh);
  for (const ExpectedSolid& e : expected) all.push_back(compare(e, solid_shape(mesh.points, solids[e.tag])));
  return all;
}

std::vector<SolidComparison> compare_labels(const std::vector<LabelMaterial>& labels,
                                            const std::optional<LabelParts>& outside, double voxel_volume,
                                            const TetMesh& mesh) {
  std::vector<SolidComparison> all;
  all.reserve(labels.size() + 1);
  Solids solids = solids_of(mesh);
  for (const LabelMaterial& label : labels)
    all.push_back(compare(label, voxel_volume, solid_shape(mesh.points, solids[label.tag])));

  std::vector<Triangle> boundary;
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (!t.other) boundary.push_back(t.ids);
  const SolidShape domain = solid_shape(mesh.points, boundary);
  if (!outside || !domain.manifold) return all;
  SolidComparison f;
  f.name = outside_name;
  f.tag = outside_tag;
  f.against = SolidComparison::Against::voxels;
  f.expected.components = outside->touching;
  f.max_components = outside->by_faces;
  f.result.components = domain.cavities();
  if (!f.same_counts()) {
    f.place = outside->smallest_place;
    add_components(f, "part within the labels", "parts within the labels");
    if (f.result.components > f.expected.components)
      f.place = std::find_if(domain.shells.begin(), domain.shells.end(), [](const SolidShell& s) {
                  return s.volume < 0;
                })->place;
  }
  all.push_back(std::move(f));
  return all;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/strip_finder.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "common/features/edge_uses.h"
#include "mesher/complex/contact_zone.h"
#include "mesher/tuning/cut_tuning.h"

namespace tetwright {

namespace {

using Strips = CutTuning::Strips;

void unite(std::vector<std::size_t>& all, const std::vector<std::size_t>& more) {
  all.insert(all.end(), more.begin(), more.end());
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
}

/// True if two parts are on opposite sides of a sheet.
bool are_across(const SheetSides& a, const SheetSides& b) {
  return std::any_of(a.begin(), a.end(), [&](const SheetSides::Side& side) {
    const SheetSides::Side* other = b.of(side.component);
    return other && other->in_front != side.in_front;
  });
}

}  // namespace

StripFinder::StripFinder(const LabelledComplex& complex, const FeatureSurface& surface, double cell,
                         const SheetParts* parts)
    : surface_(surface), cell_(cell), parts_(parts) {
  find_curves(complex);
}

void StripFinder::find_curves(const LabelledComplex& complex) {
  std::vector<Triangle> triangles;
  for (const LabelledComplex::Face& f : complex.faces) triangles.push_back(f.ids);
  for (const LabelledComplex::SheetFace& f : complex.sheets) triangles.push_back(f.ids);
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  std::vector<std::array<Index, 2>> touching;
  for (const TouchingEdge& edge : touching_edges(complex)) touching.push_back(edge.ends);
  std::map<Index, std::pair<std::size_t, Sheets>> at_points;  // the most of any edge, and all
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    std::set<std::pair<RegionIndex, RegionIndex>> pairs;
    std::size_t inner = 0;
    for (; j < uses.size() && uses[j].key == uses[i].key; ++j) {
      if (uses[j].triangle >= complex.faces.size()) {
        ++inner;
        continue;
      }
      const LabelledComplex::Face& f = complex.faces[uses[j].triangle];
      pairs.insert(std::minmax(f.behind, f.front));
    }
    // Where bodies touch in a line, the outside around it is filled.
    const bool is_touching = std::binary_search(touching.begin(), touching.end(), ends_of(uses[i].key));
    // Where an inner sheet crosses a contact, both of the contact's faces count.
    const bool branches = !is_touching && (pairs.size() + inner >= Strips::min_sheets ||
                                           (inner >= 2 && j - i >= Strips::min_sheets));
    if (!branches && pairs.size() < 2) continue;
    Sheets sheets;
    for (const auto& [a, b] : pairs) sheets.push_back(*surface_.sheet_between(a, b));
    std::sort(sheets.begin(), sheets.end());
    for (const Index p : ends_of(uses[i].key)) {
      auto& [most, all] = at_points[p];
      most = std::max(most, sheets.size());
      unite(all, sheets);
    }
    if (branches) branching_edges_.push_back(ends_of(uses[i].key));
  }
  curve_ends_.resize(complex.points.size(), 0);
  for (const auto& [p, at] : at_points) curve_ends_[p] = at.second.size() != at.first;
  std::vector<ProjectionTree::Item> items;
  for (const auto& [a, b] : branching_edges_) items.push_back({{a, b, b}, {}});
  if (!items.empty()) curves_ = ProjectionTree(complex.points, std::move(items));
}

bool StripFinder::is_near_curve(const Vec3& p) const {
  return curves_.any_within(p, Strips::curve_reach * cell_);
}

bool StripFinder::are_across_curve(const Vec3& p, const Label& a, const Label& b) const {
  if (a.material != b.material) {
    const Label &inside = a.material ? a : b, &other = a.material ? b : a;
    const auto sheet = surface_.sheet_of({{}, *inside.material, other.material});
    if (!sheet || !surface_.nearest(p, *sheet, Strips::sheet_reach * cell_)) return true;
  }
  if (!parts_ || !a.material || !b.material || a.part == b.part) return false;
  const SheetedField& field = *parts_->field;
  const SheetedField::Part &first = field.part(a.part), &second = field.part(b.part);
  if (first.region != second.region) return are_across(first.sides, second.sides);
  const auto side = [](const SheetedField::Part& part) {
    return [&part](std::uint32_t component) -> std::optional<bool> {
      const SheetSides::Side* own = part.sides.of(component);
      return own ? std::optional(own->in_front) : std::nullopt;
    };
  };
  return field.base().sheets()->branches().face_across(field.voxels().to_grid(p), Strips::curve_reach,
                                                       side(first), side(second));
}

std::vector<Triangle> StripFinder::faces(const TetMesh& mesh) const {
  const auto middle_of = [&](const Triangle& f) {
    return Vec3((mesh.points[f[0]] + mesh.points[f[1]] + mesh.points[f[2]]) / 3);
  };
  std::vector<Triangle> found;
  for (const InterfaceTriangle& f : mesh.interfaces) {
    // Faces between parts include those between materials.
    if (parts_ && f.other) continue;
    const Vec3 middle = middle_of(f.ids);
    if (is_near_curve(middle) && are_across_curve(middle, {f.material}, {f.other})) found.push_back(f.ids);
  }
  if (!parts_) return found;
  for (const PartFace& f : part_faces(mesh, *parts_)) {
    const Vec3 middle = middle_of(f.ids);
    const auto label = [&](Index t) {
      const MaterialTag tag = mesh.materials[t];
      return Label{tag == outside_tag ? MaterialOrOutside{} : MaterialOrOutside{tag}, parts_->of_tets[t]};
    };
    const Label a = label(f.first), b = label(f.second);
    if (is_near_curve(middle) && are_across_curve(middle, a, b)) found.push_back(f.ids);
  }
  return found;
}

}  // namespace tetwright

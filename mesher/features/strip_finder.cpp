// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/strip_finder.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "common/features/edge_uses.h"
#include "mesher/features/surface_pinches.h"
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

/// Flags the points of junctions: a region touches itself nowhere else.
std::vector<std::uint8_t> points_at_junctions(const LabelledComplex& complex) {
  std::vector<std::uint8_t> flags(complex.points.size(), 0);
  for (const auto& [a, b] : complex.junctions()) flags[a] = flags[b] = 1;
  return flags;
}

}  // namespace

StripFinder::StripFinder(const LabelledComplex& complex, const FeatureSurface& surface, double cell,
                         const SheetParts* parts)
    : surface_(surface), cell_(cell), parts_(parts) {
  add_complex(complex);
}

void StripFinder::add_complex(const LabelledComplex& complex) {
  std::vector<Triangle> triangles;
  for (const LabelledComplex::Face& f : complex.faces) {
    triangles.push_back(f.ids);
    const std::size_t sheet = *surface_.sheet_between(f.behind, f.front);
    if (sides_.size() <= sheet) sides_.resize(sheet + 1);
    sides_[sheet] = {f.behind, f.front};
  }
  for (const LabelledComplex::SheetFace& f : complex.sheets) triangles.push_back(f.ids);
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  std::vector<Vec3> points;
  std::vector<ProjectionTree::Item> branching, junctions, corners;
  std::map<Index, std::pair<std::size_t, Sheets>> at_points;  // the most of any curve, and all
  std::map<Sheets, std::uint32_t> numbers;
  const auto number = [&](const Sheets& sheets) {
    return numbers.try_emplace(sheets, static_cast<std::uint32_t>(numbers.size())).first->second;
  };
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
    // Where an inner sheet crosses a contact, both of the contact's faces count.
    const bool branches =
        pairs.size() + inner >= Strips::min_sheets || (inner >= 2 && j - i >= Strips::min_sheets);
    if (!branches && pairs.size() < 2) continue;
    Sheets sheets;
    for (const auto& [a, b] : pairs) sheets.push_back(*surface_.sheet_between(a, b));
    std::sort(sheets.begin(), sheets.end());
    const auto first = static_cast<Index>(points.size());
    for (const Index p : ends_of(uses[i].key)) {
      points.push_back(complex.points[p]);
      auto& [most, all] = at_points[p];
      most = std::max(most, sheets.size());
      unite(all, sheets);
    }
    junctions.push_back({{first, first + 1, first + 1}, {number(sheets), 0, 0}});
    if (branches) branching.push_back({{first, first + 1, first + 1}, {}});
  }
  if (branching.empty()) return;
  for (const auto& [p, at] : at_points) {
    if (at.second.size() == at.first) continue;
    const auto own = static_cast<Index>(points.size());
    points.push_back(complex.points[p]);
    corners.push_back({{own, own, own}, {number(at.second), 0, 0}});
  }
  sheets_.resize(numbers.size());
  for (const auto& [sheets, index] : numbers) sheets_[index] = sheets;
  curves_ = ProjectionTree(points, std::move(branching));
  junctions_ = ProjectionTree(points, std::move(junctions));
  corners_ = ProjectionTree(std::move(points), std::move(corners));
  find_own_pinches(complex);
}

void StripFinder::Surfaces::add(const Triangle& face, std::size_t sheet,
                                const std::array<RegionIndex, 2>& sides, std::size_t sheets) {
  faces.push_back(face);
  numbers.push_back(static_cast<std::uint32_t>(sheet));
  for (const RegionIndex region : sides) {
    if (region == outside_region) continue;
    faces.push_back(face);
    numbers.push_back(static_cast<std::uint32_t>(sheets + region));
  }
}

void StripFinder::find_own_pinches(const LabelledComplex& complex) {
  Surfaces all;
  for (const LabelledComplex::Face& f : complex.faces)
    all.add(f.ids, *surface_.sheet_between(f.behind, f.front), {f.behind, f.front}, sides_.size());
  const std::vector<std::uint8_t> at_junction = points_at_junctions(complex);
  const SurfacePinches own =
      find_pinches(all.faces, all.numbers, [&](Index p) { return at_junction[p] != 0; });
  std::vector<ProjectionTree::Item> items;
  for (const SurfacePinches::Edge& e : own.edges)
    items.push_back({{e.ends[0], e.ends[1], e.ends[1]}, {e.surface, 0, 0}});
  for (const SurfacePinches::Point& p : own.points)
    items.push_back({{p.point, p.point, p.point}, {p.surface, 0, 0}});
  if (!items.empty()) pinches_ = ProjectionTree(complex.points, std::move(items));
}

bool StripFinder::is_near_curve(const Vec3& p) const {
  return curves_.any_within(p, Strips::curve_reach * cell_);
}

std::vector<Triangle> StripFinder::faces(const TetMesh& mesh) const {
  const auto middle_of = [&](const Triangle& f) {
    return Vec3((mesh.points[f[0]] + mesh.points[f[1]] + mesh.points[f[2]]) / 3);
  };
  std::vector<Triangle> found;
  for (const InterfaceTriangle& f : mesh.interfaces) {
    const Vec3 middle = middle_of(f.ids);
    if (!is_near_curve(middle)) continue;
    const auto sheet = surface_.sheet_of(f);
    if (!sheet || !surface_.nearest(middle, *sheet, Strips::sheet_reach * cell_)) found.push_back(f.ids);
  }
  if (!parts_) return found;
  const SheetedField& field = *parts_->field;
  const SheetBranches& branches = field.base().sheets()->branches();
  for (const PartFace& f : part_faces(mesh, *parts_)) {
    const SheetedField::Part &a = field.part(parts_->of_tets[f.first]),
                             &b = field.part(parts_->of_tets[f.second]);
    if (a.region != b.region) {
      if (are_across(a.sides, b.sides) && is_near_curve(middle_of(f.ids))) found.push_back(f.ids);
      continue;
    }
    const auto side = [](const SheetedField::Part& part) {
      return [&part](std::uint32_t component) -> std::optional<bool> {
        const SheetSides::Side* own = part.sides.of(component);
        return own ? std::optional(own->in_front) : std::nullopt;
      };
    };
    if (branches.face_across(field.voxels().to_grid(middle_of(f.ids)), Strips::curve_reach, side(a), side(b)))
      found.push_back(f.ids);
  }
  return found;
}

bool StripFinder::meet_near(const ProjectionTree& junctions, const Sheets& sheets, const Vec3& p) const {
  return junctions
      .nearest_of(p, Strips::sheet_reach * cell_,
                  [&](const ProjectionTree::Item& item) {
                    const Sheets& all = sheets_[item.kind[0]];
                    return std::includes(all.begin(), all.end(), sheets.begin(), sheets.end());
                  })
      .has_value();
}

StripFinder::Faces StripFinder::faces_near_curves(const TetMesh& mesh) const {
  std::map<Index, bool> is_near;
  const auto near = [&](Index p) {
    const auto [known, is_new] = is_near.try_emplace(p, false);
    if (is_new) known->second = is_near_curve(mesh.points[p]);
    return known->second;
  };
  Faces found;
  for (const InterfaceTriangle& f : mesh.interfaces) {
    if (std::none_of(f.ids.begin(), f.ids.end(), near)) continue;
    const auto sheet = surface_.sheet_of(f);
    if (!sheet) continue;
    found.ids.push_back(f.ids);
    found.sheets.push_back(*sheet);
  }
  return found;
}

void StripFinder::add_drawn_out_corners(const TetMesh& mesh, const Faces& near, Edges& edges) const {
  std::map<Index, Sheets> at_points;
  for (std::size_t f = 0; f < near.ids.size(); ++f)
    for (const Index p : near.ids[f]) unite(at_points[p], {near.sheets[f]});
  std::erase_if(at_points, [&](const auto& at) {
    return at.second.size() < Strips::min_sheets || meet_near(junctions_, at.second, mesh.points[at.first]);
  });
  for (const Triangle& ids : near.ids)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [a, b] = ascending_edge(ids[k], ids[(k + 1) % 3]);
      if (!at_points.contains(a) || !at_points.contains(b)) continue;
      Sheets sheets = at_points[a];
      unite(sheets, at_points[b]);
      if (meet_near(corners_, sheets, (mesh.points[a] + mesh.points[b]) / 2)) edges.insert({a, b});
    }
}

void StripFinder::add_pinches(const TetMesh& mesh, const Faces& near, Edges& edges) const {
  Surfaces all;
  for (std::size_t f = 0; f < near.ids.size(); ++f)
    all.add(near.ids[f], near.sheets[f], sides_[near.sheets[f]], sides_.size());
  const SurfacePinches found =
      find_pinches(all.faces, all.numbers, [&](Index p) { return is_near_curve(mesh.points[p]); });
  const auto is_meant = [&](std::uint32_t surface, const Vec3& p) {
    return pinches_
        .nearest_of(p, Strips::curve_reach * cell_,
                    [&](const ProjectionTree::Item& item) { return item.kind[0] == surface; })
        .has_value();
  };
  for (const SurfacePinches::Edge& e : found.edges)
    if (!is_meant(e.surface, (mesh.points[e.ends[0]] + mesh.points[e.ends[1]]) / 2)) edges.insert(e.ends);
  for (const SurfacePinches::Point& p : found.points) {
    if (is_meant(p.surface, mesh.points[p.point])) continue;
    const Vec3& position = mesh.points[p.point];
    const Index nearest = *std::min_element(p.beside.begin(), p.beside.end(), [&](Index a, Index b) {
      return (mesh.points[a] - position).squaredNorm() < (mesh.points[b] - position).squaredNorm();
    });
    edges.insert(ascending_edge(p.point, nearest));
  }
}

std::vector<std::array<Index, 2>> StripFinder::edges(const TetMesh& mesh, bool any_strip) const {
  const Faces near = faces_near_curves(mesh);
  Edges found;
  add_drawn_out_corners(mesh, near, found);
  if (!any_strip) add_pinches(mesh, near, found);
  return {found.begin(), found.end()};
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/strip_finder.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "common/features/edge_uses.h"
#include "mesher/tuning/cut_tuning.h"

namespace tetwright {

namespace {

using Strips = CutTuning::Strips;

}  // namespace

StripFinder::StripFinder(const LabelledComplex& complex, const FeatureSurface& surface, double cell,
                         const SheetParts* parts)
    : surface_(surface), cell_(cell), parts_(parts) {
  add_complex(complex);
}

void StripFinder::add_complex(const LabelledComplex& complex) {
  std::vector<Triangle> triangles;
  for (const LabelledComplex::Face& f : complex.faces) triangles.push_back(f.ids);
  for (const LabelledComplex::SheetFace& f : complex.sheets) triangles.push_back(f.ids);
  const std::vector<EdgeUse> uses = edge_uses(triangles, {});
  std::vector<Vec3> points;
  std::vector<ProjectionTree::Item> branching, junctions;
  std::map<std::vector<std::size_t>, std::uint32_t> numbers;
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
    const bool branches = pairs.size() + inner >= Strips::min_sheets;
    if (!branches && pairs.size() < 2) continue;
    std::vector<std::size_t> sheets;
    for (const auto& [a, b] : pairs) sheets.push_back(*surface_.sheet_between(a, b));
    std::sort(sheets.begin(), sheets.end());
    const auto first = static_cast<Index>(points.size());
    for (const Index p : ends_of(uses[i].key)) points.push_back(complex.points[p]);
    const std::uint32_t kind =
        numbers.try_emplace(std::move(sheets), static_cast<std::uint32_t>(numbers.size())).first->second;
    junctions.push_back({{first, first + 1, first + 1}, {kind, 0, 0}});
    if (branches) branching.push_back({{first, first + 1, first + 1}, {}});
  }
  if (branching.empty()) return;
  sheets_.resize(numbers.size());
  for (const auto& [sheets, number] : numbers) sheets_[number] = sheets;
  curves_ = ProjectionTree(points, std::move(branching));
  junctions_ = ProjectionTree(std::move(points), std::move(junctions));
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
    if (a.region != b.region) continue;
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

bool StripFinder::meet_near(const std::vector<std::size_t>& sheets, const Vec3& p) const {
  return junctions_
      .nearest_of(p, Strips::sheet_reach * cell_,
                  [&](const ProjectionTree::Item& item) {
                    const std::vector<std::size_t>& all = sheets_[item.kind[0]];
                    return std::includes(all.begin(), all.end(), sheets.begin(), sheets.end());
                  })
      .has_value();
}

std::vector<std::array<Index, 2>> StripFinder::edges(const TetMesh& mesh) const {
  std::vector<Triangle> near;
  std::vector<std::size_t> sheet_of;
  for (const InterfaceTriangle& f : mesh.interfaces) {
    const auto sheet = surface_.sheet_of(f);
    if (!sheet || !is_near_curve(mesh.points[f.ids[0]])) continue;
    near.push_back(f.ids);
    sheet_of.push_back(*sheet);
  }
  const std::vector<EdgeUse> uses = edge_uses(near, {});
  std::vector<std::array<Index, 2>> found;
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    std::vector<std::size_t> sheets;
    for (; j < uses.size() && uses[j].key == uses[i].key; ++j) sheets.push_back(sheet_of[uses[j].triangle]);
    if (sheets.size() < Strips::min_sheets) continue;
    std::sort(sheets.begin(), sheets.end());
    sheets.erase(std::unique(sheets.begin(), sheets.end()), sheets.end());
    const auto [a, b] = ends_of(uses[i].key);
    if (sheets.size() >= Strips::min_sheets && !meet_near(sheets, (mesh.points[a] + mesh.points[b]) / 2))
      found.push_back({a, b});
  }
  return found;
}

}  // namespace tetwright

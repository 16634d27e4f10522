// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/expected_solids.h"

#include <algorithm>

#include "common/geometry/self_intersection.h"
#include "common/geometry/surface_tree.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/tuning/input_tuning.h"
#include "tetwright/sheets.h"

namespace tetwright {

namespace {

bool boxes_meet(const RepairedSurface& a, const RepairedSurface& b) {
  return (a.low.array() <= b.high.array()).all() && (b.low.array() <= a.high.array()).all();
}

/// Whether points off a closed surface are inside.
class Inside {
 public:
  Inside(const RepairedSurface& surface, std::size_t queries) : surface_(surface) {
    if (queries > InputTuning::ExpectedSolids::max_plain_queries)
      tree_.emplace(surface.points, surface.triangles);
  }
  bool operator()(const Vec3& p) const {
    return (tree_ ? tree_->winding_number(p) : winding_number(surface_.points, surface_.triangles, p)) > 0.5;
  }

 private:
  const RepairedSurface& surface_;
  std::optional<SurfaceTree> tree_;
};

/// Whether surfaces meet each other; they may intersect themselves.
bool meet(const RepairedSurface& body, const std::vector<const RepairedSurface*>& later) {
  std::vector<Vec3> points = body.points;
  std::vector<Triangle> triangles = body.triangles;
  std::vector<std::size_t> ends{triangles.size()};  // of each surface's triangles
  for (const RepairedSurface* l : later) {
    const auto first = static_cast<Index>(points.size());
    points.insert(points.end(), l->points.begin(), l->points.end());
    for (const Triangle& t : l->triangles) triangles.push_back({first + t[0], first + t[1], first + t[2]});
    ends.push_back(triangles.size());
  }
  const auto surface_of = [&](Index triangle) {
    return std::upper_bound(ends.begin(), ends.end(), triangle);
  };
  const std::vector<std::pair<Index, Index>> pairs = self_intersections(points, triangles);
  return std::any_of(pairs.begin(), pairs.end(),
                     [&](const auto& pair) { return surface_of(pair.first) != surface_of(pair.second); });
}

/// The solid of a body without `later` ones, whose surfaces do not meet. Consists of the body's shells that
/// are in no later body, and of the shells of later bodies inside this one and in no other, reversed.
SolidShape carved_solid(const RepairedSurface& body, const SolidShape& solid,
                        const std::vector<const RepairedSurface*>& later,
                        const std::vector<SolidShape>& later_solids) {
  std::size_t shells = solid.shells.size();
  for (const SolidShape& s : later_solids) shells += s.shells.size();
  std::vector<Inside> inside_later;
  inside_later.reserve(later.size());
  for (const RepairedSurface* l : later) inside_later.emplace_back(*l, shells);
  const auto in_another = [&](const Vec3& p, std::size_t own) {
    for (std::size_t k = 0; k < later.size(); ++k)
      if (k != own && inside_later[k](p)) return true;
    return false;
  };
  SolidShape carved;
  for (const SolidShell& shell : solid.shells)
    if (!in_another(shell.place, later.size())) carved.shells.push_back(shell);
  const Inside inside_body(body, shells);
  for (std::size_t i = 0; i < later.size(); ++i)
    for (SolidShell shell : later_solids[i].shells) {
      if (!inside_body(shell.place) || in_another(shell.place, i)) continue;
      shell.volume = -shell.volume;
      carved.shells.push_back(shell);
    }
  return carved;
}

/// The solid of a surface that nothing carves.
SurfaceSolid own_solid(const RepairedSurface& s) {
  if (s.closed != s.triangles.size()) return {{}, SurfaceFlaw::open};
  SolidShape solid = solid_shape(s.points, s.triangles);
  if (!solid.manifold) return {{}, SurfaceFlaw::touching};
  const SurfaceFlaw flaw = s.intersects_itself    ? SurfaceFlaw::intersecting
                           : solid.touches_itself ? SurfaceFlaw::touching
                                                  : SurfaceFlaw::none;
  return {std::move(solid), flaw};
}

/// The solid of a region, from the faces of the complex; nothing if it touches itself in an edge or a point.
std::optional<SolidShape> solid_in_complex(const LabelledComplex& complex, std::size_t region) {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;
  std::vector<Index> number(complex.points.size(), no_index);
  for (const LabelledComplex::Face& f : complex.faces) {
    if (f.behind != region && f.front != region) continue;
    Triangle ids = f.ids;
    if (f.front == region) std::swap(ids[1], ids[2]);
    for (Index& p : ids) {
      if (number[p] == no_index) {
        number[p] = static_cast<Index>(points.size());
        points.push_back(complex.points[p]);
      }
      p = number[p];
    }
    triangles.push_back(ids);
  }
  SolidShape solid = solid_shape(points, triangles);
  if (!solid.manifold) return {};
  return solid;
}

/// The solid of a body that all later ones carve. `own` has the solid of each body before carving.
SurfaceSolid solid_of(const MesherInput& input, std::size_t number, const std::vector<SurfaceSolid>& own) {
  const RepairedSurface& body = input.bodies[number].surface;
  SurfaceSolid solid = own[number];
  std::vector<const RepairedSurface*> later;
  std::vector<SolidShape> later_solids;
  for (std::size_t k = number + 1; k < input.bodies.size() && solid.shape; ++k) {
    const RepairedSurface& other = input.bodies[k].surface;
    if (!boxes_meet(body, other)) continue;
    if (solid.flaw == SurfaceFlaw::none) solid.flaw = own[k].flaw;
    if (!own[k].shape) {
      solid.shape.reset();
      break;
    }
    later.push_back(&other);
    later_solids.push_back(*own[k].shape);
  }
  if (!solid.shape || later.empty()) return solid;
  if (meet(body, later)) {
    if (solid.flaw != SurfaceFlaw::none) return {{}, solid.flaw};
    return {input.complex ? solid_in_complex(*input.complex, number + 1) : std::nullopt,
            SurfaceFlaw::meeting};
  }
  solid.shape = carved_solid(body, *own[number].shape, later, later_solids);
  return solid;
}

}  // namespace

std::vector<std::optional<SurfaceSolid>> expected_solids(const MesherInput& input) {
  std::vector<SurfaceSolid> own;
  own.reserve(input.bodies.size());
  for (const MesherInput::Body& body : input.bodies) own.push_back(own_solid(body.surface));
  std::vector<std::optional<SurfaceSolid>> solids(input.bodies.size());
  for (std::size_t i = input.layers.empty() ? 0 : 1; i < input.bodies.size(); ++i)
    solids[i] = solid_of(input, i, own);
  return solids;
}

std::vector<ExpectedSheet> expected_sheets(const MesherInput& input) {
  if (!input.complex || input.complex->sheets.empty()) return {};
  const LabelledComplex& complex = *input.complex;
  std::vector<ExpectedSheet> expected;
  for (std::uint32_t k = 0; k < input.sheets.size(); ++k) {
    TetMesh mesh;
    mesh.points = complex.points;
    ExpectedSheet sheet;
    sheet.file = input.sheets[k].file;
    mesh.patch_groups[{{1, 1}, 0}] = input.sheets[k].group;
    double largest = -1;
    for (const LabelledComplex::SheetFace& f : complex.sheets) {
      if (f.sheet != k) continue;
      mesh.interfaces.push_back({f.ids, 1, 1});
      const auto& [a, b, c] = f.ids;
      const Vec3 &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
      const double size = (q - p).cross(r - p).norm();
      if (size > largest) largest = size, sheet.place = (p + q + r) / 3;
    }
    sheet.shape = sheet_statistics(mesh).front();
    sheet.shape.triangles = 0;
    expected.push_back(std::move(sheet));
  }
  return expected;
}

}  // namespace tetwright

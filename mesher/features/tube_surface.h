// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "mesher/features/branching_curves.h"
#include "mesher/features/near_tets.h"
#include "mesher/features/strip_finder.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The outer faces of tubes around branching curves, and a map of their points to vertices of the curves'
/// chains under which each face goes to a vertex or an edge, so that tets between a face and its image fill
/// the tubes.
class TubeSurface {
 public:
  /// A face between a tet of a tube and one outside it.
  struct Face {
    Triangle ids;        ///< counterclockwise as seen from the tube
    Index inner, outer;  ///< near tets; outer may be NearTets::far
  };
  /// The shape of a face that goes neither to a vertex nor to an edge: worse than all others.
  static constexpr double not_simplicial = -8;

  /// The arguments are kept.
  /// \param nearest by point of the mesh, the vertex of the chains that is preferred
  TubeSurface(const TetMesh& mesh, const NearTets& near, const BranchingCurves& curves,
              const StripFinder& finder, const std::vector<Index>& nearest, double cell);

  /// Finds the outer faces and maps their points.
  /// \param is_inside by near tet: part of a tube
  void find(const std::vector<std::uint8_t>& is_inside);

  const std::vector<Face>& faces() const { return faces_; }
  /// Points of the faces, ascending.
  const std::vector<Index>& points() const { return points_; }
  /// Indices of the faces at one of their points.
  const std::vector<Index>& faces_at(Index p) const { return faces_at_[p]; }
  /// The vertex to which one of the faces' points goes.
  Index image(Index p) const { return image_[p]; }
  /// Points of the mesh, followed by the vertices of the chains.
  const Vec3& position(Index p) const {
    return p < mesh_.points.size() ? mesh_.points[p] : vertex(p - first_vertex()).position;
  }
  Index first_vertex() const { return static_cast<Index>(mesh_.points.size()); }

  /// Calls `add` with the tets that join a face to the images of its points, as indices for position(). \pre
  /// the face goes to a vertex or an edge
  template <class Add>
  void tets_of(const Face& f, const Add& add) const;
  /// The smallest solid angle of the tets of a face. CutTuning::Tubes::shape_in_sheet if one has all points
  /// on one sheet, so that it will be flat once they are fitted to it; less if one is not positive.
  double shape(const Face& f) const;
  /// Whether the faces at a point are one fan, each label is one sector of it, and neighbours may touch.
  bool has_clean_bands(Index p) const;
  /// The number of steps along the chains from a vertex to the boundary, up to one more than is looked at.
  int steps_to_boundary(Index v) const { return steps_to_boundary_[v]; }

 private:
  const BranchingCurves::Vertex& vertex(Index v) const { return curves_.vertices()[v]; }
  void find_ways_to_boundary();
  bool are_joined(Index v, Index w) const;
  Index step(Index from, Index to) const;
  void map_points();
  void improve_map();
  bool may_go_to(Index p, Index v) const { return !is_on_border_[p] || vertex(v).is_on_boundary(); }
  bool is_in_sheet(const Tet& t) const;
  double worst_shape_at(Index p, double other) const;

  const TetMesh& mesh_;
  const NearTets& near_;
  const BranchingCurves& curves_;
  const StripFinder& finder_;
  const std::vector<Index>& nearest_;
  double cell_;
  std::vector<Index> to_boundary_;  ///< by vertex, the next one on the way there, or no_index
  std::vector<int> steps_to_boundary_;
  std::vector<Face> faces_;
  std::vector<Index> points_;                 ///< of the faces, ascending
  std::vector<std::vector<Index>> faces_at_;  ///< by point
  std::vector<std::uint8_t> is_on_border_;    ///< by point: on that of the faces, where the boundary begins
  std::vector<Index> image_;                  ///< by point, if it is one of the faces
};

template <class Add>
void TubeSurface::tets_of(const Face& f, const Add& add) const {
  std::array<Index, 3> order{0, 1, 2};
  const auto key = [&](Index k) { return std::pair(image(f.ids[k]), f.ids[k]); };
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return key(a) < key(b); });
  const bool is_even = order == std::array<Index, 3>{0, 1, 2} || order == std::array<Index, 3>{1, 2, 0} ||
                       order == std::array<Index, 3>{2, 0, 1};
  const Index a = f.ids[order[0]], b = f.ids[order[1]], c = f.ids[order[2]];
  const Index v = image(b), w = image(c);
  const auto give = [&](Tet t) {
    if (!is_even) std::swap(t[0], t[1]);
    add(t);
  };
  give({a, b, c, first_vertex() + w});
  if (v != w) give({a, b, first_vertex() + w, first_vertex() + v});
}

}  // namespace tetwright

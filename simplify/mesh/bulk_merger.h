// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "simplify/mesh/point_merging.h"

namespace tetwright {

/// Numbers in buckets: those of bucket k are items[starts[k]] to items[starts[k + 1]].
struct NumberBuckets {
  std::vector<Index> starts, items;
  std::span<const Index> operator[](Index k) const {
    return {items.data() + starts[k], items.data() + starts[k + std::size_t{1}]};
  }
};

inline bool vanishes(const Triangle& t) { return t[0] == t[1] || t[0] == t[2] || t[1] == t[2]; }
inline bool vanishes(const Tet& t) {
  return t[0] == t[1] || t[0] == t[2] || t[0] == t[3] || t[1] == t[2] || t[1] == t[3] || t[2] == t[3];
}

/// The moves of merge_points(): which points stay, and onto which ones the others move.
class BulkMerger {
 public:
  /// \param progress see merge_points()
  BulkMerger(const EditableMesh& mesh, const PointMerging& options, const Progress* progress)
      : mesh_(mesh),
        options_(options),
        progress_(progress),
        max_squared_(options.max_distance * options.max_distance) {}
  /// Finds the moves. False if a tet is not positive or the boundary meets itself.
  bool run();
  /// The remaining tets, in order, with their regions.
  void tets(std::vector<Tet>& tets, std::vector<RegionId>& regions) const;
  /// The remaining faces of boundary, interfaces and sheets.
  std::vector<InterfaceFace> faces() const;

 private:
  enum class Kind : std::uint8_t {
    fixed,      ///< always stays
    undecided,  ///< may stay or move
    kept,       ///< stays
    merged      ///< moves, unless its moves were undone
  };

  /// Finds the pieces of the surface: faces that share points which may move.
  void find_pieces();
  /// Lists the faces, and those at each point.
  void list_faces();
  /// Makes the points of smooth surfaces `undecided`, and lists them and the points inside materials. All
  /// others are `fixed`.
  void classify_points();
  bool is_smooth(Index p) const;
  /// Lists the tets of the points that may move.
  void list_stars();
  /// Keeps a maximal set of undecided points without neighbours in it, the first ones in a random order.
  /// The others are `merged`, and move onto their nearest neighbour.
  void merge(const std::vector<Index>& points);

  Vec3 normal(const Triangle& t) const {
    const Vec3& a = mesh_.position(t[0]);
    return (mesh_.position(t[1]) - a).cross(mesh_.position(t[2]) - a);
  }
  template <std::size_t n>
  std::array<Index, n> image(std::array<Index, n> ids) const {
    for (Index& p : ids) p = targets_[p];
    return ids;
  }
  bool on_surface(Index p) const { return faces_at_.starts[p] != faces_at_.starts[p + std::size_t{1}]; }
  /// Calls f(q) for the neighbours q of a point, on the surface if it is on the surface, several times each,
  /// until it returns false.
  ///
  /// \return false if f did
  template <class F>
  bool for_each_neighbour(Index p, const F& f) const;
  /// The kept or fixed neighbour that follows `last` in the order of distance, or `p` if none is near enough.
  ///
  /// \param last `p` for the first neighbour
  Index next_target(Index p, Index last) const;
  /// The point of an element that was moved farthest.
  template <std::size_t n>
  Index moved_farthest(const std::array<Index, n>& ids) const;
  bool is_bad(const Triangle& face) const;
  bool is_bad(const Tet& tet) const;
  /// Moves points onto other targets, or back, if they have had enough.
  ///
  /// \param points receives the same points in ascending order, each once
  ///
  /// \throws OutOfTime or Interrupted: each of the loops below asks here, as they may have many passes where
  ///   surfaces lie close together
  void move_elsewhere(std::vector<Index>& points);
  /// Moves points onto other targets, or back, until none of the faces is bad.
  void repair_faces();
  /// As above, for the tets at these points, or all. Moves of surface points are undone.
  void repair_tets(const std::optional<std::vector<Index>>& points);
  void undo(Index p);
  template <std::size_t n>
  void undo_all(const std::array<Index, n>& ids) {
    for (const Index p : ids) undo(p);
  }
  /// Undoes the moves that change the topology of the surface. False if there were such moves.
  bool topology_is_kept();
  bool clusters_are_contractible();
  bool pieces_remain();
  bool edges_are_kept();
  /// Undoes the moves of points of regions whose volume changes too much. False if there were such moves.
  bool volumes_are_kept();
  /// Undoes the moves that make the surface of all materials meet itself. False if there were such moves.
  bool surface_is_embedded();

  const EditableMesh& mesh_;
  const PointMerging& options_;
  const Progress* progress_;  ///< may be null
  const double max_squared_;
  std::vector<InterfaceFace> faces_;
  std::vector<Index> pieces_;          ///< by face: one of its piece
  NumberBuckets faces_at_;             ///< by point
  NumberBuckets tets_at_;              ///< by point that may move
  std::vector<std::uint32_t> keys_;    ///< by point: random
  std::vector<Kind> kinds_;            ///< by point
  std::vector<Index> targets_;         ///< by point: the point onto which it moves, or itself
  std::vector<std::uint8_t> changes_;  ///< by point: the number of its targets so far
  std::vector<Index> smooth_, inner_;  ///< points that may move, ascending
  std::vector<Index> changed_;         ///< surface points with other moves since the last check of tets
  int volume_passes_ = 0;              ///< calls of volumes_are_kept() that found changes
  bool intersects_ = false;            ///< the mesh's own surface meets itself
};

}  // namespace tetwright

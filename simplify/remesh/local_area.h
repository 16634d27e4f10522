// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/mesh/local_numbers.h"
#include "simplify/mesh/neighbourhood.h"
#include "simplify/remesh/change_journal.h"
#include "simplify/schedule/improvement_area.h"

namespace tetwright {

/// Tets and points to work on, as lists that are updated with every change, without scans of the whole mesh.
/// During its lifetime, observes every operation that a BlockRunner carries out.
class LocalArea final : public ImprovementArea {
 public:
  /// Covers `tets`, the rim around them, and the tets that replace these. Points beyond the rim are never
  /// worked on; tets at points of the rim may change with these points.
  ///
  /// \param journal records the changes.
  /// \param tets each once.
  /// \param with_rim all tets that share points with `tets`, including these.
  LocalArea(const EditableMesh& mesh, BlockRunner& runner, ChangeJournal& journal,
            const std::vector<Index>& tets, const std::vector<Index>& with_rim);
  ~LocalArea() override;
  LocalArea(const LocalArea&) = delete;
  LocalArea& operator=(const LocalArea&) = delete;

  /// Initial number of tets, with the rim.
  std::size_t tet_count() const override { return first_count_; }
  /// Mean edge of the initial tets.
  double usual_edge() const override { return usual_edge_; }
  /// \pre The limit does not increase from call to call: unchanged tets that were above it are not listed.
  std::vector<TetSnapshot> bad_tets(float limit) override;
  std::vector<Index> bad_points(float limit) override;
  std::vector<TetSnapshot> tets_around(const std::vector<TetSnapshot>& tets) override;
  std::vector<Index> points_around(const std::vector<TetSnapshot>& tets) override;
  std::vector<Index> points_to_thin(const std::vector<TetSnapshot>& bad) override {
    return points_around(bad);
  }

  /// The points of the initial tets, ascending.
  const std::vector<Index>& first_points() const { return first_points_; }
  /// Selects tets with inner points only, or tets without a point beyond the rim. Inner points are those of
  /// the initial tets and those added since; with_rim includes the points of the rim.
  enum class Part { inner, with_rim };
  /// The live points whose surroundings have changed since the last call, ascending.
  std::vector<Index> take_changed_points(Part part);
  /// The area's tets at these points, each once, ascending.
  std::vector<Index> tets_at(const std::vector<Index>& points, Part part);
  /// Restricts bad_tets() to the tets around these points, some of which may have been removed, and to later
  /// changes.
  void look_around(std::vector<Index>&& points);
  /// Number of operations carried out.
  std::uint64_t operations() const { return operations_; }

 private:
  void observe(const Proposal& proposal);
  enum class Place : std::uint8_t { beyond, rim, inner };
  Place place(Index point) const;
  void set_place(Index point, Place place);
  bool has(Index point, Part part) const {
    return place(point) >= (part == Part::inner ? Place::inner : Place::rim);
  }
  bool has(const Tet& tet, Part part) const;
  std::vector<Index> tets_around_living(std::vector<Index>&& points);
  std::vector<Index> numbers_around(const std::vector<TetSnapshot>& tets);
  std::vector<TetSnapshot> listed(const std::vector<Index>& tets) const;

  const EditableMesh& mesh_;
  BlockRunner& runner_;
  ChangeJournal& journal_;
  std::size_t first_count_;
  double usual_edge_;
  LocalNumbers point_numbers_;
  std::vector<Place> places_;  ///< by number of point_numbers_
  std::vector<Index> first_points_;
  std::vector<Index> candidates_;      ///< tets that bad_tets() looks at
  std::vector<Index> changed_points_;  ///< since take_changed_points()
  Neighbourhood near_;
  std::uint64_t operations_ = 0;
};

}  // namespace tetwright

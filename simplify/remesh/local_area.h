// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/mesh/local_numbers.h"
#include "simplify/mesh/neighbourhood.h"
#include "simplify/remesh/change_journal.h"
#include "simplify/schedule/improvement_area.h"

namespace tetwright {

/// Tets and points to be worked on, as lists that follow what changes: nothing looks at the whole mesh. Sees
/// all that a BlockRunner carries out while it exists.
class LocalArea final : public ImprovementArea {
 public:
  /// Of `tets`, each listed once, of the rim around them, and of what takes their place. `with_rim` are all
  /// tets that share points with `tets`, which are among them. Points beyond it are never worked on; tets at
  /// the rim's points change with these. `journal` takes down what changes.
  LocalArea(const EditableMesh& mesh, BlockRunner& runner, ChangeJournal& journal,
            const std::vector<Index>& tets, const std::vector<Index>& with_rim);
  ~LocalArea() override;
  LocalArea(const LocalArea&) = delete;
  LocalArea& operator=(const LocalArea&) = delete;

  /// Of the tets that there were at first, with the rim.
  std::size_t tet_count() const override { return first_count_; }
  /// The mean of those of its tets that there were at first.
  double usual_edge() const override { return usual_edge_; }
  /// The limit may not rise: what was above it before and has not changed since is not listed.
  std::vector<TetSnapshot> bad_tets(float limit) override;
  std::vector<Index> bad_points(float limit) override;
  std::vector<TetSnapshot> tets_around(const std::vector<TetSnapshot>& tets) override;
  std::vector<Index> points_around(const std::vector<TetSnapshot>& tets) override;
  std::vector<Index> points_to_thin(const std::vector<TetSnapshot>& bad) override {
    return points_around(bad);
  }

  /// The points of the tets that there were at first, ascending.
  const std::vector<Index>& first_points() const { return first_points_; }
  /// Which tets: those of inner points alone, or all without a point beyond the rim. Which points: those of
  /// the tets that there were at first and those that came since, or with the rim's.
  enum class Part { inner, with_rim };
  /// The living points around which something changed since this was last called, ascending.
  std::vector<Index> take_changed_points(Part part);
  /// The tets of the area at points, each once, ascending.
  std::vector<Index> tets_at(const std::vector<Index>& points, Part part);
  /// From now on bad_tets() looks at the tets around these points, some of which may have gone since, and at
  /// what changes.
  void look_around(std::vector<Index>&& points);
  /// Operations that were carried out.
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
  std::vector<Place> places_;  ///< by these
  std::vector<Index> first_points_;
  std::vector<Index> candidates_;      ///< tets that bad_tets() looks at
  std::vector<Index> changed_points_;  ///< since they were last taken
  Neighbourhood near_;
  std::uint64_t operations_ = 0;
};

}  // namespace tetwright

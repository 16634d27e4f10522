// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/geometry/box_tree.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/remesh/change_journal.h"
#include "simplify/remesh/tet_overlap.h"

namespace tetwright {

/// Carries fields over from the tets that a ChangeJournal has to those that took their place.
///
/// Numbers at points are linear in each old tet; where none holds a point that moved or came (the surface
/// went outwards), the nearest place of an old tet counts. Numbers of tets are densities: constant in each
/// old tet, weighted by the volumes that old and new tets have in common; then those of each material are
/// corrected by one summand, so that the sum of number times volume over the changed tets stays what it was.
class FieldCarrier {
 public:
  /// After the changes; both must live as long.
  FieldCarrier(const EditableMesh& mesh, const ChangeJournal& journal);

  /// `values`: `components` for each point slot. Those of points that came or moved are written; those of
  /// points that went become 0.
  void carry_point_field(std::vector<double>& values, std::size_t components) const;
  /// `values`: `components` for each tet slot. Those of all tets that came or changed are written, those of
  /// tets that went become 0.
  void carry_tet_field(std::vector<double>& values, std::size_t components) const;

 private:
  /// An old tet with its positive volume; inverted ones count as their mirror images.
  struct Source {
    PlanedTet tet;
    Tet points;
    Index slot;
    RegionId region;
  };
  struct Target {
    Index slot;
    RegionId region;
    double volume;
    std::vector<std::pair<std::uint32_t, double>> shares;  ///< source, common volume
  };
  struct Weights {
    std::array<Index, 4> points;
    std::array<double, 4> weights;
  };
  struct PlacedPoint {
    Index point;
    Weights from;
  };
  void add_sources();
  void add_targets();
  void place_points();
  /// Shares of a source's corners in a place, none below 0, or all 0 where it is flat; whether it holds it.
  static bool weigh(const Source& source, const Vec3& p, std::array<double, 4>& weights);
  Weights weights_at(const Vec3& p) const;
  template <class Visit>
  void for_sources_near(const Box3& box, const Visit& visit) const;

  const EditableMesh& mesh_;
  const ChangeJournal& journal_;
  std::vector<Source> sources_;  ///< in the order of the tree
  std::vector<Box3> boxes_;      ///< of the sources
  BoxTree tree_;
  std::vector<Target> targets_;
  std::vector<PlacedPoint> placed_;
};

}  // namespace tetwright

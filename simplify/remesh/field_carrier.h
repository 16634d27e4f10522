// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "common/geometry/box_tree.h"
#include "simplify/mesh/editable_mesh.h"
#include "simplify/remesh/change_journal.h"
#include "simplify/remesh/tet_overlap.h"

namespace tetwright {

/// Transfers fields from the old tets of a ChangeJournal to the tets that replace them.
///
/// Point fields are linear in each old tet. A point that no old tet contains (the surface moved outwards)
/// gets the value of the nearest point on an old tet. Tet fields are densities: constant in each old tet,
/// averaged by the volumes that old and new tets share. Then a constant added to the values of each material
/// restores the sum of value times volume over the changed tets.
class FieldCarrier {
 public:
  /// \pre All changes are complete. Both arguments must outlive this object.
  FieldCarrier(const EditableMesh& mesh, const ChangeJournal& journal);

  /// \param values `components` for each point slot. Writes those of points that were added or moved; sets
  ///   those of removed points to 0.
  void carry_point_field(std::vector<double>& values, std::size_t components) const;
  /// \param values `components` for each tet slot. Writes those of all tets that were added or changed; sets
  ///   those of removed tets to 0.
  void carry_tet_field(std::vector<double>& values, std::size_t components) const;

 private:
  /// An old tet with positive volume; an inverted one counts as its mirror image.
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
  /// Barycentric weights of a point in a source, clamped to at least 0; all 0 if the source is flat. Returns
  /// whether the source contains the point.
  static bool weigh(const Source& source, const Vec3& p, std::array<double, 4>& weights);
  Weights weights_at(const Vec3& p) const;
  template <class Visit>
  void for_sources_near(const Box3& box, const Visit& visit) const;

  const EditableMesh& mesh_;
  const ChangeJournal& journal_;
  std::vector<Source> sources_;  ///< in the order of the tree
  std::vector<Box3> boxes_;      ///< by source
  BoxTree tree_;
  std::vector<Target> targets_;
  std::vector<PlacedPoint> placed_;
};

}  // namespace tetwright

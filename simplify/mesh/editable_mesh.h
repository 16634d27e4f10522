// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/tet_mesh.h"
#include "common/types.h"
#include "simplify/mesh/face_patches.h"
#include "simplify/mesh/free_slots.h"
#include "simplify/mesh/reservations.h"
#include "simplify/mesh/tet_record.h"
#include "simplify/mesh/working_space.h"

namespace tetwright {

/// New numbers by old ones; no_index: nothing was there.
struct SlotNumbers {
  std::vector<Index> points, tets;
};

/// The mesh while it is simplified: a tet knows its neighbours across faces, a point knows one incident tet.
/// No array is reallocated while workers run.
///
/// Who may write what (README.md has the whole protocol): while operations are decided, nobody writes. While
/// they are committed, each writes the tets that it changes, and across a hull face the link of the tet
/// outside; all points of such tets and faces are in its write set (Reservations). WriteRule asserts it.
class EditableMesh {
 public:
  /// Takes a mesh over. Working coordinates are shifted along each axis on which that is exact for every
  /// point, and scaled by a power of two; they come back bit by bit by `to_mesh`. Flat and negative tets are
  /// taken as they are. A point whose star falls into parts that no face joins becomes one frozen point for
  /// each part, and one again in to_mesh. Patches are those of the mesh's interfaces. Throws InputError (with
  /// `name` in the message) where a coordinate is not finite, a tet repeats a point, a face has more than two
  /// tets or two on one side (such a mesh has no neighbours to walk by), or `interfaces` is neither empty nor
  /// what the tets say.
  EditableMesh(TetMesh&& mesh, const std::string& name);

  /// The mesh as a plain value, without dead tets and unused points, in input units, with its interfaces;
  /// what this holds is given up.
  TetMesh to_mesh() &&;

  std::size_t live_tets() const { return live_; }
  /// Slots of tets, dead ones included: 0 <= tet < tet_slots().
  std::size_t tet_slots() const { return tets_.size(); }
  std::size_t point_slots() const { return positions_.size(); }
  std::size_t region_count() const { return tags_.size(); }
  MaterialTag tag(RegionId region) const { return tags_[region]; }
  const std::map<MaterialTag, std::string>& names() const { return names_; }
  const std::map<InterfacePatch, SurfaceRegion>& patch_groups() const { return patch_groups_; }
  const WorkingSpace& space() const { return space_; }
  Vec3 snap(const Vec3& working) const { return space_.snap(working); }

  /// A point that never moves nor goes. A face of boundary or interfaces with three such points stays.
  bool frozen(Index point) const { return any_frozen() && frozen_[point] != 0; }
  /// A tet that stays as it is: all its points are in the mask of freeze(), or at places where parts touch.
  bool frozen_tet(Index t) const {
    if (!any_frozen()) return false;
    const Tet& p = tets_[t].points;
    return (frozen_[p[0]] & frozen_[p[1]] & frozen_[p[2]] & frozen_[p[3]] & with_tets) != 0;
  }
  bool any_frozen() const { return !frozen_.empty(); }
  /// Freezes the points p for which mask[p] is not 0, in the order in which the mesh came, and the tets that
  /// have no others. Points where parts touch without a common face are frozen with all their tets already.
  /// While no task runs, before compact().
  void freeze(const std::vector<std::uint8_t>& mask);
  /// Freezes all points of boundary and interfaces, and so their faces. While no task runs.
  void freeze_interfaces();
  /// Places where parts touch without a common face, whatever number of points stands at each.
  std::size_t touching_points() const;
  /// What such a point was split off from; the point itself for all others.
  Index original(Index point) const { return point < originals_.size() ? originals_[point] : point; }
  /// Whether faces between materials have patches other than 0: these stand in SurfaceGrid.
  bool interface_patches() const { return !interface_patches_.empty(); }

  // Reading.
  const Vec3& position(Index point) const { return positions_[point]; }
  /// One tet of the point; no_index when the point is no longer there.
  Index incident_tet(Index point) const { return incident_tets_[point]; }
  /// Whether the point's star was changed since the last begin_round().
  bool touched(Index point) const { return touched_[point] == round_; }
  const Tet& points(Index t) const { return tets_[t].points; }
  bool dead(Index t) const { return tets_[t].points[0] == no_index; }
  FaceLink link(Index t, int face) const { return tets_[t].links[face]; }
  /// The tet across a face; no_index: outside.
  Index neighbour(Index t, int face) const { return tets_[t].links[face].tet(); }
  RegionId region(Index t) const { return regions_[t]; }
  /// By the objective of the schedule, rounded.
  float quality(Index t) const { return qualities_[t]; }
  /// The region on the other side of a face.
  RegionId region_across(Index t, int face) const {
    const FaceLink link = tets_[t].links[face];
    return link.is_outside() ? outside_id : regions_[link.tet()];
  }
  /// Where `point` stands in tet t, which has it.
  int slot_of(Index t, Index point) const { return slot_in(tets_[t].points, point); }
  /// The face of t across which `other` lies, which is a neighbour.
  int face_towards(Index t, Index other) const {
    const auto& n = tets_[t].links;
    return n[0].tet() == other ? 0 : n[1].tet() == other ? 1 : n[2].tet() == other ? 2 : 3;
  }

  /// Asks for what is going to be read of a tet, or of a point, so that it is there by then.
  void prefetch_tet(Index t) const {
    __builtin_prefetch(&tets_[t]);
    __builtin_prefetch(&qualities_[t]);
  }
  void prefetch_point(Index p) const { __builtin_prefetch(&positions_[p]); }

  // Writing: while no task runs, or by the winner whose write set has the points concerned.
  void set_position(Index point, const Vec3& position) {
    WriteRule::check(point);
    positions_[point] = position;
  }
  /// Only where the tet that stood there dies: then there is one writer.
  void set_incident_tet(Index point, Index tet) {
    WriteRule::check(point);
    incident_tets_[point] = tet;
  }
  /// Marks a point whose star was changed, with the current round.
  void touch(Index point) {
    WriteRule::check(point);
    // Several may touch one point at a time; relaxed, since all write the same and nobody reads it meanwhile.
    std::atomic_ref<std::uint32_t>(touched_[point]).store(round_, std::memory_order_relaxed);
  }
  void set_points(Index t, const Tet& points) {
    check_tet(t);
    tets_[t].points = points;
    check_tet(t);
  }
  void set_point(Index t, int slot, Index point) {
    check_tet(t);
    tets_[t].points[slot] = point;
    WriteRule::check(point);
  }
  void set_link(Index t, int face, FaceLink link) {
    for (std::uint8_t k : tet_faces[face]) check_point_of(t, k);
    tets_[t].links[face] = link;
  }
  void set_region(Index t, RegionId region) {
    check_tet(t);
    regions_[t] = region;
  }
  void set_quality(Index t, float quality) {
    check_tet(t);
    qualities_[t] = quality;
  }

  // Only while no task runs.

  /// The number of living tets changes by that much.
  void change_count(std::int64_t change) {
    WriteRule::check();
    live_ = static_cast<std::size_t>(static_cast<std::int64_t>(live_) + change);
  }
  /// Free slots for operations that add; make_room() adds slots where there are fewer, not many at a time.
  FreeSlots& free_tets() { return free_tets_; }
  FreeSlots& free_points() { return free_points_; }
  void make_room(std::size_t tets, std::size_t points);
  Reservations& reservations() { return reservations_; }
  /// Nothing is touched any more.
  void begin_round() { ++round_; }
  /// Removes dead tets and points and renumbers both along a space-filling curve, so that what is near
  /// in space is near in memory; leaves free slots at the end for operations that add tets and points.
  /// `numbers`, unless it is null, gets the new numbers of all slots.
  void compact(std::size_t spare_tets, std::size_t spare_points, SlotNumbers* numbers = nullptr);
  /// Room for twice as many without copying what there is; memory is taken up only where it is written.
  void reserve_twice();
  /// The share of the slots that were in use and are dead now.
  double dead_share() const;
  /// The faces between two regions, outside being one, each once. Parallel; the order does not depend on the
  /// threads. Patches of faces between materials are those with which the mesh came: only before the first
  /// operation.
  std::vector<InterfaceFace> interface_faces() const;
  /// The patches of faces between materials, for to_mesh(); by operations' end they stand in SurfaceGrid.
  void set_interface_patches(FacePatches&& patches) { interface_patches_ = std::move(patches); }
  /// Of a living tet, working coordinates cubed.
  double signed_volume(Index t) const;
  /// In working coordinates cubed; flat and negative tets count as they are.
  double total_volume() const;
  /// Of the bounding box of the living points, working coordinates.
  double diagonal() const;
  /// Whether all tets are positive, by exact sign.
  bool all_positive() const;
  /// Every invariant of the links: neighbours mutual, incident_tets right, faces equal, live count right. For
  /// tests.
  bool links_consistent() const;

 private:
  friend class MeshBuilder;
  friend class MeshCompaction;

  void set_incident_tets();
  void check_point_of(Index t, int k) const {
    if (tets_[t].points[k] != no_index) WriteRule::check(tets_[t].points[k]);
  }
  void check_tet(Index t) const {
    for (int k = 0; k < 4; ++k) check_point_of(t, k);
  }

  std::vector<TetRecord> tets_;
  std::vector<RegionId> regions_;
  std::vector<float> qualities_;
  std::vector<Vec3> positions_;
  std::vector<Index> incident_tets_;
  std::vector<std::uint32_t> touched_;  ///< by point: the round of the last change
  std::uint32_t round_ = 1;
  Reservations reservations_;
  std::size_t live_ = 0;
  FreeSlots free_tets_, free_points_;
  /// What frozen_ says of a point: it stays; it stays with the tets that have only such points.
  static constexpr std::uint8_t alone = 1, with_tets = 2;
  std::vector<std::uint8_t> frozen_;  ///< by point; empty if none is
  std::vector<Index> originals_;      ///< by point; empty if no star was split
  /// By the ascending originals of their points; empty if all are 0.
  FacePatches interface_patches_;
  std::vector<MaterialTag> tags_;  ///< of each region
  std::map<MaterialTag, std::string> names_;
  std::map<InterfacePatch, SurfaceRegion> patch_groups_;
  WorkingSpace space_;
};

}  // namespace tetwright

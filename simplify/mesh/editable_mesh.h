// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "common/geometry/box_tree.h"
#include "simplify/mesh/face_patches.h"
#include "simplify/mesh/free_slots.h"
#include "simplify/mesh/reservations.h"
#include "simplify/mesh/tet_record.h"
#include "simplify/mesh/working_space.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// New numbers by old ones; no_index: unused slot.
struct SlotNumbers {
  std::vector<Index> points, tets;
};

/// The mesh during simplification: each tet has links to its neighbours across faces, each point to one
/// incident tet. No array is reallocated while workers run.
///
/// Concurrency (README.md has the whole protocol): nothing is written while operations are decided. During
/// commit, each operation writes the tets that it changes, and the links of tets across the cavity's hull;
/// all points of these tets and faces are in its write set (Reservations). WriteRule asserts this.
class EditableMesh {
 public:
  /// Takes ownership of the mesh. Working coordinates are shifted along each axis for which that is exact for
  /// every point, and scaled by a power of two; `to_mesh` restores the input coordinates bit by bit. Flat and
  /// negative tets are accepted. A point whose star consists of parts not joined by faces is split into one
  /// frozen point for each part; `to_mesh` merges them again. Patches come from the mesh's interfaces.
  ///
  /// \param name the mesh's name in messages.
  /// \throws InputError if a coordinate is not finite; if a tet repeats a point; if a face has more than two
  ///   tets, or two on one side (neighbours are then undefined); if `interfaces` is neither empty nor what
  ///   the tets imply, apart from sheets; if a face of a sheet is not between two tets of its material.
  EditableMesh(TetMesh&& mesh, const std::string& name);

  /// Returns the mesh without dead tets and unused points, in input units, with its interfaces. Empties this
  /// object.
  TetMesh to_mesh() &&;

  std::size_t live_tets() const { return live_; }
  /// Number of tet slots, dead ones included: 0 <= tet < tet_slots().
  std::size_t tet_slots() const { return tets_.size(); }
  std::size_t point_slots() const { return positions_.size(); }
  std::size_t region_count() const { return tags_.size(); }
  MaterialTag tag(RegionId region) const { return tags_[region]; }
  const std::map<MaterialTag, std::string>& names() const { return names_; }
  const std::map<InterfacePatch, SurfaceRegion>& patch_groups() const { return patch_groups_; }
  /// TetMesh::space of the mesh.
  const std::string& coordinate_system() const { return coordinate_system_; }
  const WorkingSpace& space() const { return space_; }
  Vec3 snap(const Vec3& working) const { return space_.snap(working); }

  /// Whether the point is never moved or removed. A boundary or interface face with three frozen points is
  /// kept.
  bool frozen(Index point) const { return any_frozen() && frozen_[point] != 0; }
  /// Whether the tet is kept unchanged: all its points are in the mask of freeze() or belong to tets at a
  /// touching point.
  bool frozen_tet(Index t) const {
    if (!any_frozen()) return false;
    const Tet& p = tets_[t].points;
    return (frozen_[p[0]] & frozen_[p[1]] & frozen_[p[2]] & frozen_[p[3]] & with_tets) != 0;
  }
  bool any_frozen() const { return !frozen_.empty(); }
  /// Freezes the points p with a nonzero mask[p], and the tets with only such points. Points where parts
  /// touch without a common face are already frozen, with all their tets.
  ///
  /// \param mask by point, in the input's order.
  /// \pre No task runs; before compact().
  void freeze(const std::vector<std::uint8_t>& mask);
  /// Freezes all points of boundary and interfaces, and so their faces.
  /// \pre No task runs.
  void freeze_interfaces();
  /// Number of positions at which parts touch without a common face; each counts once, whatever its number of
  /// points.
  std::size_t touching_points() const;
  /// The original of a copy made by splitting; for all other points, the point itself.
  Index original(Index point) const { return point < originals_.size() ? originals_[point] : point; }
  /// Whether interface faces have patches other than 0; SurfaceGrid keeps these.
  bool interface_patches() const { return !interface_patches_.empty(); }

  // Reading.
  const Vec3& position(Index point) const { return positions_[point]; }
  std::span<const Vec3> positions() const { return positions_; }
  /// A tet of the point; no_index: the point is dead.
  Index incident_tet(Index point) const { return incident_tets_[point]; }
  /// Whether the point's star was changed since the last begin_round().
  bool touched(Index point) const { return touched_[point] == round_; }
  const Tet& points(Index t) const { return tets_[t].points; }
  bool dead(Index t) const { return tets_[t].points[0] == no_index; }
  FaceLink link(Index t, int face) const { return tets_[t].links[face]; }
  /// The tet across a face; no_index: outside.
  Index neighbour(Index t, int face) const { return tets_[t].links[face].tet(); }
  RegionId region(Index t) const { return regions_[t]; }
  /// Value of the schedule's objective, rounded.
  float quality(Index t) const { return qualities_[t]; }
  /// The region on the other side of a face.
  RegionId region_across(Index t, int face) const {
    const FaceLink link = tets_[t].links[face];
    return link.is_outside() ? outside_id : regions_[link.tet()];
  }
  /// Slot of `point` in tet t.
  /// \pre The tet has the point.
  int slot_of(Index t, Index point) const { return slot_in(tets_[t].points, point); }
  /// The face of t shared with `other`.
  /// \pre The tets are neighbours.
  int face_towards(Index t, Index other) const {
    const auto& n = tets_[t].links;
    return n[0].tet() == other ? 0 : n[1].tet() == other ? 1 : n[2].tet() == other ? 2 : 3;
  }

  /// Prefetches the data of a tet or a point.
  void prefetch_tet(Index t) const {
    __builtin_prefetch(&tets_[t]);
    __builtin_prefetch(&qualities_[t]);
  }
  void prefetch_point(Index p) const { __builtin_prefetch(&positions_[p]); }

  // Writing: while no task runs, or by a winner, at points of its write set.
  void set_position(Index point, const Vec3& position) {
    WriteRule::check(point);
    positions_[point] = position;
  }
  /// Call this only if the old incident tet is removed, so that there is a single writer.
  void set_incident_tet(Index point, Index tet) {
    WriteRule::check(point);
    incident_tets_[point] = tet;
  }
  /// Marks that the point's star has changed in the current round.
  void touch(Index point) {
    WriteRule::check(point);
    // Several threads may touch a point at the same time. Relaxed, since all store the same value and no
    // thread reads it meanwhile.
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

  /// Adds `change` to the number of live tets.
  void change_count(std::int64_t change) {
    WriteRule::check();
    live_ = static_cast<std::size_t>(static_cast<std::int64_t>(live_) + change);
  }
  /// Free slots for operations that add elements. make_room() adds slots, in small steps, if fewer than
  /// requested are free.
  FreeSlots& free_tets() { return free_tets_; }
  FreeSlots& free_points() { return free_points_; }
  void make_room(std::size_t tets, std::size_t points);
  Reservations& reservations() { return reservations_; }
  /// Clears all touched marks.
  void begin_round() { ++round_; }
  /// Removes dead tets and points and renumbers both along a space-filling curve, so that neighbours in space
  /// are close in memory.
  ///
  /// \param spare_tets, spare_points free slots left at the end for operations that add elements.
  /// \param numbers receives the new numbers of all slots; may be null.
  void compact(std::size_t spare_tets, std::size_t spare_points, SlotNumbers* numbers = nullptr);
  /// Reserves room for twice as many slots, so that growth copies nothing; memory is committed only where it
  /// is written.
  void reserve_twice();
  /// Fraction of dead slots among the slots used so far.
  double dead_share() const;
  /// The faces between two regions, outside included, and those of sheets, each once. Parallel; the order
  /// does not depend on the number of threads. Patches of interface faces are those of the input, so they are
  /// valid only before the first operation.
  std::vector<InterfaceFace> interface_faces() const;
  /// The faces of sheets, without patches.
  ///
  /// \param numbers by point: its index in the faces.
  std::vector<InterfaceTriangle> sheets(const std::vector<Index>& numbers) const;
  /// Sets the patches of interface faces for to_mesh(): SurfaceGrid keeps them during operations.
  void set_interface_patches(FacePatches&& patches) { interface_patches_ = std::move(patches); }
  /// Volume of a live tet, working coordinates cubed.
  double signed_volume(Index t) const;
  /// Sum of the signed volumes, working coordinates cubed.
  double total_volume() const;
  /// Bounding box of the live points, working coordinates.
  Box3 bounding_box() const;
  /// Its diagonal.
  double diagonal() const;
  /// Whether all tets are positive, by exact sign.
  bool all_positive() const;
  /// Checks every invariant of the links: mutual neighbours, equal faces, valid incident tets, correct live
  /// count. For tests.
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
  /// Values of frozen_: the point is frozen; the point and the tets that have only such points are.
  static constexpr std::uint8_t alone = 1, with_tets = 2;
  std::vector<std::uint8_t> frozen_;  ///< by point; empty if no point is frozen
  std::vector<Index> originals_;      ///< by point; empty if no star was split
  /// Patches of interface faces by the ascending originals of their points; empty if all are 0.
  FacePatches interface_patches_;
  std::vector<MaterialTag> tags_;  ///< by region
  std::map<MaterialTag, std::string> names_;
  std::map<InterfacePatch, SurfaceRegion> patch_groups_;
  std::string coordinate_system_;  ///< TetMesh::space
  WorkingSpace space_;
};

}  // namespace tetwright

#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/tet_mesh.h"
#include "common/types.h"
#include "simplify/mesh/free_slots.h"
#include "simplify/mesh/locks.h"
#include "simplify/mesh/tet_record.h"
#include "simplify/mesh/working_space.h"

namespace tetwright {

/// The mesh while it is simplified: a tet knows its neighbours across faces, a point knows one incident tet
/// and has a try-lock. No array is reallocated while workers run.
///
/// What the lock of a point guards (README.md has the whole protocol). All that is stored for the point is
/// read and written only while it is locked. A tet's points, region and quality are written while all its old
/// and new points are locked, and read while one of its points is. A tet's neighbour across a face is written
/// while the three points of the face are locked, and read while one of them is.
///
/// The four ids of a tet are relaxed atomics (load_points()), since a worker compares them with its list
/// before it knows whether the tet still exists.
class EditableMesh {
 public:
  /// Takes a mesh over. Working coordinates are shifted along each axis on which that is exact for every
  /// point, and scaled by a power of two; they come back bit by bit by `to_mesh`. Flat and negative tets are
  /// taken as they are. A point whose star falls into parts that no face joins becomes one pinned point for
  /// each part, and one again in to_mesh. Throws InputError (with `name` in the message) where a coordinate
  /// is not finite, a tet repeats a point, or a face has more than two tets or two on one side: such a mesh
  /// has no neighbours to walk by.
  EditableMesh(TetMesh&& mesh, const std::string& name);

  /// The mesh as a plain value, without dead tets and unused points, in input units; what this holds is given
  /// up.
  TetMesh to_mesh() &&;

  std::size_t live_tets() const { return static_cast<std::size_t>(live_.load(std::memory_order_relaxed)); }
  /// Slots of tets, dead ones included: 0 <= tet < tet_slots().
  std::size_t tet_slots() const { return tets_.size(); }
  std::size_t point_slots() const { return positions_.size(); }
  std::size_t region_count() const { return tags_.size(); }
  MaterialTag tag(RegionId region) const { return tags_[region]; }
  const WorkingSpace& space() const { return space_; }
  Vec3 snap(const Vec3& working) const { return space_.snap(working); }
  /// A point where parts of the mesh touch without a common face: it stays as it is with all its tets.
  bool pinned(Index point) const { return any_pinned() && pinned_[point] != 0; }
  bool any_pinned() const { return !pinned_.empty(); }
  /// Pinned places, whatever number of points stands at each.
  std::size_t pinned_points() const;
  /// What a pinned point was split off from; the point itself for all others.
  Index original(Index point) const { return any_pinned() ? originals_[point] : point; }

  // Access under the protocol above.
  const Vec3& position(Index point) const { return positions_[point]; }
  void set_position(Index point, const Vec3& position) { positions_[point] = position; }
  /// One tet of the point; no_index when the point is no longer there.
  Index incident_tet(Index point) const { return incident_tets_[point]; }
  void set_incident_tet(Index point, Index tet) { incident_tets_[point] = tet; }
  /// Marks a point whose star an operation changed, with the current round.
  void touch(Index point) { touched_[point] = round_; }
  /// Whether it was since the last begin_round().
  bool touched(Index point) const { return touched_[point] == round_; }
  const TetRecord& tet(Index t) const { return tets_[t]; }
  Index neighbour(Index t, int face) const { return tets_[t].neighbours[face]; }
  void set_neighbour(Index t, int face, Index other) { tets_[t].neighbours[face] = other; }
  void set_quality(Index t, float quality) { tets_[t].quality = quality; }
  /// The four ids, safe to read without any lock; only a comparison with what is held gives them a meaning.
  Tet load_points(Index t) const {
    Tet out;
    for (int k = 0; k < 4; ++k)
      out[k] = std::atomic_ref<Index>(const_cast<Index&>(tets_[t].points[k])).load(std::memory_order_relaxed);
    return out;
  }
  void store_point(Index t, int k, Index point) {
    std::atomic_ref<Index>(tets_[t].points[k]).store(point, std::memory_order_relaxed);
  }
  void store_points(Index t, const Tet& points) {
    for (int k = 0; k < 4; ++k) store_point(t, k, points[k]);
  }
  void set_region(Index t, RegionId region) { tets_[t].region = region; }
  /// The region on the other side of a face.
  RegionId region_across(Index t, int face) const {
    const Index other = tets_[t].neighbours[face];
    return other == no_index ? outside_id : tets_[other].region;
  }
  /// Where `point` stands in tet t, which has it.
  int slot_of(Index t, Index point) const {
    const Tet& p = tets_[t].points;
    return p[0] == point ? 0 : p[1] == point ? 1 : p[2] == point ? 2 : 3;
  }
  /// The face of t across which `other` lies, which is a neighbour.
  int face_towards(Index t, Index other) const {
    const auto& n = tets_[t].neighbours;
    return n[0] == other ? 0 : n[1] == other ? 1 : n[2] == other ? 2 : 3;
  }
  bool dead(Index t) const { return load_points(t)[0] == no_index; }

  TryLocks& locks() { return locks_; }

  /// Free slots for operations that add.
  FreeSlotReserve& free_tets() { return free_tets_; }
  FreeSlotReserve& free_points() { return free_points_; }

  /// Changes the number of living tets unless it would leave [min_tets, max_tets] or get farther away from
  /// it: then false, and nothing changed.
  bool change_count(std::int64_t change, std::size_t min_tets, std::size_t max_tets) {
    std::int64_t now = live_.load(std::memory_order_relaxed);
    do {
      if (change < 0 && now + change < static_cast<std::int64_t>(min_tets)) return false;
      if (change > 0 && now + change > static_cast<std::int64_t>(max_tets)) return false;
      // Relaxed: the number carries no other data.
    } while (!live_.compare_exchange_weak(now, now + change, std::memory_order_relaxed));
    return true;
  }

  // Only while no task runs.

  /// Nothing is touched any more.
  void begin_round() { ++round_; }
  /// Removes dead tets and points and renumbers both along a space-filling curve, so that what is near
  /// in space is near in memory; leaves free slots at the end for operations that add tets and points.
  void compact(std::size_t spare_tets, std::size_t spare_points);
  /// The faces between two regions, outside being one, each once. Parallel; the order does not depend on the
  /// threads.
  std::vector<InterfaceFace> interface_faces() const;
  /// Of a living tet, working coordinates cubed.
  double signed_volume(Index t) const;
  /// In working coordinates cubed; flat and negative tets count as they are.
  double total_volume() const;
  /// Every invariant of the links: neighbours mutual, incident_tets right, faces equal, live count right. For
  /// tests.
  bool links_consistent() const;

 private:
  friend class MeshBuilder;
  friend class MeshCompaction;

  void set_incident_tets();

  std::vector<TetRecord> tets_;
  std::vector<Vec3> positions_;
  std::vector<Index> incident_tets_;
  std::vector<std::uint32_t> touched_;  ///< by point: the round of the last change
  std::uint32_t round_ = 1;
  TryLocks locks_;
  std::atomic<std::int64_t> live_{0};
  FreeSlotReserve free_tets_, free_points_;
  std::vector<std::uint8_t> pinned_;  ///< by point; empty if none is
  std::vector<Index> originals_;      ///< by point; empty if none is pinned
  std::vector<MaterialTag> tags_;     ///< of each region
  std::map<MaterialTag, std::string> names_;
  WorkingSpace space_;
};

}  // namespace tetwright

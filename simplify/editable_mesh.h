#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/tet_mesh.h"
#include "common/types.h"
#include "simplify/local_numbers.h"
#include "simplify/locks.h"

namespace tetwright {

/// Number of a material inside an EditableMesh (its tags in ascending order), or outside.
using Region = std::uint32_t;
inline constexpr Region beyond_mesh = 0xffffffffu;

/// A tet that can be edited by several tasks. 40 bytes.
struct TetRecord {
  Tet points;                       ///< no_index four times: dead
  std::array<Index, 4> neighbours;  ///< across the face opposite each point; no_index: outside
  Region region;
  float quality;  ///< Quality^3 (see TetQuality::cubed), rounded
};
static_assert(sizeof(TetRecord) <= 48);

/// The mesh while it is simplified: tets know their neighbours across faces, a point knows one tet, each
/// point has a try-lock. Nothing moves in memory while tasks run.
///
/// What the lock of a point guards (README.md has the whole protocol):
///  - all that is stored per point: read and written only while it is held;
///  - points, region and quality of a tet: written while all its old and new points are held, read while one
///  of its
///    current points is held;
///  - a tet's neighbour across a face: written while the three points of that face are held, read while one
///  is.
/// The four ids of a tet are relaxed atomics, since a task compares them with its list before it knows
/// whether the tet still lives: `load_points`.
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
  MaterialTag tag(Region region) const { return tags_[region]; }
  /// Lengths in working coordinates are input lengths times this power of two.
  double scale() const { return scale_; }
  Vec3 to_input(const Vec3& working) const { return working / scale_ + shift_; }
  Vec3 to_working(const Vec3& input) const { return (input - shift_) * scale_; }
  /// Where a point that is to stand at `working` is put: on a lattice of 2^-30 (about 1e-9 of the mesh's
  /// size), and where that has no exact input coordinates, on the nearest place that has. So signs hold for
  /// what is written, and a mesh that is moved far away comes out the same.
  Vec3 snap(const Vec3& working) const {
    const Vec3 on_lattice = (working * 0x1p30).array().round().matrix() * 0x1p-30;
    return to_working(to_input(on_lattice));
  }
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
  Index hint(Index point) const { return hints_[point]; }
  void set_hint(Index point, Index tet) { hints_[point] = tet; }
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
  void set_region(Index t, Region region) { tets_[t].region = region; }
  /// The region on the other side of a face.
  Region region_across(Index t, int face) const {
    const Index other = tets_[t].neighbours[face];
    return other == no_index ? beyond_mesh : tets_[other].region;
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

  /// A task's own stock of free tet slots: refilled from the common reserve in small lots, so that tasks
  /// share no list.
  class SlotStock {
   public:
    explicit SlotStock(EditableMesh& mesh) : mesh_(&mesh) {}
    /// False if fewer than `count` slots can be had.
    bool reserve(std::size_t count);
    Index take();
    void give_back(Index slot) { free_.push_back(slot); }

   private:
    EditableMesh* mesh_;
    std::vector<Index> free_;
  };
  /// A task's own stock of free point slots.
  class PointStock {
   public:
    explicit PointStock(EditableMesh& mesh) : mesh_(&mesh) {}
    /// A free slot, or no_index. Another task may hold its lock for a moment, having it on an old list.
    Index take();
    void give_back(Index slot) { free_.push_back(slot); }

   private:
    EditableMesh* mesh_;
    std::vector<Index> free_;
  };

  /// Changes the number of living tets unless it would leave [fewest, most] or get farther away from it: then
  /// false, and nothing changed.
  bool change_count(std::int64_t change, std::size_t fewest, std::size_t most) {
    std::int64_t now = live_.load(std::memory_order_relaxed);
    do {
      if (change < 0 && now + change < static_cast<std::int64_t>(fewest)) return false;
      if (change > 0 && now + change > static_cast<std::int64_t>(most)) return false;
      // Relaxed: the number carries no other data.
    } while (!live_.compare_exchange_weak(now, now + change, std::memory_order_relaxed));
    return true;
  }

  // Only while no task runs.

  /// Nothing is touched any more.
  void begin_round() { ++round_; }
  /// Squeezes out dead tets and points and renumbers both along a space-filling curve, so that what is near
  /// in space is near in memory; leaves free slots at the end for operations that add tets and points.
  void compact(std::size_t spare_tets, std::size_t spare_points);
  /// A face between two regions, outside being one; the normal points out of `inside`.
  struct InterfaceFace {
    Triangle ids;
    Region inside, across;
  };
  /// All of them, each once. Parallel; the order does not depend on the threads.
  std::vector<InterfaceFace> interface_faces() const;
  /// Of a living tet, working coordinates cubed.
  double signed_volume(Index t) const;
  /// In working coordinates cubed; flat and negative tets count as they are.
  double total_volume() const;
  /// Every invariant of the links: neighbours mutual, hints right, faces equal, live count right. For tests.
  bool links_consistent() const;

 private:
  void link_faces(const std::string& name);
  void set_hints();
  void split_stars();
  /// The tets at `point` that faces join with the tet `first`.
  void part_of_star(Index point, Index first, LocalNumbers& seen, std::vector<Index>& part) const;

  std::vector<TetRecord> tets_;
  std::vector<Vec3> positions_;
  std::vector<Index> hints_;
  std::vector<std::uint32_t> touched_;  ///< by point: the round of the last change
  std::uint32_t round_ = 1;
  TryLocks locks_;
  std::atomic<std::int64_t> live_{0};
  std::atomic<std::size_t> next_spare_{0};  ///< first slot of the reserve that nobody took
  std::atomic<std::size_t> next_spare_point_{0};
  std::vector<std::uint8_t> pinned_;  ///< by point; empty if none is
  std::vector<Index> originals_;      ///< by point; empty if none is pinned
  std::vector<MaterialTag> tags_;     ///< of each region
  std::map<MaterialTag, std::string> names_;
  double scale_ = 1;
  Vec3 shift_ = Vec3::Zero();  ///< input coordinates
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/triangle_distance.h"
#include "common/geometry/triangle_intersection.h"
#include "simplify/mesh/editable_mesh.h"

namespace tetwright {

class SurfaceSamples;

/// The boundary and interface triangles of an EditableMesh with their coordinates, in a hashed spatial grid:
/// the explicit test against self-intersection, which positive tets alone do not prevent (two parts of a
/// surface may pass through each other from outside). It also holds the patches of the faces between
/// materials.
///
/// While operations are decided, it is read; while they are committed, each writes the records of its own
/// triangles, and cells of the grid, which a lock guards for the moment: the order of a cell's records does
/// not matter, since any hit decides.
class SurfaceGrid {
 public:
  /// A triangle that comes in.
  struct Added {
    MeshTriangle triangle;
    PatchId patch;
    RegionId inside = outside_id, across = outside_id;  ///< that it separates
  };
  /// A sample of the input's surface that one of the triangles that come in takes over (SurfaceSamples).
  struct ReassignedSample {
    std::uint32_t sample;
    std::uint32_t added;  ///< place in Edit::added
    float distance;       ///< between them
  };
  /// What an operation takes away and puts in.
  struct Edit {
    std::vector<MeshTriangle> removed;
    std::vector<Added> added;
    // Of those that come in, and the records of those that go: filled by test().
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
    std::vector<std::uint32_t> removed_records;
    /// Edges, by their ends, where a triangle that comes in and another one are nearly folded together: what
    /// lies between them, outside or a part of it, may be turned inside out without an intersection.
    std::vector<std::array<Index, 2>> narrow_edges;
    /// Records for those that come in: filled by take_records().
    std::vector<std::uint32_t> added_records;
    std::vector<ReassignedSample> reassigned;  ///< filled by SurfaceSamples::reassign_samples()
    // Its memory.
    std::vector<TriangleDistance> distances;
    std::vector<std::uint32_t> takers;
    std::vector<std::uint8_t> near_sample;

    void clear() {
      removed.clear();
      added.clear();
      removed_records.clear();
      narrow_edges.clear();
      added_records.clear();
      reassigned.clear();
    }
    bool empty() const { return removed.empty() && added.empty(); }
  };

  /// All interface triangles of the mesh; while no task runs. `min_cell` (working coordinates) is the
  /// size that triangles are about to grow to. The records are numbered as in interface_faces().
  void build(const EditableMesh& mesh, double min_cell);
  /// build() for the same mesh with other numbers of its points, by the old ones: samples stay with their
  /// triangles.
  void rebuild(const EditableMesh& mesh, double min_cell, const std::vector<Index>& new_points);
  std::size_t record_count() const { return records_.size(); }
  /// Points that the triangles own from now on, or null; must outlive the last edit.
  void set_samples(SurfaceSamples* samples) { samples_ = samples; }
  const SurfaceSamples* samples() const { return samples_; }

  /// Room for twice as many triangles without copying what there is; memory is taken up only where it is
  /// written.
  void reserve_twice();

  /// Whether no two triangles that stand meet elsewhere than in what they share; while no task runs, after
  /// build().
  bool embedded() const;

  /// Whether no added triangle meets one that stands and stays, or another added one. Fills the edit; the
  /// points' ids become those of the places where they stand (EditableMesh::original). Safe concurrently.
  bool test(Edit& edit) const;
  /// Gives the triangles of an edit the ids that records have, and finds the records of those that go: what
  /// test() begins with.
  void find_records(Edit& edit) const;
  /// Whether no triangle that comes in by one edit meets one of the other or is nearly folded onto it. Both
  /// were tested.
  static bool apart(const Edit& first, const Edit& second);
  /// Puts triangles into the place of others without any test, where points were moved from outside. While no
  /// task runs.
  void replace(Edit& edit);

  /// Gives a tested edit the records that it needs, and takes those of removed triangles back. One thread at
  /// a time, before commit().
  void take_records(Edit& edit);
  /// All that was given records is committed.
  void end_batch() { free_records_.end_batch(); }
  /// Carries an edit out. Safe concurrently for edits that share no triangle.
  void commit(const Edit& edit);

  /// The patch of a standing triangle with these points, of any order; 0 unless the mesh has patches on faces
  /// between materials. Safe while nothing is committed.
  PatchId patch(const EditableMesh& mesh, const Triangle& ids) const;
  /// The patches other than 0 of all faces, by the ascending originals of their points; while no task runs.
  FacePatches patches() const;

  /// All that stand, ids ascending within each; while no task runs, for tests.
  std::vector<MeshTriangle> triangles() const;

 private:
  struct Cell3 {
    std::int32_t x, y, z;
    bool operator==(const Cell3&) const = default;
  };
  /// A triangle's box, rounded outwards: most pairs are told apart by it, and the triangle need not be read.
  struct Box {
    std::array<float, 3> low, high;
    bool meets(const Box& other) const {
      for (int k = 0; k < 3; ++k)
        if (low[k] > other.high[k] || other.low[k] > high[k]) return false;
      return true;
    }
  };
  struct Entry {
    std::uint32_t record;
    Cell3 low;  ///< the cell of the box's low corner
    Box box;
  };
  /// The triangles whose boxes touch the cell.
  struct Cell {
    std::vector<Entry> entries;
    void lock() {
      while (std::atomic_ref<std::uint8_t>(locked).exchange(1, std::memory_order_acquire) != 0) {
      }
    }
    void unlock() { std::atomic_ref<std::uint8_t>(locked).store(0, std::memory_order_release); }
    std::uint8_t locked = 0;
  };
  static Box box_of(const MeshTriangle& t);
  Cell3 cell_at(const Vec3& p) const;
  std::uint32_t slot(const Cell3& c) const;
  /// Calls f(cell) for each cell that the triangle's box touches.
  template <class F>
  void for_cells(const MeshTriangle& t, const F& f) const;
  void insert(std::uint32_t record);
  /// Appends to `narrow`, if there is one, the edges where they are nearly folded together.
  bool hits_standing(const MeshTriangle& t, std::span<const std::uint32_t> removed,
                     std::vector<std::array<Index, 2>>* narrow = nullptr) const;
  /// The records of all that stand, ascending.
  std::vector<std::uint32_t> standing() const;
  /// The record of a standing triangle, ids ascending.
  std::uint32_t record_of(const MeshTriangle& t) const;

  const EditableMesh* mesh_ = nullptr;  ///< tells which points are one and the same
  Vec3 origin_ = Vec3::Zero();
  double to_cell_ = 1;
  std::uint32_t mask_ = 0;
  std::vector<Cell> cells_;            ///< by slot
  std::vector<MeshTriangle> records_;  ///< ids ascending, points in the same order
  std::vector<PatchId> patches_;       ///< by record; empty if all are 0
  FreeSlots free_records_;
  SurfaceSamples* samples_ = nullptr;
};

}  // namespace tetwright

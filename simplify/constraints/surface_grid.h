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

/// The boundary and interface triangles of an EditableMesh with their coordinates, in a hashed hierarchical
/// grid (Eitz & Gu 2007): each triangle is in cells a few times as large as itself, so that cells list few
/// triangles whatever their sizes. It tests for self-intersection explicitly, because positive tets alone do
/// not prevent it: two parts of a surface may pass through each other from outside. Also keeps the patches of
/// interface faces.
///
/// Concurrency: nothing is written while operations are decided. During commit, each operation writes the
/// records of its own triangles and the grid cells that they touch, each guarded by a short lock. The order
/// of a cell's records does not matter, since any intersection decides.
class SurfaceGrid {
 public:
  /// A triangle's bounding box, rounded outwards. It separates most pairs without reading their triangles.
  struct Box {
    std::array<float, 3> low, high;
    bool meets(const Box& other) const {
      for (int k = 0; k < 3; ++k)
        if (low[k] > other.high[k] || other.low[k] > high[k]) return false;
      return true;
    }
  };
  /// A triangle that an edit adds.
  struct Added {
    MeshTriangle triangle;
    PatchId patch;
    RegionId inside = outside_id, across = outside_id;  ///< regions on its two sides

    bool is_sheet() const { return inside == across && inside != outside_id; }
  };
  /// A sample of the input's surface that is reassigned to an added triangle (SurfaceSamples).
  struct ReassignedSample {
    std::uint32_t sample;
    std::uint32_t added;  ///< index in Edit::added
    float distance;       ///< from the sample to the triangle
  };
  /// The triangles that an operation removes and adds.
  struct Edit {
    std::vector<MeshTriangle> removed;
    std::vector<Added> added;
    // Filled by test(): bounding box of the added triangles, records of the removed ones.
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
    std::vector<std::uint32_t> removed_records;
    /// Edges, by their ends, at which an added triangle and another one are nearly folded together: the thin
    /// wedge there, of outside or a material, can invert without an intersection.
    std::vector<std::array<Index, 2>> narrow_edges;
    /// Records of the added triangles: filled by take_records().
    std::vector<std::uint32_t> added_records;
    std::vector<ReassignedSample> reassigned;  ///< filled by SurfaceSamples::reassign_samples()
    // Scratch memory.
    /// A remaining triangle whose box meets that of the added ones.
    struct Near {
      Box box;
      std::uint32_t record;
    };
    std::vector<Near> near;
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

  /// Fills the grid with all interface triangles of the mesh; record i is face i of interface_faces().
  /// \pre No task runs.
  void build(const EditableMesh& mesh);
  /// build() for the same mesh after its points were renumbered. Samples stay with their triangles.
  ///
  /// \param new_points new numbers by old ones.
  void rebuild(const EditableMesh& mesh, const std::vector<Index>& new_points);
  std::size_t record_count() const { return records_.size(); }
  /// Sets the samples that the triangles own, or null; they must outlive the last edit.
  void set_samples(SurfaceSamples* samples) { samples_ = samples; }
  const SurfaceSamples* samples() const { return samples_; }

  /// Reserves room for twice as many triangles, so that growth copies nothing; memory is committed only where
  /// it is written.
  void reserve_twice();

  /// Whether no two triangles intersect except in shared vertices and edges.
  /// \pre No task runs; build() has just run.
  bool embedded() const;

  /// Whether no added triangle intersects a remaining one or another added one. Fills the edit and replaces
  /// its point ids by those of EditableMesh::original(). Safe concurrently while nothing is committed.
  bool test(Edit& edit) const;
  /// First step of test(): replaces the edit's point ids by those that records use, and finds the records of
  /// its removed triangles.
  void find_records(Edit& edit) const;
  /// Whether no added triangle of one edit intersects one of the other or is nearly folded onto it.
  /// \pre Both edits have passed test().
  static bool apart(const Edit& first, const Edit& second);
  /// Replaces triangles without any test, after points were moved by other means than operations.
  /// \pre No task runs.
  void replace(Edit& edit);

  /// Assigns records to the added triangles of a tested edit and frees the records of the removed ones. One
  /// thread at a time, before commit().
  void take_records(Edit& edit);
  /// Call this after all edits of a batch are committed.
  void end_batch() { free_records_.end_batch(); }
  /// Carries out an edit. Safe concurrently for edits that share no triangle.
  void commit(const Edit& edit);

  /// The patch of an existing triangle with these points, in any order; 0 unless the mesh has patches on
  /// interface faces. Safe concurrently while nothing is committed.
  PatchId patch(const EditableMesh& mesh, const Triangle& ids) const;
  /// All patches other than 0, by the ascending originals of their points.
  /// \pre No task runs.
  FacePatches patches() const;

  /// All triangles, the ids of each ascending. For tests.
  /// \pre No task runs.
  std::vector<MeshTriangle> triangles() const;

 private:
  /// A cell of a level. Those of level 0 are the smallest; on each further level they are four times as
  /// large: with a factor of two, more time goes into levels than into triangles.
  struct Cell3 {
    std::int32_t x, y, z;
    Cell3 at_level(int level) const { return {x >> 2 * level, y >> 2 * level, z >> 2 * level}; }
    bool operator==(const Cell3&) const = default;
  };
  /// The cells of level 0 that a box touches.
  struct CellRange {
    Cell3 low, high;
  };
  struct Entry {
    std::uint32_t record;
    std::int32_t level;
    Cell3 low;  ///< the cell of the box's low corner, of this level
    Box box;
  };
  /// Entries of the triangles of this level whose boxes touch the cell.
  struct Cell {
    std::vector<Entry> entries;
    void lock() {
      while (std::atomic_ref<std::uint8_t>(locked).exchange(1, std::memory_order_acquire) != 0) {
      }
    }
    void unlock() { std::atomic_ref<std::uint8_t>(locked).store(0, std::memory_order_release); }
    void set_finer() {
      if (!has_finer()) std::atomic_ref<std::uint8_t>(finer).store(1, std::memory_order_relaxed);
    }
    /// Whether smaller triangles have been in the cell since the grid was built.
    bool has_finer() const {
      return std::atomic_ref<std::uint8_t>(const_cast<std::uint8_t&>(finer))
                 .load(std::memory_order_relaxed) != 0;
    }
    std::uint8_t locked = 0, finer = 0;
  };
  static Box box_of(const Vec3& low, const Vec3& high);
  Cell3 smallest_cell_at(const Vec3& p) const;
  CellRange range_of(const MeshTriangle& t) const;
  int level_of(const MeshTriangle& t) const;
  std::uint32_t slot(const Cell3& c, int level) const;
  /// Calls f(cell) for each cell of a level in a range.
  template <class F>
  static void for_cells(const CellRange& range, int level, const F& f);
  void insert(std::uint32_t record);
  /// Calls `test(entry)` once for each triangle whose box meets that between two corners, until it
  /// returns true; whether it did.
  template <class Test>
  bool any_near(const Vec3& low, const Vec3& high, const Test& test) const;
  /// Calls `test(entry)` for the entries in a cell and smaller ones within it whose boxes meet `box`, each in
  /// one cell only, until it returns true.
  template <class Test>
  bool any_in_cell(const Cell3& c, int level, const CellRange& range, const Box& box, const Test& test) const;
  /// The records in use, ascending.
  std::vector<std::uint32_t> records_in_use() const;
  /// The record of an existing triangle.
  /// \pre Ids ascending.
  std::uint32_t record_of(const MeshTriangle& t) const;

  const EditableMesh* mesh_ = nullptr;  ///< maps copies of a point to their original
  Vec3 origin_ = Vec3::Zero();
  double to_cell_ = 1;  ///< of level 0
  int top_level_ = 0;   ///< of cells as large as the surface when the grid was built
  std::uint32_t mask_ = 0;
  std::vector<Cell> cells_;            ///< by slot
  std::vector<MeshTriangle> records_;  ///< ids ascending, points in the same order
  std::vector<PatchId> patches_;       ///< by record; empty if all are 0
  FreeSlots free_records_;
  SurfaceSamples* samples_ = nullptr;
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "common/geometry/projection_tree.h"
#include "simplify/constraints/original_surface.h"
#include "simplify/constraints/surface_grid.h"
#include "simplify/mesh/editable_mesh.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// The surface that a mesh represents, as triangles. Working coordinates.
class RepresentedSurface {
 public:
  /// Uses the given surface, the sheets of the mesh, and the parts of its own boundary and interfaces that
  /// are far from the given surface (caps of holes, layers, the box of a meshed outside). Without a given
  /// surface, uses the mesh's whole boundary and interfaces.
  ///
  /// \param mesh before any operation.
  /// \param given triangles wound outwards, input units; may be null.
  RepresentedSurface(const EditableMesh& mesh, const TriangleMesh* given);
  /// Uses the surface of the mesh from which this one was made.
  explicit RepresentedSurface(OriginalSurface original);

  /// The regions on both sides of a triangle and its patch; unused for given triangles.
  struct Kind {
    RegionId low = outside_id, high = outside_id;
    PatchId patch = 0;
    bool is_sheet() const { return low == high && low != outside_id; }
    bool operator==(const Kind&) const = default;
  };
  static Kind kind_of(RegionId inside, RegionId across, PatchId patch);

  const ProjectionTree& triangles() const { return triangles_; }
  static bool is_given(const ProjectionTree::Item& item) { return item.kind == given_kind; }
  static Kind kind_of(const ProjectionTree::Item& item);
  /// Distance, working coordinates, within which mesh and input correspond.
  double reach() const { return reach_; }
  /// Finds the triangles that no part of the input mesh is near; deviation() ignores them. Parallel.
  /// \pre `mesh` is unchanged.
  void find_hidden(const EditableMesh& mesh);
  /// Two-sided distance between the current mesh's surface and this one, with proven bounds; input units.
  /// Parallel.
  ///
  /// \param mesh the mesh for which this surface was made.
  /// \param progress may end the computation early, as in surface_deviation(); may be null.
  DeviationReport deviation(const EditableMesh& mesh, const Progress* progress) const;
  /// A boundary or interface face, by its index in mesh.interface_faces(), that is far from this surface, or
  /// nearest to a point of it that is far from all faces; `place` is that point.
  struct FarFace {
    std::uint32_t face;
    std::optional<Vec3> place;
  };
  /// The faces with a distance above `limit`, working coordinates. Parallel.
  /// \pre This surface was made for `mesh`.
  std::vector<FarFace> far_faces(const EditableMesh& mesh, double limit) const;

 private:
  /// The surface with which a mesh is compared: without the triangles found by find_hidden().
  ProjectionTree shown() const;
  /// Accuracy of the distances, working coordinates.
  double accuracy() const;

  /// No face of a mesh has the outside on both sides, but a sheet has its region on both.
  static constexpr ProjectionTree::Kind given_kind{outside_id, outside_id, 0};
  ProjectionTree triangles_;
  std::vector<std::uint8_t> hidden_;  ///< by item of triangles_: found by find_hidden()
  double reach_ = 0;
};

/// Points of the input's surface, each owned by a boundary or interface triangle of the mesh. They keep a
/// simplified surface near the input from both sides (Ciampalini, Cignoni, Montani & Scopigno 1997,
/// "Multiresolution decimation based on global error"), and its vertices are fitted to them. Working
/// coordinates.
///
/// Every operation reassigns the samples of its removed triangles to the nearest added triangles of the same
/// kind.
///
/// Concurrency: nothing is written while operations are decided. During commit, each operation writes the
/// lists of its own triangles.
class SurfaceSamples {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  /// \pre The mesh's grid has just been built.
  ///
  /// \param records number of the grid's records.
  /// \param surface must outlive this object.
  /// \param edge target edge length of the simplified mesh: each of its triangles gets about ten samples,
  ///   vertices of the input first.
  /// \param scale factor on `edge`, by position.
  SurfaceSamples(
      const EditableMesh& mesh, std::size_t records, const RepresentedSurface& surface, double edge,
      const std::function<double(const Vec3&)>& scale = [](const Vec3&) { return 1; });

  /// Assigns the samples of an edit's removed triangles, whose records must be known, to its added ones.
  /// False if that moves a sample farther from its triangle than both `max_distance` and its distance before.
  /// False also if an added triangle's centroid, a midpoint of a new edge or a moved corner is farther from
  /// the surface than both `max_distance` and the worst of these samples. Safe concurrently while nothing is
  /// committed.
  bool reassign_samples(SurfaceGrid::Edit& edit, double max_distance) const;
  /// Sets the max distance between the points at which added triangles are tested.
  void set_spacing(double spacing) { spacing_ = spacing; }

  /// Calls f(position, its distance from the triangle) for each sample of a triangle.
  template <class F>
  void for_each(std::uint32_t record, const F& f) const {
    for (std::uint32_t s = first_[record]; s != none; s = samples_[s].next)
      f(samples_[s].position, samples_[s].distance);
  }

  /// Makes room for that many records.
  /// \pre No task runs.
  void resize(std::size_t records);
  /// Carries out an edit. Safe concurrently for edits that share no triangle.
  void commit(const SurfaceGrid::Edit& edit);
  /// Renumbers the triangles' records.
  ///
  /// \param new_record by old record; `none`: unused.
  /// \param records number of new records.
  void renumber(const std::vector<std::uint32_t>& new_record, std::size_t records);

  /// Adds a sample to the triangle nearest to it.
  /// \pre No task runs.
  void add(const Vec3& position, std::uint32_t record, double distance);

  // For tests; while no task runs.
  std::size_t size() const { return samples_.size(); }
  /// The max stored distance of a sample from its triangle.
  double largest_distance() const;

 private:
  using Kind = RepresentedSurface::Kind;
  struct Sample {
    Vec3 position;
    float distance;      ///< from its triangle
    std::uint32_t next;  ///< next sample of the triangle
  };
  bool choose_new_owners(SurfaceGrid::Edit& edit, double max_distance) const;
  bool stays_near_surface(SurfaceGrid::Edit& edit, double max_distance) const;

  const ProjectionTree& surface_;
  double spacing_ = std::numeric_limits<double>::infinity();
  std::vector<Sample> samples_;
  std::vector<std::uint32_t> first_;  ///< by record
  std::vector<Kind> kinds_;           ///< by record
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "common/geometry/projection_tree.h"
#include "common/geometry/surface_deviation.h"
#include "common/triangle_mesh.h"
#include "simplify/constraints/surface_grid.h"
#include "simplify/mesh/editable_mesh.h"

namespace tetwright {

/// The surface that a mesh stands for, as triangles. Working coordinates.
class InputSurface {
 public:
  /// `given` (input units) is the surface as it was given, its triangles wound outwards; or null. Parts of
  /// the mesh's own boundary and interfaces that are far from it (caps of holes, layers, the box of an
  /// outside that is meshed), or all of them without it, stand for themselves. The mesh as it came.
  InputSurface(const EditableMesh& mesh, const TriangleMesh* given);

  /// What is known of a triangle: the regions on both sides and the patch, or nothing if it was given.
  struct Kind {
    RegionId low = outside_id, high = outside_id;
    PatchId patch = 0;
    bool operator==(const Kind&) const = default;
  };
  static Kind kind_of(RegionId inside, RegionId across, PatchId patch);

  const ProjectionTree& triangles() const { return triangles_; }
  static bool is_given(const ProjectionTree::Item& item) { return item.kind == given_kind; }
  static Kind kind_of(const ProjectionTree::Item& item);
  /// What stands for the other, mesh and input, is within this distance.
  double reach() const { return reach_; }
  /// Finds what no part of the mesh as it came is near, for deviation(). Parallel.
  void find_hidden(const EditableMesh& mesh);
  /// How far the mesh's surface is from this one now, proven; input units. Of the same mesh. Parallel.
  /// `progress` (may be null) ends it as it ends surface_deviation().
  DeviationReport deviation(const EditableMesh& mesh, const Progress* progress) const;
  /// A boundary or interface face, by number of mesh.interface_faces(), that is far from this surface, or
  /// nearest to a place of it that is far from all faces.
  struct FarFace {
    std::uint32_t face;
    std::optional<Vec3> place;
  };
  /// Those of the same mesh where that is farther than `limit`; working coordinates. Parallel.
  std::vector<FarFace> far_faces(const EditableMesh& mesh, double limit) const;

 private:
  /// What a mesh is measured against: all but what find_hidden() found.
  ProjectionTree shown() const;
  /// To which it is measured, working coordinates.
  double accuracy() const;

  static constexpr ProjectionTree::Kind given_kind{0, 0, 0};
  ProjectionTree triangles_;
  std::vector<std::uint8_t> hidden_;  ///< by item of these: what find_hidden() found
  double reach_ = 0;
};

/// Points of the input's surface, each owned by a boundary or interface triangle of the mesh: what keeps a
/// simplified surface near the input from both sides (Ciampalini, Cignoni, Montani & Scopigno 1997, "Multi-
/// resolution decimation based on global error"), and what its vertices are fitted to. Working coordinates.
///
/// Every operation hands the samples of the triangles that it removes to the nearest ones of the same kind
/// that it adds. While operations are decided, all is read; while they are committed, each writes the lists
/// of its own triangles.
class SurfaceSamples {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;

  /// For a mesh whose grid was just built. `edge`: of a triangle of the mesh to come, for which there will be
  /// some ten samples, vertices of the input first; at a place it is scale(place) times that. `surface` must
  /// outlive this.
  SurfaceSamples(
      const EditableMesh& mesh, std::size_t records, const InputSurface& surface, double edge,
      const std::function<double(const Vec3&)>& scale = [](const Vec3&) { return 1; });

  /// Gives the samples of an edit's removed triangles (its records must be known) to added ones. False if a
  /// sample would be farther from its triangle than `max_distance`, and than before; or a place on an added
  /// triangle farther from the surface than that, and than one of the samples was: its centre, the middles of
  /// its new edges, and a corner that moved. Safe while nothing is committed.
  bool reassign_samples(SurfaceGrid::Edit& edit, double max_distance) const;
  /// From now on the places on an added triangle that are tested are at most this far from each other.
  void set_spacing(double spacing) { spacing_ = spacing; }

  /// Calls f(position, its distance from the triangle) for each sample of a triangle.
  template <class F>
  void for_each(std::uint32_t record, const F& f) const {
    for (std::uint32_t s = first_[record]; s != none; s = samples_[s].next)
      f(samples_[s].position, samples_[s].distance);
  }

  /// Room for so many records; while no task runs.
  void resize(std::size_t records);
  /// Carries an edit out. Safe concurrently for edits that share no triangle.
  void commit(const SurfaceGrid::Edit& edit);
  /// Triangles have other records: the one that had number i has new_record[i], or none; `records` of them.
  void renumber(const std::vector<std::uint32_t>& new_record, std::size_t records);

  /// Another point of the input's surface, for the triangle that is nearest to it; while no task runs.
  void add(const Vec3& position, std::uint32_t record, double distance);

  // For tests; while no task runs.
  std::size_t size() const { return samples_.size(); }
  /// The largest distance of a sample from its triangle, as it is remembered.
  double largest_distance() const;

 private:
  using Kind = InputSurface::Kind;
  struct Sample {
    Vec3 position;
    float distance;      ///< from its triangle
    std::uint32_t next;  ///< of the same triangle
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

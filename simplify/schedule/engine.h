// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simplify/constraints/constrained_mesh.h"
#include "simplify/constraints/original_surface.h"
#include "simplify/constraints/surface_projection.h"
#include "simplify/mesh/point_merging.h"
#include "simplify/schedule/block_runner.h"
#include "simplify/schedule/input_samples.h"
#include "simplify/schedule/round_recorder.h"

namespace tetwright {

/// State shared by the schedules: the mesh with its constraints and rules, the block runner, the report.
/// Steps that use it are free functions: selection.h chooses tets and points, fitting_sweeps.h moves the
/// surface.
class Engine {
 public:
  struct Options {
    std::string name;
    double target_tets;  ///< for the ideal sizes of Quality(t)
    double beta, gamma;
    std::uint64_t seed;
    std::size_t batch_size;
    ShapeObjective objective;
    const ReferenceSurface* reference;
    const std::vector<std::uint8_t>& frozen;
    bool fix_boundary;
    bool keep_volumes = true;          ///< bounds them by a VolumeLedger
    OriginalMesh* original = nullptr;  ///< SimplifyOptions::original
  };
  Engine(TetMesh&& mesh, const Options& options, SimplifyReport* report, Progress* progress);
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Ends the work and returns the mesh with its interface triangles.
  TetMesh take() &&;

  EditableMesh& mesh() { return mesh_; }
  const EditableMesh& mesh() const { return mesh_; }
  const SurfaceGrid& grid() const { return constrained_.grid; }
  BlockRunner& runner() { return runner_; }
  const SurfaceProjection& projection() const { return projection_; }
  const VolumeLedger& ledger() const { return constrained_.ledger; }
  RoundRecorder& recorder() { return recorder_; }
  InputSamples& input_samples() { return samples_; }
  BlockRules rules;

  /// Compacts the mesh, leaves free slots for operations that add elements, and rebuilds the grid. Every
  /// schedule calls this first, and rate_all() after setting its objective.
  void compact();
  /// Coarsens the mesh in bulk: tetwright::merge_points().
  /// \throws OutOfTime or Interrupted if the work should end; the mesh is unchanged then
  /// \pre No operation has run; before compact().
  void merge_points(const PointMerging& options);
  /// InputSamples::keep_surface() with the original's surface, if there is one. Once, before any operation.
  void keep_surface(const TriangleMesh* surface, bool measured);
  /// Number of tets of the mesh as it came, or of its original.
  std::size_t first_tets() const { return first_tets_; }
  /// Compacts the mesh and gives its triangles samples: InputSamples::assign().
  /// \pre keep_surface() has been called.
  void assign_samples(double edge);
  /// Sets the target edge lengths and their bounds, input units, in the rules.
  ///
  /// \param target_length may be null.
  void set_sizes(const SizeField* target_length, double min_edge, double max_edge);
  /// The sizes set by set_sizes().
  const EdgeSizes& sizes() const { return *sizes_; }
  /// EdgeSizes::allow_shorter().
  void allow_shorter_edges() { sizes_->allow_shorter(); }
  /// Progress::throw_if_stopped().
  void throw_if_stopped() const {
    if (progress_) progress_->throw_if_stopped();
  }
  /// Calls compact() if so many slots are dead that it pays off.
  void compact_if_sparse();
  /// Rates every tet by rules.objective.
  void rate_all();
  /// Compacts the mesh, rates its tets by shape and sets the rules common to all improvement. Call this
  /// before the first run_bulk_improvement() or run_improvement().
  void begin_improvement();

 private:
  bool compacted_ = false;  ///< the grid is built
  ConstrainedMesh constrained_;
  EditableMesh& mesh_ = constrained_.mesh;
  SurfaceGrid& grid_ = constrained_.grid;
  const std::size_t first_tets_;
  std::optional<OriginalSurface> original_;  ///< until keep_surface(), which the tuned schedule calls
  SurfaceProjection projection_;
  InputSamples samples_;
  std::optional<EdgeSizes> sizes_;
  BlockRunner runner_;
  RoundRecorder recorder_;
  const Progress* progress_;  ///< may be null
};

}  // namespace tetwright

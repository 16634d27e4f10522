// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simplify/constraints/constrained_mesh.h"
#include "simplify/constraints/surface_samples.h"
#include "simplify/schedule/block_runner.h"
#include "simplify/schedule/improvement_area.h"
#include "simplify/schedule/round_recorder.h"

namespace tetwright {

/// State shared by the schedules: the mesh, its grid, the block runner, the selection of bad tets, the
/// report.
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
    bool keep_volumes = true;  ///< bounds them by a VolumeLedger
  };
  Engine(TetMesh&& mesh, const Options& options, SimplifyReport* report, Progress* progress);
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  /// Ends the work and returns the mesh with its interface triangles.
  TetMesh take() &&;

  EditableMesh& mesh() { return mesh_; }
  BlockRunner& runner() { return runner_; }
  const SurfaceProjection& projection() const { return projection_; }
  const VolumeLedger& ledger() const { return constrained_.ledger; }
  RoundRecorder& recorder() { return recorder_; }
  BlockRules rules;

  /// Compacts the mesh, leaves free slots for operations that add, and rebuilds the grid. Every schedule
  /// calls it first, and rate_all() after setting its objective.
  void compact();
  /// Keeps the input's surface: the `surface` (input units) that the mesh was made from, or without it the
  /// mesh's own.
  ///
  /// \param measured deviation() will be called.
  /// \pre No operation has run.
  void keep_input_surface(const TriangleMesh* surface, bool measured);
  /// Gives the triangles samples of the input's surface, some ten for each triangle with edges of length
  /// `edge`.
  /// \pre keep_input_surface() has been called.
  void own_samples(double edge);
  void set_spacing(double spacing) { spacing_ = spacing; }
  /// Sets the target edge lengths and their bounds, input units, in the rules.
  ///
  /// \param target_length may be null.
  void set_sizes(const SizeField* target_length, double min_edge, double max_edge);
  /// Number of well-shaped tets with the target edge lengths that fill the mesh.
  double tets_for_sizes() const;
  /// tets_for_sizes() for one length everywhere, input units.
  double tets_for_edge(double length) const;
  /// EdgeSizes::allow_shorter().
  void allow_shorter_edges() { sizes_->allow_shorter(); }
  /// Two-sided distance between the mesh's surface and the input's, with proven bounds; wider bounds once the
  /// deadline has passed.
  DeviationReport deviation() const;
  /// Progress::throw_if_stopped().
  void throw_if_stopped() const {
    if (progress_) progress_->throw_if_stopped();
  }
  /// The tets of boundary and interface faces that are farther than `limit` (working coordinates) from the
  /// input's surface, or nearest to a part of it that is; in the order of the curve. Points of such parts
  /// become samples.
  std::vector<TetSnapshot> find_far_tets(double limit);
  bool owns_samples() const { return samples_ != nullptr; }
  /// compact() if so many slots are dead that it pays off.
  void compact_if_sparse();
  /// Rates every tet by rules.objective.
  void rate_all();
  /// Compacts the mesh, rates its tets by shape and sets the rules that all improvement shares. Call it
  /// before the first run_bulk_improvement() or run_improvement().
  void begin_improvement();

  // Only while no task runs. Parallel; the results do not depend on the threads.

  /// The quality below which `percent` of the tets lie; 1 for all tets, 0 for an empty mesh.
  float cutoff(double percent) const;
  /// The tets of quality `limit` or less, in the order of the curve.
  std::vector<TetSnapshot> bad_tets(float limit) const;
  /// The points of bad_tets(), each once, in the order of the curve.
  std::vector<Index> bad_points(float limit) const;
  /// Share of the tets whose shape is worse than the shape_quality_bound() of a solid angle (steradians),
  /// whatever objective rates them.
  double share_below(double angle) const;
  /// The tets that share a point with a listed one, in the order of the curve, and their points, each once.
  std::vector<TetSnapshot> tets_around(const std::vector<TetSnapshot>& tets) const;
  std::vector<Index> points_around(const std::vector<TetSnapshot>& tets) const;
  /// The points of boundary and interfaces, in the order of the curve.
  std::vector<Index> interface_points() const;

  /// fit_to_samples() for all interface points.
  void fit_interfaces(float floor);
  /// fit_to_samples() for the points of the listed tets and around them, weighting the farthest samples most.
  void fit_far(const std::vector<TetSnapshot>& tets, float floor);
  /// fit_to_crease() for all boundary points off their feature edge or corner; a point that cannot move there
  /// is collapsed along its feature edge.
  void fit_creases();

 private:
  /// The points for which mark(tet, slot in it) is true for some tet.
  template <class Mark>
  std::vector<Index> marked_points(const Mark& mark) const;
  /// The boundary points at which two patches meet off any feature edge, or three off any corner.
  std::vector<Index> points_off_creases() const;
  /// The live tets that pass the test, in the order of the curve.
  template <class Test>
  std::vector<TetSnapshot> tets_where(const Test& test) const;
  /// By point: 1 if it is a vertex of a listed tet.
  std::vector<std::uint8_t> points_of(const std::vector<TetSnapshot>& tets) const;

  bool compacted_ = false;  ///< the grid is built
  ConstrainedMesh constrained_;
  EditableMesh& mesh_ = constrained_.mesh;
  SurfaceGrid& grid_ = constrained_.grid;
  SurfaceProjection projection_;
  std::unique_ptr<InputSurface> input_surface_;
  std::unique_ptr<SurfaceSamples> samples_;
  double spacing_ = std::numeric_limits<double>::infinity();
  std::optional<EdgeSizes> sizes_;
  BlockRunner runner_;
  RoundRecorder recorder_;
  const Progress* progress_;  ///< may be null
};

/// The whole mesh of an engine.
class WholeMesh final : public ImprovementArea {
 public:
  explicit WholeMesh(Engine& engine) : engine_(engine) {}
  std::size_t tet_count() const override { return engine_.mesh().live_tets(); }
  double usual_edge() const override { return engine_.rules.objective.quality.ideal_edge; }
  std::vector<TetSnapshot> bad_tets(float limit) override { return engine_.bad_tets(limit); }
  std::vector<Index> bad_points(float limit) override { return engine_.bad_points(limit); }
  std::vector<TetSnapshot> tets_around(const std::vector<TetSnapshot>& tets) override {
    return engine_.tets_around(tets);
  }
  std::vector<Index> points_around(const std::vector<TetSnapshot>& tets) override {
    return engine_.points_around(tets);
  }
  std::vector<Index> points_to_thin(const std::vector<TetSnapshot>&) override {
    return engine_.bad_points(1);
  }

 private:
  Engine& engine_;
};

}  // namespace tetwright

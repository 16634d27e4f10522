// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/engine.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "common/geometry/point_triangle.h"
#include "common/parallel/parallel.h"
#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "simplify/operations/collapse.h"
#include "simplify/operations/fitting.h"

namespace tetwright {

namespace {

constexpr std::size_t slot_grain = 8192;  ///< tets or points a parallel loop hands out at a time
/// Share of dead slots among those used above which the mesh is compacted.
constexpr double compact_above = 0.3;
/// Free slots left for operations that add: the inverse of their share of the live ones, and their min
/// number. If they run out, the arrays grow.
constexpr std::size_t spare_share = 16;
constexpr std::size_t min_spare = 4096;
/// Min quality of tets, by any objective, when points are fitted to feature edges: shapes recover.
constexpr float crease_floor = 1e-4f;

}  // namespace

Engine::Engine(TetMesh&& mesh, const Options& options, SimplifyReport* report, Progress* progress)
    : constrained_(std::move(mesh), options.name, options.frozen, options.fix_boundary, options.keep_volumes),
      projection_(mesh_, options.reference),
      runner_(mesh_, grid_, constrained_.ledger, options.seed, options.batch_size, progress),
      recorder_(mesh_, runner_, report, progress),
      progress_(progress) {
  rules.objective.quality = TetQuality::for_target(mesh_.total_volume(), options.target_tets, options.beta);
  rules.objective.shape = options.objective;
  rules.gamma = options.gamma;
  // Keep patches from the first collapse on; without patches only improvement needs the projection.
  if (projection_.has_patches()) rules.project_onto(projection_, mesh_.diagonal());
}

TetMesh Engine::take() && {
  constrained_.keep_patches();
  return std::move(mesh_).to_mesh();
}

void Engine::compact() {
  const bool first = !std::exchange(compacted_, true);
  if (!first) constrained_.keep_patches();
  const std::size_t spare = mesh_.live_tets() / spare_share + min_spare;
  SlotNumbers numbers;
  mesh_.compact(spare, spare / 2, &numbers);
  const double min_cell = rules.objective.quality.ideal_edge / 2;
  if (first) {
    grid_.build(mesh_, min_cell);
  } else {
    grid_.rebuild(mesh_, min_cell, numbers.points);
  }
  // An embedded mesh stays embedded: no operation undoes it.
  if (first) rules.embedded = mesh_.all_positive() && grid_.embedded();
}

void Engine::keep_input_surface(const TriangleMesh* surface, bool measured) {
  input_surface_ = std::make_unique<InputSurface>(mesh_, surface);
  if (measured) input_surface_->find_hidden(mesh_);
}

void Engine::set_sizes(const SizeField* target_length, double min_edge, double max_edge) {
  sizes_.emplace(target_length, min_edge, max_edge, mesh_.diagonal(), mesh_.space());
  rules.sizes = rules.objective.sizes = &*sizes_;
}

double Engine::tets_for_edge(double length) const {
  const double ideal = length * mesh_.space().scale() / Objective::edge_to_ideal;
  return mesh_.total_volume() / (ideal * ideal * ideal);
}

double Engine::tets_for_sizes() const {
  double count = 0;
  for (Index t = 0; t < mesh_.tet_slots(); ++t) {
    if (mesh_.dead(t)) continue;
    const Tet& p = mesh_.points(t);
    const Vec3 centre =
        (mesh_.position(p[0]) + mesh_.position(p[1]) + mesh_.position(p[2]) + mesh_.position(p[3])) / 4;
    const double edge = sizes_->target_length(centre) / Objective::edge_to_ideal;
    count += std::fabs(mesh_.signed_volume(t)) / (edge * edge * edge);
  }
  return count;
}

void Engine::own_samples(double edge) {
  compact();
  samples_ = std::make_unique<SurfaceSamples>(mesh_, grid_.record_count(), *input_surface_, edge,
                                              [&](const Vec3& place) { return rules.scale_at(place); });
  samples_->set_spacing(spacing_);
  grid_.set_samples(samples_.get());
}

DeviationReport Engine::deviation() const { return input_surface_->deviation(mesh_, progress_); }

void Engine::compact_if_sparse() {
  if (mesh_.dead_share() > compact_above) compact();
}

void Engine::rate_all() {
  parallel_for(0, mesh_.tet_slots(), slot_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto t = static_cast<Index>(i);
      const Tet& p = mesh_.points(t);
      if (p[0] == no_index) continue;
      mesh_.set_quality(t, rules.objective(mesh_.position(p[0]), mesh_.position(p[1]), mesh_.position(p[2]),
                                           mesh_.position(p[3])));
    }
  });
}

float Engine::cutoff(double percent) const {
  // Bit patterns of floats in [0, 1] ascend with their values: a histogram of their upper halves finds the
  // bin, and only the bin's tets are read again.
  constexpr std::size_t bins = 1 << 14;
  const auto bin = [](float q) { return std::bit_cast<std::uint32_t>(q) >> 16; };
  std::vector<std::atomic<std::uint32_t>> shared(bins);
  std::atomic<std::size_t> alive{0};
  parallel_for(0, mesh_.tet_slots(), 16 * slot_grain, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> counts(bins, 0);
    std::size_t count = 0;
    for (std::size_t t = begin; t < end; ++t) {
      if (mesh_.dead(static_cast<Index>(t))) continue;
      ++counts[bin(mesh_.quality(static_cast<Index>(t)))];
      ++count;
    }
    for (std::size_t b = 0; b < bins; ++b)
      if (counts[b]) shared[b].fetch_add(counts[b], std::memory_order_relaxed);
    alive.fetch_add(count, std::memory_order_relaxed);
  });
  if (alive == 0) return 0;
  auto wanted = static_cast<std::size_t>(percent / 100 * static_cast<double>(alive));
  if (wanted >= alive) return 1;
  std::size_t b = 0;
  while (wanted >= shared[b]) wanted -= shared[b++];
  std::vector<float> in_bin = parallel_collect<float>(
      0, mesh_.tet_slots(), slot_grain, [&](std::size_t begin, std::size_t end, std::vector<float>& out) {
        for (std::size_t t = begin; t < end; ++t) {
          const float quality = mesh_.quality(static_cast<Index>(t));
          if (!mesh_.dead(static_cast<Index>(t)) && bin(quality) == b) out.push_back(quality);
        }
      });
  std::nth_element(in_bin.begin(), in_bin.begin() + static_cast<std::ptrdiff_t>(wanted), in_bin.end());
  return in_bin[wanted];
}

void Engine::begin_improvement() {
  rules.objective.kind = Objective::Kind::shape;
  rules.accept_worse = 0;
  rules.project_onto(projection_, mesh_.diagonal());
  compact();
  rate_all();
}

template <class Test>
std::vector<TetSnapshot> Engine::tets_where(const Test& test) const {
  return parallel_collect<TetSnapshot>(
      0, mesh_.tet_slots(), slot_grain,
      [&](std::size_t begin, std::size_t end, std::vector<TetSnapshot>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const auto t = static_cast<Index>(i);
          if (!mesh_.dead(t) && test(t)) out.push_back({t, mesh_.points(t)});
        }
      });
}

std::vector<TetSnapshot> Engine::bad_tets(float limit) const {
  return tets_where([&](Index t) { return mesh_.quality(t) <= limit; });
}

double Engine::share_below(double angle) const {
  Objective shape = rules.objective;
  shape.kind = Objective::Kind::shape;
  const auto bound = static_cast<float>(shape_quality_bound(shape.shape, angle));
  const auto below = tets_where([&](Index t) {
    const Tet& p = mesh_.points(t);
    return shape(mesh_.position(p[0]), mesh_.position(p[1]), mesh_.position(p[2]), mesh_.position(p[3])) <
           bound;
  });
  return static_cast<double>(below.size()) / static_cast<double>(std::max<std::size_t>(1, mesh_.live_tets()));
}

template <class Mark>
std::vector<Index> Engine::marked_points(const Mark& mark) const {
  std::vector<std::uint8_t> marks(mesh_.point_slots(), 0);
  parallel_for(0, mesh_.tet_slots(), slot_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto t = static_cast<Index>(i);
      if (mesh_.dead(t)) continue;
      // Relaxed: all threads write the same value, which is read after the loop.
      for (int k = 0; k < 4; ++k)
        if (mark(t, k))
          std::atomic_ref<std::uint8_t>(marks[mesh_.points(t)[k]]).store(1, std::memory_order_relaxed);
    }
  });
  return parallel_collect<Index>(0, marks.size(), slot_grain,
                                 [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
                                   for (std::size_t p = begin; p < end; ++p)
                                     if (marks[p]) out.push_back(static_cast<Index>(p));
                                 });
}

std::vector<TetSnapshot> Engine::find_far_tets(double limit) {
  const std::vector<InterfaceFace> faces = mesh_.interface_faces();
  std::vector<Triangle> far;
  SurfaceGrid::Edit edit;
  for (const InputSurface::FarFace& f : input_surface_->far_faces(mesh_, limit)) {
    const Triangle& ids = faces[f.face].ids;
    far.push_back(face_key(ids));
    if (!f.place) continue;
    const Vec3 &a = mesh_.position(ids[0]), &b = mesh_.position(ids[1]), &c = mesh_.position(ids[2]);
    edit.clear();
    edit.removed.push_back({ids, {a, b, c}});
    grid_.find_records(edit);
    samples_->add(*f.place, edit.removed_records.front(), std::sqrt(squared_distance(*f.place, a, b, c)));
  }
  std::sort(far.begin(), far.end());
  return tets_where([&](Index t) {
    for (int f = 0; f < 4; ++f)
      if (mesh_.link(t, f).is_interface() &&
          std::binary_search(far.begin(), far.end(), face_key(face_of(mesh_.points(t), f))))
        return true;
    return false;
  });
}

std::vector<Index> Engine::bad_points(float limit) const {
  return marked_points([&](Index t, int) { return mesh_.quality(t) <= limit; });
}

std::vector<std::uint8_t> Engine::points_of(const std::vector<TetSnapshot>& tets) const {
  std::vector<std::uint8_t> listed(mesh_.point_slots(), 0);
  for (const TetSnapshot& t : tets)
    for (Index p : t.points) listed[p] = 1;
  return listed;
}

std::vector<TetSnapshot> Engine::tets_around(const std::vector<TetSnapshot>& tets) const {
  const std::vector<std::uint8_t> listed = points_of(tets);
  return tets_where([&](Index t) {
    const Tet& points = mesh_.points(t);
    return std::any_of(points.begin(), points.end(), [&](Index p) { return listed[p] != 0; });
  });
}

std::vector<Index> Engine::points_around(const std::vector<TetSnapshot>& tets) const {
  const std::vector<std::uint8_t> listed = points_of(tets);
  return marked_points([&](Index t, int) {
    const Tet& points = mesh_.points(t);
    return std::any_of(points.begin(), points.end(), [&](Index p) { return listed[p] != 0; });
  });
}

std::vector<Index> Engine::interface_points() const {
  return marked_points([&](Index t, int k) {
    for (int f = 0; f < 4; ++f)
      if (f != k && mesh_.link(t, f).is_interface()) return true;
    return false;
  });
}

std::vector<Index> Engine::points_off_creases() const {
  // By point: min and max patch of its boundary faces.
  constexpr std::uint32_t no_patch = 0xffffffff;
  std::vector<std::uint32_t> smallest(mesh_.point_slots(), no_patch), largest(mesh_.point_slots(), 0);
  std::vector<std::uint8_t> third(mesh_.point_slots(), 0);  // whether the point has a third patch
  for (std::size_t i = 0; i < mesh_.tet_slots(); ++i) {
    const auto t = static_cast<Index>(i);
    if (mesh_.dead(t)) continue;
    for (int f = 0; f < 4; ++f) {
      const FaceLink link = mesh_.link(t, f);
      if (!link.is_outside()) continue;
      for (const Index p : face_of(mesh_.points(t), f)) {
        const std::uint32_t patch = link.patch();
        const std::uint32_t low = smallest[p], high = largest[p];
        third[p] |= low != no_patch && low != high && patch != low && patch != high;
        smallest[p] = std::min(low, patch);
        largest[p] = std::max(high, patch);
      }
    }
  }
  return parallel_collect<Index>(0, smallest.size(), slot_grain,
                                 [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
                                   for (std::size_t p = begin; p < end; ++p) {
                                     if (smallest[p] == no_patch || smallest[p] == largest[p]) continue;
                                     // Nearly all points pass this test.
                                     const Vec3& at = mesh_.position(static_cast<Index>(p));
                                     if (!(third[p] ? projection_.onto_corner(at, tolerance::flat_patch)
                                                    : projection_.onto_curve(at, tolerance::flat_patch)))
                                       out.push_back(static_cast<Index>(p));
                                   }
                                 });
}

void Engine::fit_creases() {
  if (!projection_.has_patches()) return;
  BlockRules fitting = rules;
  fitting.max_error = std::numeric_limits<double>::infinity();
  fitting.good_enough = crease_floor;
  runner_.each_star(points_off_creases(), Operation::fit, [&](Workspace& ws) {
    const Outcome moved = fit_to_crease(ws, fitting, crease_floor);
    if (moved == Outcome::done || moved == Outcome::no_candidate || ws.star.dimension() != 1) return moved;
    for (std::size_t b = 0; b < ws.star.points.size(); ++b)
      if (ws.star.edge_dimension(b) == 1 && collapse_onto(ws, fitting, b) == Outcome::done)
        return Outcome::done;
    return moved;
  });
}

void Engine::fit_far(const std::vector<TetSnapshot>& tets, float floor) {
  BlockRules farthest = rules;
  farthest.fit_farthest = true;
  runner_.each_star(points_around(tets), Operation::fit,
                    [&](Workspace& ws) { return fit_to_samples(ws, farthest, floor); });
}

void Engine::fit_interfaces(float floor) {
  runner_.each_star(interface_points(), Operation::fit,
                    [&](Workspace& ws) { return fit_to_samples(ws, rules, floor); });
}

}  // namespace tetwright

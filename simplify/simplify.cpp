#include "simplify/simplify.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "common/error.h"
#include "common/interfaces.h"
#include "common/parallel.h"
#include "common/portable_math.h"
#include "simplify/block.h"
#include "simplify/collapse.h"
#include "simplify/flip.h"
#include "simplify/smoothing.h"

namespace tetwright {

namespace {

// The tuned schedule, found by trying on scans (README.md, Schedule).
constexpr double first_error_edges = 4;  ///< E at first, in ideal edges
constexpr double error_growth = 1.3;     ///< E's factor after an iteration that removed too little
constexpr double least_removed = 0.15;   ///< of the tets: less than that is too little
constexpr double percent_step = 10;      ///< the paper's: the share of poor tets grows by this each iteration
constexpr double first_annealing = 0.3;  ///< probability at first of an action that leaves a poorer tet
constexpr double swaps_below = 10;       ///< times the target: above it swaps and smoothing are wasted work
constexpr int most_closing_rounds = 24;
/// The loop stops this much above the target, and the closing may end as far below it: collapses are what
/// removes the last slivers on flat boundaries. Together they keep the count well within 1 %.
constexpr double closing_slack = 0.006;
/// Iterations in a row that remove next to nothing before the loop gives up.
constexpr int most_idle_iterations = 3;
constexpr double idle_below = 0.003;  ///< of the tets
/// E stops growing here, in working coordinates, of which the farthest is below 2, for gamma 10: beyond it
/// nothing is refused any more.
constexpr double largest_useful_error = 200;
/// The mesh is squeezed and renumbered when fewer than this share of its slots are alive.
constexpr double squeeze_below = 0.7;

constexpr std::size_t grain = 8192;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

class Simplifier {
 public:
  Simplifier(TetMesh&& mesh, const SimplifyOptions& options, SimplifyReport* report, Progress* progress)
      : options_(options),
        report_(report),
        progress_(progress),
        mesh_(std::move(mesh), options.name),
        runner_(mesh_, grid_, options.seed, options.chunk_size, progress) {}

  TetMesh run() {
    const auto start = std::chrono::steady_clock::now();
    begin_stage("simplify");
    first_count_ = mesh_.live_tets();
    rules_.objective.quality = TetQuality::for_target(
        mesh_.total_volume(), static_cast<double>(options_.target_tets), options_.beta);
    rules_.gamma = options_.gamma;
    // Rounded up: for small targets the slack is less than one tet.
    rules_.fewest_tets = static_cast<std::size_t>(
        std::ceil(static_cast<double>(std::min(options_.target_tets, first_count_)) * (1 - closing_slack)));
    squeeze();
    const double build = seconds_since(start);
    loop();
    const double loop_end = seconds_since(start);
    begin_stage("improve");
    close();
    if (report_) {
      report_->seconds_build = build;
      report_->seconds_simplify = loop_end - build;
      report_->seconds_close = seconds_since(start) - loop_end;
    }
    TetMesh mesh = std::move(mesh_).to_mesh();
    mesh.interfaces = find_interfaces(mesh);
    return mesh;
  }

 private:
  void begin_stage(const char* name) {
    if (!progress_) return;
    progress_->throw_if_cancelled();
    progress_->begin_stage(name);
  }

  /// Compaction, and all that holds indices anew.
  void squeeze() {
    // Flips 2-3 add tets where collapses take away more; an eighth is never used up before the next squeeze.
    mesh_.compact(mesh_.live_tets() / 8 + 1024);
    grid_.build(mesh_, rules_.objective.quality.ideal_edge / 2);
    runner_.reset_tasks();
    rate_all();
  }

  void rate_all() {
    parallel_for(0, mesh_.tet_slots(), grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto t = static_cast<Index>(i);
        const Tet& p = mesh_.tet(t).points;
        if (p[0] == no_index) continue;
        mesh_.set_quality(t, rules_.objective(mesh_.position(p[0]), mesh_.position(p[1]),
                                              mesh_.position(p[2]), mesh_.position(p[3])));
      }
    });
  }

  /// The quality below which `percent` of the tets lie.
  float cutoff(double percent) const {
    std::vector<float> qualities;
    qualities.reserve(mesh_.live_tets());
    for (Index t = 0; t < mesh_.tet_slots(); ++t)
      if (mesh_.tet(t).points[0] != no_index) qualities.push_back(mesh_.tet(t).quality);
    if (qualities.empty()) return 0;
    const auto k = static_cast<std::size_t>(percent / 100 * static_cast<double>(qualities.size()));
    if (k >= qualities.size()) return 1;
    std::nth_element(qualities.begin(), qualities.begin() + static_cast<std::ptrdiff_t>(k), qualities.end());
    return qualities[k];
  }

  std::vector<ListedTet> poor_tets(float limit) const {
    std::vector<ListedTet> list;
    for (Index t = 0; t < mesh_.tet_slots(); ++t) {
      const TetRecord& r = mesh_.tet(t);
      if (r.points[0] != no_index && r.quality <= limit) list.push_back({t, r.points});
    }
    return list;
  }

  /// The points of the poor tets, each once, in the order of the curve.
  std::vector<Index> poor_points(float limit) const {
    std::vector<std::uint8_t> poor(mesh_.point_slots(), 0);
    for (Index t = 0; t < mesh_.tet_slots(); ++t) {
      const TetRecord& r = mesh_.tet(t);
      if (r.points[0] != no_index && r.quality <= limit)
        for (Index p : r.points) poor[p] = 1;
    }
    std::vector<Index> list;
    for (Index p = 0; p < poor.size(); ++p)
      if (poor[p]) list.push_back(p);
    return list;
  }

  void collapse_block(float limit) {
    runner_.points(
        poor_points(limit),
        [&](Task& task, Index p) {
          if (!task.points.try_lock(p)) return Outcome::lock_taken;
          Outcome o = task.star.gather(mesh_, p, task.points);
          if (o == Outcome::done) o = collapse(task, rules_);
          task.counts.add(Operation::collapse, o);
          return o;
        },
        [&] { return mesh_.live_tets() <= loop_target(); });
  }

  /// Swaps and smoothing of what is still poor.
  void swap_and_smooth_block(float limit) {
    const auto most = std::max(loop_target(), first_count_ <= options_.target_tets ? first_count_ : 0);
    const bool closing = rules_.objective.kind == Objective::Kind::shape;
    runner_.tets(
        poor_tets(limit),
        [&](Task& task, const ListedTet& item) {
          if (const Outcome o = hold(task, item); o != Outcome::done) return o;
          // The tet may have been improved by a neighbour's operation since it was listed.
          if (mesh_.tet(item.tet).quality > limit) return Outcome::stale;
          const std::size_t count = mesh_.live_tets();
          for (int f = 0; f < 4 && !(closing && count >= most); ++f) {
            const Outcome o = flip23(task, rules_, item.tet, f);
            task.counts.add(Operation::flip23, o);
            if (o == Outcome::done || o == Outcome::lock_taken) return o;
          }
          for (int e = 0; e < 6; ++e) {
            const Outcome o = flip32(task, rules_, item.tet, e);
            task.counts.add(Operation::flip32, o);
            if (o == Outcome::done || o == Outcome::lock_taken) return o;
          }
          for (Index p : item.points) {
            Outcome o = task.star.gather(mesh_, p, task.points);
            if (o == Outcome::done) o = smooth(task, rules_);
            task.counts.add(Operation::smooth, o);
            if (o == Outcome::done || o == Outcome::lock_taken) return o;
          }
          if (!closing) return Outcome::no_candidate;
          for (Index p : item.points) {
            Outcome o = task.star.gather(mesh_, p, task.points);
            if (o == Outcome::done) o = optimise(task, rules_);
            task.counts.add(Operation::optimise, o);
            if (o == Outcome::done || o == Outcome::lock_taken) return o;
          }
          for (Index p : item.points) {
            if (mesh_.live_tets() <= rules_.fewest_tets) break;
            Outcome o = task.star.gather(mesh_, p, task.points);
            if (o == Outcome::done) o = collapse(task, rules_);
            task.counts.add(Operation::collapse, o);
            if (o == Outcome::done || o == Outcome::lock_taken) return o;
          }
          return Outcome::no_candidate;
        },
        [] { return false; });
  }

  /// Where the block loop stops: a little above the target, to leave the closing some collapses.
  std::size_t loop_target() const {
    return static_cast<std::size_t>(static_cast<double>(options_.target_tets) * (1 + closing_slack));
  }

  /// The block loop (Figure 3 of the paper, with the tuned schedule).
  void loop() {
    const auto target = static_cast<double>(options_.target_tets);
    const double ideal_edge = rules_.objective.quality.ideal_edge;
    const double log_first = portable_log(std::max(static_cast<double>(first_count_) / target, 1 + 1e-9));
    double percent = percent_step;
    const double largest_error = largest_useful_error * std::max(1.0, options_.gamma / 10);
    rules_.largest_error = first_error_edges * ideal_edge;
    int idle = 0;
    for (int i = 0; i < options_.max_iterations && mesh_.live_tets() > loop_target(); ++i) {
      const auto start = std::chrono::steady_clock::now();
      IterationReport it;
      it.kind = "simplify";
      it.tets_before = mesh_.live_tets();
      it.percent = percent;
      it.largest_error = rules_.largest_error / mesh_.scale();
      const double log_now = portable_log(static_cast<double>(it.tets_before) / target);
      rules_.accept_worse = first_annealing * std::clamp(log_now / log_first, 0.0, 1.0);
      if (static_cast<double>(mesh_.live_tets()) < squeeze_below * static_cast<double>(mesh_.tet_slots()))
        squeeze();
      const float limit = cutoff(percent);
      it.cutoff = portable_cbrt(limit);
      collapse_block(limit);
      const std::size_t collapsed = mesh_.live_tets();
      const double removed = 1 - static_cast<double>(collapsed) / static_cast<double>(it.tets_before);
      // Where collapses stall, other connectivity and places may let them go on.
      if (collapsed > loop_target() && (static_cast<double>(collapsed) < swaps_below * target ||
                                        (removed < least_removed && percent >= 100)))
        swap_and_smooth_block(limit);
      finish(it, start);
      // A larger E helps as long as E is what refuses.
      const bool error_refuses = rules_.largest_error < largest_error &&
                                 10 * it.counts.of(Operation::collapse, Outcome::surface_error) >
                                     it.counts.tried(Operation::collapse);
      if (removed < least_removed)
        rules_.largest_error = std::min(largest_error, error_growth * rules_.largest_error);
      idle = removed < idle_below && percent >= 100 && !error_refuses ? idle + 1 : 0;
      if (idle == most_idle_iterations) break;
      percent = std::min(100.0, percent + percent_step);
      if (progress_) progress_->update(1 - log_now / log_first);
    }
  }

  /// Rounds of swap and smooth by shape alone: stopping in mid-block leaves that block's tets poor.
  void close() {
    rules_.objective.kind = Objective::Kind::shape;
    rules_.accept_worse = 0;
    squeeze();
    const auto limit = static_cast<float>(1.5 * options_.min_solid_angle / regular_solid_angle);
    for (int round = 0; round < most_closing_rounds; ++round) {
      const auto start = std::chrono::steady_clock::now();
      IterationReport it;
      it.kind = "close";
      it.tets_before = mesh_.live_tets();
      it.cutoff = limit * regular_solid_angle;
      it.largest_error = rules_.largest_error / mesh_.scale();
      const std::size_t poor = poor_tets(limit).size();
      it.percent = 100 * static_cast<double>(poor) / static_cast<double>(it.tets_before);
      swap_and_smooth_block(limit);
      finish(it, start);
      std::uint64_t done = 0;
      for (std::size_t o = 0; o < operation_count; ++o)
        done += it.counts.of(static_cast<Operation>(o), Outcome::done);
      if (done == 0) break;
      if (progress_) progress_->update(static_cast<double>(round + 1) / most_closing_rounds);
    }
  }

  void finish(IterationReport& it, std::chrono::steady_clock::time_point start) {
    const BlockRunner::Totals totals = runner_.take_totals();
    it.counts = totals.counts;
    it.lock_conflicts = totals.lock_conflicts;
    it.skipped = totals.skipped;
    it.tets_after = mesh_.live_tets();
    it.seconds = seconds_since(start);
    if (report_) report_->iterations.push_back(it);
  }

  const SimplifyOptions& options_;
  SimplifyReport* report_;
  Progress* progress_;
  EditableMesh mesh_;
  SurfaceGrid grid_;
  BlockRunner runner_;
  BlockRules rules_;
  std::size_t first_count_ = 0;
};

}  // namespace

TetMesh simplify(TetMesh mesh, const SimplifyOptions& options, SimplifyReport* report, Progress* progress) {
  if (options.target_tets == 0) throw UsageError("a target of 0 tets leaves nothing; give 1 or more");
  if (options.chunk_size == 0) throw UsageError("a chunk must hold at least one item");
  if (!(options.beta > 0) || !(options.gamma >= 0))
    throw UsageError("beta must be above 0 and gamma at least 0");
  if (mesh.tets.empty()) throw InputError(options.name, 0, "no tets in it");
  return Simplifier(std::move(mesh), options, report, progress).run();
}

TetMesh improve(TetMesh mesh, const ImproveOptions& options, SimplifyReport* report, Progress* progress) {
  if (options.chunk_size == 0) throw UsageError("a chunk must hold at least one item");
  if (mesh.tets.empty()) throw InputError(options.name, 0, "no tets in it");
  SimplifyOptions o;
  o.target_tets = mesh.tets.size();
  o.min_solid_angle = options.min_solid_angle;
  o.max_iterations = 0;
  o.seed = options.seed;
  o.chunk_size = options.chunk_size;
  o.name = options.name;
  return Simplifier(std::move(mesh), o, report, progress).run();
}

}  // namespace tetwright

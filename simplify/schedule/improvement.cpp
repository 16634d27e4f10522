// SPDX-License-Identifier: Apache-2.0
#include "simplify/schedule/improvement.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "simplify/operations/collapse.h"
#include "simplify/operations/smoothing.h"
#include "simplify/schedule/improve_step.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

namespace {

using ImprovementRounds = SimplifyTuning::ImprovementRounds;

/// The rounds of run_improvement().
class ImprovementLoop {
 public:
  ImprovementLoop(const ImprovementTools& tools, ImprovementArea& area, const ImprovementPlan& plan)
      : recorder_(tools.recorder),
        mesh_(tools.mesh),
        runner_(tools.runner),
        rules_(tools.rules),
        area_(area),
        plan_(plan),
        bounds_{quality(plan.angle), quality(plan.leave_surface_angle)} {
    rules_.count = {plan_.min_tets, plan_.max_tets};
  }

  /// The number of rounds.
  int run() {
    relaxed_ = relaxed_rules(rules_, area_.usual_edge());
    relaxed_.surface.leave_surface = true;
    max_deviation_ = rules_.deviation.widened(ImprovementRounds::max_deviation_factor);
    min_bad_ = 4 * area_.tet_count();
    int i = 0;
    for (; i < plan_.max_rounds; ++i) {
      std::vector<TetSnapshot> bad = area_.bad_tets(bounds_.bad_quality);
      if (bad.empty() || !worth_a_round(bad, i == 0)) break;
      RoundRecorder::Round round(recorder_, plan_.kind, rules_.error.limit());
      round.report().cutoff = plan_.angle;
      round.report().percent = 100 * static_cast<double>(bad.size()) / static_cast<double>(mesh_.live_tets());
      run_round(std::move(bad));
      round.finish();
      recorder_.update(static_cast<double>(i + 1) / plan_.max_rounds);
    }
    return i;
  }

 private:
  float quality(double angle) const {
    return static_cast<float>(shape_quality_bound(rules_.objective.shape, angle));
  }

  /// Rates the last round by the bad tets that it left: false if the last rounds gained too little. Decides
  /// whether the next round also moves the points around the bad tets and perturbs; if the plan is not fast,
  /// the first round always perturbs.
  bool worth_a_round(const std::vector<TetSnapshot>& bad, bool first) {
    const bool any_may_leave_surface = std::any_of(bad.begin(), bad.end(), [&](const TetSnapshot& t) {
      return mesh_.quality(t.tet) < bounds_.leave_surface;
    });
    stuck_ = static_cast<double>(bad.size()) > ImprovementRounds::stuck_above * static_cast<double>(min_bad_);
    if (plan_.brief && stuck_ && !any_may_leave_surface) return false;
    const double gain = 1 - static_cast<double>(bad.size()) / static_cast<double>(min_bad_);
    // If a large share of the tets is bad, interfaces are the cause, and more rounds would gain little for
    // their time.
    const bool many = static_cast<double>(bad.size()) >
                      ImprovementRounds::many_bad * static_cast<double>(area_.tet_count());
    idle_ =
        gain >= (many ? ImprovementRounds::min_gain_of_many : ImprovementRounds::min_gain) ? 0 : idle_ + 1;
    const bool few =
        static_cast<double>(bad.size()) < ImprovementRounds::few_bad * static_cast<double>(area_.tet_count());
    if (idle_ >= (few                              ? ImprovementRounds::max_idle_of_few
                  : any_may_leave_surface && !many ? ImprovementRounds::max_idle
                  : many                           ? ImprovementRounds::max_idle_of_many
                                                   : ImprovementRounds::max_idle_when_good))
      return false;
    min_bad_ = std::min(min_bad_, bad.size());
    // Wait until perturbation within the surfaces gains no more, since points that leave their surface do not
    // return.
    const bool perturbed = plan_.fast || perturbs_;
    last_resort_ = stuck_ && ((idle_ > 0 && perturbed) || (plan_.fast && !many));
    perturbs_ = last_resort_ || (!plan_.fast && (stuck_ || first));
    return true;
  }

  void run_round(std::vector<TetSnapshot> bad) {
    if (last_resort_ && max_deviation_)
      rules_.deviation.max = relaxed_.deviation.max =
          std::min(*max_deviation_, *rules_.deviation.widened(ImprovementRounds::deviation_growth));
    const double kept =
        last_resort_ || plan_.target_tets <= plan_.min_tets
            ? 0
            : ImprovementRounds::kept_share * static_cast<double>(plan_.target_tets - plan_.min_tets);
    rules_.count.min = relaxed_.count.min = plan_.min_tets + static_cast<std::size_t>(kept);
    // Make room if the count is more than halfway from the target to the upper bound. In floating point,
    // since the bound may be the max of its type.
    if (2 * static_cast<double>(mesh_.live_tets()) >
        static_cast<double>(plan_.target_tets) + static_cast<double>(plan_.max_tets))
      make_room(bad);
    if (perturbs_) perturb(bad);
    if (stuck_) move_points_around(bad);
    std::vector<TetSnapshot> tries = worth_trying(bad);
    tried_ = std::move(bad);
    mesh_.begin_round();
    std::sort(tries.begin(), tries.end(), [&](const TetSnapshot& a, const TetSnapshot& b) {
      const float qa = mesh_.quality(a.tet), qb = mesh_.quality(b.tet);
      return qa != qb ? qa < qb : a.tet < b.tet;
    });
    runner_.tets_in_order(tries, [&](Workspace& ws, const TetSnapshot& item, int) {
      return improve_tet(ws, {rules_, relaxed_, bounds_, last_resort_, plan_.fast}, item);
    });
  }

  /// Makes room for insertions by collapses that leave only good tets, or improve the worst.
  void make_room(const std::vector<TetSnapshot>& bad) {
    BlockRules thinning = rules_;
    thinning.acceptance.good_enough = bounds_.bad_quality * ImprovementRounds::thinning_margin;
    thinning.count.min = plan_.target_tets;
    runner_.each_star(
        area_.points_to_thin(bad), Operation::collapse, [&](Workspace& ws) { return collapse(ws, thinning); },
        [&] { return mesh_.live_tets() <= plan_.target_tets; });
  }

  void perturb(const std::vector<TetSnapshot>& bad) {
    BlockRules perturbation = last_resort_ ? relaxed_ : rules_;
    perturbation.acceptance.good_enough = ImprovementRounds::perturbed_share * bounds_.bad_quality;
    runner_.tets(
        area_.tets_around(bad),
        [&](Workspace& ws, const TetSnapshot& item, int) { return perturb_tet(ws, perturbation, item); },
        [] { return false; });
  }

  void move_points_around(const std::vector<TetSnapshot>& bad) {
    std::vector<Index> around = area_.points_around(bad);
    if (!last_resort_) std::erase_if(around, [&](Index p) { return !mesh_.touched(p); });
    runner_.each_star(around, Operation::optimise, [&](Workspace& ws) { return optimise(ws, rules_); });
  }

  /// Drops tets that the last round tried, unless their surroundings have changed or this round allows more.
  std::vector<TetSnapshot> worth_trying(const std::vector<TetSnapshot>& bad) const {
    if (last_resort_) return bad;
    std::vector<TetSnapshot> tries;
    const auto before = [](const TetSnapshot& a, const TetSnapshot& b) { return a.tet < b.tet; };
    for (const TetSnapshot& t : bad) {
      const auto known = std::lower_bound(tried_.begin(), tried_.end(), t, before);
      if (known == tried_.end() || known->tet != t.tet || known->points != t.points ||
          std::any_of(t.points.begin(), t.points.end(), [&](Index p) { return mesh_.touched(p); }))
        tries.push_back(t);
    }
    return tries;
  }

  RoundRecorder& recorder_;
  EditableMesh& mesh_;
  BlockRunner& runner_;
  BlockRules& rules_;
  ImprovementArea& area_;
  const ImprovementPlan& plan_;
  ImproveBounds bounds_;
  BlockRules relaxed_;
  std::optional<double> max_deviation_;
  std::vector<TetSnapshot> tried_;  ///< tets tried in the last round, by number
  std::size_t min_bad_ = 0;         ///< min number of bad tets after a round
  int idle_ = 0;                    ///< consecutive rounds without gain
  bool stuck_ = false, perturbs_ = false, last_resort_ = false;
};

}  // namespace

int run_improvement(const ImprovementTools& tools, ImprovementArea& area, const ImprovementPlan& plan) {
  return ImprovementLoop(tools, area, plan).run();
}

}  // namespace tetwright

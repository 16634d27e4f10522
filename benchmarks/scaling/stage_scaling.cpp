// SPDX-License-Identifier: Apache-2.0
#include "benchmarks/scaling/stage_scaling.h"

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "benchmarks/processes.h"
#include "tetwright/error.h"
#include "tetwright/loop_times.h"

namespace tetwright {

namespace {

/// Seconds that a loop takes on several cores beyond its share of the work: waking the threads, and waiting
/// for the last. A fit to what was measured on sixteen cores (README.md, scaling).
constexpr double loop_overhead = 1e-4;

double ratio(double a, double b) { return b > 0 ? a / b : 0; }

/// Speed-up of a stage on LoopTimes::cores[i] cores.
double predicted_speedup(const nlohmann::json& stage, std::size_t i) {
  return ratio(stage["thread_seconds"],
               stage["stage_on_cores"][i].get<double>() + loop_overhead * stage["count"].get<double>());
}

/// Prints the stages of a run with one thread.
void print_stages(const nlohmann::json& loops) {
  std::printf("%10s %8s %8s %7s %8s", "stage", "CPU s", "serial s", "%", "loops");
  for (const unsigned cores : LoopTimes::cores) std::printf(" %4u cores", cores);
  std::printf("\n");
  for (const nlohmann::json& stage : loops) {
    const double seconds = stage["thread_seconds"], serial = seconds - stage["seconds"].get<double>();
    std::printf("%10s %8.3f %8.3f %7.1f %8zu", stage["stage"].get<std::string>().c_str(), seconds, serial,
                100 * ratio(serial, seconds), stage["count"].get<std::size_t>());
    for (std::size_t i = 0; i < LoopTimes::cores.size(); ++i)
      std::printf(" %9.2fx", predicted_speedup(stage, i));
    std::printf("\n");
  }
}

/// Speed-up of a whole run with that many threads; 0 for one without a prediction.
double predicted_speedup_of_run(const nlohmann::json& loops, unsigned threads) {
  if (threads == 1) return 1;
  const auto at = std::find(LoopTimes::cores.begin(), LoopTimes::cores.end(), threads);
  if (at == LoopTimes::cores.end()) return 0;
  return predicted_speedup(loops.back(), static_cast<std::size_t>(at - LoopTimes::cores.begin()));
}

}  // namespace

nlohmann::json StageScaling::best_run(const ScaledCall& call, unsigned threads) const {
  std::vector<std::string> arguments{program_};
  arguments.insert(arguments.end(), call.arguments.begin(), call.arguments.end());
  for (const std::string& more : {std::string("--threads"), std::to_string(threads), std::string("--stats"),
                                  stats_, std::string("--quiet")})
    arguments.push_back(more);
  nlohmann::json best;
  for (int i = 0; i < runs_; ++i) {
    const ProgramRun run = run_program(arguments);
    if (run.status > 1) throw InputError(call.name + " ended with status " + std::to_string(run.status));
    std::ifstream file(stats_);
    const nlohmann::json stats = nlohmann::json::parse(file);
    // Busy machines prolong wall times far more than processor times.
    const double judged = threads == 1 ? run.cpu_seconds : run.seconds;
    if (!best.is_null() && judged >= best["judged"].get<double>()) continue;
    best = {{"judged", judged},
            {"threads", threads},
            {"seconds", run.seconds},
            {"cpu_seconds", run.cpu_seconds},
            {"tets", stats["result"]["tets"]},
            {"loops", stats["loops"]}};
  }
  best.erase("judged");
  return best;
}

nlohmann::json StageScaling::measure(const ScaledCall& call, const std::vector<unsigned>& threads) const {
  const nlohmann::json one = best_run(call, 1);
  nlohmann::json all = nlohmann::json::array({one});
  std::printf("\n%s: %zu tets\n\n", call.name.c_str(), one["tets"].get<std::size_t>());
  print_stages(one["loops"]);
  std::printf("\n%10s %8s %9s %8s %8s %10s\n", "threads", "wall s", "speed-up", "CPU s", "growth",
              "predicted");
  const double seconds = one["seconds"], cpu_seconds = one["cpu_seconds"];
  for (const unsigned n : threads) {
    const nlohmann::json run = n == 1 ? one : best_run(call, n);
    if (n != 1) all.push_back(run);
    std::printf("%10u %8.2f %8.2fx %8.2f %7.2fx", n, run["seconds"].get<double>(),
                ratio(seconds, run["seconds"]), run["cpu_seconds"].get<double>(),
                ratio(run["cpu_seconds"], cpu_seconds));
    const double predicted = predicted_speedup_of_run(one["loops"], n);
    if (predicted > 0)
      std::printf(" %9.2fx\n", predicted);
    else
      std::printf(" %10s\n", "");
    std::fflush(stdout);
  }
  return {{"call", call.name}, {"runs", all}};
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tools/report/stage_times_json.h"

#include <algorithm>
#include <string>
#include <vector>

namespace tetwright {

namespace {

struct StageTimes {
  const char* name;
  double seconds;
  LoopTimes loops;
};

/// The stages of a run, with the total last.
std::vector<StageTimes> stages_of(const PrepareReport& run) {
  std::vector<StageTimes> stages{{"read", run.seconds_read, run.loops_read}};
  if (run.mesher) {
    const MesherReport& m = *run.mesher;
    stages.insert(stages.end(), {{"mesh", run.seconds_mesh, run.loops_mesh},
                                 {"sdf", m.seconds_sdf, m.loops_sdf},
                                 {"octree", m.seconds_octree, m.loops_octree},
                                 {"lattice", m.seconds_lattice, m.loops_lattice},
                                 {"move", m.seconds_move, m.loops_move},
                                 {"cut", m.seconds_cut, m.loops_cut}});
  }
  if (run.simplify) {
    const SimplifyReport& s = *run.simplify;
    stages.insert(stages.end(), {{"build", s.seconds_build, s.loops_build},
                                 {"simplify", s.seconds_simplify, s.loops_simplify},
                                 {"close", s.seconds_close, s.loops_close}});
  }
  stages.push_back({"write", run.seconds_write, run.loops_write});
  stages.push_back({"total", run.seconds_total, run.loops_total});
  return stages;
}

}  // namespace

nlohmann::json seconds_json(const PrepareReport& run) {
  nlohmann::json seconds;
  for (const StageTimes& stage : stages_of(run)) seconds[stage.name] = stage.seconds;
  return seconds;
}

nlohmann::json loops_json(const PrepareReport& run) {
  nlohmann::json loops = nlohmann::json::array();
  for (const auto& [name, seconds, times] : stages_of(run)) {
    std::vector<double> on_cores;
    for (std::size_t i = 0; i < LoopTimes::cores.size(); ++i)
      on_cores.push_back(std::max(0.0, times.predicted(i)));
    loops.push_back({{"stage", name},
                     {"thread_seconds", times.thread_seconds},
                     {"count", times.loops},
                     {"seconds", times.seconds},
                     {"stage_on_cores", on_cores}});
  }
  return loops;
}

}  // namespace tetwright

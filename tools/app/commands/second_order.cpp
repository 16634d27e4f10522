// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/second_order.h"

#include "common/mesh/interfaces.h"

namespace tetwright {

void make_second_order(const TetMesh& result, const SurfaceToFollow& surface, CommandRun& run) {
  if (run.line.order < 2) return;
  run.progress.begin_stage("second order");
  run.midside = straight_midside_nodes(result);
  run.report.second_order = curve_midside_nodes(result, surface, *run.midside);
}

std::optional<SurfaceToFollow> followed_interfaces(const TetMesh& input, const CommandRun& run) {
  if (run.line.order < 2) return {};
  if (!input.interfaces.empty()) return follow_interfaces(input);
  TetMesh with_interfaces = input;
  with_interfaces.interfaces = find_interfaces(input);
  return follow_interfaces(with_interfaces);
}

}  // namespace tetwright

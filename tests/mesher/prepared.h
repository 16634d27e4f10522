// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <string>

#include "common/geometry/surface_tree.h"
#include "mesher/input/surface_repair.h"

namespace tetwright {

/// The count of a finding; 0 if it is not listed.
inline std::size_t found(const SurfaceRepair& input, const std::string& what) {
  for (const SurfaceFinding& f : input.findings)
    if (f.what == what) return f.count;
  return 0;
}

/// All findings, for messages of failed tests.
inline std::string findings_text(const SurfaceRepair& input) {
  std::string text;
  for (const SurfaceFinding& f : input.findings) text += std::to_string(f.count) + " " + f.what + "; ";
  return text;
}

inline double winding_at(const RepairedSurface& s, const Vec3& p) {
  return winding_number(s.points, s.triangles, p);
}

}  // namespace tetwright

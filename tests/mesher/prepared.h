#pragma once

#include <algorithm>
#include <string>

#include "mesher/surface_input.h"
#include "mesher/surface_tree.h"

namespace tetwright {

/// How many of something were found; 0 if it is not listed.
inline std::size_t found(const SurfaceInput& input, const std::string& what) {
  for (const SurfaceFinding& f : input.findings)
    if (f.what == what) return f.count;
  return 0;
}

/// All findings, for messages of failed tests.
inline std::string findings_text(const SurfaceInput& input) {
  std::string text;
  for (const SurfaceFinding& f : input.findings) text += std::to_string(f.count) + " " + f.what + "; ";
  return text;
}

inline double winding_at(const PreparedSurface& s, const Vec3& p) {
  return winding_number(s.points, s.triangles, p);
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <string>

namespace tetwright {

/// A part of a surface, or of the boundary and the interfaces of a mesh, that a file tells apart: its faces
/// stay together, and come out under the same name.
struct SurfaceRegion {
  std::int64_t number = 0;  ///< of formats that number their groups; 0: none
  std::string name;         ///< empty: only a number

  /// False: no region.
  explicit operator bool() const { return number != 0 || !name.empty(); }
  auto operator<=>(const SurfaceRegion&) const = default;
};

}  // namespace tetwright

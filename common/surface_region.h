// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <compare>
#include <cstdint>
#include <string>

namespace tetwright {

/// A region of a surface, or of the boundary and the interfaces of a mesh, that a file distinguishes. Its
/// faces stay together and are written under the same name.
struct SurfaceRegion {
  std::int64_t number = 0;  ///< in formats that number their groups; 0: none
  std::string name;         ///< empty: only a number

  /// False: no region.
  explicit operator bool() const { return number != 0 || !name.empty(); }
  auto operator<=>(const SurfaceRegion&) const = default;
};

}  // namespace tetwright

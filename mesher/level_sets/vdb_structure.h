// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tetwright {

/// Description of a grid in a .vdb file.
struct VdbGrid {
  std::string name;
  std::string type;  ///< type of the values: "float", "int32", "vec3s"
  std::string kind;  ///< class of the grid: "level set", "fog volume", "unknown"
  /// For grids of floats, doubles, int32 and int64: the bytes of a .vdb file with only this grid, which
  /// OpenVDB can read safely. Otherwise empty.
  std::string alone;
  /// For grids of doubles and integers: the reason why `alone` is empty, as the rest of a sentence that
  /// begins with the file's name.
  std::string fault;
};

/// Splits a .vdb file into its grids. OpenVDB trusts all sizes in a file and writes past the ends of its
/// arrays if they are wrong, so this validates names, masks, counts of values and compressed sizes. Supports
/// the formats 222 to 224 (OpenVDB 3 to 12, since 2014) and the usual trees of floats, doubles, int32 and
/// int64.
///
/// Grids after a damaged grid of doubles or integers can be read if the file gives the end of that grid.
///
/// \throws std::runtime_error with the rest of a sentence that begins with the file's name: not a .vdb file,
///   damaged or truncated, another format
std::vector<VdbGrid> split_vdb(std::string_view bytes);

}  // namespace tetwright

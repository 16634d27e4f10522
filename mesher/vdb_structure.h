#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tetwright {

/// A grid of a .vdb file, as its bytes say.
struct VdbGrid {
  std::string name;
  std::string type;  ///< of its values: "float", "int32", "vec3s"
  std::string kind;  ///< its class: "level set", "fog volume", "unknown"
  /// Of grids of floats, int32 and int64: a .vdb file of this grid alone, which OpenVDB can read without
  /// harm. Else empty.
  std::string alone;
  /// Of grids of whole numbers: why there is none. The rest of a sentence that begins with the file's name.
  std::string fault;
};

/// Takes a .vdb file apart. OpenVDB believes whatever sizes a file gives and writes beyond its arrays when
/// they are wrong, so they are all checked here, one by one: names, masks, counts of values, compressed
/// sizes. Files of format 222 to 224 (OpenVDB 3 to 12, since 2014) with the usual trees of floats, int32 and
/// int64.
///
/// A damaged grid of whole numbers does not keep others from being read where the file says where it ends.
/// Throws std::runtime_error with the rest of a sentence that begins with the file's name: not a .vdb file,
/// damaged or cut short, another format.
std::vector<VdbGrid> take_apart_vdb(std::string_view bytes);

}  // namespace tetwright

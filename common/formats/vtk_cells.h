#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/formats/dropped.h"

namespace tetwright {

/// VTK's number of a linear tet, in legacy and in XML files.
inline constexpr std::int64_t vtk_tet_type = 10;

/// The cells of a file that are not linear tets, by kind.
class OtherVtkCells {
 public:
  /// `type` is VTK's number of the kind, `cell` the index of the cell.
  void add(std::int64_t type, std::size_t cell);
  /// There are cells of three dimensions, or of unknown types, which might be such.
  bool has_volumes() const { return has_volumes_; }
  /// Of the first of these.
  std::size_t first_volume() const { return first_volume_; }
  /// The message that refuses the file for them.
  std::string refusal() const;
  /// Appends the kinds that are skipped: lines, faces, vertices.
  void append_flat_to(std::vector<Dropped>& dropped) const;

 private:
  std::map<std::int64_t, std::size_t> counts_;  ///< by type
  bool has_volumes_ = false;
  std::size_t first_volume_ = 0;
  std::int64_t first_volume_type_ = 0;
};

}  // namespace tetwright

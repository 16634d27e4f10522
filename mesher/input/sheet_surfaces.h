// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "mesher/complex/surface_imprint.h"
#include "mesher/input/surface_cleaning.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// Open sheets, ready to be imprinted on bodies.
class SheetSoup {
 public:
  /// Adds the sheets of a surface: *parts* connected across edges of exactly two triangles, each oriented
  /// consistently. Appends to `sheets` the names that occur.
  /// \throws InputError as clean_surface() does; for a closed or one-sided part
  void add(const SheetSurface& surface, std::vector<MesherInput::Sheet>& sheets,
           std::vector<Diagnostic>& findings);

  bool empty() const { return triangles_.empty(); }
  /// Appends the triangles to a soup of bodies, each part as a surface.
  /// \param first_surface number of the first part
  /// \param sheet_of_triangle receives the sheet of each triangle of the soup; bodies have 0
  void append_to(SurfaceSoup& soup, std::uint32_t first_surface,
                 std::vector<std::uint32_t>& sheet_of_triangle) const;
  const std::vector<Vec3>& points() const { return points_; }

 private:
  std::vector<Vec3> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> part_, sheet_;  ///< by triangle
  std::uint32_t parts_ = 0;
};

}  // namespace tetwright

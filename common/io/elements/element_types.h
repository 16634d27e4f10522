// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

namespace tetwright {

/// A type of element with its numbers in the file formats that number them.
struct ElementType {
  const char* name;       ///< plural
  std::size_t dimension;  ///< 0 to 3
  std::size_t nodes;      ///< 0: differs from element to element
  std::int64_t vtk;       ///< vtkCellType.h; unnumbered if VTK lacks it
  std::int64_t msh;       ///< Gmsh's manual, "MSH file format"; unnumbered if Gmsh lacks it

  static constexpr std::int64_t unnumbered = -1;
};

/// The types that are read and written.
namespace element {
inline constexpr ElementType triangle{"triangles", 2, 3, 5, 2};
inline constexpr ElementType quadratic_triangle{"quadratic triangles", 2, 6, 22, 9};
inline constexpr ElementType quad{"quads", 2, 4, 9, 3};
inline constexpr ElementType tet{"tets", 3, 4, 10, 4};
inline constexpr ElementType quadratic_tet{"quadratic tets", 3, 10, 24, 11};
inline constexpr ElementType wedge{"prisms", 3, 6, 13, 6};
}  // namespace element

/// Type with this number in VTK files, legacy and XML; null for unknown numbers.
const ElementType* vtk_element_type(std::int64_t number);

/// Type with this number in MSH files; null for unknown numbers.
const ElementType* msh_element_type(std::int64_t number);

}  // namespace tetwright

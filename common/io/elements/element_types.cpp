// SPDX-License-Identifier: Apache-2.0
#include "common/io/elements/element_types.h"

#include <array>
#include <map>

namespace tetwright {

namespace {

constexpr std::int64_t none = ElementType::unnumbered;

constexpr std::array types = std::to_array<ElementType>({
    {"empty cells", 0, 0, 0, none},
    {"point elements", 0, 1, 1, 15},
    {"point elements", 0, 0, 2, none},
    {"lines", 1, 2, 3, 1},
    {"polylines", 1, 0, 4, none},
    {"quadratic lines", 1, 3, 21, 8},
    {"cubic lines", 1, 4, 35, 26},
    {"lines of higher order", 1, 5, none, 27},
    {"lines of higher order", 1, 6, none, 28},
    {"lines of higher order", 1, 0, 51, none},
    {"lines of higher order", 1, 0, 60, none},
    {"lines of higher order", 1, 0, 68, none},
    {"lines of higher order", 1, 0, 75, none},

    element::triangle,
    element::quadratic_triangle,
    {"quadratic triangles", 2, 7, 34, none},
    {"triangles of higher order", 2, 9, none, 20},
    {"triangles of higher order", 2, 10, none, 21},
    {"triangles of higher order", 2, 12, none, 22},
    {"triangles of higher order", 2, 15, none, 23},
    {"triangles of higher order", 2, 15, none, 24},
    {"triangles of higher order", 2, 21, none, 25},
    {"triangles of higher order", 2, 0, 53, none},
    {"triangles of higher order", 2, 0, 61, none},
    {"triangles of higher order", 2, 0, 69, none},
    {"triangles of higher order", 2, 0, 76, none},
    {"triangle strips", 2, 0, 6, none},
    element::quad,
    {"pixels", 2, 4, 8, none},
    {"quadratic quads", 2, 6, 30, none},
    {"quadratic quads", 2, 8, 23, 16},
    {"quadratic quads", 2, 9, 28, 10},
    {"quads of higher order", 2, 0, 54, none},
    {"quads of higher order", 2, 0, 62, none},
    {"quads of higher order", 2, 0, 70, none},
    {"quads of higher order", 2, 0, 77, none},
    {"polygons", 2, 0, 7, none},
    {"quadratic polygons", 2, 0, 36, none},
    {"parametric surfaces", 2, 0, 52, none},
    {"polygons of higher order", 2, 0, 63, none},

    element::tet,
    element::quadratic_tet,
    {"tets of higher order", 3, 20, none, 29},
    {"tets of higher order", 3, 35, none, 30},
    {"tets of higher order", 3, 56, none, 31},
    {"tets of higher order", 3, 0, none, 71},
    {"tets of higher order", 3, 0, none, 72},
    {"tets of higher order", 3, 0, none, 73},
    {"tets of higher order", 3, 0, none, 74},
    {"tets of higher order", 3, 0, none, 75},
    {"tets of higher order", 3, 0, 55, none},
    {"tets of higher order", 3, 0, 64, none},
    {"tets of higher order", 3, 0, 71, none},
    {"tets of higher order", 3, 0, 78, none},
    {"voxels", 3, 8, 11, none},
    {"hexahedra", 3, 8, 12, 5},
    {"quadratic hexahedra", 3, 20, 25, 17},
    {"quadratic hexahedra", 3, 24, 33, none},
    {"quadratic hexahedra", 3, 27, 29, 12},
    {"hexahedra of higher order", 3, 64, none, 92},
    {"hexahedra of higher order", 3, 125, none, 93},
    {"hexahedra of higher order", 3, 0, 56, none},
    {"hexahedra of higher order", 3, 0, 67, none},
    {"hexahedra of higher order", 3, 0, 72, none},
    {"hexahedra of higher order", 3, 0, 79, none},
    element::wedge,
    {"quadratic prisms", 3, 12, 31, none},
    {"quadratic prisms", 3, 15, 26, 18},
    {"quadratic prisms", 3, 18, 32, 13},
    {"prisms of higher order", 3, 40, none, 90},
    {"prisms of higher order", 3, 75, none, 91},
    {"prisms of higher order", 3, 0, 65, none},
    {"prisms of higher order", 3, 0, 73, none},
    {"prisms of higher order", 3, 0, 80, none},
    {"pyramids", 3, 5, 14, 7},
    {"quadratic pyramids", 3, 13, 27, 19},
    {"quadratic pyramids", 3, 14, none, 14},
    {"quadratic pyramids", 3, 19, 37, none},
    {"pyramids of higher order", 3, 0, none, 118},
    {"pyramids of higher order", 3, 0, none, 119},
    {"pyramids of higher order", 3, 0, 66, none},
    {"pyramids of higher order", 3, 0, 74, none},
    {"pyramids of higher order", 3, 0, 81, none},
    {"pentagonal prisms", 3, 10, 15, none},
    {"hexagonal prisms", 3, 12, 16, none},
    {"polyhedra", 3, 0, 42, none},
});

using Numbered = std::map<std::int64_t, const ElementType*>;

Numbered by(std::int64_t ElementType::*number) {
  Numbered numbered;
  for (const ElementType& type : types)
    if (type.*number != none) numbered.emplace(type.*number, &type);
  return numbered;
}

const ElementType* find(const Numbered& numbered, std::int64_t number) {
  const auto found = numbered.find(number);
  return found == numbered.end() ? nullptr : found->second;
}

}  // namespace

const ElementType* vtk_element_type(std::int64_t number) {
  static const Numbered numbered = by(&ElementType::vtk);
  return find(numbered, number);
}

const ElementType* msh_element_type(std::int64_t number) {
  static const Numbered numbered = by(&ElementType::msh);
  return find(numbered, number);
}

}  // namespace tetwright

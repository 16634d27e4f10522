// SPDX-License-Identifier: Apache-2.0
#include "common/io/elements/element_types.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <string>

namespace tetwright {
namespace {

// VTK numbers its cells up to 81, Gmsh its elements up to 140.
constexpr std::int64_t last_number = 200;

TEST(ElementTypes, ANumberFindsTheTypeThatHasIt) {
  int vtk = 0, msh = 0;
  for (std::int64_t number = -2; number <= last_number; ++number) {
    if (const ElementType* type = vtk_element_type(number)) {
      EXPECT_EQ(type->vtk, number);
      ++vtk;
    }
    if (const ElementType* type = msh_element_type(number)) {
      EXPECT_EQ(type->msh, number);
      ++msh;
    }
  }
  // A number that two types share would be found once only, and these counts would be smaller.
  EXPECT_EQ(vtk, 63);
  EXPECT_EQ(msh, 42);
}

TEST(ElementTypes, BothFormatsFindTheTypesThatAreRead) {
  for (const ElementType& type : {element::triangle, element::quadratic_triangle, element::quad, element::tet,
                                  element::quadratic_tet}) {
    const ElementType *by_vtk = vtk_element_type(type.vtk), *by_msh = msh_element_type(type.msh);
    ASSERT_TRUE(by_vtk && by_msh) << type.name;
    EXPECT_EQ(by_vtk, by_msh) << type.name;
    EXPECT_STREQ(by_vtk->name, type.name);
    EXPECT_EQ(by_vtk->nodes, type.nodes);
    EXPECT_EQ(by_vtk->dimension, type.dimension);
  }
}

TEST(ElementTypes, AFormatsOwnNumbersAreThoseOfItsManual) {
  struct Expected {
    std::int64_t number;
    const char* name;
    std::size_t dimension, nodes;
  };
  for (const auto& [number, name, dimension, nodes] : {Expected{3, "lines", 1, 2},
                                                       {13, "prisms", 3, 6},
                                                       {14, "pyramids", 3, 5},
                                                       {25, "quadratic hexahedra", 3, 20},
                                                       {42, "polyhedra", 3, 0},
                                                       {71, "tets of higher order", 3, 0}}) {
    const ElementType* type = vtk_element_type(number);
    ASSERT_TRUE(type) << number;
    EXPECT_STREQ(type->name, name);
    EXPECT_EQ(type->dimension, dimension);
    EXPECT_EQ(type->nodes, nodes);
  }
  for (const auto& [number, name, dimension, nodes] : {Expected{1, "lines", 1, 2},
                                                       {6, "prisms", 3, 6},
                                                       {7, "pyramids", 3, 5},
                                                       {10, "quadratic quads", 2, 9},
                                                       {15, "point elements", 0, 1},
                                                       {31, "tets of higher order", 3, 56}}) {
    const ElementType* type = msh_element_type(number);
    ASSERT_TRUE(type) << number;
    EXPECT_STREQ(type->name, name);
    EXPECT_EQ(type->dimension, dimension);
    EXPECT_EQ(type->nodes, nodes);
  }
}

TEST(ElementTypes, UnknownNumbersHaveNone) {
  for (const std::int64_t number : {std::int64_t{-1}, std::int64_t{43}, std::int64_t{100}, INT64_MAX}) {
    EXPECT_EQ(vtk_element_type(number), nullptr) << number;
    EXPECT_EQ(msh_element_type(number == 43 ? 500 : number), nullptr) << number;
  }
}

}  // namespace
}  // namespace tetwright

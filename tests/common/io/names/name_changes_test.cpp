// SPDX-License-Identifier: Apache-2.0
#include "tetwright/io.h"

#include <gtest/gtest.h>

#include "tests/common/io/round_trip.h"

namespace tetwright::name_changes_test {
namespace {

using Texts = std::vector<std::string>;

Texts texts(const std::vector<NameChange>& changes) {
  Texts out;
  for (const NameChange& c : changes) out.push_back(c.own + " -> " + c.written);
  return out;
}

TEST(NameChanges, WhatEveryFormatHoldsIsNotChanged) {
  TetMesh mesh = two_tets(7);
  mesh.material_names = {{1, "bone"}, {7, "skin"}};
  mesh.interfaces = find_interfaces(mesh);
  mesh.interfaces[0].patch = 1;
  mesh.patch_groups = {{{mesh.interfaces[0].pair(), 1}, {5, "outlet"}}};
  for (const TetFormatInfo& format : written_tet_formats()) {
    const NameChanges c = written_name_changes(mesh, "m" + format.extension, format.name);
    EXPECT_TRUE(c.tags.empty() && c.material_names.empty() && c.patch_numbers.empty() &&
                c.patch_names.empty())
        << format.name;
  }
}

TEST(NameChanges, TagsAndNumbersOutsideOfEightDigits) {
  TetMesh mesh = mesh_with_surfaces();
  mesh.patch_groups.begin()->second.number = 123456781;
  NameChanges c = written_name_changes(mesh, "m.bdf");
  EXPECT_EQ(texts(c.tags), Texts{"-7 -> 2"});
  ASSERT_EQ(c.patch_numbers.size(), 1u);
  EXPECT_EQ(c.patch_numbers[0].own, "123456781");
  c = written_name_changes(mesh, "m.msh");
  EXPECT_TRUE(c.tags.empty());
  EXPECT_TRUE(c.patch_numbers.empty());
  mesh.patch_groups.begin()->second.number = -4;
  EXPECT_EQ(written_name_changes(mesh, "m.msh").patch_numbers.size(), 1u);
  EXPECT_TRUE(written_name_changes(mesh, "m.inp").patch_numbers.empty());  // only names
}

TEST(NameChanges, NamesThatAFormatCannotHold) {
  TetMesh mesh = mesh_with_surfaces();
  mesh.material_names = {{-7, "a'b"}, {1, "a b"}};
  mesh.patch_groups.begin()->second.name = "in let";
  EXPECT_EQ(texts(written_name_changes(mesh, "m.inp").material_names),
            (Texts{R"("a'b" -> "a_b")", R"("a b" -> "a_b_2")"}));
  EXPECT_EQ(texts(written_name_changes(mesh, "m.mesh").patch_names), Texts{R"("in let" -> "in_let")"});
  EXPECT_TRUE(written_name_changes(mesh, "m.meshb").patch_names.empty());  // the format has no names
  EXPECT_TRUE(written_name_changes(mesh, "m.vtk").material_names.empty());
  mesh.material_names = {{-7, R"(a"b)"}, {1, R"(a\b)"}};
  EXPECT_EQ(texts(written_name_changes(mesh, "m.msh").material_names),
            (Texts{R"("a"b" -> "a_b")", R"("a\b" -> "a_b_2")"}));
  mesh.material_names = {{-7, "same"}, {1, "same"}};
  for (const char* file : {"m.vtk", "m.bdf", "m.xdmf", "m.node"})
    EXPECT_EQ(texts(written_name_changes(mesh, file).material_names), Texts{R"("same" -> "same_2")"}) << file;
  EXPECT_TRUE(written_name_changes(mesh, "m.vtu").material_names.empty());
  mesh.material_names = {{-7, ""}};  // an empty name; material 1 has a default name
  EXPECT_EQ(texts(written_name_changes(mesh, "m.vtk").material_names), Texts{R"("" -> "material_-7")"});
}

}  // namespace
}  // namespace tetwright::name_changes_test

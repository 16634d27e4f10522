// SPDX-License-Identifier: Apache-2.0
#include "common/io/names/mesh_fields.h"

#include <limits>

#include "tests/common/io/expect_error.h"
#include "tests/common/small_meshes.h"

namespace tetwright::mesh_fields_test {
namespace {

TEST(MeshFields, NamesThatAnyFormatCanHold) {
  EXPECT_EQ(field_name("v\xc3\xa4lue <1>"), "v\xc3\xa4lue <1>");
  EXPECT_EQ(field_name("a\nb\tc"), "a_b_c");
  EXPECT_EQ(field_name("a\xff\xc3"), "a__");
  EXPECT_EQ(field_name("\xed\xa0\x80"), "___");  // a surrogate
  EXPECT_EQ(field_name(""), "field");
  EXPECT_EQ(field_name(std::string(5000, 'x')).size(), 200u);
  EXPECT_EQ(field_name(std::string(199, 'x') + "\xc3\xa4"), std::string(199, 'x') + "_");
}

TEST(MeshFields, NamesAreWrittenOnce) {
  const auto field = [](const char* name) { return MeshField{name, 1, false, {}}; };
  EXPECT_EQ(field_names_to_write({field("a"), field("a"), field("material"), field("a_2"), field("a")},
                                 {"material"}),
            (std::vector<std::string>{"a", "a_2", "material_2", "a_2_2", "a_3"}));
}

TEST(MeshFields, WholeNumbers) {
  EXPECT_TRUE(all_whole({"", 1, false, {1, -5, 0x1p53 - 1}}));
  EXPECT_FALSE(all_whole({"", 1, false, {1, 0.5}}));
  EXPECT_FALSE(all_whole({"", 1, false, {0x1p53}}));  // may stand for the next integer
  EXPECT_FALSE(all_whole({"", 1, false, {std::numeric_limits<double>::quiet_NaN()}}));
}

ReadTetMesh with_fields(std::vector<MeshField> fields, const std::string& own = "") {
  ReadTetMesh read{two_tets(2), own};
  if (own.empty()) read.mesh.materials.clear();
  read.mesh.cell_fields = std::move(fields);
  return read;
}

TEST(MeshFields, TheMaterialByRule) {
  const auto taken = [](std::vector<MeshField> fields) {
    ReadTetMesh read = with_fields(std::move(fields));
    const std::size_t before = read.mesh.cell_fields.size();
    take_material(read, {}, "f");
    EXPECT_EQ(read.mesh.materials.size(), 2u);
    EXPECT_EQ(read.mesh.cell_fields.size(), before - !read.material_field.empty());
    return read.material_field;
  };
  const MeshField region{"region", 1, true, {3, 4}}, id{"id", 1, true, {1, 2}}, real{"x", 1, false, {1, 2}};
  EXPECT_EQ(taken({}), "");
  EXPECT_EQ(taken({real}), "");
  EXPECT_EQ(taken({real, region}), "region");
  EXPECT_EQ(taken({id, region}), "");
  EXPECT_EQ(taken({{"pair", 2, true, {1, 2, 3, 4}}, region}), "region");
  const char* order[] = {"material", "medit:ref", "gmsh:physical", "MaterialID", "attribute"};
  std::vector<MeshField> all{id};
  for (int i = 4; i >= 0; --i) {
    all.push_back({order[i], 1, false, {5, 6}});
    EXPECT_EQ(taken(all), order[i]);
  }
  // A field with a known name but fractional values is skipped.
  EXPECT_EQ(taken({{"attribute", 1, false, {0.5, 1}}, region}), "region");
  EXPECT_EQ(taken({{"material", 3, true, {1, 2, 3, 4, 5, 6}}, region}), "region");
}

TEST(MeshFields, TheMaterialAskedFor) {
  ReadTetMesh read = with_fields({{"material", 1, true, {5, 6}}, {"region", 1, true, {3, 4}}});
  read.mesh.material_names = {{3, "not this one"}};
  take_material(read, {.material_field = "region"}, "f");
  EXPECT_EQ(read.mesh.materials, (std::vector<MaterialTag>{3, 4}));
  EXPECT_EQ(read.material_field, "region");
  EXPECT_EQ(read.mesh.cell_fields, (std::vector<MeshField>{{"material", 1, true, {5, 6}}}));
  EXPECT_TRUE(read.mesh.material_names.empty());
  // It replaces the format's own materials, which become an ordinary field.
  read = with_fields({{"region", 1, false, {3, 4}}}, "medit:ref");
  take_material(read, {.material_field = "region"}, "f");
  EXPECT_EQ(read.mesh.materials, (std::vector<MaterialTag>{3, 4}));
  EXPECT_EQ(read.mesh.cell_fields, (std::vector<MeshField>{{"medit:ref", 1, true, {1, 2}}}));
  read = with_fields({}, "medit:ref");
  take_material(read, {.material_field = "medit:ref"}, "f");
  EXPECT_EQ(read.mesh.materials, (std::vector<MaterialTag>{1, 2}));
}

TEST(MeshFields, TheMaterialAskedForIfItIsThere) {
  ReadTetMesh read = with_fields({{"material", 1, true, {5, 6}}, {"region", 1, true, {3, 4}}});
  read.mesh.material_names = {{5, "five"}};
  take_material(read, {"zone", false}, "f");
  EXPECT_EQ(read.material_field, "material");
  EXPECT_EQ(read.mesh.materials, (std::vector<MaterialTag>{5, 6}));
  EXPECT_EQ(read.mesh.material_names.size(), 1u);
  read = with_fields({{"material", 1, true, {5, 6}}, {"region", 1, true, {3, 4}}});
  take_material(read, {"region", false}, "f");
  EXPECT_EQ(read.material_field, "region");
  read = with_fields({}, "medit:ref");
  take_material(read, {"zone", false}, "f");
  EXPECT_EQ(read.material_field, "medit:ref");
}

TEST(MeshFields, MaterialsThatAreNone) {
  const auto message = [](std::vector<MeshField> fields, const char* asked) {
    return error_of<InputError>([&] {
      ReadTetMesh read = with_fields(std::move(fields));
      take_material(read, {.material_field = asked}, "f");
    });
  };
  EXPECT_EQ(message({}, "x"),
            "f: no cell field \"x\" with one number for each tet; there is no integer cell field in it");
  EXPECT_EQ(message({{"a", 1, true, {1, 2}}, {"b", 1, false, {.5, 1}}, {"c", 1, false, {1, 2}}}, "x"),
            "f: no cell field \"x\" with one number for each tet; there is \"a\", \"c\"");
  EXPECT_NE(message({{"b", 1, false, {1, .5}}}, "b").find("tet 1 (counted from 0) has 0.5"),
            std::string::npos);
  EXPECT_NE(message({{"b", 1, false, {std::numeric_limits<double>::quiet_NaN(), 1}}}, "b").find("nan"),
            std::string::npos);
  EXPECT_NE(message({{"b", 1, true, {1, 3e9}}}, "b").find("3000000000"), std::string::npos);
}

}  // namespace
}  // namespace tetwright::mesh_fields_test

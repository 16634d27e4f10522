// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/exodus.h"

#include <gtest/gtest.h>
#include <netcdf.h>
#include <netcdf_mem.h>

#include "tests/common/io/expect_error.h"
#include "tests/common/io/round_trip.h"
#include "tests/common/io/tricky_meshes.h"

namespace tetwright::exodus_test {
namespace {

/// Opens the bytes of a file with the netCDF library.
class Opened {
 public:
  explicit Opened(std::string bytes) : bytes_(std::move(bytes)) {
    EXPECT_EQ(nc_open_mem("test", NC_NOWRITE, bytes_.size(), bytes_.data(), &id_), NC_NOERR);
  }
  ~Opened() { nc_close(id_); }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;

  int variable(const std::string& name) const {
    int variable = -1;
    EXPECT_EQ(nc_inq_varid(id_, name.c_str(), &variable), NC_NOERR) << name;
    return variable;
  }
  bool has(const std::string& name) const {
    int variable = -1;
    return nc_inq_varid(id_, name.c_str(), &variable) == NC_NOERR;
  }
  nc_type type(const std::string& name) const {
    nc_type type = NC_NAT;
    nc_inq_vartype(id_, variable(name), &type);
    return type;
  }
  std::size_t length(const std::string& dimension) const {
    int number = -1;
    std::size_t length = 0;
    EXPECT_EQ(nc_inq_dimid(id_, dimension.c_str(), &number), NC_NOERR) << dimension;
    nc_inq_dimlen(id_, number, &length);
    return length;
  }
  std::size_t size(const std::string& name) const {
    int count = 0;
    nc_inq_varndims(id_, variable(name), &count);
    std::vector<int> dimensions(static_cast<std::size_t>(count));
    nc_inq_vardimid(id_, variable(name), dimensions.data());
    std::size_t size = 1;
    for (const int dimension : dimensions) {
      std::size_t length = 0;
      nc_inq_dimlen(id_, dimension, &length);
      size *= length;
    }
    return size;
  }
  std::vector<double> numbers(const std::string& name) const {
    std::vector<double> values(size(name));
    EXPECT_EQ(nc_get_var_double(id_, variable(name), values.data()), NC_NOERR) << name;
    return values;
  }
  std::vector<std::string> texts(const std::string& name, std::size_t width) const {
    std::string all(size(name), ' ');
    EXPECT_EQ(nc_get_var_text(id_, variable(name), all.data()), NC_NOERR) << name;
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < all.size(); i += width) texts.emplace_back(all.substr(i, width).c_str());
    return texts;
  }

 private:
  std::string bytes_;
  int id_ = -1;
};

using Numbers = std::vector<double>;
using Texts = std::vector<std::string>;

TEST(Exodus, BlocksSetsAndMaps) {
  const Opened file(text_of(write_exodus, mesh_with_surfaces()));
  // Materials in ascending order: -7 has the smallest free number, 2, since 1 is kept.
  EXPECT_EQ(file.texts("eb_names", 33), (Texts{"skin", "bone"}));
  EXPECT_EQ(file.numbers("eb_prop1"), (Numbers{2, 1}));
  EXPECT_EQ(file.numbers("connect1"), (Numbers{1, 3, 2, 5}));
  EXPECT_EQ(file.numbers("connect2"), (Numbers{1, 2, 3, 4}));
  EXPECT_EQ(file.numbers("elem_num_map"), (Numbers{2, 1}));
  EXPECT_EQ(file.numbers("node_num_map"), (Numbers{1, 2, 3, 4, 5}));
  const Texts names = file.texts("ss_names", 33);
  EXPECT_EQ(names, file.texts("ns_names", 33));
  EXPECT_EQ(file.numbers("ss_prop1"), file.numbers("ns_prop1"));
  const auto at = [&](const std::string& name) {
    return std::to_string(std::find(names.begin(), names.end(), name) - names.begin() + 1);
  };
  // The contact is on the side of the smaller tag: the first element of the file, whose face 1-3-2 is side 4.
  EXPECT_EQ(file.numbers("elem_ss" + at("skin|bone")), (Numbers{1}));
  EXPECT_EQ(file.numbers("side_ss" + at("skin|bone")), (Numbers{4}));
  EXPECT_EQ(file.numbers("node_ns" + at("skin|bone")), (Numbers{1, 2, 3}));
  EXPECT_EQ(file.numbers("elem_ss" + at("outlet")), (Numbers{2}));
  EXPECT_EQ(file.numbers("elem_ss" + at("skin|outside")).size(), 3u);
  EXPECT_EQ(file.length("time_step"), 0u);
  EXPECT_EQ(file.texts("qa_records", 33), (Texts{"tetwright", TETWRIGHT_VERSION, "", ""}));
}

TEST(Exodus, NothingFollowsTheLastVariable) {
  // The library fills a file up to the size for which memory was reserved.
  TetMesh mesh = one_tet();
  const std::size_t one = text_of(write_exodus, mesh).size();
  constexpr std::size_t more = 100'000;
  mesh.tets.resize(1 + more, mesh.tets[0]);
  mesh.materials.resize(1 + more, 1);
  EXPECT_LT(one, 5000u);
  // Four nodes and a number in the map for each tet; numbers of more digits in the header take no more.
  EXPECT_EQ(text_of(write_exodus, mesh).size(), one + 20 * more);
}

TEST(Exodus, SidesAreThoseOfTheFormat) {
  // According to its manual, side 1 has the nodes 1-2-4, side 2 2-3-4, side 3 1-4-3, side 4 1-3-2.
  const std::vector<std::array<Index, 3>> sides{{0, 1, 3}, {1, 2, 3}, {0, 3, 2}, {0, 2, 1}};
  TetMesh mesh = one_tet();
  mesh.interfaces = find_interfaces(mesh);
  for (std::size_t side = 0; side < 4; ++side) {
    TetMesh one = mesh;
    std::erase_if(one.interfaces, [&](const InterfaceTriangle& t) {
      return !std::is_permutation(sides[side].begin(), sides[side].end(), t.ids.begin());
    });
    const Opened file(text_of(write_exodus, one));
    EXPECT_EQ(file.numbers("side_ss1"), Numbers{static_cast<double>(side + 1)});
  }
}

TEST(Exodus, CoordinatesKeepEveryBit) {
  const TetMesh mesh = tricky_tets();
  const Opened file(text_of(write_exodus, mesh));
  std::vector<Vec3> points(mesh.points.size());
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Numbers values = file.numbers(std::string("coord") + "xyz"[k]);
    for (std::size_t i = 0; i < points.size(); ++i) points[i][k] = values.at(i);
  }
  EXPECT_TRUE(same_bits(points, mesh.points));
}

TEST(Exodus, FieldsAreVariablesOfTheirComponents) {
  TetMesh mesh = mesh_with_surfaces();
  mesh.point_fields = {
      {"u", 3, false, {}}, {"my t", 1, true, {1, 2, 3, 4, 5}}, {"u_y", 1, false, {1, 2, 3, 4, 5}}};
  for (int i = 0; i < 15; ++i) mesh.point_fields[0].values.push_back(i);
  mesh.cell_fields = {{"s", 2, false, {10, 11, 20, 21}}};
  const std::string bytes = text_of(write_exodus, mesh);
  EXPECT_EQ(text_of(write_exodus, mesh), bytes);
  const Opened file(bytes);
  EXPECT_EQ(file.numbers("time_whole"), Numbers{0});
  EXPECT_EQ(file.texts("name_nod_var", 33), (Texts{"u_x", "u_y", "u_z", "my_t", "u_y_2"}));
  EXPECT_EQ(file.numbers("vals_nod_var2"), (Numbers{1, 4, 7, 10, 13}));
  EXPECT_EQ(file.numbers("vals_nod_var4"), (Numbers{1, 2, 3, 4, 5}));
  EXPECT_EQ(file.texts("name_elem_var", 33), (Texts{"s_1", "s_2"}));
  EXPECT_EQ(file.numbers("vals_elem_var1eb1"), Numbers{20});
  EXPECT_EQ(file.numbers("vals_elem_var2eb2"), Numbers{11});
  EXPECT_EQ(file.numbers("elem_var_tab"), (Numbers{1, 1, 1, 1}));
}

TEST(Exodus, TenNodes) {
  const TetMesh mesh = mesh_with_surfaces();
  const MidsideNodes midside = straight_midside_nodes(mesh);
  const Opened file(text_of(write_exodus, {mesh, &midside}));
  // The edges 01 02 03 04 12 13 14 23 24 of the points have the nodes 6 to 14.
  EXPECT_EQ(file.numbers("connect2"), (Numbers{1, 2, 3, 4, 6, 10, 7, 8, 11, 13}));
  EXPECT_EQ(file.numbers("coordx").size(), 14u);
  const Texts names = file.texts("ns_names", 33);
  const auto contact = std::find(names.begin(), names.end(), "skin|bone") - names.begin() + 1;
  EXPECT_EQ(file.numbers("node_ns" + std::to_string(contact)), (Numbers{1, 2, 3, 6, 7, 10}));
}

TEST(Exodus, TheFormIsTheSmallestThatHoldsTheMesh) {
  const auto form = [](std::size_t nodes, std::size_t tets, std::size_t bytes) {
    const ExodusForm f = exodus_form(nodes, tets, bytes);
    return std::pair(f.large_variables, f.long_numbers);
  };
  EXPECT_EQ(form(100, 100, 4'294'967'292), std::pair(false, false));
  EXPECT_EQ(form(100, 100, 4'294'967'293), std::pair(true, false));
  EXPECT_EQ(form(2'147'483'644, 100, 100), std::pair(false, false));
  EXPECT_EQ(form(2'147'483'645, 100, 100), std::pair(false, true));
  EXPECT_EQ(form(100, 2'147'483'645, 100), std::pair(false, true));
}

TEST(Exodus, LargeForms) {
  const TetMesh mesh = mesh_with_surfaces();
  const auto bytes = [&](const ExodusForm& form) {
    std::string out;
    write_exodus_as(form, mesh, [&](std::string_view piece) { out += piece; });
    return out;
  };
  EXPECT_EQ(text_of(write_exodus, mesh).substr(0, 4), "CDF\x02");
  EXPECT_EQ(bytes({}), text_of(write_exodus, mesh));
  EXPECT_EQ(bytes({.large_variables = true}).substr(0, 4), "CDF\x05");
  EXPECT_EQ(Opened(bytes({.large_variables = true})).type("connect1"), NC_INT);
  const Opened file(bytes({.long_numbers = true}));
  for (const char* name : {"connect1", "elem_num_map", "node_num_map", "elem_ss1", "side_ss1", "node_ns1"})
    EXPECT_EQ(file.type(name), NC_INT64) << name;
  EXPECT_EQ(file.type("eb_prop1"), NC_INT);
  EXPECT_EQ(file.numbers("connect1"), (Numbers{1, 3, 2, 5}));
}

TEST(Exodus, NamesThatMooseCanReferTo) {
  EXPECT_EQ(exodus_name("left lung"), "left_lung");
  EXPECT_EQ(exodus_name("12"), "n12");
  EXPECT_EQ(exodus_name("12a|3"), "12a|3");
  EXPECT_EQ(exodus_name(std::string(67, 'a') + "\xc3\xa4"), std::string(67, 'a'));
  EXPECT_EQ(exodus_name(std::string(300, 'a')).size(), 68u);
  TetMesh mesh = mesh_with_surfaces();
  mesh.material_names = {{1, std::string(90, 'a') + "1"}, {-7, std::string(90, 'a') + "2"}};
  const Opened file(text_of(write_exodus, mesh));
  EXPECT_EQ(file.length("len_name"), 71u);
  EXPECT_EQ(file.texts("eb_names", 71), (Texts{std::string(68, 'a'), std::string(68, 'a') + "_2"}));
}

TEST(Exodus, WithoutSurfacesThereAreNoSets) {
  const Opened file(text_of(write_exodus, one_tet()));
  EXPECT_FALSE(file.has("ss_names"));
  EXPECT_FALSE(file.has("name_nod_var"));
}

}  // namespace
}  // namespace tetwright::exodus_test

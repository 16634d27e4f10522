// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/febio.h"

#include <gtest/gtest.h>

#include "tests/common/io/round_trip.h"

namespace tetwright::febio_test {
namespace {

TEST(Febio, DomainsSurfacesAndNodeSetsByName) {
  TetMesh mesh = mesh_with_surfaces();
  mesh.material_names[1] = "a<b";
  const std::string text = text_of(write_febio, mesh);
  for (const char* part :
       {"<febio_spec version=\"4.0\">", "<node id=\"2\">0.3333333333333333,1e-07,-0.6666666666666666</node>",
        "<Elements type=\"tet4\" name=\"skin\">\n<elem id=\"2\">1,3,2,5</elem>\n</Elements>",
        "<Elements type=\"tet4\" name=\"a&lt;b\">\n<elem id=\"1\">1,2,3,4</elem>\n</Elements>",
        "<Surface name=\"skin|a&lt;b\">\n<tri3 id=\"1\">1,2,3</tri3>\n</Surface>\n<NodeSet "
        "name=\"skin|a&lt;b\">1,2,3</NodeSet>",
        "<Surface name=\"outlet\">\n<tri3 id=\"1\">", "<SolidDomain name=\"skin\" mat=\"skin\"/>"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(Febio, NoQuotationMarkIsInANameAndNoNodeSetIsBesideOurs) {
  TetMesh mesh = mesh_with_surfaces();
  mesh.material_names[1] = "5\" tube";
  const std::string text = text_of(write_febio, mesh);
  EXPECT_NE(text.find("<SolidDomain name=\"5' tube\" mat=\"5' tube\"/>"), std::string::npos) << text;
  EXPECT_EQ(text.find("&quot;"), std::string::npos);
  EXPECT_NE(text.find("<Nodes>\n"), std::string::npos);
}

TEST(Febio, TenNodes) {
  const TetMesh mesh = mesh_with_surfaces();
  const MidsideNodes midside = straight_midside_nodes(mesh);
  const std::string text = text_of(write_febio, {mesh, &midside});
  // The edges 01 02 03 04 12 13 14 23 24 of the points have the nodes 6 to 14.
  EXPECT_NE(text.find("<elem id=\"1\">1,2,3,4,6,10,7,8,11,13</elem>"), std::string::npos) << text;
  EXPECT_NE(text.find("type=\"tet10\""), std::string::npos);
  EXPECT_NE(text.find("<tri6 id=\"1\">1,2,3,6,10,7</tri6>"), std::string::npos) << text;
}

}  // namespace
}  // namespace tetwright::febio_test

// SPDX-License-Identifier: Apache-2.0

// Tests what the program says of labels and contacts that differ from the voxels as read.
#include <gtest/gtest.h>

#include <functional>
#include <nlohmann/json.hpp>

#include "tests/mesher/label_adjacency.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"
#include "tetwright/mesh_quality.h"

namespace tetwright::label_changes_test {
namespace {

class LabelChanges : public testing::Test {
 protected:
  std::string volume(const std::array<int, 3>& size,
                     const std::function<MaterialTag(int, int, int)>& label) const {
    LabelVolume made;
    made.size = size;
    for (int z = 0; z < size[2]; ++z)
      for (int y = 0; y < size[1]; ++y)
        for (int x = 0; x < size[0]; ++x) made.labels.push_back(label(x, y, z));
    write_label_volume(made, folder_ / "labels.nrrd");
    return folder_ / "labels.nrrd";
  }
  Answer prepare(const std::string& words, int tets = 1500) const {
    return run("prepare " + words + " --target-tets " + std::to_string(tets) + " -o " +
               (folder_ / "out.vtu") + " --stats " + (folder_ / "s.json"));
  }
  nlohmann::json stats() const { return nlohmann::json::parse(contents(folder_ / "s.json")); }
  bool has(const std::string& code) const {
    const nlohmann::json all = stats();
    for (const nlohmann::json& d : all.at("diagnostics"))
      if (d.at("code") == code) return true;
    return false;
  }

  /// Expects the parts and contacts of the voxels in the simplified mesh.
  void expect_same(const std::array<int, 3>& size,
                   const std::function<MaterialTag(int, int, int)>& label) const {
    const Answer a = prepare(volume(size, label), 4000);
    EXPECT_EQ(a.status, 0) << a.err;
    Contacts touching;
    const Adjacency expected = of_voxels(size, label, touching);
    TetMesh mesh = read_tet_mesh(folder_ / "out.vtu").mesh;
    mesh.interfaces = find_interfaces(mesh);
    Adjacency found = of_mesh(mesh);
    // Where four labels meet in an edge, two must touch that share no voxel face.
    std::erase_if(found.contacts, [&](const auto& pair) {
      return touching.contains(pair) && !expected.contacts.contains(pair);
    });
    EXPECT_TRUE(found == expected) << text_of(found) << "\n" << text_of(expected);
  }

  TemporaryFolder folder_;
};

bool in_box(int x, int y, int z, int low, int high) {
  return x >= low && x < high && y >= low && y < high && z >= low && z < high;
}

TEST_F(LabelChanges, MergedVoxelsOfMoreThanTwoPercentAreAShortfall) {
  // 216 voxels and an island of 6, in the other label.
  const std::string file = volume({20, 12, 12}, [](int x, int y, int z) {
    if (in_box(x, y, z, 2, 8) || (x == 14 && y >= 4 && y < 7 && z >= 4 && z < 6)) return 2;
    return x >= 1 && x < 19 && y >= 1 && y < 11 && z >= 1 && z < 11 ? 1 : 0;
  });
  const Answer a = prepare(file);
  EXPECT_EQ(a.status, 1);
  EXPECT_NE(a.err.find("merging islands changed labels: 'label_2' has 216 voxels instead of 222 (-2.7 %)"),
            std::string::npos)
      << a.err;
  EXPECT_TRUE(has("labels-changed"));
  EXPECT_EQ(prepare(file + " --accept-changes").status, 0);
  EXPECT_EQ(prepare(file + " --min-voxels 6").status, 0);
  EXPECT_FALSE(has("labels-changed"));
}

TEST_F(LabelChanges, PartsThatMergingJoinsAreAShortfall) {
  // A wall of six voxels between two halves of a bar, all of it a small island.
  const std::string file = volume({21, 8, 8}, [](int x, int y, int z) {
    if (y < 3 || y >= 5 || z < 3 || z >= 6 || x < 2 || x >= 19) return 0;
    return x == 10 ? 2 : 1;
  });
  const Answer a = prepare(file + " --labels 1-2");
  EXPECT_EQ(a.status, 1);
  EXPECT_NE(a.err.find("two parts of 'label_1' became one at "), std::string::npos) << a.err;
  EXPECT_EQ(prepare(file + " --min-voxels 0").status, 0);
}

TEST_F(LabelChanges, DiagonalLayersAreNoIslands) {
  // A layer of one voxel on a diagonal, connected by edges alone, between two halves of a box.
  const auto layered = [](int x, int y, int z) -> MaterialTag {
    if (!in_box(x, y, z, 1, 15)) return 0;
    return x + y + z == 23 ? 3 : x + y + z < 23 ? 1 : 2;
  };
  const std::string file = volume({16, 16, 16}, layered);
  const Answer a = prepare(file);
  EXPECT_FALSE(has("islands-merged")) << a.err;
  EXPECT_FALSE(has("contacts-changed")) << a.err;
  // The halves do not touch.
  const ReadTetMesh out = read_tet_mesh(folder_ / "out.vtu");
  for (const InterfaceTriangle& t : find_interfaces(out.mesh)) EXPECT_FALSE(t.material == 1 && t.other == 2);
}

TEST_F(LabelChanges, LabelsOneVoxelApartStayApart) {
  const std::string file = volume({21, 12, 12}, [](int x, int y, int z) {
    const auto in = [&](double centre) { return Vec3(x - centre, y - 5.5, z - 5.5).norm() < 4.6; };
    return in(5) ? 20 : in(15) ? 22 : 0;
  });
  EXPECT_EQ(prepare(file).status, 0);
  for (const InterfaceTriangle& t : find_interfaces(read_tet_mesh(folder_ / "out.vtu").mesh))
    EXPECT_FALSE(t.other.has_value());
}

TEST_F(LabelChanges, ThinLettersSideBySideKeepTheirPartsAndContacts) {
  expect_same({19, 13, 7}, letters_a_and_b(3));
}

TEST_F(LabelChanges, CellsKeepTheirPartsAndContacts) { expect_same({20, 20, 20}, cells_in_a_ball(12)); }

}  // namespace
}  // namespace tetwright::label_changes_test

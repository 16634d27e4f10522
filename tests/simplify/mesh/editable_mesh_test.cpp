// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/editable_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "tests/simplify/meshes.h"
#include "tetwright/error.h"

namespace tetwright::editable_mesh_test {
namespace {

/// The tets as sets of positions with their materials, in an order independent of numbering.
std::vector<std::pair<std::array<std::array<double, 3>, 4>, MaterialTag>> contents(const TetMesh& mesh) {
  std::vector<std::pair<std::array<std::array<double, 3>, 4>, MaterialTag>> out;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    std::array<std::array<double, 3>, 4> corners;
    for (int k = 0; k < 4; ++k) {
      const Vec3& p = mesh.points[mesh.tets[t][k]];
      corners[k] = {p.x(), p.y(), p.z()};
    }
    std::sort(corners.begin(), corners.end());
    out.push_back({corners, mesh.materials[t]});
  }
  std::sort(out.begin(), out.end());
  return out;
}

TEST(EditableMesh, HandsBackWhatItTookBitForBit) {
  TetMesh mesh =
      grid_mesh({4, 3, 5}, [](int x, int, int) { return std::optional<MaterialTag>(x < 2 ? -7 : 90); });
  jitter(mesh, 3);
  mesh.material_names[90] = "bone";
  const auto before = contents(mesh);
  EditableMesh editable(TetMesh(mesh), "mesh");
  EXPECT_TRUE(editable.links_consistent());
  EXPECT_EQ(editable.live_tets(), mesh.tets.size());
  editable.compact(100, 0);
  EXPECT_TRUE(editable.links_consistent());
  EXPECT_EQ(editable.tet_slots(), mesh.tets.size() + 100);
  const TetMesh after = std::move(editable).to_mesh();
  EXPECT_EQ(contents(after), before);
  EXPECT_EQ(after.material_names.at(90), "bone");
}

TEST(EditableMesh, VolumeIsThatOfTheGrid) {
  EditableMesh editable(grid_mesh(4), "mesh");
  const double s = editable.space().scale();
  EXPECT_NEAR(editable.total_volume() / (s * s * s), 64, 1e-11);
}

TEST(EditableMesh, CompactionDropsUnusedPoints) {
  TetMesh mesh = grid_mesh(2);
  mesh.points.emplace_back(100, 100, 100);
  EditableMesh editable(TetMesh(mesh), "mesh");
  EXPECT_EQ(std::move(editable).to_mesh().points.size(), 27u);
}

std::string refusal(TetMesh mesh) {
  try {
    EditableMesh editable(std::move(mesh), "some.mesh");
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(EditableMesh, RefusesWhatHasNoNeighbours) {
  TetMesh twice = grid_mesh(2);
  twice.tets[7][0] = twice.tets[7][1];
  EXPECT_NE(refusal(twice).find("some.mesh: tet 7 "), std::string::npos) << refusal(twice);

  TetMesh over_shared = grid_mesh(1);
  over_shared.points.emplace_back(0.3, 0.4, 0.2);
  Tet extra = over_shared.tets[0];
  extra[0] = static_cast<Index>(over_shared.points.size() - 1);
  over_shared.tets.push_back(extra);
  over_shared.materials.push_back(1);
  EXPECT_NE(refusal(over_shared), "");

  // Two tets on the same side of a face.
  TetMesh folded;
  folded.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.1, 2}};
  folded.tets = {{0, 1, 2, 3}, {0, 1, 2, 4}};
  folded.materials = {1, 1};
  EXPECT_NE(refusal(folded).find("one side"), std::string::npos) << refusal(folded);
}

TEST(EditableMesh, TakesNegativeAndFlatTetsAsTheyAre) {
  TetMesh mesh = grid_mesh(3);
  for (Vec3& p : mesh.points)
    if (p == Vec3(1, 1, 1)) p = Vec3(2.5, 1, 1);
  const auto before = contents(mesh);
  EditableMesh editable(TetMesh(mesh), "mesh");
  EXPECT_TRUE(editable.links_consistent());
  EXPECT_EQ(contents(std::move(editable).to_mesh()), before);
}

// Two cubes that touch along an edge only: no walk across faces connects them.
TEST(EditableMesh, SplitsWhatTouchesWithoutAFaceAndPutsItTogetherAgain) {
  const TetMesh touching = grid_mesh({6, 6, 1}, [](int x, int y, int) {
    return (x < 3) == (y < 3) ? std::optional<MaterialTag>(1) : std::optional<MaterialTag>();
  });
  const auto before = contents(touching);
  EditableMesh editable(TetMesh(touching), "mesh");
  EXPECT_TRUE(editable.links_consistent());
  EXPECT_EQ(editable.point_slots(), touching.points.size() + 2);
  editable.compact(10, 10);
  std::size_t copies = 0;
  std::set<Index> split;
  for (Index p = 0; p < editable.point_slots(); ++p) {
    if (editable.original(p) == p) continue;
    ++copies;
    split.insert({p, editable.original(p)});
    EXPECT_EQ(editable.position(p), editable.position(editable.original(p)));
  }
  EXPECT_EQ(copies, 2u);
  EXPECT_EQ(split.size(), 4u);
  EXPECT_EQ(editable.touching_points(), 2u);
  // Touching points are frozen with all their tets, and nothing else is.
  std::size_t frozen = 0;
  for (Index t = 0; t < editable.tet_slots(); ++t) {
    if (editable.dead(t)) continue;
    const Tet& points = editable.points(t);
    const bool at_split = std::any_of(points.begin(), points.end(), [&](Index p) { return split.count(p); });
    EXPECT_TRUE(editable.frozen_tet(t) || !at_split);
    frozen += editable.frozen_tet(t);
  }
  EXPECT_GE(frozen, 6u);
  EXPECT_LT(frozen, 30u);
  const TetMesh after = std::move(editable).to_mesh();
  EXPECT_EQ(after.points.size(), touching.points.size());
  EXPECT_EQ(contents(after), before);
}

TEST(EditableMesh, WorksAtTheOriginWhereThatIsExact) {
  const TetMesh mesh = grid_mesh(3);
  TetMesh moved = mesh;
  for (Vec3& p : moved.points) p += Vec3(0x1p40, -0x1p45, 3);
  EditableMesh here(TetMesh(mesh), "mesh"), there(TetMesh(moved), "mesh");
  for (Index p = 0; p < here.point_slots(); ++p) EXPECT_EQ(here.position(p), there.position(p));
  // A position without exact input coordinates is rounded to one that has them.
  const Vec3 off = there.position(5) + Vec3::Constant(1e-9);
  const Vec3 snapped = there.snap(off);
  EXPECT_EQ(there.space().to_working(there.space().to_input(snapped)), snapped);
  EXPECT_NE(snapped, off);
  EXPECT_EQ(contents(std::move(there).to_mesh()), contents(moved));

  TetMesh uneven = grid_mesh(2);  // 1e-30 has bits that a shift by 1 would lose
  for (Vec3& p : uneven.points) p.x() = p.x() == 0 ? -1 : p.x() == 1 ? 1e-30 : 1;
  const auto before = contents(uneven);
  EXPECT_EQ(contents(EditableMesh(TetMesh(uneven), "mesh").to_mesh()), before);
}

}  // namespace
}  // namespace tetwright::editable_mesh_test

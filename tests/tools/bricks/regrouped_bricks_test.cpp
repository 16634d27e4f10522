// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/regrouped_bricks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "tests/tools/bricks/cut_meshes.h"
#include "tetwright/error.h"
#include "tools/bricks/joined_parts.h"

namespace tetwright::regrouped_bricks_test {
namespace {

using namespace cut_meshes;

/// The voxels of whole_mesh(): those of its grid.
LabelInput voxels() {
  LabelInput labels;
  labels.size = {cells, cells, cells};
  labels.origin = Vec3::Constant(0.5);
  return labels;
}

/// Parts cut off where no round has cuts.
std::vector<BrickPart> parts_of(const TetMesh& whole) {
  return cut(whole, 8, [](std::size_t, const Vec3& p) {
    return static_cast<std::size_t>(p.x() > 2) + 2 * static_cast<std::size_t>(p.y() > 4.5) +
           4 * static_cast<std::size_t>(p.z() > 2.5);
  });
}

RegroupedBricks regroup(const std::vector<BrickPart>& parts, const ShiftedBricks& bricks) {
  static const Progress progress;
  return {bricks, parts.size(),
          [&](std::size_t p) { return std::shared_ptr<const BrickPart>(std::shared_ptr<void>(), &parts[p]); },
          progress};
}

/// So many final tets that nothing is coarsened.
constexpr double keep_all = 1e6;

std::vector<BrickPart> make_all(const RegroupedBricks& regrouped, double density) {
  std::vector<BrickPart> made;
  for (std::size_t b = 0; b < regrouped.count(); ++b)
    made.push_back(coarsen_pieces(regrouped.pieces(b, nullptr), {b}, density, nullptr, {}, nullptr));
  return made;
}

TEST(ShiftedBricks, AreHalfAnEdgeAgainstTheFirst) {
  const ShiftedBricks bricks(voxels(), 1, 4, 2);  // cuts at 2 and 6, where the volume ends
  EXPECT_EQ(bricks.count(), 8u);
  EXPECT_EQ(bricks.brick_at({1.9, 1.9, 1.9}), 0u);
  EXPECT_EQ(bricks.brick_at({2.1, 1.9, 1.9}), 1u);
  EXPECT_EQ(bricks.brick_at({1.9, 2.1, 1.9}), 2u);
  EXPECT_EQ(bricks.brick_at({1.9, 1.9, 2.1}), 4u);
  // Points outside belong to the outermost bricks.
  EXPECT_EQ(bricks.brick_at({-9, -9, -9}), 0u);
  EXPECT_EQ(bricks.brick_at({99, 99, 99}), 7u);
  const std::vector<CellBox> boxes = bricks.boxes();
  ASSERT_EQ(boxes.size(), 8u);
  EXPECT_EQ(boxes[5], (CellBox{{1, 0, 1}, {2, 1, 2}}));
}

TEST(RegroupedBricks, GiveTheWholeWithAllItsFaces) {
  const TetMesh whole = whole_mesh();
  const std::vector<BrickPart> parts = parts_of(whole);
  for (const int edge : {2, 3, 4, 100}) {
    const RegroupedBricks regrouped = regroup(parts, ShiftedBricks(voxels(), 1, edge, 2));
    std::size_t shared = 0, tets = 0;
    const JoinedParts before = join_parts(parts);
    for (const std::uint8_t s : before.shared) shared += s;
    EXPECT_EQ(regrouped.shared_points(), shared);
    for (const std::size_t t : regrouped.tets()) tets += t;
    EXPECT_EQ(tets, whole.tets.size());
    const std::vector<BrickPart> made = make_all(regrouped, keep_all);
    const JoinedParts after = join_parts(made);
    EXPECT_EQ(after.mesh.points.size(), whole.points.size()) << edge;
    EXPECT_TRUE(plain_tets(after.mesh) == plain_tets(whole)) << edge;
    EXPECT_TRUE(plain_faces(after.mesh) == plain_faces(whole)) << edge;
    // Again, in bricks with other cuts.
    const std::vector<BrickPart> third =
        make_all(regroup(made, ShiftedBricks(voxels(), 1, edge, 3)), keep_all);
    EXPECT_TRUE(plain_faces(join_parts(third).mesh) == plain_faces(whole)) << edge;
  }
}

TEST(RegroupedBricks, CoarsenWithoutMovingWhatTheyShare) {
  TetMesh whole = grid_mesh({12, 12, 12}, [](int x, int, int z) -> Tag { return x + z < 12 ? 1 : 2; });
  whole.interfaces = find_interfaces(whole);
  const std::vector<BrickPart> parts =
      cut(whole, 2, [](std::size_t, const Vec3& p) { return static_cast<std::size_t>(p.x() > 6); });
  LabelInput labels = voxels();
  labels.size = {12, 12, 12};
  const RegroupedBricks regrouped = regroup(parts, ShiftedBricks(labels, 1, 8, 2));
  const std::vector<BrickPart> made = make_all(regrouped, 0.1);
  const JoinedParts joined = join_parts(made);
  EXPECT_LT(joined.mesh.tets.size(), whole.tets.size() * 2 / 3);
  // Bricks that did not agree about their cuts would leave holes.
  for (const MeshFinding& finding : check_mesh(joined.mesh)) ADD_FAILURE() << mesh_finding_line(finding);
  const MeshStatistics before = mesh_statistics(whole), after = mesh_statistics(joined.mesh);
  EXPECT_NEAR(after.volume, before.volume, 1e-9 * before.volume);
  EXPECT_EQ(after.interfaces.size(), before.interfaces.size());
  EXPECT_TRUE(meeting_parts(joined, made.size()).empty());
  // The former cut at 6 is inside of bricks, where most of its points are gone.
  const auto at_former_cut = [](const TetMesh& mesh) {
    return std::count_if(mesh.points.begin(), mesh.points.end(), [](const Vec3& p) { return p.x() == 6; });
  };
  EXPECT_LT(at_former_cut(joined.mesh), at_former_cut(whole) * 2 / 3);
}

TEST(RegroupedBricks, KeptSurfacesDoNotMove) {
  const TetMesh whole = whole_mesh();
  const std::vector<BrickPart> parts = parts_of(whole);
  const RegroupedBricks regrouped = regroup(parts, ShiftedBricks(voxels(), 1, 4, 2));
  const auto outside = [](const BrickPart& part) {
    std::set<PlainFace> faces;
    for (const PlainFace& face :
         plain_faces({.points = part.mesh.points, .interfaces = find_interfaces(part.mesh)}))
      if (!std::get<2>(face)) faces.insert(face);
    return faces;
  };
  const BrickTask task{7, 0, true};
  const BrickPieces pieces = regrouped.pieces(task.brick, nullptr);
  const BrickPart all = coarsen_pieces(pieces, task, keep_all, nullptr, {}, nullptr),
                  kept = coarsen_pieces(pieces, task, 0.01, nullptr, {}, nullptr);
  EXPECT_TRUE(kept.kept_surface);
  EXPECT_LT(kept.mesh.tets.size(), all.mesh.tets.size());
  // The border of the volume has patches on two sides only; the others count as a boundary that may meet.
  for (const PlainFace& face : outside(all)) EXPECT_EQ(outside(kept).count(face), 1u);
}

// The lattice of a left-handed volume begins at the other end of the last axis.
TEST(ShiftedBricks, CutsOfAllRoundsAreApartForBothHands) {
  constexpr int size = 80, side = 32;
  for (const bool left_handed : {false, true}) {
    LabelInput labels;
    labels.size = {size, size, size};
    if (left_handed) labels.directions(2, 2) = -1;
    std::vector<double> cuts;
    for (int k = side; k < size; k += side) cuts.push_back(left_handed ? size - k : k);
    for (int round = 2; round <= 3; ++round) {
      const ShiftedBricks bricks(labels, 1, side, round);
      const auto at = [&](double from_start) {
        return bricks.brick_at(Vec3(0, 0, (left_handed ? -1 : 1) * (from_start - 0.5)));
      };
      for (double z = 0.25; z < size - 1; z += 0.5)
        if (at(z) != at(z + 0.5))
          for (const double other : cuts) EXPECT_GE(std::fabs(z + 0.25 - other), side / 4.0) << round << z;
      EXPECT_NE(at(0.25), at(size - 0.25));
    }
  }
}

}  // namespace
}  // namespace tetwright::regrouped_bricks_test

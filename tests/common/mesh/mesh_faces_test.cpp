// SPDX-License-Identifier: Apache-2.0
#include "common/mesh/mesh_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "common/parallel/parallel.h"
#include "common/random.h"
#include "tests/common/small_meshes.h"

namespace tetwright::mesh_faces_test {
namespace {

TEST(MeshFaces, TwoTets) {
  const TetMesh mesh = two_tets();
  const std::vector<MeshFace> faces = mesh_faces(mesh.tets, mesh.points.size());
  ASSERT_EQ(faces.size(), 7u);
  EXPECT_EQ(faces[0].ids, (Triangle{0, 1, 2}));
  EXPECT_EQ(faces[0].first, 0u);
  EXPECT_EQ(faces[0].second, 1u);
  EXPECT_EQ(faces[0].count, 2u);
  EXPECT_EQ(faces[1].second, no_index);
}

TEST(MeshFaces, AgreesWithAMapOnRandomTetsAndAnyThreads) {
  Random random(5);
  std::vector<Tet> tets(20000);
  for (Tet& tet : tets)
    for (Index& v : tet) v = random.below(9000) % (random.below(4) ? 9000 : 12);
  std::map<Triangle, std::vector<Index>> expected;
  for (Index t = 0; t < tets.size(); ++t)
    for (const auto& f : tet_faces) {
      Triangle ids{tets[t][f[0]], tets[t][f[1]], tets[t][f[2]]};
      std::sort(ids.begin(), ids.end());
      expected[ids].push_back(t);
    }
  for (unsigned threads : {1u, 3u}) {
    const ThreadLimit limit(threads);
    const std::vector<MeshFace> faces = mesh_faces(tets, 9000);
    ASSERT_EQ(faces.size(), expected.size());
    auto at = expected.begin();
    for (const MeshFace& f : faces) {
      const auto& [ids, owners] = *at++;
      ASSERT_EQ(f.ids, ids);
      ASSERT_EQ(f.count, owners.size());
      ASSERT_EQ(f.first, owners[0]);
      ASSERT_EQ(f.second, owners.size() > 1 ? owners[1] : no_index);
    }
  }
}

TEST(MeshFaces, CandidatesLeaveTheFacesOfThreeFlaggedPoints) {
  Random random(7);
  std::vector<Tet> tets(5000);
  for (Tet& tet : tets)
    for (Index& v : tet) v = random.below(300);
  std::vector<std::uint8_t> flagged(300);
  for (std::uint8_t& f : flagged) f = static_cast<std::uint8_t>(random.below(2));
  std::vector<MeshFace> expected = mesh_faces(tets, 300);
  std::erase_if(expected, [&](const MeshFace& f) {
    return !(flagged[f.ids[0]] && flagged[f.ids[1]] && flagged[f.ids[2]]);
  });
  const std::vector<MeshFace> faces = mesh_faces(tets, 300, &flagged);
  ASSERT_EQ(faces.size(), expected.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    EXPECT_EQ(faces[i].ids, expected[i].ids);
    EXPECT_EQ(faces[i].first, expected[i].first);
    EXPECT_EQ(faces[i].second, expected[i].second);
    EXPECT_EQ(faces[i].count, expected[i].count);
  }
}

TEST(MeshFaces, Empty) { EXPECT_TRUE(mesh_faces({}, 0).empty()); }

}  // namespace
}  // namespace tetwright::mesh_faces_test

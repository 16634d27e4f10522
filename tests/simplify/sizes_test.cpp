// SPDX-License-Identifier: Apache-2.0

// Target edge lengths and their bounds.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "common/mesh/mesh_check.h"
#include "common/mesh/mesh_statistics.h"
#include "common/mesh/topology.h"
#include "common/parallel/parallel.h"
#include "simplify/simplify.h"
#include "tests/simplify/meshes.h"

namespace tetwright::sizes_test {
namespace {

class Source final : public SizeSource {
 public:
  explicit Source(std::function<double(const Vec3&)> f) : f_(std::move(f)) {}
  std::optional<WantedLength> at(const Vec3& place) const override { return WantedLength{f_(place), 0}; }
  void for_each_value(const std::function<void(const Vec3&, double)>&) const override {}

 private:
  std::function<double(const Vec3&)> f_;
};

std::vector<std::pair<double, Vec3>> edges(const TetMesh& mesh) {
  std::set<std::pair<Index, Index>> ends;
  for (const Tet& t : mesh.tets)
    for (const auto& e : tet_edges) ends.insert(std::minmax({t[e[0]], t[e[1]]}));
  std::vector<std::pair<double, Vec3>> out;
  for (const auto& [a, b] : ends)
    out.emplace_back((mesh.points[a] - mesh.points[b]).norm(), (mesh.points[a] + mesh.points[b]) / 2);
  return out;
}

double share_within(const TetMesh& mesh, const SizeField& target_length) {
  const auto all = edges(mesh);
  double within = 0;
  for (const auto& [length, middle] : all) {
    const double ratio = length / target_length.at(middle);
    within += ratio <= 1.5 && ratio >= 1 / 1.5;
  }
  return within / static_cast<double>(all.size());
}

TetMesh block() {
  TetMesh mesh =
      grid_mesh({24, 12, 12}, [](int x, int, int) { return std::optional<MaterialTag>(x < 12 ? 1 : 2); });
  jitter(mesh, 3);
  return mesh;
}

/// Target lengths for the block that grow by x / 10.
SizeField growing_from(double smallest) {
  return {Source([=](const Vec3& p) { return smallest + 0.1 * p.x(); }), {0, 0, 0}, {24, 12, 12}, {}};
}

SimplifyOptions wanting(const SizeField& target_length) {
  SimplifyOptions options;
  options.target_tets = 0;
  options.sizes = &target_length;
  return options;
}

void expect_kept(const TetMesh& before, const TetMesh& after) {
  for (const MeshFinding& f : check_mesh(after)) ADD_FAILURE() << mesh_finding_line(f);
  for (const std::string& d : topology_differences(topology(before), topology(after))) ADD_FAILURE() << d;
  EXPECT_GE(mesh_statistics(after, 0.1).min_solid_angle, 0.1);
}

TEST(Sizes, EdgesHaveTheWantedLengths) {
  const TetMesh mesh = block();
  // From the current length to three times that, across an interface.
  const SizeField target_length = growing_from(1.2);
  const TetMesh after = simplify(mesh, wanting(target_length));
  expect_kept(mesh, after);
  EXPECT_LT(share_within(mesh, target_length), 0.7);
  EXPECT_GE(share_within(after, target_length), 0.95);
}

TEST(Sizes, LongEdgesAreSplit) {
  const TetMesh mesh = block();
  const SizeField target_length = growing_from(0.5);
  const TetMesh after = simplify(mesh, wanting(target_length));
  expect_kept(mesh, after);
  EXPECT_GE(share_within(after, target_length), 0.9);
  double near = 0, count = 0;
  for (const auto& [length, middle] : edges(after))
    if (middle.x() < 2) {
      near += length / target_length.at(middle);
      ++count;
    }
  EXPECT_NEAR(near / count, 1, 0.15);
}

TEST(Sizes, NoEdgeBecomesLongerThanTheBound) {
  const TetMesh mesh = block();
  SimplifyOptions options;
  options.target_tets = 1000;
  double longest = 0;
  for (const auto& [length, middle] : edges(simplify(mesh, options))) longest = std::max(longest, length);
  ASSERT_GT(longest, 3.5) << "else the bound would change nothing";
  options.max_edge = 3;
  const TetMesh after = simplify(mesh, options);
  expect_kept(mesh, after);
  for (const auto& [length, middle] : edges(after)) ASSERT_LE(length, 3);
  EXPECT_GT(after.tets.size(), 1000u);
}

TEST(Sizes, TheSameForAnyNumberOfThreads) {
  const TetMesh mesh = block();
  const SizeField target_length = growing_from(0.8);
  const auto with_threads = [&](unsigned threads) {
    const ThreadLimit limit(threads);
    return simplify(mesh, wanting(target_length));
  };
  const TetMesh one = with_threads(1), four = with_threads(4);
  EXPECT_EQ(one.tets, four.tets);
  EXPECT_EQ(one.points, four.points);
}

TEST(Sizes, ContradictingBoundsAreRefused) {
  SimplifyOptions options;
  options.min_edge = 2;
  options.max_edge = 1;
  EXPECT_ANY_THROW(simplify(grid_mesh(2), options));
}

}  // namespace
}  // namespace tetwright::sizes_test

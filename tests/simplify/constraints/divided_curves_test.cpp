// SPDX-License-Identifier: Apache-2.0

// The link condition where bodies with creases are among labels: creases and curves between labels keep their
// topology, but not the pieces into which they cut each other.
#include <map>
#include <numeric>
#include <set>

#include "simplify/constraints/link_condition.h"
#include "simplify/operations/collapse.h"
#include "tests/simplify/contraction.h"
#include "tests/simplify/patches.h"
#include "tests/simplify/workbench.h"

namespace tetwright::divided_curves_test {
namespace {

using Tag = std::optional<MaterialTag>;

constexpr PatchId first_body_patch_of_cube = 7;
constexpr MaterialTag body = 9;

/// A cube of 4^3 cells in a block of 6^3 with islands of a second label. The sides of the cube are patches.
TetMesh cube_among_labels(std::uint64_t seed) {
  Random random(seed);
  const auto in_cube = [](int i) { return i >= 1 && i <= 4; };
  TetMesh mesh = grid_mesh({6, 6, 6}, [&](int x, int y, int z) {
    if (in_cube(x) && in_cube(y) && in_cube(z)) return Tag(body);
    return Tag(random.below(8) == 0 ? 2 : 1);
  });
  set_patches(mesh, [](const InterfaceTriangle& t, const Vec3& c) {
    const bool on_body = t.material == body || t.other == body;
    return static_cast<std::uint16_t>(on_body ? first_body_patch_of_cube - 1 + side_of(c - Vec3(1, 1, 1), 4)
                                              : 0);
  });
  return mesh;
}

/// The creases after a is contracted onto b: number of connected parts and of independent loops, and the
/// numbers of edges at their branches.
struct CreaseGraph {
  int parts = 0, loops = 0;
  std::multiset<int> branches;
  bool operator==(const CreaseGraph&) const = default;
};

CreaseGraph creases(const EditableMesh& mesh, const SurfaceGrid& grid, Index a, Index b) {
  std::map<std::pair<Index, Index>, std::set<PatchId>> patches;
  for (const InterfaceFace& f : mesh.interface_faces()) {
    const PatchId patch = f.across == outside_id ? f.patch : grid.patch(mesh, f.ids);
    if (patch < first_body_patch_of_cube) continue;
    Triangle ids = f.ids;
    const bool has_b = std::find(ids.begin(), ids.end(), b) != ids.end();
    const auto at_a = std::find(ids.begin(), ids.end(), a);
    if (at_a != ids.end() && has_b) continue;
    if (at_a != ids.end()) *at_a = b;
    for (std::size_t k = 0; k < 3; ++k) patches[std::minmax(ids[k], ids[(k + 1) % 3])].insert(patch);
  }
  std::map<Index, std::vector<Index>> neighbours;
  int edges = 0;
  for (const auto& [edge, meeting] : patches) {
    if (meeting.size() < 2) continue;
    ++edges;
    neighbours[edge.first].push_back(edge.second);
    neighbours[edge.second].push_back(edge.first);
  }
  CreaseGraph graph;
  std::set<Index> seen;
  for (const auto& [p, others] : neighbours) {
    if (others.size() != 2) graph.branches.insert(static_cast<int>(others.size()));
    if (!seen.insert(p).second) continue;
    ++graph.parts;
    std::vector<Index> queue{p};
    while (!queue.empty()) {
      const Index from = queue.back();
      queue.pop_back();
      for (const Index q : neighbours[from])
        if (seen.insert(q).second) queue.push_back(q);
    }
  }
  graph.loops = edges - static_cast<int>(neighbours.size()) + graph.parts;
  return graph;
}

/// Knows the patches' numbers; the operations here ask for no more.
class Cube : public ReferenceSurface {
 public:
  double signed_distance(const Vec3&, MaterialTag) const override { return 0; }
  std::optional<Vec3> project(const Vec3& p, MaterialOrOutside, MaterialOrOutside, double) const override {
    return p;
  }
  bool has_patches() const override { return true; }
  std::uint16_t first_body_patch() const override { return first_body_patch_of_cube; }
};

TEST(DividedCurves, CreasesAndLabelsKeepTheirOwnTopology) {
  int crossings = 0, merges = 0, only_divided = 0, pinches = 0, carried_out = 0, merged = 0;
  const Cube cube;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Workbench w(cube_among_labels(seed));
    const SurfaceProjection projection(w.mesh, &cube);
    w.rules.surface.projection = &projection;
    w.rules.acceptance.worse_probability = 1;
    const CreaseGraph creases_before = creases(w.mesh, w.grid, no_index, no_index);
    EXPECT_EQ(creases_before.loops, 5);
    EXPECT_EQ(creases_before.branches.size(), 8U);
    const Topology before = topology(contracted(w.mesh, no_index, no_index));
    // Collapse points first, since curves come close to each other in coarse meshes.
    for (int sweep = 0; sweep < 3; ++sweep)
      for (const Index p : w.live_points()) {
        if (w.mesh.incident_tet(p) == no_index) continue;
        const Star& star = w.star(p);
        const bool crossing = star.dimension() == 0 && w.ws->is_crossing(w.rules);
        const bool on_curve = star.dimension() == 1;
        const Outcome o = collapse(*w.ws, w.rules);
        if (o == Outcome::done) {
          carried_out += crossing;
          const auto target = std::find(star.points.begin(), star.points.end(), w.ws->proposal.target);
          const auto onto = static_cast<std::size_t>(target - star.points.begin());
          if (on_curve && star.edge_dimension(onto) == 2) {
            ++merged;
            double longest = 0;
            for (std::size_t q = 0; q < star.points.size(); ++q)
              if (star.edge_dimension(q) == 1)
                longest = std::max(longest, (star.positions[q] - star.centre_position).norm());
            EXPECT_LE((star.positions[onto] - star.centre_position).norm(), 0.5 * longest);
          } else {
            only_divided += !w.ws->link_condition.holds(w.mesh, w.grid, star, onto);
          }
        }
        w.carry_out(o);
      }
    EXPECT_EQ(topology(contracted(w.mesh, no_index, no_index)), before) << seed;
    EXPECT_EQ(creases(w.mesh, w.grid, no_index, no_index), creases_before) << seed;
    for (const Index a : w.live_points()) {
      const Star& star = w.star(a);
      const int dimension = star.dimension();
      const bool crossing = w.ws->is_crossing(w.rules);
      if (dimension == 0 && !crossing) continue;
      for (std::size_t b = 0; b < star.points.size(); ++b) {
        const bool merge = star.edge_dimension(b) != dimension && !crossing &&
                           w.ws->is_on_label_curve(w.rules) && w.ws->may_merge_with(w.rules, b);
        if (crossing ? !w.ws->kinds[b].on_crease() : star.edge_dimension(b) != dimension && !merge) continue;
        if (!w.ws->link_condition.holds(w.mesh, w.grid, star, b, first_body_patch_of_cube)) continue;
        const Index onto = star.points[b];
        const bool changes = topology(contracted(w.mesh, a, onto)) != before;
        if (crossing && !w.ws->may_cross_at(w.rules, b)) {
          pinches += changes;
          continue;
        }
        crossings += crossing;
        merges += merge;
        EXPECT_FALSE(changes) << seed << ": " << a << " onto " << onto;
        EXPECT_EQ(creases(w.mesh, w.grid, a, onto), creases_before) << seed << ": " << a << " onto " << onto;
      }
    }
  }
  EXPECT_GT(crossings, 0);
  EXPECT_GT(merges, 0);
  EXPECT_GT(merged, 0);
  EXPECT_GT(only_divided, 0);
  EXPECT_GT(carried_out, 0);
  EXPECT_GT(pinches, 0);  // may_cross_at() is needed
}

}  // namespace
}  // namespace tetwright::divided_curves_test

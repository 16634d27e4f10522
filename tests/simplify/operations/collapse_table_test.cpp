// SPDX-License-Identifier: Apache-2.0
#include "simplify/operations/collapse_table.h"

#include <fstream>
#include <iterator>
#include <string>

#include "simplify/operations/collapse.h"
#include "tests/simplify/workbench.h"

namespace tetwright::collapse_table_test {
namespace {

const std::array<std::string, vertex_kind_count> kind_names{"interior", "interface", "junction curve",
                                                            "corner", "frozen"};
using Counts = std::array<std::array<int, vertex_kind_count>, vertex_kind_count>;

// The last index is for frozen vertices; the others are 3 minus the dimension.
TEST(CollapseTable, AsksForTheRemovedVertexsDimension) {
  for (std::size_t from = 0; from < vertex_kind_count; ++from)
    for (std::size_t onto = 0; onto < vertex_kind_count; ++onto) {
      const bool vanishes = from < 3, reachable = onto == 4 || onto >= from;
      EXPECT_EQ(collapse_table[from][onto], vanishes && reachable ? 3 - from : never)
          << kind_names[from] << " onto " << kind_names[onto];
      if (collapse_table[from][onto] != never) {
        EXPECT_EQ(collapse_table[from][onto], collapsible_edge(static_cast<VertexKind>(from)));
      }
    }
  EXPECT_EQ(collapsible_edge(VertexKind::corner), never);
  EXPECT_EQ(collapsible_edge(VertexKind::frozen), never);
}

/// A block of three materials on a fourth, with one in five vertices frozen. It has edges between all kinds.
Workbench block_of_all_kinds() {
  TetMesh mesh = grid_mesh({4, 4, 4}, [](int x, int y, int z) {
    return std::optional<MaterialTag>(z < 3 ? 1 : x < 2 ? 2 : y < 2 ? 3 : 4);
  });
  jitter(mesh, 1);
  std::vector<std::uint8_t> frozen(mesh.points.size(), 0);
  for (std::size_t p = 3; p < frozen.size(); p += 5) frozen[p] = 1;
  return Workbench(mesh, [&](EditableMesh& editable) { editable.freeze(frozen); });
}

TEST(CollapseTable, DecidesForEveryPairOfKinds) {
  Workbench w = block_of_all_kinds();
  std::vector<std::size_t> kinds(w.mesh.point_slots());
  for (const Index p : w.live_points()) kinds[p] = static_cast<std::size_t>(vertex_kind(w.star(p)));
  Counts adjacent{}, allowed{};
  for (const Index a : w.live_points()) {
    const std::size_t count = w.star(a).points.size();
    for (std::size_t b = 0; b < count; ++b) {
      const Star& star = w.star(a);
      const std::size_t from = kinds[a], onto = kinds[star.points[b]];
      const int entry = collapse_table[from][onto];
      const bool asked = entry != never && star.edge_dimension(b) == entry;
      ++adjacent[from][onto];
      allowed[from][onto] += asked;
      EXPECT_EQ(collapse_onto(*w.ws, w.rules, b) != Outcome::material_rule, asked)
          << kind_names[from] << " onto " << kind_names[onto] << ", edge of dimension "
          << star.edge_dimension(b);
    }
  }
  for (std::size_t from = 0; from < vertex_kind_count; ++from)
    for (std::size_t onto = 0; onto < vertex_kind_count; ++onto) {
      EXPECT_GT(adjacent[from][onto], 0) << kind_names[from] << " onto " << kind_names[onto];
      EXPECT_EQ(allowed[from][onto] > 0, collapse_table[from][onto] != never)
          << kind_names[from] << " onto " << kind_names[onto];
    }
}

TEST(CollapseTable, IsTheOneInTheReadme) {
  std::ifstream file(TETWRIGHT_SIMPLIFY_README);
  const std::string readme((std::istreambuf_iterator<char>(file)), {});
  for (std::size_t from = 0; from < vertex_kind_count; ++from) {
    std::string row = "| " + kind_names[from];
    if (from < 4) row += " (" + std::to_string(3 - from) + ")";
    for (const int entry : collapse_table[from])
      row += entry == never ? " | never" : " | " + std::to_string(entry);
    EXPECT_NE(readme.find("\n" + row + " |\n"), std::string::npos) << row;
  }
}

}  // namespace
}  // namespace tetwright::collapse_table_test

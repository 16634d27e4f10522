// SPDX-License-Identifier: Apache-2.0

// Tests that the parts of labels and their contacts in the mesh are those of the voxels, for shapes in which
// labels nearly touch, touch in edges and corners, or are a voxel thick.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "tests/mesher/checked_labels.h"
#include "tests/mesher/label_adjacency.h"
#include "tests/mesher/label_volumes.h"

namespace tetwright::label_contacts_test {
namespace {

/// Which labels may touch in the mesh without voxels that share a face.
enum class Diagonals {
  none,
  /// Labels whose voxels touch in an edge or a corner: where four labels meet in an edge, two of them must.
  any
};

/// Expects the parts and contacts of the voxels.
void expect_same(const std::array<int, 3>& size, const VoxelLabels& label,
                 const std::vector<double>& cells = {1}, Diagonals diagonals = Diagonals::none) {
  const LabelInput labels = make_labels(size, label);
  Contacts touching;
  const Adjacency expected = of_voxels(size, label, touching);
  for (const double cell : cells) {
    Adjacency found = of_mesh(checked_mesh(labels, cell).mesh);
    if (diagonals == Diagonals::any)
      std::erase_if(found.contacts, [&](const auto& pair) {
        return touching.contains(pair) && !expected.contacts.contains(pair);
      });
    EXPECT_TRUE(found == expected) << "cells of " << cell << "\nmesh:   " << text_of(found)
                                   << "\nvoxels: " << text_of(expected);
  }
}

TEST(LabelContacts, LettersOfAVoxelSideBySide) {
  // The strokes are one voxel thick, and the letters one voxel apart.
  for (const int depth : {1, 3}) expect_same({19, 13, 4 + depth}, letters_a_and_b(depth));
}

TEST(LabelContacts, StripesOfOneAndTwoVoxels) {
  for (const int width : {1, 2})
    for (const int labels : {2, 3})
      expect_same({14, 8, 6}, [=](int x, int y, int z) -> MaterialTag {
        if (x < 1 || x >= 13 || y < 1 || y >= 7 || z < 1 || z >= 5) return 0;
        return 1 + (x - 1) / width % labels;
      });
}

TEST(LabelContacts, TwelveCellsInABall) {
  expect_same({20, 20, 20}, cells_in_a_ball(12), {1}, Diagonals::any);
}

/// Two blocks of 4 x 4 x 4 voxels, the second one shifted by four along the axes of the set bits of `axes`,
/// and mirrored along those of `mirrored`.
VoxelLabels two_blocks(int axes, int mirrored, MaterialTag first, MaterialTag second) {
  return [=](int x, int y, int z) -> MaterialTag {
    const std::array<int, 3> at{x, y, z};
    const auto is_in = [&](bool shifted) {
      for (int a = 0; a < 3; ++a) {
        const int i =
            mirrored >> a & 1 ? 11 - at[static_cast<std::size_t>(a)] : at[static_cast<std::size_t>(a)];
        const int begin = shifted && (axes >> a & 1) ? 6 : 2;
        if (i < begin || i >= begin + 4) return false;
      }
      return true;
    };
    return is_in(false) ? first : is_in(true) ? second : 0;
  };
}

TEST(LabelContacts, BlocksOfDifferentLabelsAtAnEdgeOrACornerStayApart) {
  for (const int axes : {3, 6, 7})
    for (const int mirrored : {0, 1}) {
      SCOPED_TRACE(std::to_string(axes) + " " + std::to_string(mirrored));
      const VoxelLabels blocks = two_blocks(axes, mirrored, 1, 2);
      expect_same({12, 12, 12}, blocks);
      // In another label instead of the outside.
      expect_same({12, 12, 12}, [&](int x, int y, int z) { return blocks(x, y, z) + 1; });
    }
}

TEST(LabelContacts, BlocksOfDifferentLabelsThatTouchInAFace) {
  for (const int axes : {1, 2, 4}) expect_same({12, 12, 12}, two_blocks(axes, 0, 1, 2));
}

/// Parts of the labels of a mesh.
std::map<MaterialTag, std::size_t> parts_of(const std::array<int, 3>& size, const VoxelLabels& label,
                                            double cell = 1) {
  return of_mesh(checked_mesh(make_labels(size, label), cell).mesh).parts;
}

TEST(LabelContacts, AtAnEdgeTheRarerLabelPasses) {
  using Parts = std::map<MaterialTag, std::size_t>;
  // As many voxels of the prisms as of the outside are near the edge, so the smaller label passes.
  for (const bool mirrored : {false, true})
    EXPECT_EQ(parts_of({12, 12, 4},
                       [=](int x, int y, int) {
                         const int i = mirrored ? 11 - x : x;
                         return i >= 2 && i < 10 && y >= 2 && y < 10 && (i < 6) == (y < 6);
                       }),
              (Parts{{1, 2}}));
  // A row of voxels that touch in edges.
  EXPECT_EQ(parts_of({14, 14, 7}, [](int x, int y, int z) { return x == y && x > 1 && x < 12 && z == 3; }),
            (Parts{{1, 1}}));
}

TEST(LabelContacts, AtACornerTheRarerLabelPasses) {
  using Parts = std::map<MaterialTag, std::size_t>;
  EXPECT_EQ(parts_of({12, 12, 12}, two_blocks(7, 0, 1, 1)), (Parts{{1, 1}}));
  EXPECT_EQ(parts_of({12, 12, 12}, two_blocks(7, 1, 1, 1)), (Parts{{1, 1}}));
  // Rows of voxels that touch in corners, which cross in one.
  const auto crossing = [](int length_of_second) {
    return [=](int x, int y, int z) -> MaterialTag {
      if (x == y && y == z && x > 1 && x < 8) return 1;
      return x == y && x + z == 9 && std::abs(2 * x - 9) < 2 * length_of_second ? 2 : 0;
    };
  };
  for (const double cell : {1.0, 0.5}) EXPECT_EQ(parts_of({10, 10, 10}, crossing(0), cell), (Parts{{1, 1}}));
  // As many voxels of both are near.
  EXPECT_EQ(parts_of({10, 10, 10}, crossing(3)), (Parts{{1, 1}, {2, 2}}));
  EXPECT_EQ(parts_of({10, 10, 10}, crossing(1)), (Parts{{1, 2}, {2, 1}}));
}

TEST(LabelContacts, NucleiAVoxelApart) {
  expect_same({33, 14, 14}, [](int x, int y, int z) -> MaterialTag {
    for (int k = 0; k < 3; ++k)
      if (length(x - 6 - 10 * k, y - 6.5, z - 6.5) < 4.6) return k % 2 + 1;
    return 0;
  });
  // In their cell.
  expect_same({33, 16, 16}, [](int x, int y, int z) -> MaterialTag {
    if (length((x - 16.0) / 2, y - 7.5, z - 7.5) > 7) return 0;
    for (int k = 0; k < 2; ++k)
      if (length(x - 11 - 10 * k, y - 7.5, z - 7.5) < 4.6) return k + 2;
    return 1;
  });
}

TEST(LabelContacts, SpheresThatTouch) {
  // In one voxel face, in four, and in a disc.
  for (const double radius : {5.0, 5.2, 5.6})
    expect_same({26, 14, 14}, [=](int x, int y, int z) -> MaterialTag {
      const double middle = radius == 5.2 ? 6.5 : 7;
      for (int k = 0; k < 2; ++k)
        if (length(x - 6.5 - 11 * k, y - middle, z - middle) <= radius + 0.5) return k + 1;
      return 0;
    });
}

}  // namespace
}  // namespace tetwright::label_contacts_test

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/mesh/disjoint_sets.h"
#include "common/random.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

using Contacts = std::set<std::pair<MaterialTag, MaterialTag>>;

/// Parts of each label and pairs of labels that touch; the outside is label 0 and has no parts.
struct Adjacency {
  std::map<MaterialTag, std::size_t> parts;
  Contacts contacts;
  bool operator==(const Adjacency&) const = default;
};

inline std::string text_of(const Adjacency& a) {
  std::string out;
  for (const auto& [tag, parts] : a.parts)
    out += std::to_string(tag) + ": " + std::to_string(parts) + " parts; ";
  for (const auto& [first, second] : a.contacts)
    out += std::to_string(first) + "-" + std::to_string(second) + " ";
  return out;
}

/// Finds the parts and contacts of the tets, which are connected by faces.
inline Adjacency of_mesh(const TetMesh& mesh) {
  Adjacency found;
  const Topology all = topology(mesh);
  for (const auto& [tag, solid] : all.materials)
    found.parts[tag] = static_cast<std::size_t>(solid.components);
  // A mesh of one material.
  if (all.materials.empty()) found.parts[mesh.materials[0]] = static_cast<std::size_t>(all.domain.components);
  for (const InterfaceTriangle& t : mesh.interfaces)
    if (t.other || t.patch == 0) found.contacts.insert(std::minmax(t.material, t.other.value_or(0)));
  return found;
}

/// Finds the parts of voxels that touch at least in a corner, and the pairs of labels whose voxels share a
/// face.
/// \param touching receives the pairs whose voxels touch at least in a corner
inline Adjacency of_voxels(const std::array<int, 3>& size,
                           const std::function<MaterialTag(int, int, int)>& label, Contacts& touching) {
  std::vector<MaterialTag> labels;
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x) labels.push_back(label(x, y, z));
  const auto number = [&](int x, int y, int z) { return (z * size[1] + y) * size[0] + x; };
  DisjointSets sets(labels.size());
  Adjacency found;
  const auto is_within = [&](int i, int axis) { return i >= 0 && i < size[static_cast<std::size_t>(axis)]; };
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x)
        for (int k = 0; k < 27; ++k) {
          const int i = k % 3 - 1, j = k / 3 % 3 - 1, l = k / 9 - 1;
          if (!is_within(x + i, 0) || !is_within(y + j, 1) || !is_within(z + l, 2)) continue;
          const auto a = static_cast<Index>(number(x, y, z)),
                     b = static_cast<Index>(number(x + i, y + j, z + l));
          if (labels[a] == labels[b]) sets.unite(a, b);
          if (labels[a] == labels[b]) continue;
          touching.insert(std::minmax(labels[a], labels[b]));
          if (i * i + j * j + l * l == 1) found.contacts.insert(std::minmax(labels[a], labels[b]));
        }
  for (Index voxel = 0; voxel < labels.size(); ++voxel)
    if (labels[voxel] != 0 && sets.is_root(voxel)) ++found.parts[labels[voxel]];
  return found;
}

/// Strokes of a letter, 7 x 9.
using Letter = std::array<const char*, 9>;
inline constexpr Letter letter_a{"...#...", "..#.#..", "..#.#..", ".#...#.", ".#...#.",
                                 ".#####.", "#.....#", "#.....#", "#.....#"},
    letter_b{"#####..", "#....#.", "#.....#", "#....#.", "#####..",
             "#....#.", "#.....#", "#....#.", "#####.."};

/// Two letters whose strokes are one voxel thick, one voxel apart: labels 1 and 2 in 19 x 13 x (4 + depth)
/// voxels.
inline std::function<MaterialTag(int, int, int)> letters_a_and_b(int depth) {
  return [=](int x, int y, int z) -> MaterialTag {
    if (z < 2 || z >= 2 + depth || y < 2 || y >= 11) return 0;
    const auto is_in = [&](const Letter& letter, int left) {
      return x >= left && x < left + 7 && letter[static_cast<std::size_t>(10 - y)][x - left] == '#';
    };
    return is_in(letter_a, 2) ? 1 : is_in(letter_b, 10) ? 2 : 0;
  };
}

/// Voronoi cells of scattered seeds in a ball, labels 1 to `cells` in 20 x 20 x 20 voxels.
inline std::function<MaterialTag(int, int, int)> cells_in_a_ball(std::size_t cells) {
  constexpr double radius = 8, min_distance = 4;
  Random random(5);
  const auto coordinate = [&] { return radius * (2 * random.uniform() - 1); };
  std::vector<Vec3> seeds;
  while (seeds.size() < cells) {
    const double x = coordinate(), y = coordinate(), z = coordinate();
    const Vec3 p(x, y, z);
    if (p.norm() < radius && std::none_of(seeds.begin(), seeds.end(),
                                          [&](const Vec3& q) { return (p - q).norm() < min_distance; }))
      seeds.push_back(p);
  }
  return [=](int x, int y, int z) -> MaterialTag {
    const Vec3 p = Vec3(x, y, z) - Vec3::Constant(9.5);
    if (p.norm() > radius) return 0;
    const auto nearest = std::min_element(seeds.begin(), seeds.end(), [&](const Vec3& a, const Vec3& b) {
      return (p - a).norm() < (p - b).norm();
    });
    return static_cast<MaterialTag>(nearest - seeds.begin() + 1);
  };
}

}  // namespace tetwright

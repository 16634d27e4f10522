// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/constraints/surface_grid.h"
#include "simplify/mesh/local_numbers.h"
#include "simplify/mesh/star.h"

namespace tetwright {

/// Whether the collapse of a star's centre a onto its link point b keeps the topology of every material,
/// interface and junction curve: Lk(a) ∩ Lk(b) = Lk(ab) in the complexes K, I and J of README.md, Topology
/// (Dey, Edelsbrunner, Guha & Nekhayev 1999; Thomas & Natarajan 2011). Nothing is changed.
///
/// Reads the star of b beside that of a. Keeps its memory from test to test; one for each worker.
class LinkCondition {
 public:
  /// `b`: local number in `star`. The grid has the patches of faces between materials.
  bool holds(const EditableMesh& mesh, const SurfaceGrid& grid, const Star& star, std::size_t b);

 private:
  /// The interface triangles at an edge.
  struct EdgeSheets {
    std::uint16_t count = 0;
    PatchId patch = 0;    ///< of the first one
    bool crease = false;  ///< another one has another patch
    void add(PatchId p) {
      crease |= count != 0 && p != patch;
      if (count++ == 0) patch = p;
    }
    /// Whether the edge has dimension 1.
    bool on_junction() const { return crease || (count != 0 && count != 2); }
  };
  /// What the link of b says about a link point of a.
  struct Common {
    bool seen = false;               ///< an edge joins b and it
    bool with_ab = false;            ///< a, b and it are in one tet
    EdgeSheets interfaces;           ///< at the edge from b to it
    std::uint16_t boundary = 0;      ///< of those, the ones with outside on one side
    bool interface_with_ab = false;  ///< (a, b, it) is an interface triangle
    bool boundary_with_ab = false;   ///< (a, b, it) is a boundary triangle
  };
  /// A tet at b. `points`: the local numbers of its other three vertices in the star of a; no_index for a
  /// itself and for vertices outside the star.
  struct LinkTriangle {
    std::array<std::uint32_t, 3> points;
    int in_a = 0;  ///< how many are
    bool has_a = false;
  };

  void begin(const EditableMesh& mesh, const SurfaceGrid& grid, const Star& star, std::size_t b);
  /// Fills what depends on a's interface triangles alone.
  void read_interfaces_of_a();
  /// Walks the star of b; false as soon as a tet, triangle or edge is in both links but not in that of ab, or
  /// the star is too large to test.
  bool walk_star_of_b();
  LinkTriangle link_triangle(Index tet, int slot);
  /// Walks on across the faces of a tet at b and counts the interface triangles among them.
  void read_faces_at_b(Index tet, int slot);
  void count_interface(Index point, bool outside, PatchId patch);
  /// Whether an edge or the whole of b's link triangle is in a's link too, but not in the link of ab.
  bool shares_simplex(const LinkTriangle& triangle) const;
  /// Lk(a) ∩ Lk(b) = Lk(ab) for the vertices, those of K, I and J, and omega.
  bool vertices_agree() const;
  /// The same for the interface triangles of a opposite it: edges of I, and of K with omega.
  bool interface_edges_agree() const;
  bool is_interface_of_b(Index x, Index y) const;

  const EditableMesh* mesh_ = nullptr;
  const SurfaceGrid* grid_ = nullptr;
  const Star* star_ = nullptr;
  std::size_t b_ = 0;
  Index a_id_ = no_index, b_id_ = no_index;
  bool a_on_boundary_ = false, b_on_boundary_ = false, a_on_junction_ = false;
  std::vector<Common> common_;                ///< by local number
  std::vector<std::uint16_t> boundary_at_a_;  ///< boundary triangles at the edge from a, by local number
  LocalNumbers local_of_a_;                   ///< local numbers by id
  LocalNumbers tet_numbers_;
  std::vector<Index> walk_;  ///< the tets at b
  /// Interface triangles at edges from b to points that are not in a's link: they only tell whether b is on a
  /// junction curve.
  LocalNumbers other_points_;
  std::vector<EdgeSheets> other_interfaces_;
};

}  // namespace tetwright

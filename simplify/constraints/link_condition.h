// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/constraints/surface_grid.h"
#include "simplify/mesh/local_numbers.h"
#include "simplify/mesh/star.h"

namespace tetwright {

/// Tests whether collapsing a star's centre a onto its link point b keeps the topology of every material,
/// interface and junction curve: Lk(a) ∩ Lk(b) = Lk(ab) in the complexes K, I and J of README.md, Topology
/// (Dey, Edelsbrunner, Guha & Nekhayev 1999; Thomas & Natarajan 2011). The border of a sheet is a junction
/// curve: its edges have one interface triangle. Changes nothing.
///
/// Reads the stars of a and b. Reuses its memory; one object for each worker.
class LinkCondition {
 public:
  /// \param grid has the patches of interface faces.
  /// \param star the star of a.
  /// \param b local number in `star`.
  /// \param first_body_patch see ReferenceSurface. If it is not 0, J is divided: creases of bodies keep their
  ///   topology, and so do the curves between labels, but not the pieces into which one cuts the other, since
  ///   voxels do not say exactly where they cross
  bool holds(const EditableMesh& mesh, const SurfaceGrid& grid, const Star& star, std::size_t b,
             PatchId first_body_patch = 0);

 private:
  /// The interface triangles at an edge.
  struct EdgeSheets {
    std::uint16_t count = 0;
    PatchId patch = 0;    ///< patch of the first triangle
    bool crease = false;  ///< the triangles have different patches
    CurveKinds kinds;     ///< only where bodies are among labels
    void add(PatchId p, PatchId first_body_patch) {
      crease |= count != 0 && p != patch;
      if (count++ == 0) patch = p;
      if (first_body_patch != 0) kinds.add(p, first_body_patch);
    }
    /// Whether the edge has dimension 1.
    bool on_junction() const { return crease || (count != 0 && count != 2); }
  };
  /// Incidences of b with a link point p of a.
  struct Common {
    bool seen = false;               ///< edge bp exists
    bool with_ab = false;            ///< a, b and p share a tet
    EdgeSheets interfaces;           ///< interface triangles at edge bp
    std::uint16_t boundary = 0;      ///< boundary triangles among them
    bool interface_with_ab = false;  ///< (a, b, p) is an interface triangle
    bool boundary_with_ab = false;   ///< (a, b, p) is a boundary triangle
  };
  /// The triangle opposite b in a tet of its star. `points`: local numbers of its vertices in the star of a;
  /// no_index for a itself and for vertices outside that star.
  struct LinkTriangle {
    std::array<std::uint32_t, 3> points;
    int in_a = 0;  ///< vertices in the link of a
    bool has_a = false;
  };

  void begin(const EditableMesh& mesh, const SurfaceGrid& grid, const Star& star, std::size_t b);
  /// Collects data that depends only on a's interface triangles.
  void read_interfaces_of_a();
  /// Walks the star of b. False if a triangle or edge is in both links but not in that of ab, or if the star
  /// is too large to test.
  bool walk_star_of_b();
  LinkTriangle link_triangle(Index tet, int slot);
  /// Queues the neighbours of a tet at b and counts its interface triangles at b.
  void read_faces_at_b(Index tet, int slot);
  void count_interface(Index point, bool outside, PatchId patch);
  /// Whether b's link triangle, or an edge of it, is also in a's link but not in the link of ab.
  bool shares_simplex(const LinkTriangle& triangle) const;
  /// Lk(a) ∩ Lk(b) = Lk(ab) for the vertices of K and I, and for ω.
  bool surfaces_agree() const;
  /// Lk(a) ∩ Lk(b) = Lk(ab) for the vertices of J.
  bool all_curves_agree();
  /// As above for J, or for one kind of its curves.
  /// \param at_a, at_b whether the edge from a to a link point, or from b to another point, is in J
  template <class AtA, class AtB>
  bool curves_agree(const AtA& at_a, const AtB& at_b) const;
  /// Lk(a) ∩ Lk(b) = Lk(ab) for the edges of I, and for those of K with ω: the edges opposite a in its
  /// interface triangles.
  bool interface_edges_agree() const;
  bool is_interface_of_b(Index x, Index y) const;

  const EditableMesh* mesh_ = nullptr;
  const SurfaceGrid* grid_ = nullptr;
  const Star* star_ = nullptr;
  std::size_t b_ = 0;
  Index a_id_ = no_index, b_id_ = no_index;
  PatchId first_body_patch_ = 0;
  bool a_on_boundary_ = false, b_on_boundary_ = false;
  std::vector<Common> common_;                ///< by local number
  std::vector<std::uint16_t> boundary_at_a_;  ///< boundary triangles at the edge from a, by local number
  LocalNumbers local_of_a_;                   ///< local numbers by id
  LocalNumbers tet_numbers_;
  std::vector<Index> walk_;        ///< the tets at b
  std::vector<CurveKinds> kinds_;  ///< of the edges at a
  /// Interface triangles at edges from b to points outside a's link. They only determine whether b is on a
  /// junction curve.
  LocalNumbers other_points_;
  std::vector<EdgeSheets> other_interfaces_;
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/local_numbers.h"
#include "simplify/mesh/outcome.h"

namespace tetwright {

/// What the volume of a region gains, working coordinates cubed.
struct VolumeChange {
  RegionId region;
  double volume;
};

/// The closed star of a point: a local copy, so that the operations work on memory that is near, and the
/// interface triangles at the point.
struct Star {
  /// Triangle of the star's surface: the tet is (centre, link[0], link[1], link[2]), positive.
  struct StarTet {
    Index tet;
    std::array<std::uint16_t, 3> link;  ///< local numbers
    std::uint8_t slot;                  ///< of the centre in the tet
    RegionId region;
    float quality;

    /// Whether `point`, a local number, is one of the three.
    bool links(std::size_t point) const { return link[0] == point || link[1] == point || link[2] == point; }
  };
  /// An interface triangle (centre, first, second): a face between different regions, outside being one.
  struct InterfaceTriangle {
    std::uint16_t first, second;  ///< local numbers
    RegionId inside, across;
    PatchId patch;
    /// Whether it is a part of one and the same smooth surface as another one at their common edge.
    bool continues(const InterfaceTriangle& other) const {
      return patch == other.patch && ((inside == other.inside && across == other.across) ||
                                      (inside == other.across && across == other.inside));
    }
  };
  /// Points a star may have: more is not worth the time.
  static constexpr std::size_t max_points = 500;

  Index centre;
  Vec3 centre_position;
  std::vector<StarTet> tets;
  std::vector<Index> points;                           ///< the link's, by local number
  std::vector<Vec3> positions;                         ///< of the link's points
  std::vector<InterfaceTriangle> interface_triangles;  ///< each once
  std::vector<std::uint16_t>
      interface_count;   ///< for each link point: interface triangles at the edge from the centre to it
  float worst = 1;       ///< smallest quality of the tets
  bool frozen = false;   ///< the centre may not move or go (EditableMesh::frozen)
  bool creases = false;  ///< two interface triangles that do not continue each other meet in an edge

  /// Copies the closed star of `centre`: done, stale, or too_large. Faces between materials get patch 0: who
  /// knows better says so and calls find_creases().
  Outcome gather(const EditableMesh& mesh, Index centre);

  // For the star that a point would have if it were inserted.

  /// An empty star.
  void begin(Index centre, const Vec3& position);
  /// The local number of a point of the link, which is added unless it is there.
  std::uint16_t add_point(Index p, const Vec3& position);
  /// An interface triangle (centre, first, second), both added before.
  void add_interface_triangle(Index first, Index second, RegionId inside, RegionId across, PatchId patch);
  /// To be called when all have been added, or their patches changed.
  void find_creases();

  /// Dimension of the edge from the centre to a link point: 3 within a material, 2 on an interface, 1 on a
  /// junction curve or between two patches.
  int edge_dimension(std::size_t link_point) const {
    const unsigned n = interface_count[link_point];
    return n == 0 ? 3 : n == 2 && !(creases && crease_[link_point]) ? 2 : 1;
  }
  /// Dimension of the centre (README.md, Topology): 3, 2, 1, or 0 for all else.
  int dimension() const;

  /// For each tet (y - x) x (z - x), where x, y, z are its points of the link: six times its volume is
  /// (x - c) . normals[k] wherever the centre c stands. compute_normals() fills it, in the order of the tets.
  std::vector<Vec3> normals;
  void compute_normals();

  /// Gradient of the volume of each region with respect to the centre's position: moving the centre by d
  /// changes the volume of gradients[i].region by gradients[i].change . d exactly. Outside is left out;
  /// without interface triangles it is empty.
  struct VolumeGradient {
    RegionId region;
    Vec3 change;
  };
  std::vector<VolumeGradient> gradients;
  void compute_gradients();
  /// What each region's volume gains when the centre moves by `step` (also: is collapsed by it). Gradients
  /// must be computed.
  const std::vector<VolumeChange>& volume_changes(const Vec3& step);
  /// Error(op) of Cutler, Dorsey & McMillan 2004, section 3, for moving the centre by `step`:
  /// gamma * sum over the materials of the cube root of the change of volume. The paper takes the net change
  /// (`losses_cancel`); else what one interface triangle gains and another loses is added up: otherwise a
  /// saddle or an edge may be cut off for nothing.
  double surface_error(const Vec3& step, double gamma, bool losses_cancel);

 private:
  LocalNumbers point_numbers_, tet_numbers_;
  std::vector<std::uint8_t> crease_;           // by link point, where there are creases
  mutable std::vector<std::uint8_t> visited_;  // scratch of dimension()
  std::vector<Vec3> areas_;                    // a third of each interface triangle's area vector
  std::vector<VolumeChange> changes_;
  std::vector<double> swept_;  // scratch of surface_error()
};

}  // namespace tetwright

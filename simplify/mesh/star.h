// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "simplify/mesh/editable_mesh.h"
#include "simplify/mesh/local_numbers.h"
#include "tetwright/simplify.h"

namespace tetwright {

/// Change of a region's volume, working coordinates cubed.
struct VolumeChange {
  RegionId region;
  double volume;
};

/// The kinds of curves that an edge belongs to, if bodies are among labels: creases and contacts of bodies,
/// and curves in which labels meet each other or a body. Found from the interface triangles at the edge.
class CurveKinds {
 public:
  /// \param first_body_patch see ReferenceSurface
  void add(PatchId patch, PatchId first_body_patch) {
    Side& side = patch < first_body_patch ? labels_ : bodies_;
    on_border_ |= patch != 0 && patch < first_body_patch;
    side.several |= side.count != 0 && side.patch != patch;
    side.patch = patch;
    ++side.count;
  }
  bool on_crease() const { return bodies_.several || (bodies_.count != 0 && bodies_.count != 2); }
  bool between_labels() const {
    const unsigned count = labels_.count + bodies_.count;
    return labels_.several || (count != 0 && count != 2);
  }
  /// Whether it follows voxels only: neither bodies nor the border of the volume say where it is exactly.
  bool follows_voxels() const { return between_labels() && !on_crease() && !on_border_; }

 private:
  struct Side {
    PatchId patch = 0;
    std::uint16_t count = 0;
    bool several = false;
  };
  Side labels_, bodies_;
  bool on_border_ = false;
};

/// The closed star of a point with its interface triangles: a local copy, for memory locality.
struct Star {
  /// A tet of the star with its link triangle: (centre, link[0], link[1], link[2]) is positive.
  struct StarTet {
    Index tet;
    std::array<std::uint16_t, 3> link;  ///< local numbers
    std::uint8_t slot;                  ///< slot of the centre in the tet
    RegionId region;
    float quality;

    /// Whether the link triangle has `point`, a local number.
    bool links(std::size_t point) const { return link[0] == point || link[1] == point || link[2] == point; }
  };
  /// An interface triangle (centre, first, second): a face between different regions, outside included, or of
  /// a sheet.
  struct InterfaceTriangle {
    std::uint16_t first, second;  ///< local numbers
    RegionId inside, across;
    PatchId patch;
    bool is_sheet() const { return inside == across; }
    /// Whether this triangle and another one at a common edge belong to the same smooth surface.
    bool continues(const InterfaceTriangle& other) const {
      return patch == other.patch && ((inside == other.inside && across == other.across) ||
                                      (inside == other.across && across == other.inside));
    }
  };
  Index centre;
  Vec3 centre_position;
  std::vector<StarTet> tets;
  std::vector<Index> points;                           ///< link points, by local number
  std::vector<Vec3> positions;                         ///< positions of the link points
  std::vector<InterfaceTriangle> interface_triangles;  ///< each once
  /// By link point: interface triangles at the edge from the centre to it.
  std::vector<std::uint16_t> interface_count;
  float worst = 1;       ///< min quality of the tets
  bool frozen = false;   ///< the centre must stay (EditableMesh::frozen)
  bool creases = false;  ///< two interface triangles meet at an edge and do not continue each other
  bool sheets = false;   ///< an interface triangle belongs to a sheet

  /// Copies the closed star of `centre`. Interface faces get patch 0; a caller that knows their patches must
  /// set them and call find_creases().
  ///
  /// \return done, stale or too_large.
  Outcome gather(const EditableMesh& mesh, Index centre);

  // Building the star that an inserted point would have.

  /// Makes the star empty.
  void begin(Index centre, const Vec3& position);
  /// Local number of a link point; adds it if it is new.
  std::uint16_t add_point(Index p, const Vec3& position);
  /// Adds the interface triangle (centre, first, second).
  /// \pre Both points have been added.
  void add_interface_triangle(Index first, Index second, RegionId inside, RegionId across, PatchId patch);
  /// Call this after adding all interface triangles or changing their patches.
  void find_creases();

  /// Dimension of the edge from the centre to a link point: 3 within a material, 2 on an interface, 1 on a
  /// junction curve, between two patches or on the border of a sheet.
  int edge_dimension(std::size_t link_point) const {
    const unsigned n = interface_count[link_point];
    return n == 0 ? 3 : n == 2 && !(creases && crease_[link_point]) ? 2 : 1;
  }
  /// Dimension of the centre (README.md, Topology), 0 to 3.
  int dimension() const;
  /// The kinds of curves that the edges from the centre belong to, by link point.
  void find_curves(PatchId first_body_patch, std::vector<CurveKinds>& kinds) const;
  /// Dimension of the centre if the patches of bodies are not told apart.
  /// \param kinds by find_curves()
  int dimension_among_labels(const std::vector<CurveKinds>& kinds) const;
  /// Dimension of the centre if only the faces of bodies count, 0 to 3.
  int dimension_on_bodies(PatchId first_body_patch, const std::vector<CurveKinds>& kinds) const;

  /// For each tet, in their order, (y - x) x (z - x), where x, y, z are its link points: six times its volume
  /// is (x - c) . normals[k] for any centre c. Filled by compute_normals().
  std::vector<Vec3> normals;
  void compute_normals();

  /// Gradient of each region's volume with respect to the centre's position: moving the centre by d changes
  /// the volume of gradients[i].region by exactly gradients[i].change . d. Contains no entry for outside;
  /// empty without interface triangles.
  struct VolumeGradient {
    RegionId region;
    Vec3 change;
  };
  std::vector<VolumeGradient> gradients;
  void compute_gradients();
  /// A normal of the surface at a centre of dimension 2, of any length: the gradient of the first region's
  /// volume, or the area vector of the sheet's triangles, since a sheet changes no volume.
  /// \pre compute_gradients() has been called.
  const Vec3& surface_normal() const { return sheets ? sheet_normal_ : gradients.front().change; }
  /// Change of each region's volume if the centre moves by `step` or is collapsed along it.
  /// \pre compute_gradients() has been called.
  const std::vector<VolumeChange>& volume_changes(const Vec3& step);
  /// Error(op) of Cutler, Dorsey & McMillan 2004, section 3, for moving the centre by `step`: gamma * sum
  /// over the materials of the cube root of the volume change.
  ///
  /// \param losses_cancel uses the net change, as in the paper. Otherwise the absolute gains and losses of
  ///   the interface triangles add up, so that cutting off a saddle or an edge has a cost. The volumes that
  ///   sheets sweep always add up.
  double surface_error(const Vec3& step, double gamma, bool losses_cancel);

 private:
  /// Dimension of the centre in the complex of the interface triangles that count.
  /// \param is_curve whether the edge to a link point has dimension 1 in it
  template <class Counts, class IsCurve>
  int dimension_of(const Counts& counts, const IsCurve& is_curve) const;
  /// Sum of the areas of the interface triangles, oriented consistently: the triangles of a sheet have no
  /// side.
  Vec3 oriented_area();
  /// Volume that the triangles of sheets sweep if the centre moves by `step`.
  double swept_by_sheets(const Vec3& step) const;

  LocalNumbers point_numbers_, tet_numbers_;
  std::vector<std::uint8_t> crease_;           // by link point, where there are creases
  mutable std::vector<std::uint8_t> visited_;  // scratch of dimension()
  std::vector<int> sides_;                     // scratch of oriented_area()
  std::vector<Vec3> areas_;                    // a third of each interface triangle's area vector
  Vec3 sheet_normal_ = Vec3::Zero();           // oriented_area(), if there are sheets
  std::vector<VolumeChange> changes_;
  std::vector<double> swept_;  // scratch of surface_error()
};

}  // namespace tetwright

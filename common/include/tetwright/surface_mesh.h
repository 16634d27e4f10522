// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A triangle surface as read from a file, which may be inconsistently oriented, open or have unused points.
struct TriangleMesh {
  std::vector<Vec3> points;  ///< input units
  std::vector<Triangle>
      triangles;  ///< indices into points; counter-clockwise seen from outside if the surface is closed
  /// Regions that the file distinguishes, and the index of each triangle's region. Both are empty if it
  /// distinguishes none. One entry may stand for no region.
  std::vector<SurfaceRegion> groups = {};
  std::vector<std::uint32_t> triangle_groups = {};
  /// Coordinate system that the file names: "left-posterior-superior" or "right-anterior-superior", or empty.
  /// Readers do not convert between them.
  std::string space = {};
};

/// Converts a surface to another coordinate system, if both are such as "left-posterior-superior":
/// coordinates along the axes that point the other way change their signs. Triangles keep their orientation.
/// \param space see LabelGrid::space
/// \return false if nothing changed: the systems are equal, or one of them is unknown
bool change_space(TriangleMesh& surface, const std::string& space);

struct NamedSurface {
  std::string name;
  TriangleMesh surface;
};

/// Material on one side of a face; std::nullopt: outside.
using MaterialOrOutside = std::optional<MaterialTag>;

/// Interfaces of the original mesh: a simplified mesh is measured against them and its points are projected
/// onto them.
///
/// `mesher/` implements it with its signed distance fields, on which `simplify/` has no other dependency. All
/// functions may be called concurrently.
class ReferenceSurface {
 public:
  virtual ~ReferenceSurface() = default;

  /// Signed distance of `point` from the surface of `material`, negative inside, input units. Beyond the band
  /// of the reference only the sign is exact, and the absolute value is at least the band.
  virtual double signed_distance(const Vec3& point, MaterialTag material) const = 0;

  /// Projects `point` onto the interface between two regions.
  /// \param max_distance input units
  /// \return a point of the interface at most twice as far away as the nearest one, or std::nullopt if there
  ///   is none within `max_distance`
  virtual std::optional<Vec3> project(const Vec3& point, MaterialOrOutside first, MaterialOrOutside second,
                                      double max_distance) const = 0;

  /// Whether the patches of the mesh's interfaces are known by number, with the creases and corners where
  /// they meet. If so, the queries below are exact. Otherwise they return std::nullopt, and borders of
  /// patches in the mesh are preserved like its junction curves.
  virtual bool has_patches() const { return false; }
  /// Whether onto_crease() and onto_corner() also know the curves in which three or more interfaces meet.
  virtual bool has_junctions() const { return false; }
  /// Diagonal of the bounding box, input units, of the smallest body that has creases: how far edges of the
  /// mesh may be from them is a share of it. std::nullopt: that of the mesh.
  virtual std::optional<double> creased_size() const { return {}; }
  /// Number of the first patch of bodies, if they are among labels: faces between labels have smaller ones.
  /// Otherwise 0. Curves between labels may cross creases of bodies anywhere.
  virtual std::uint16_t first_body_patch() const { return 0; }
  /// Whether a patch, of the interface between any two regions, lies in a plane. Its points then stay in it.
  virtual bool is_flat(std::uint16_t /*patch*/) const { return false; }
  /// True where creases that bound patches were given up: onto_crease() does not know them, and borders of
  /// patches in the mesh are preserved like its junction curves.
  virtual bool lacks_creases(const Vec3& /*point*/) const { return false; }
  /// Nearest point of a patch of the interface between two regions within `max_distance` (input units).
  virtual std::optional<Vec3> onto_patch(const Vec3& /*point*/, MaterialOrOutside /*first*/,
                                         MaterialOrOutside /*second*/, std::uint16_t /*patch*/,
                                         double /*max_distance*/) const {
    return {};
  }
  /// Nearest point of any crease within `max_distance` (input units).
  virtual std::optional<Vec3> onto_crease(const Vec3& /*point*/, double /*max_distance*/) const { return {}; }
  /// Nearest corner within `max_distance` (input units).
  virtual std::optional<Vec3> onto_corner(const Vec3& /*point*/, double /*max_distance*/) const { return {}; }
};

/// Rule that decides which edges of a surface are creases.
struct FeatureAngle {
  enum class Rule : std::uint8_t {
    automatic,  ///< 35 degrees, if the creases found look like those of a mechanical part
    off,        ///< no edges
    degrees     ///< edges at which the normal turns by more than `degrees`
  };
  Rule rule = Rule::automatic;
  double degrees = 0;  ///< above 0, below 180
};

struct PatchOptions {
  FeatureAngle angle;
  /// Patches below this area are merged with the neighbour across the border with the smallest sharp
  /// fraction; square of the surface's unit.
  double min_area = 0;
  bool list_chains = false;  ///< fill SurfacePatches::chains
};

/// Successive edges of a surface that turn by more than the feature angle, and what became of them.
struct CreaseChain {
  enum class Fate : std::uint8_t {
    kept,         ///< creases: borders of patches
    kept_groups,  ///< borders of groups, which are kept even if creases are given up
    noise,        ///< in or beside a part of the surface whose sharp edges are noise
    faded,        ///< within a patch: less than half of the border turns by more than the angle
    small,        ///< at a patch below PatchOptions::min_area, which was merged with its neighbour
    given_up      ///< would be kept elsewhere, but the mesh cannot have it there; or in a staircase
  };
  static constexpr std::size_t fates = 6;
  Fate fate = Fate::kept;
  double length = 0;                    ///< unit of the surface
  double turn = 0;                      ///< mean angle between the normals by length, radians
  Vec3 middle = Vec3::Zero();           ///< the point half-way along it
  std::vector<Vec3> line = {};          ///< its points in order, if it is kept
  std::optional<double> distance = {};  ///< its largest distance from the creases of a mesh, if measured

  bool is_kept() const { return fate == Fate::kept || fate == Fate::kept_groups; }
};

/// The chains of a surface. They are maximal, but end where other than two sharp edges meet or their fate
/// changes.
struct CreaseChains {
  struct Total {
    std::size_t count = 0;
    double length = 0;  ///< unit of the surface
  };
  static constexpr std::size_t max_listed = 256;
  std::vector<CreaseChain> longest;                ///< at most `max_listed`, the longest first
  std::array<Total, CreaseChain::fates> totals{};  ///< of all chains, by fate

  std::size_t count() const;
  const Total& total(CreaseChain::Fate fate) const { return totals[static_cast<std::size_t>(fate)]; }
};

/// A surface cut into smooth parts along its creases.
struct SurfacePatches {
  enum class Verdict : std::uint8_t {
    off,           ///< not searched
    smooth,        ///< no edge turns far enough
    scan,          ///< sharp edges end anywhere, as in noise, on all of the surface but specks
    intersecting,  ///< discarded: all creases are where the surface intersects itself
    meeting,       ///< discarded: all are where the surface meets another one, intersects itself or gaps are
                   ///< closed
    staircase,     ///< creases nearly everywhere, as on the faces of voxels
    part           ///< there are creases
  };
  Verdict verdict = Verdict::off;
  /// Patch of each triangle, from 0 to count - 1, ascending by each patch's first triangle; all 0 unless the
  /// verdict is `part` or groups were given.
  std::vector<std::uint16_t> patches;
  std::size_t count = 1;
  /// A flag for each patch, or empty: its sharp edges are noise, so that creases at its border turn anywhere.
  std::vector<std::uint8_t> rough;
  std::size_t dropped = 0;  ///< patches below PatchOptions::min_area, merged with neighbours
  /// Number of loose ends of edges that turn by more than 15 and 35 degrees, divided by the number of these
  /// edges; 2 if no two of them meet.
  double loose_ends_low = 0, loose_ends_high = 0;
  /// Fraction of the area where sharp edges are noise and no creases.
  double noisy_share = 0;
  CreaseChains chains;  ///< if PatchOptions::list_chains; none if the angle is off

  bool any() const { return count > 1; }
};

/// Cuts a surface into patches. Regions grow across edges that turn little; two regions merge if less than
/// half of their border's length turns by more than the angle. Faceted cylinders and fillets thus stay whole,
/// and creases that fade out within a patch disappear. A plain threshold would let patches leak through every
/// edge that turns slightly less.
///
/// Automatic: creases of a mechanical part end at other creases or at borders, sharp edges due to noise end
/// anywhere. There is no noise unless there are more than 9 loose ends per 100 edges that turn by 15 degrees,
/// or more than 20 per 100 edges that turn by 35. If there is, the same test decides for each patch, and
/// small patches beside noise belong to it.
///
/// Edges at which a group does not have exactly two triangles are borders, as are edges between triangles of
/// opposite orientation. Triangles without area belong to a neighbour's patch. O(n log n); the result does
/// not depend on the number of threads.
/// \param options min_area is in the square of the surface's unit
/// \param groups empty, or a number for each triangle: patches never cross from one group to another, even if
///   the angle is off
/// \param file file name for messages
/// \throws InputError if there are more than 65,535 patches (automatic: such a surface is a staircase)
SurfacePatches find_patches(std::span<const Vec3> points, std::span<const Triangle> triangles,
                            const PatchOptions& options, std::span<const std::uint32_t> groups,
                            const std::string& file);

/// The chains that find_patches() lists, for any number of patches. O(n log n).
/// \param is_given_up where kept edges are given up, but for borders of groups; may be empty
/// \param piece max length of the pieces of an edge that are kept or given up as a whole, unit of the surface
CreaseChains find_crease_chains(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                PatchOptions options, std::span<const std::uint32_t> groups,
                                const std::function<bool(const Vec3&)>& is_given_up = {}, double piece = 0);

/// Cuts the boundary and the interfaces of a tet mesh into patches, each pair of materials as a separate
/// group. Sets the patches of `mesh.interfaces`, which are computed if they are empty. Patches are numbered
/// from 0 for each pair, so that a mesh without creases equals one that was not searched. Patches set by
/// readers (other than 0) stay separate.
/// \return count, verdict and chains over all pairs
SurfacePatches find_mesh_patches(TetMesh& mesh, const FeatureAngle& angle, const std::string& file);

/// Creases and corners of a surface, given its patches.
struct SurfaceCreases {
  struct Segment {
    std::array<Index, 2> ends;             ///< points, ascending
    std::array<std::uint16_t, 2> patches;  ///< adjacent patches, ascending
  };
  std::vector<Segment> segments;  ///< ascending by their ends
  /// Points where creases do not continue, since the number of segments is not two or they separate different
  /// pairs of patches, and points where a crease turns by more than 45 degrees; ascending.
  std::vector<Index> corners;
};

/// Finds the creases, which are edges between triangles of different patches. An edge with more than two
/// patches has a segment for each pair of them.
/// \param corner_reach the turn of a crease is measured between the chords to the nearest points at least
///   this far away along it (0: the neighbouring points). Only one such corner is kept within that distance,
///   so that a zigzag from triangle to triangle has none
/// \param rough SurfacePatches::rough; turns of creases at such patches are no corners
SurfaceCreases find_creases(std::span<const Vec3> points, std::span<const Triangle> triangles,
                            std::span<const std::uint16_t> patches, double corner_reach = 0,
                            std::span<const std::uint8_t> rough = {});

/// Creases and corners as polylines, for comparisons.
struct CreaseCurves {
  std::vector<Vec3> points;
  std::vector<std::array<Index, 2>> segments;  ///< indices into points
  std::vector<Vec3> corners;

  void add(const SurfaceCreases& creases, std::span<const Vec3> surface_points);
  void add(const CreaseCurves& other);
};

/// Creases of the boundary and the interfaces of a mesh, between the patches of each pair of materials.
CreaseCurves mesh_creases(const TetMesh& mesh);

/// Junction edges, where the number of faces of a pair of materials is not two, for example where three
/// regions meet. No corners.
CreaseCurves mesh_junctions(const TetMesh& mesh);

}  // namespace tetwright

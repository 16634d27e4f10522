// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tetwright/diagnostic.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Maximum of the smallest solid angle of a tet, reached by the regular tet: 3 acos(1/3) - pi, steradians.
inline constexpr double regular_solid_angle = 0.55128559843253081;

/// Solid angles of a tet in steradians, in the order of its vertices; all 0 if it is flat or negative (Van
/// Oosterom & Strackee 1983).
std::array<double, 4> solid_angles(const std::array<Vec3, 4>& tet);

/// Minimum of solid_angles(), without computing the others.
double min_solid_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Tangent of half of min_solid_angle(), for comparisons: grows with the angle and is cheaper.
double min_solid_angle_tangent(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Dihedral angles in degrees, in the order of tet_edges; NaN where a face is degenerate.
std::array<double, 6> dihedral_angles(const std::array<Vec3, 4>& tet);

/// Signed volume, input units cubed.
double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Measure of a tet's shape for mesh improvement, a number in [0, 1]: 1 for the regular tet.
enum class ShapeObjective : std::uint8_t {
  /// Minimum of the smallest solid angle in steradians and 0.3 times the smallest sine of a dihedral angle:
  /// against slivers, needles and flat tets alike.
  both,
  solid_angle,  ///< the smallest solid angle
  dihedral      ///< the smallest sine of a dihedral angle: against small and large ones alike
};

/// Weight of a sine against a solid angle in steradians in ShapeObjective::both: 0.1 sr then corresponds to
/// dihedral angles of 19.5 and 160.5 degrees.
inline constexpr double sine_weight = 0.3;

/// Quality(t) of Cutler, Dorsey & McMillan 2004, section 3: the geometric mean of three factors in [0, 1]
/// that reward solid angles near the regular tet's, a volume of at least the ideal one and edges no longer
/// than beta ideal edges.
struct TetQuality {
  double ideal_volume;  ///< volume of the model / target count
  double ideal_edge;    ///< cube root of ideal_volume
  double beta;          ///< the paper uses 5
  /// Tets whose smallest solid angle (steradians) is below this are devalued by the square of its ratio to
  /// it; otherwise a needle would equal a small but well-shaped tet. 0: off, as in the paper.
  double needle_angle = 0;

  /// \param total_volume volume of the model
  /// \param target number of tets wanted
  static TetQuality for_target(double total_volume, double target, double beta = 5);

  /// Quality(t)^3 in [0, 1], which orders tets as Quality(t) does without the cube root. 0 for a tet that is
  /// negative or so flat that rounding may have decided its sign; a positive value proves a positive exact
  /// sign.
  double cubed(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;
  /// Upper bound of cubed() for a tet of six times the volume `det`, slightly enlarged for rounding.
  double max_for_volume(double det) const { return det * (1 + 0x1p-20) / (6 * ideal_volume); }
  /// Quality(t) in [0, 1].
  double operator()(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;
};

/// Shape quality, independent of size: the objective's value over the regular tet's, in [0, 1]; 0 as for
/// TetQuality::cubed().
double shape_quality(ShapeObjective objective, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
/// shape_quality() of a tet whose smallest solid angle is `solid_angle` (steradians) and whose dihedral
/// angles are no worse than the objective weighs against it: converts bounds on angles into bounds on the
/// objective. At most 0.99: no mesh consists of regular tets alone, and a bound on all tets must be
/// attainable.
double shape_quality_bound(ShapeObjective objective, double solid_angle);

class Progress;
class ProjectionTree;

/// Gap between the bounds of a SurfaceDeviation, relative to the deviation.
inline constexpr double relative_deviation_accuracy = 0.01;

/// One-sided Hausdorff distance of a surface from another, over all its points, not only the vertices: proven
/// to be between `lower` and `upper`. Input units.
struct SurfaceDeviation {
  double lower = 0, upper = 0;
  Vec3 place = Vec3::Zero();  ///< on the first surface, at the distance `lower` from the second
  double rms = 0;             ///< over about 100,000 points, evenly distributed by area
};

/// Proven distance of a mesh from the surface that it represents, input units. Parts of the dense mesh's
/// surface that are far from the given one (caps of holes, layers, the box of a meshed outside) are compared
/// with themselves. Parts of the given surface that are far from the dense mesh (removed inner walls) are
/// left out.
struct DeviationReport {
  SurfaceDeviation from_mesh, from_surface;
  double apart_area = 0;   ///< of the parts compared with themselves
  double hidden_area = 0;  ///< of the parts left out
  double upper() const { return std::max(from_mesh.upper, from_surface.upper); }
};

/// Computes the deviation of `from` from `to`.
///
/// Branch and bound over triangles (Tang, Lee & Kim 2009, "Interactive Hausdorff distance computation for
/// general polygonal models"): the distance from one triangle is convex, hence largest in a corner; any
/// distance grows no faster than the path; where triangles of the other surface meet, a piecewise linear map
/// to them bounds it. Triangles that may exceed the lower bound are bisected where the nearest triangle of
/// the other surface changes. Parallel; the result does not depend on the number of threads.
/// \param accuracy gap allowed between the bounds, input units, above 0; relative_deviation_accuracy if that
///   is more. The gap is larger only where closing it would take more than four million triangles, or 150
///   cuts of one, which is not to be expected
/// \param progress may be null; after its deadline the bounds remain as far apart as they are
/// \return infinite where `to` is empty and `from` is not
/// \throws Interrupted if `progress` is cancelled
SurfaceDeviation surface_deviation(const ProjectionTree& from, const ProjectionTree& to, double accuracy,
                                   const Progress* progress = nullptr);

/// A triangle with a point that is far from another surface.
struct FarTriangle {
  std::uint32_t item;     ///< index into items() of its surface
  std::uint32_t nearest;  ///< item of the other surface nearest to `place`
  Vec3 place;             ///< the far point
};

/// Finds the triangles of `from`, ascending, with a point farther from `to` than `limit`. A triangle that
/// exceeds it by less than `accuracy` (above 0), or is not settled after a few thousand cuts, may be missing.
/// Parallel; the result does not depend on the number of threads.
/// \pre `to` is not empty
std::vector<FarTriangle> triangles_beyond(const ProjectionTree& from, const ProjectionTree& to, double limit,
                                          double accuracy);

/// A face of a tet mesh and its tets.
struct MeshFace {
  Triangle ids;         ///< ascending
  Index first;          ///< its tet with the smallest index
  Index second;         ///< the next one, or no_index on the boundary
  std::uint32_t count;  ///< number of its tets; more than two only in a broken mesh
};

/// All faces in lexicographic order of their ids. Parallel; the result does not depend on the number of
/// threads. Peak memory about 100 bytes for each tet; with candidates 50 for each face found and 8 for each
/// point.
/// \param points number of points; ids are below it
/// \param candidates a flag for each point: only faces of three flagged points are listed; null: all
std::vector<MeshFace> mesh_faces(std::span<const Tet> tets, std::size_t points,
                                 const std::vector<std::uint8_t>* candidates = nullptr);

struct MeshPlace {
  std::string text;           ///< such as "tet 7 (1 2 2 5)" or "point 3 at 0 0.5 1"
  std::vector<Index> points;  ///< indices of the points concerned, in the order of the text
  std::optional<Vec3> at;     ///< mean position of the points, if all exist and are finite
};

/// A defect that check_mesh() found. Its code is one from materials_missing to self_intersections, and
/// kind_of(code).message says what is counted, such as "tets with a repeated vertex".
struct MeshFinding {
  DiagnosticCode code;
  std::size_t count;
  std::vector<MeshPlace> places;  ///< the first few
};

/// Name in machine-readable reports, such as "degenerate_tets": that of the code with underscores.
std::string mesh_finding_name(const MeshFinding& finding);

struct MeshCheckOptions {
  bool self_intersections = true;  ///< takes as long as all other checks together
  std::size_t places = 3;          ///< maximum number of examples in each finding
};

/// True unless a finding is an error.
bool is_valid(const std::vector<MeshFinding>& findings);

/// Checks any mesh, even one with indices out of range. Parallel; the result does not depend on the number of
/// threads. Takes well under a second for a million tets, and about 120 bytes of memory for each tet.
/// Stops at unsound arrays: after materials_missing, index_out_of_range or coordinates_not_finite no further
/// check is made. Unused points are a warning, since no computation on the tets notices them; all other
/// defects are errors.
/// \return the defects found, in the order of their codes; numbers in their texts count from 0
std::vector<MeshFinding> check_mesh(const TetMesh& mesh, const MeshCheckOptions& options = {});
/// Checks a mesh with the faces that mesh_faces() found in it.
/// \pre indices in range
std::vector<MeshFinding> check_mesh(const TetMesh& mesh, const MeshCheckOptions& options,
                                    const std::vector<MeshFace>& faces);

/// One line for messages: "tets with a repeated vertex (degenerate_tets): 3, the first at tet 7 (1 2 2 5)".
std::string mesh_finding_line(const MeshFinding& finding);

/// The finding as a diagnostic, with mesh_finding_line() for its text.
Diagnostic diagnostic_of(const MeshFinding& finding);

/// Numbers of tets by volume and smallest solid angle, as in Figure 2 of Cutler, Dorsey & McMillan 2004.
struct QualityHistogram {
  /// Linear, 0 to 0.55 steradians; the last bin includes larger angles (a regular tet has 0.5513).
  static constexpr std::size_t angle_bins = 22;
  static constexpr double angle_step = 0.025;
  /// Logarithmic: volume / mean volume from 2^-8 to 2^8, two bins for each doubling. The first and the last
  /// bin include values beyond; the first also volumes that are zero or negative.
  static constexpr std::size_t volume_bins = 32;
  static constexpr double min_relative_volume = 0x1p-8;

  /// counts[angle bin][volume bin]
  std::array<std::array<std::size_t, volume_bins>, angle_bins> counts{};
};

/// Numbers of dihedral angles by size, six of each tet: linear, 0 to 180 degrees. Degenerate faces, whose
/// angles are undefined, are left out.
struct DihedralHistogram {
  static constexpr std::size_t bins = 36;
  static constexpr double step = 5;  ///< degrees

  std::array<std::size_t, bins> counts{};
};

struct MaterialStatistics {
  std::size_t tets = 0;
  double volume = 0;  ///< input units cubed; the sum of signed volumes
};

/// Faces between two materials, or between one and outside.
struct InterfaceStatistics {
  std::size_t triangles = 0;
  double area = 0;  ///< input units squared
};

/// Statistics of a mesh for reports.
struct MeshStatistics {
  std::size_t tets = 0;
  std::size_t points = 0;
  std::map<MaterialTag, MaterialStatistics> materials;
  double volume = 0;  ///< of all materials
  // Smallest solid angle of each tet, steradians; 0 for a tet that is flat or negative by exact sign.
  double min_solid_angle = 0;
  double mean_solid_angle = 0;
  std::size_t below_count = 0;  ///< tets below the threshold
  double below_percent = 0;     ///< 0 to 100
  /// Dihedral angles in degrees, over all tets where they are defined (0 and 180 for flat ones).
  double min_dihedral = std::numeric_limits<double>::quiet_NaN();
  double max_dihedral = std::numeric_limits<double>::quiet_NaN();
  QualityHistogram histogram;
  DihedralHistogram dihedrals;
  // From TetMesh::interfaces; empty if those are.
  std::map<MaterialPair, InterfaceStatistics> interfaces;
  std::size_t junction_edges = 0;  ///< edges at which three or more interface triangles meet
};

/// Computes the statistics. Parallel; the result is the same for any number of threads and on every machine.
/// About 0.2 s for a million tets and as much for a million interface triangles. Takes 48 bytes for each
/// triangle, then one for each tet.
/// \param threshold solid angle for below_count, steradians
/// \pre ids in range
MeshStatistics mesh_statistics(const TetMesh& mesh, double threshold = 0.1);

/// A connected component of the surface of a solid.
struct SolidShell {
  Vec3 place = Vec3::Zero();  ///< first point of its first triangle
  double volume = 0;          ///< input units cubed; negative if oriented inwards: a cavity
  std::ptrdiff_t handles = 0;
  std::size_t triangles = 0;
};

/// A solid, described by its shells. A solid in space has as many handles (first Betti number) as all of its
/// shells together.
struct SolidShape {
  /// False if some edge does not have exactly two triangles of opposite direction: then handles are
  /// meaningless, and parts that meet in such an edge count as separate.
  bool manifold = true;
  bool touches_itself = false;     ///< at some point without a common edge
  std::vector<SolidShell> shells;  ///< in the order of their first triangles

  double volume() const;
  std::size_t components() const;  ///< shells oriented outwards
  std::size_t cavities() const { return shells.size() - components(); }
  std::ptrdiff_t handles() const;
};

/// Analyses the solid bounded by closed triangles oriented outwards. Points at which fans of triangles meet
/// without a common edge count once for each fan. O(n log n), 120 bytes for each triangle; parallel except
/// for the chaining of triangles. The result does not depend on the number of threads.
/// \pre ids below the number of points; no intersections
SolidShape solid_shape(std::span<const Vec3> points, std::span<const Triangle> triangles);

/// Topology that simplification preserves: components, handles and cavities of materials, interfaces and
/// junction curves.
struct Topology {
  using Count = std::ptrdiff_t;

  /// The whole domain or a material.
  struct Solid {
    Count components = 0;  ///< of tets connected by faces
    Count euler = 0;       ///< points - edges + faces - tets
    Count boundary_components = 0;
    Count boundary_euler = 0;
    bool operator==(const Solid&) const = default;
  };
  struct Surface {
    Count components = 0;  ///< of triangles connected by edges
    Count euler = 0;
    bool operator==(const Surface&) const = default;
  };
  /// Edges with more than two boundary or interface triangles.
  struct Curves {
    Count components = 0;
    Count euler = 0;
    Count branch_points = 0;  ///< points where other than two such edges meet
    bool operator==(const Curves&) const = default;
  };
  using Pair = MaterialPair;

  Solid domain;
  // Empty for a mesh of one material, which the domain describes.
  std::map<MaterialTag, Solid> materials;
  std::map<Pair, Surface> interfaces;
  std::optional<Count> touching_fans;  ///< fans of boundary and interface triangles beyond one for each point
  std::optional<Curves> junction_curves;

  bool operator==(const Topology&) const = default;
};

/// Computes the topology. About 0.3 s for a million tets and 120 bytes of memory for each.
/// \pre ids below the number of points, a material for each tet
Topology topology(const TetMesh& mesh);
/// Computes the topology with the faces that mesh_faces() found in this mesh.
Topology topology(const TetMesh& mesh, const std::vector<MeshFace>& faces);

/// Faces between two materials or a material and outside.
std::vector<Triangle> boundary_and_interfaces(const TetMesh& mesh, const std::vector<MeshFace>& faces);

/// One line for each part, such as "material 2: components 1, euler 1, boundary components 1, boundary euler
/// 2".
std::vector<std::string> topology_lines(const Topology& topology);

/// One line for each part that differs, such as "interface 1|2: before components 1, euler 0; after missing".
std::vector<std::string> topology_differences(const Topology& before, const Topology& after);

/// Surface that the faces of second-order tets follow. Both functions return the nearest point within a
/// distance (input units), or nothing; they may be called concurrently.
struct SurfaceToFollow {
  /// Projects onto a patch of the interface between two regions.
  std::function<std::optional<Vec3>(const Vec3&, const InterfacePatch&, double max_distance)> onto_patch;
  /// Projects onto the curves where patches or more than two regions meet; null: these stay straight.
  std::function<std::optional<Vec3>(const Vec3&, double max_distance)> onto_crease;
};

/// Follows a reference surface.
/// \pre `reference` outlives the result
SurfaceToFollow follow(const ReferenceSurface& reference);

/// Follows the interfaces of a mesh with their patches, and the edges where these meet. Copies its input.
SurfaceToFollow follow_interfaces(const TetMesh& mesh);

struct CurvingReport {
  std::size_t edges = 0;       ///< of interfaces
  std::size_t on_surface = 0;  ///< midside nodes on the surface
  std::size_t part_way = 0;    ///< moved half or a quarter of the way, for valid tets
  std::size_t straight = 0;    ///< kept halfway between the ends: no valid tets otherwise, or no surface near
};

/// Moves the midside nodes of the interfaces' edges onto the surface if all tets around stay valid; otherwise
/// part of the way or not at all. A tet is valid if the determinant of its Jacobian is everywhere at least a
/// tenth of the straight tet's, which its Bezier coefficients certify (Johnen, Remacle, Geuzaine 2013). A
/// node moves by at most a quarter of its edge's length. O(n log n).
CurvingReport curve_midside_nodes(const TetMesh& mesh, const SurfaceToFollow& surface, MidsideNodes& nodes);

/// Smallest Bezier coefficient of the determinant of a second-order tet's Jacobian, over the straight tet's
/// determinant: a lower bound of the scaled Jacobian.
/// \param midside in the order of tet_midside_edges
double min_scaled_jacobian(const std::array<Vec3, 4>& corners, const std::array<Vec3, 6>& midside);

/// Replaces the fields of `after`, a mesh of the same body with other points and tets, by those of `before`.
/// Returns at once with no fields if `before` has none.
///
/// Point fields: a point with the coordinates of a point of `before` (the first of several) gets its values
/// bit by bit. Others are interpolated linearly in the containing tet of `before`, of any material, or at the
/// nearest point of the nearest tet. Integer fields get the value of the vertex with the largest weight, of
/// the smallest index among equals. NaN at a vertex affects only points that depend on that vertex.
///
/// Cell fields: a tet gets the values of the tet of `before` with the same material that contains its
/// centroid, or is nearest to it (the first among equals). A material that `before` lacks takes values from
/// any.
///
/// Inverted tets of `before` count as their mirror images; flat ones contain no point but may be nearest. If
/// `before` has no tets, values are NaN, or 0 in integer fields.
///
/// Parallel; the result does not depend on the number of threads. Peak memory beside the fields: 40 bytes for
/// each tet of `before` and 16 for each of its points.
/// \pre both meshes in range, with finite coordinates and fields of the right size
void transfer_fields(const TetMesh& before, TetMesh& after);

/// Faces between two materials and on the boundary, in ascending order of their sorted ids, each listed from
/// its smallest id on. A face of more than two tets, which only a broken mesh has, is left out: it has no two
/// sides. Parallel; the result does not depend on the number of threads.
/// \param candidates a flag for each point: only faces of three flagged points are examined. Time and memory
///   then grow with their number, beside one pass over the tets and 8 bytes for each point. Null: time and
///   memory of mesh_faces()
/// \pre ids in range, a material for each tet; tets positive for correct normals
std::vector<InterfaceTriangle> find_interfaces(const TetMesh& mesh,
                                               const std::vector<std::uint8_t>* candidates = nullptr);

/// Pairs of regions of the triangles, ascending (outside before any tag), each once.
std::vector<MaterialPair> interface_groups(const std::vector<InterfaceTriangle>& triangles);

/// "bone|skin", "bone|outside": names of the materials, or their tags if they have none.
std::string pair_name(const MaterialPair& pair, const std::map<MaterialTag, std::string>& names = {});

/// Changes that make_coherent() made to a mesh, and defects that remain.
struct ImportCleanupReport {
  std::size_t merged_points = 0;      ///< merged into an earlier point with equal coordinates
  std::size_t removed_tets = 0;       ///< with a repeated vertex
  std::size_t turned_tets = 0;        ///< reoriented: the last two vertices swapped
  std::size_t inverted_tets = 0;      ///< flat or negative (exact sign) in the returned mesh
  std::vector<Index> first_inverted;  ///< the first, at most three
  std::size_t lost_faces = 0;         ///< faces of patches that are on no boundary or interface any more
};

/// Makes the mesh of another program satisfy what this library expects, as far as connectivity allows; no
/// point moves.
///
/// - In a soup (more than one tet, and each point used by at most one tet) points of equal coordinates are
///   merged, where -0 equals 0: the first stays, with its values of the point fields. In any other mesh
///   duplicate points are considered intended. Points without a tet stay.
/// - Tets with a repeated vertex are removed; materials and cell fields follow.
/// - Tets are oriented so that any two with a common face lie on opposite sides of it, and then each
///   component connected by faces so that its total signed volume is positive; if that is exactly zero, so
///   that its first tet that is not flat is positive. Faces of more than two tets connect nothing. A tet that
///   cannot agree with all its neighbours agrees with the one it is first reached from. A tet that is
///   inverted in space but consistent with its neighbours thus stays inverted, and is counted.
///
/// If anything changed, `interfaces` with patches are recomputed, and their faces keep the patches;
/// `interfaces` without patches are cleared. If all tets are positive none is reoriented, and nothing is
/// allocated unless the mesh has the four points a tet of a soup. Peak memory 40 bytes a tet; the result does
/// not depend on the number of threads.
/// \pre vertices in range, coordinates finite, one material for each tet, fewer than 2^30 tets
ImportCleanupReport make_coherent(TetMesh& mesh);

}  // namespace tetwright

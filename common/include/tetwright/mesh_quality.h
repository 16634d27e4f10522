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
#include "tetwright/sheets.h"
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

/// Tangent of half of min_solid_angle(): monotone in the angle, so sufficient for comparisons, and cheaper.
double min_solid_angle_tangent(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Dihedral angles in degrees, in the order of tet_edges; NaN where a face is degenerate.
std::array<double, 6> dihedral_angles(const std::array<Vec3, 4>& tet);

/// Signed volume, input units cubed.
double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Measure of a tet's shape for mesh improvement, a number in [0, 1]: 1 for the regular tet.
enum class ShapeObjective : std::uint8_t {
  /// Minimum of the smallest solid angle (steradians) and 0.3 times the smallest sine of a dihedral angle.
  /// Penalises slivers, needles and flat tets.
  both,
  solid_angle,  ///< the smallest solid angle
  dihedral      ///< the smallest sine of a dihedral angle: penalises small and large ones
};

/// Weight of a sine relative to a solid angle (steradians) in ShapeObjective::both: 0.1 sr then corresponds
/// to dihedral angles of 19.5 and 160.5 degrees.
inline constexpr double sine_weight = 0.3;

/// Quality(t) of Cutler, Dorsey & McMillan 2004, section 3: the geometric mean of three factors in [0, 1]
/// that reward solid angles near the regular tet's, a volume of at least the ideal one and edges no longer
/// than beta ideal edges.
struct TetQuality {
  double ideal_volume;  ///< volume of the model / target count
  double ideal_edge;    ///< cube root of ideal_volume
  double beta;          ///< the paper uses 5
  /// A tet whose smallest solid angle (steradians) is below this is devalued by the square of the ratio of
  /// its angle to this one. Otherwise a needle would equal a small but well-shaped tet. 0: off, as in the
  /// paper.
  double needle_angle = 0;

  /// \param total_volume volume of the model
  /// \param target target number of tets
  static TetQuality for_target(double total_volume, double target, double beta = 5);

  /// Quality(t)^3 in [0, 1]: the same order of tets as Quality(t), without the cube root. 0 for a tet that is
  /// negative, or so flat that rounding may have decided its sign; a positive value proves that the exact
  /// sign is positive.
  double cubed(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;
  /// Upper bound of cubed() for a tet of volume `det` / 6, slightly enlarged to allow for rounding.
  double max_for_volume(double det) const { return det * (1 + 0x1p-20) / (6 * ideal_volume); }
  /// Quality(t) in [0, 1].
  double operator()(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;
};

/// Shape quality, independent of size: the objective's value divided by the regular tet's, in [0, 1]; 0 under
/// the same conditions as TetQuality::cubed().
double shape_quality(ShapeObjective objective, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
/// shape_quality() of a tet whose smallest solid angle is `solid_angle` (steradians) and whose dihedral
/// angles do not lower the objective further. Converts a bound on angles into a bound on the objective. At
/// most 0.99: a bound on all tets must be attainable, and no mesh consists of regular tets alone.
double shape_quality_bound(ShapeObjective objective, double solid_angle);

class Progress;
class ProjectionTree;

/// Gap between the bounds of a SurfaceDeviation, relative to the deviation.
inline constexpr double relative_deviation_accuracy = 0.01;

/// One-sided Hausdorff distance from one surface to another over all points of the first, not only its
/// vertices. The exact distance is proven to lie between `lower` and `upper`. Input units.
struct SurfaceDeviation {
  double lower = 0, upper = 0;
  Vec3 place = Vec3::Zero();  ///< on the first surface, at the distance `lower` from the second
  double rms = 0;             ///< root mean square over about 100,000 points, evenly distributed by area
};

/// Proven distance between a mesh and the surface that it represents, input units. Parts of the dense mesh's
/// surface that are far from the given surface (caps of holes, layers, the box of a meshed outside) serve as
/// their own reference. Parts of the given surface that are far from the dense mesh (removed inner walls) are
/// left out.
struct DeviationReport {
  SurfaceDeviation from_mesh, from_surface;
  double apart_area = 0;   ///< area of the parts that serve as their own reference
  double hidden_area = 0;  ///< area of the parts left out
  double upper() const { return std::max(from_mesh.upper, from_surface.upper); }
};

/// Computes the deviation of `from` from `to`.
///
/// Branch and bound over triangles (Tang, Lee & Kim 2009, "Interactive Hausdorff distance computation for
/// general polygonal models"). Upper bounds: the distance from a single triangle is convex, hence largest at
/// a corner; a distance changes by no more than the path length; where triangles of the other surface meet, a
/// piecewise linear map to them bounds it. Triangles that may exceed the lower bound are bisected where the
/// nearest triangle of the other surface changes. Parallel; the result does not depend on the number of
/// threads.
/// \param accuracy maximum gap between the bounds, input units, above 0; relative_deviation_accuracy applies
///   if it allows more. The gap is larger only if closing it would take more than four million triangles, or
///   150 cuts of one, neither of which is expected
/// \param progress may be null; once its deadline has passed the bounds are returned as they are
/// \return infinite if `to` is empty and `from` is not
/// \throws Interrupted if `progress` is cancelled
SurfaceDeviation surface_deviation(const ProjectionTree& from, const ProjectionTree& to, double accuracy,
                                   const Progress* progress = nullptr);

/// A triangle with a point farther from another surface than a limit.
struct FarTriangle {
  std::uint32_t item;     ///< index into items() of its tree
  std::uint32_t nearest;  ///< index of the item of the other surface nearest to `place`
  Vec3 place;             ///< the far point
};

/// Finds the triangles of `from` that have a point farther from `to` than `limit`, ascending. A triangle that
/// exceeds the limit by less than `accuracy` (above 0), or is undecided after a few thousand cuts, may be
/// missing. Parallel; the result does not depend on the number of threads.
/// \pre `to` is not empty
std::vector<FarTriangle> triangles_beyond(const ProjectionTree& from, const ProjectionTree& to, double limit,
                                          double accuracy);

/// A face of a tet mesh with its tets.
struct MeshFace {
  Triangle ids;         ///< ascending
  Index first;          ///< adjacent tet with the smallest index
  Index second;         ///< next adjacent tet, or no_index on the boundary
  std::uint32_t count;  ///< number of adjacent tets; more than two only in an invalid mesh
};

/// All faces in lexicographic order of their ids. Parallel; the result does not depend on the number of
/// threads. Peak memory about 100 bytes for each tet; with candidates 50 bytes for each face found and 8 for
/// each point.
/// \param points number of points; all ids are below it
/// \param candidates a flag for each point: only faces of three flagged points are listed; null: all faces
std::vector<MeshFace> mesh_faces(std::span<const Tet> tets, std::size_t points,
                                 const std::vector<std::uint8_t>* candidates = nullptr);

struct MeshPlace {
  std::string text;           ///< such as "tet 7 (1 2 2 5)" or "point 3 at 0 0.5 1"
  std::vector<Index> points;  ///< indices of the points concerned, in the order of the text
  std::optional<Vec3> at;     ///< mean of the points' positions, if all points exist and are finite
};

/// A defect that check_mesh() found. Its code is one from materials_missing to self_intersections, and
/// kind_of(code).message says what is counted, such as "tets with a repeated vertex".
struct MeshFinding {
  DiagnosticCode code;
  std::size_t count;
  std::vector<MeshPlace> places;  ///< examples: the first few
};

/// Name in machine-readable reports, such as "degenerate_tets": that of the code with underscores.
std::string mesh_finding_name(const MeshFinding& finding);

struct MeshCheckOptions {
  bool self_intersections = true;  ///< takes as long as all other checks together
  std::size_t places = 3;          ///< maximum number of examples for each finding
};

/// True unless a finding is an error.
bool is_valid(const std::vector<MeshFinding>& findings);

/// Checks any mesh, even one with indices out of range. Parallel; the result does not depend on the number of
/// threads. Takes well under a second and about 120 MB of memory for a million tets.
/// Stops at unsound arrays: after materials_missing, index_out_of_range or coordinates_not_finite no further
/// check is made. Unused points are a warning, since no computation on the tets depends on them; all other
/// defects are errors.
/// \return the defects found, in the order of their codes; indices in their texts count from 0
std::vector<MeshFinding> check_mesh(const TetMesh& mesh, const MeshCheckOptions& options = {});
/// Checks a mesh, given its faces as returned by mesh_faces().
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
  /// Logarithmic: volume / mean volume from 2^-8 to 2^8, two bins for each doubling. Volumes beyond this
  /// range are counted in the first and last bins, zero and negative ones in the first.
  static constexpr std::size_t volume_bins = 32;
  static constexpr double min_relative_volume = 0x1p-8;

  /// counts[angle bin][volume bin]
  std::array<std::array<std::size_t, volume_bins>, angle_bins> counts{};
};

/// Histogram of dihedral angles, six for each tet: linear, 0 to 180 degrees. Undefined angles at degenerate
/// faces are left out.
struct DihedralHistogram {
  static constexpr std::size_t bins = 36;
  static constexpr double step = 5;  ///< degrees

  std::array<std::size_t, bins> counts{};
};

struct MaterialStatistics {
  std::size_t tets = 0;
  double volume = 0;  ///< sum of signed volumes, input units cubed
};

/// Faces between two materials, or between a material and outside.
struct InterfaceStatistics {
  std::size_t triangles = 0;
  double area = 0;  ///< input units squared
};

/// Statistics of a mesh for reports.
struct MeshStatistics {
  std::size_t tets = 0;
  std::size_t points = 0;
  std::map<MaterialTag, MaterialStatistics> materials;
  double volume = 0;  ///< of all materials, input units cubed
  // Smallest solid angle of each tet, steradians; 0 for tets that are flat or negative by exact sign.
  double min_solid_angle = 0;
  double mean_solid_angle = 0;
  std::size_t below_count = 0;  ///< tets below the threshold
  double below_percent = 0;     ///< 0 to 100
  /// Dihedral angles in degrees over all tets, where defined (0 and 180 in flat tets).
  double min_dihedral = std::numeric_limits<double>::quiet_NaN();
  double max_dihedral = std::numeric_limits<double>::quiet_NaN();
  QualityHistogram histogram;
  DihedralHistogram dihedrals;
  // Computed from TetMesh::interfaces; empty if those are empty.
  std::map<MaterialPair, InterfaceStatistics> interfaces;  ///< without sheets
  std::vector<SheetStatistics> sheets;
  std::size_t junction_edges = 0;  ///< edges shared by three or more interface triangles, sheets included
};

/// Computes the statistics. Parallel; the result is the same for any number of threads and on every machine.
/// Takes about 0.2 s for a million tets and as much for a million interface triangles. Peak memory 48 bytes
/// for each triangle, or one byte for each tet if that is more.
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

/// A solid, described by its shells. The number of handles of a solid (first Betti number) is the sum of the
/// handles of its shells.
struct SolidShape {
  /// False if some edge is not shared by exactly two triangles that traverse it in opposite directions. The
  /// number of handles is then meaningless, and parts that meet in such an edge count as separate.
  bool manifold = true;
  bool touches_itself = false;     ///< true if it touches itself in a point without a common edge
  std::vector<SolidShell> shells;  ///< in the order of their first triangles

  double volume() const;
  std::size_t components() const;  ///< number of shells oriented outwards
  std::size_t cavities() const { return shells.size() - components(); }
  std::ptrdiff_t handles() const;
};

/// Analyses the solid bounded by closed triangles oriented outwards. A point where several fans of triangles
/// meet without a common edge counts once for each fan. O(n log n), 120 bytes for each triangle; parallel
/// except for joining the triangles. The result does not depend on the number of threads.
/// \pre ids below the number of points; no self-intersections
SolidShape solid_shape(std::span<const Vec3> points, std::span<const Triangle> triangles);

/// Topology that simplification preserves: the components, handles and cavities of materials, interfaces and
/// junction curves.
struct Topology {
  using Count = std::ptrdiff_t;

  /// The whole domain or a material.
  struct Solid {
    Count components = 0;  ///< face-connected components of the tets
    Count euler = 0;       ///< points - edges + faces - tets
    Count boundary_components = 0;
    Count boundary_euler = 0;
    bool operator==(const Solid&) const = default;
  };
  struct Surface {
    Count components = 0;  ///< edge-connected components of the triangles
    Count euler = 0;
    bool operator==(const Surface&) const = default;
  };
  /// Curves of edges with more than two boundary or interface triangles.
  struct Curves {
    Count components = 0;
    Count euler = 0;
    Count branch_points = 0;  ///< points where the number of such edges is not two
    bool operator==(const Curves&) const = default;
  };
  using Pair = MaterialPair;

  Solid domain;
  // Empty for a mesh of one material, since `domain` describes it.
  std::map<MaterialTag, Solid> materials;
  std::map<Pair, Surface> interfaces;
  std::map<std::string, Surface> sheets;  ///< by SheetStatistics::name
  std::optional<Count> touching_fans;     ///< surplus fans of boundary and interface triangles
  std::optional<Curves> junction_curves;

  bool operator==(const Topology&) const = default;
};

/// Computes the topology. Takes about 0.3 s and 120 MB of memory for a million tets.
/// \pre ids below the number of points, a material for each tet
Topology topology(const TetMesh& mesh);
/// Computes the topology, given the faces of the mesh as returned by mesh_faces().
Topology topology(const TetMesh& mesh, const std::vector<MeshFace>& faces);

/// Faces between two materials or between a material and outside.
std::vector<Triangle> boundary_and_interfaces(const TetMesh& mesh, const std::vector<MeshFace>& faces);

/// One line for each part, such as "material 2: components 1, euler 1, boundary components 1, boundary euler
/// 2".
std::vector<std::string> topology_lines(const Topology& topology);

/// One line for each part that differs, such as "interface 1|2: before components 1, euler 0; after missing".
std::vector<std::string> topology_differences(const Topology& before, const Topology& after);

/// Surface that the faces of second-order tets follow. The functions return the nearest point within a
/// distance (input units), or std::nullopt; they may be called concurrently.
struct SurfaceToFollow {
  /// Projects onto a patch of the interface between two regions.
  std::function<std::optional<Vec3>(const Vec3&, const InterfacePatch&, double max_distance)> onto_patch;
  /// Projects onto the curves where patches or more than two regions meet; null: edges on these curves stay
  /// straight.
  std::function<std::optional<Vec3>(const Vec3&, double max_distance)> onto_crease;
  /// Projects onto the borders of sheets and the curves where they meet anything else; null: these edges stay
  /// straight.
  std::function<std::optional<Vec3>(const Vec3&, double max_distance)> onto_sheet_curve;
};

/// Makes tets follow a reference surface. Sheets stay straight: a reference does not have them.
/// \pre `reference` outlives the result
SurfaceToFollow follow(const ReferenceSurface& reference);

/// Makes tets follow the interfaces of a mesh with their patches, and the edges where patches meet. Copies
/// its input.
SurfaceToFollow follow_interfaces(const TetMesh& mesh);

/// Makes tets follow the sheets of a mesh in addition to `surface`. Copies its input.
void follow_sheets(SurfaceToFollow& surface, const TetMesh& mesh);

struct CurvingReport {
  std::size_t edges = 0;       ///< edges of interfaces
  std::size_t on_surface = 0;  ///< midside nodes moved onto the surface
  std::size_t part_way = 0;    ///< midside nodes moved half or a quarter of the way, to keep tets valid
  std::size_t straight = 0;    ///< nodes kept at midpoints: no valid tets otherwise, or no surface near
};

/// Moves the midside nodes of interface edges onto the surface if all adjacent tets stay valid; otherwise
/// part of the way or not at all. A tet is valid if its Jacobian determinant is everywhere at least a tenth
/// of the straight tet's; its Bezier coefficients certify this (Johnen, Remacle, Geuzaine 2013). A node moves
/// by at most a quarter of its edge's length. O(n log n).
CurvingReport curve_midside_nodes(const TetMesh& mesh, const SurfaceToFollow& surface, MidsideNodes& nodes);

/// Lower bound of the scaled Jacobian of a second-order tet: the smallest Bezier coefficient of the Jacobian
/// determinant, divided by the straight tet's determinant.
/// \param midside in the order of tet_midside_edges
double min_scaled_jacobian(const std::array<Vec3, 4>& corners, const std::array<Vec3, 6>& midside);

/// Replaces the fields of `after` by those of `before`, a mesh of the same body with different points and
/// tets. Returns at once, leaving no fields, if `before` has none.
///
/// Point fields: a point with the coordinates of a point of `before` (the first of several) gets its values
/// bit by bit. Other values are interpolated linearly in the containing tet of `before`, of any material, or
/// at the nearest point of the nearest tet. Integer fields get the value of the vertex with the largest
/// weight, the smallest index among equals. NaN at a vertex affects only points whose interpolation uses that
/// vertex.
///
/// Cell fields: a tet gets the values of the tet of `before` with the same material that contains its
/// centroid, or is nearest to it (the first among equals). A material that `before` lacks takes values from
/// any material.
///
/// Inverted tets of `before` count as their mirror images; flat ones contain no point but may be nearest. If
/// `before` has no tets, values are NaN, or 0 in integer fields.
///
/// Parallel; the result does not depend on the number of threads. Peak memory in addition to the fields: 40
/// bytes for each tet of `before` and 16 for each of its points.
/// \pre both meshes have indices in range, finite coordinates and fields of the right size
void transfer_fields(const TetMesh& before, TetMesh& after);

/// Faces between two materials and on the boundary, in ascending order of their sorted ids, each starting at
/// its smallest id. A face of more than two tets, which occurs only in an invalid mesh, is left out: it has
/// no two sides. Parallel; the result does not depend on the number of threads.
/// \param candidates a flag for each point: only faces of three flagged points are examined. Time and memory
///   then grow with the number of these faces, plus one pass over the tets and 8 bytes for each point. Null:
///   all faces, with the time and memory of mesh_faces()
/// \pre ids in range, a material for each tet; tets positive for correct normals
std::vector<InterfaceTriangle> find_interfaces(const TetMesh& mesh,
                                               const std::vector<std::uint8_t>* candidates = nullptr);

/// Pairs of regions of the triangles, ascending (outside before any tag), each once.
std::vector<MaterialPair> interface_groups(const std::vector<InterfaceTriangle>& triangles);

/// Names of both materials, or the tag of one without a name: "bone|skin", "bone|outside".
std::string pair_name(const MaterialPair& pair, const std::map<MaterialTag, std::string>& names = {});

/// Changes that make_coherent() made to a mesh, and defects that remain.
struct ImportCleanupReport {
  std::size_t merged_points = 0;      ///< points merged into an earlier point with equal coordinates
  std::size_t removed_tets = 0;       ///< tets with a repeated vertex
  std::size_t turned_tets = 0;        ///< tets reoriented by swapping their last two vertices
  std::size_t inverted_tets = 0;      ///< flat or negative tets (exact sign) in the returned mesh
  std::vector<Index> first_inverted;  ///< indices of the first inverted tets, at most three
  std::size_t lost_faces = 0;         ///< faces of patches that are no longer on a boundary or interface
};

/// Makes a mesh of another program satisfy the requirements of this library, as far as connectivity allows.
/// No point moves.
///
/// - In a soup (more than one tet, and each point used by at most one tet) points with equal coordinates are
///   merged, where -0 equals 0: the first is kept, with its values of the point fields. In any other mesh
///   duplicate points are assumed to be intended. Points without a tet are kept.
/// - Tets with a repeated vertex are removed, together with their materials and cell fields.
/// - Tets are oriented so that any two tets with a common face lie on opposite sides of it. Each
///   face-connected component is then oriented so that its total signed volume is positive; if that is
///   exactly zero, so that its first tet that is not flat is positive. Faces of more than two tets connect
///   nothing. A tet that cannot be consistent with all its neighbours is made consistent with the one from
///   which it is first reached. A tet that is inverted in space but consistent with its neighbours thus stays
///   inverted, and is counted.
///
/// If anything changed, `interfaces` with patches are recomputed, and their faces keep the patches;
/// `interfaces` without patches are cleared. If all tets are positive, none is reoriented, and nothing is
/// allocated unless the mesh has four points for each tet, as a soup does. Peak memory 40 bytes for each tet;
/// the result does not depend on the number of threads.
/// \pre vertices in range, coordinates finite, one material for each tet, fewer than 2^30 tets
ImportCleanupReport make_coherent(TetMesh& mesh);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tetwright/mesh_quality.h"
#include "tetwright/mesher.h"
#include "tetwright/mesher_input.h"
#include "tetwright/sizes.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Volume and topology of a solid.
struct SolidNumbers {
  double volume = 0;  ///< input units cubed
  std::size_t components = 0, cavities = 0;
  std::ptrdiff_t handles = 0;

  bool same_counts(const SolidNumbers& other) const {
    return components == other.components && handles == other.handles && cavities == other.cavities;
  }
};

/// Comparison of a material of a mesh with its expected solid.
struct SolidComparison {
  std::string name;
  MaterialTag tag = 0;
  enum class Against { surface, distances, voxels } against = Against::surface;
  SurfaceFlaw flaw = SurfaceFlaw::none;  ///< flaw of the surfaces that define the material
  /// False if `expected` is only an estimate: the surfaces have a flaw, and they disagree with the signed
  /// distances or do not define a solid at all.
  bool certain = true;
  /// False if components, handles and cavities are not compared, since an edge of the material is shared by
  /// more than two of its faces. Handles are never compared with voxels.
  bool counted = true;
  /// With voxels, `expected` has only the volume and the minimum number of components.
  SolidNumbers expected, result;
  /// With voxels, the maximum number of components: touching voxels may or may not be connected.
  std::size_t max_components = 0;
  /// Text such as "256 handles instead of 0, volume 3.1 % less"; empty if the solid is as expected.
  std::string difference;
  /// A point of the largest shell without a counterpart, input units. With voxels, a point of the smallest
  /// component: of the mesh if it has too many components, otherwise of the volume.
  std::optional<Vec3> place;

  bool same() const { return difference.empty(); }
  bool same_counts() const {
    if (against == Against::voxels)
      return expected.components <= result.components && result.components <= max_components;
    return expected.same_counts(result);
  }
};

/// The volume that a label should have, voxels.
double expected_volume(const LabelMaterial& label);

/// Whether a volume is within 1 % of the expected volume `meant`.
bool is_same_volume(double volume, double meant);

/// Compares materials with their expected solids: components, handles and cavities must be equal, volumes
/// must agree within 1 % or ExpectedSolid::volume_slack. If a material's surfaces have a flaw, the material
/// may match either the signed distances or the surfaces.
///
/// \param expected solids of the input; materials are matched by tag
/// \param mesh in input units
/// \return one comparison for each expected solid, in the same order
/// \pre `mesh` has its interfaces.
std::vector<SolidComparison> compare_solids(const std::vector<ExpectedSolid>& expected, const TetMesh& mesh);

/// Compares labels with their voxels: volumes must agree within 2 %, or a larger fraction for few voxels; the
/// number of components must be in the range that the voxels allow.
///
/// \param labels labels of the segmented volume; matched by tag
/// \param outside parts of the outside label enclosed by others; they are compared with the cavities of the
///   whole mesh, without their volume; std::nullopt: outside is meshed
/// \param voxel_volume input units cubed
/// \param mesh in input units
/// \return one comparison for each label in the same order, then one for `outside` unless the boundary is not
///   manifold
/// \pre `mesh` has its interfaces.
std::vector<SolidComparison> compare_labels(const std::vector<LabelMaterial>& labels,
                                            const std::optional<LabelParts>& outside, double voxel_volume,
                                            const TetMesh& mesh);

/// Distances of the creases and corners of an input from those of its mesh. All lengths are in input units.
struct CreaseComparison {
  double diagonal = 0;  ///< diagonal of the bounding box; the limits below are relative to it
  double length = 0;    ///< total length of the input's creases
  /// Upper bound on the distance of any point of the input's creases from the mesh's creases. Exceeds the
  /// largest sampled distance by at most 1 % of it or 1e-9 of the diagonal.
  double max_distance = 0;
  double p99_distance = 0;           ///< 99th percentile of the sampled distances
  Vec3 place = Vec3::Zero();         ///< the sample with the largest distance
  std::size_t corners = 0;           ///< corners of the input
  double max_corner_distance = 0;    ///< maximum distance of a corner from the mesh's boundary points
  std::size_t lost_corners = 0;      ///< corners farther than 0.1 % of the diagonal
  Vec3 lost_corner = Vec3::Zero();   ///< the first lost corner
  Vec3 corner_place = Vec3::Zero();  ///< the corner with the largest distance

  /// Whether all creases are within 0.5 % of the diagonal and all corners within 0.1 %.
  bool same() const;
};

/// Measures creases at samples 1/2,000 of the diagonal apart, with a bound for the points between the
/// samples.
///
/// \param expected creases and corners to measure from
/// \param found creases to measure to; their corners are ignored
/// \param points candidates for the counterpart of a corner
/// \param diagonal diagonal of the bounding box, input units, above 0
/// \return the comparison; distances of creases are infinite if `found` has no segments, distances of corners
///   if `points` is empty
CreaseComparison compare_creases(const CreaseCurves& expected, const std::vector<CreaseCurves>& found,
                                 std::span<const Vec3> points, double diagonal);

/// Measures the distances of creases from the creases and junctions of a mesh, and of corners from the points
/// of its interfaces.
///
/// \return the comparison; distances of creases are the diagonal if the mesh has no creases; all is 0 if it
///   has no interfaces
/// \pre `mesh` has its interfaces with their patches.
CreaseComparison compare_creases(const CreaseCurves& expected, const TetMesh& mesh);

/// Sets the distances of chains that are kept from the creases and junctions of a mesh, at samples 1/2,000 of
/// the diagonal apart. Leaves them unset if the mesh has neither.
///
/// \pre `mesh` has its interfaces with their patches.
void measure_chains(std::vector<FeatureReport>& features, const TetMesh& mesh);

/// A named or numbered patch, in the input and in the result.
struct PatchComparison {
  SurfaceRegion group;
  double input_area = 0, area = 0;  ///< input units squared
  std::size_t triangles = 0;        ///< number of triangles in the result
  Vec3 place = Vec3::Zero();        ///< a point of the patch in the input, input units

  bool lost() const { return triangles == 0; }
};

/// Name of a group, or its number if it has no name.
std::string patch_name(const SurfaceRegion& group);

/// Named or numbered patches of an input, without their result.
std::vector<PatchComparison> patches_of_input(const MesherInput& input);
std::vector<PatchComparison> patches_of_input(const TetMesh& mesh);

/// Fills in triangles and area of each patch in the result.
///
/// \pre `result` has its interfaces.
void compare_patches(const TetMesh& result, std::vector<PatchComparison>& patches);

/// An edge meets its target length if it differs from it by at most this factor.
inline constexpr double edge_length_factor = 1.5;

/// Edge lengths of a mesh, compared with their targets and bounds. Input units.
struct EdgeLengthReport {
  /// The worst violation of a bound; its length is 0 if there is none.
  struct Offender {
    double length = 0;
    Vec3 place = Vec3::Zero();  ///< midpoint of the edge
    std::size_t count = 0;      ///< number of edges that violate the bound
  };
  std::size_t edges = 0;
  double shortest = 0, longest = 0;
  Offender above_max, below_min;
  // These are zero without a target length.
  std::size_t within = 0;              ///< edges within edge_length_factor of their target
  double median = 0;                   ///< median of the ratios of length to target
  std::size_t with_target_length = 0;  ///< number of edges compared with a target
  double within_share() const {
    return with_target_length ? static_cast<double>(within) / static_cast<double>(with_target_length) : 1;
  }
};

/// Compares all edges of a mesh with a target length and bounds. The target is evaluated at the edges'
/// midpoints.
///
/// \param target_length null: no target
/// \param source source of `target_length`, which samples it on a grid; the smaller of the two lengths
///   applies. May be null only if `target_length` is
/// \param min_edge input units; 0: no bound
/// \param max_edge input units; infinite: no bound
EdgeLengthReport compare_edge_lengths(const TetMesh& mesh, const SizeField* target_length,
                                      const SizeSource* source, double min_edge, double max_edge);

/// Comparison of a mesh with the surfaces that it should follow. Input units.
struct SurfaceComparison {
  /// Upper bound on a distance that a tolerance limits.
  struct Bound {
    double upper;      ///< infinite if there is no counterpart
    std::string what;  ///< text such as "the mesh is up to 1.5 from the surface, at (0, 1, 2)"
  };

  double diagonal = 0;           ///< diagonal of the surfaces' bounding box
  std::size_t outside_tets = 0;  ///< number of tets of the material `outside`, which are not compared
  bool inverted = false;         ///< true: all other tets are inverted; they are compared as if reoriented
  SurfaceDeviation from_mesh, from_surfaces;
  std::size_t open_edges = 0;  ///< number of boundary edges of the surfaces
  /// Parts of the mesh that close holes of the surfaces: their closest points lie on boundary edges. Left out
  /// of `from_mesh`.
  struct Caps {
    SurfaceDeviation from_mesh;  ///< distance of the caps only
    double area = 0, share = 0;  ///< area of the caps, and its fraction of the compared area
  };
  std::optional<Caps> caps;
  /// Volume and topology of the mesh's boundary; only for a single closed manifold surface.
  std::optional<SolidComparison> solid;
  /// Distances of the surfaces' creases from edges of the mesh that turn by at least half a crease's angle,
  /// and vice versa; std::nullopt if the surfaces have no creases.
  std::optional<CreaseComparison> creases, mesh_creases;
  bool intersecting = false;      ///< true: a surface intersects itself
  bool creases_left_out = false;  ///< true: such a surface has creases, which are not compared

  /// Proven upper bounds of the distances between mesh and surfaces in both directions, of creases of the
  /// surfaces from edges of the mesh that turn enough, and of corners of the surfaces from points of the
  /// mesh. Creases of the mesh have no bound, since large tets create creases on round surfaces. If caps
  /// cover more than half of the mesh's area, the bound is infinite.
  std::vector<Bound> bounds() const;
  /// Maximum of bounds().
  double upper() const;
};

/// Compares the boundary of a mesh, without the material `outside`, with surfaces from which it need not have
/// been made. If there are several surfaces, the interfaces of the mesh are compared too, with all surfaces
/// together. Distances refer to the surfaces as given; volume, topology and creases refer to the surfaces
/// after equal points are merged and triangles are oriented consistently.
///
/// \param mesh in the units of the surfaces
/// \param surfaces may be open
/// \param names one for each surface, for messages
/// \throws InputError in the cases of make_mesher_input() and find_patches()
/// \throws UsageError if all tets are of the material `outside`
/// \pre `mesh` has its interfaces.
SurfaceComparison compare_with_surfaces(const TetMesh& mesh, const std::vector<TriangleMesh>& surfaces,
                                        const std::vector<std::string>& names);

/// Lines that `check` prints, without line ends.
std::vector<std::string> comparison_lines(const SurfaceComparison& comparison);

/// A line that tells whether all bounds are within the tolerance, and which are not.
///
/// \param tolerance input units
std::string tolerance_line(const SurfaceComparison& comparison, double tolerance);

}  // namespace tetwright

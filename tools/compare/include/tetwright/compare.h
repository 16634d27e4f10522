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

/// A material of a mesh compared with its expected solid.
struct SolidComparison {
  std::string name;
  MaterialTag tag = 0;
  enum class Against { surface, distances, voxels } against = Against::surface;
  SurfaceFlaw flaw = SurfaceFlaw::none;  ///< of the surfaces that define the material
  /// False if `expected` is only an estimate: the surfaces have a flaw, and they disagree with the signed
  /// distances or give no solid at all.
  bool certain = true;
  /// False if components, handles and cavities are not compared, since an edge of the material is shared by
  /// more than two of its faces. Handles are never compared with voxels.
  bool counted = true;
  /// With voxels `expected` has only the volume and the min number of components.
  SolidNumbers expected, result;
  /// With voxels, the max number of components: touching voxels may or may not be connected.
  std::size_t max_components = 0;
  /// "256 handles instead of 0, volume 3.1 % less"; empty if the solid is as expected.
  std::string difference;
  /// A point of the largest shell without a counterpart, input units. With voxels, a point of the smallest
  /// component: of the mesh if it has too many, else of the volume.
  std::optional<Vec3> place;

  bool same() const { return difference.empty(); }
  bool same_counts() const {
    if (against == Against::voxels)
      return expected.components <= result.components && result.components <= max_components;
    return expected.same_counts(result);
  }
};

/// Whether a volume is within 1 % of the expected one, `meant`.
bool is_same_volume(double volume, double meant);

/// Compares materials with their expected solids: components, handles and cavities must be equal, volumes
/// within 1 % or ExpectedSolid::volume_slack. If a material's surfaces have a flaw, it may match either the
/// signed distances or the surfaces.
///
/// \param expected solids of the input; materials are matched by tag
/// \param mesh in input units
/// \return one comparison for each expected solid, in the same order
/// \pre `mesh` has its interfaces.
std::vector<SolidComparison> compare_solids(const std::vector<ExpectedSolid>& expected, const TetMesh& mesh);

/// Compares labels with their voxels: volumes within 2 %, or more for few voxels, and components with the
/// range that the voxels allow.
///
/// \param labels of the segmented volume; matched by tag
/// \param outside parts of the outside label within the others, compared with the cavities of the whole mesh,
/// without their volume; std::nullopt: outside is meshed
/// \param voxel_volume input units cubed
/// \param mesh in input units
/// \return one comparison for each label in the same order, then one for `outside` unless the boundary is not
/// manifold
/// \pre `mesh` has its interfaces.
std::vector<SolidComparison> compare_labels(const std::vector<LabelMaterial>& labels,
                                            const std::optional<LabelParts>& outside, double voxel_volume,
                                            const TetMesh& mesh);

/// Distances of the creases and corners of an input from those of its mesh. All lengths in input units.
struct CreaseComparison {
  double diagonal = 0;  ///< of the bounding box that the limits below are relative to
  double length = 0;    ///< total length of the input's creases
  /// Upper bound on the distance of any point of the input's creases from the mesh's; exceeds the largest
  /// sampled distance by at most 1 % of it or 1e-9 of the diagonal.
  double max_distance = 0;
  double p99_distance = 0;           ///< 99th percentile of the sampled distances
  Vec3 place = Vec3::Zero();         ///< the farthest sample
  std::size_t corners = 0;           ///< corners of the input
  double max_corner_distance = 0;    ///< max distance of a corner from the mesh's boundary points
  std::size_t lost_corners = 0;      ///< corners farther than 0.1 % of the diagonal
  Vec3 lost_corner = Vec3::Zero();   ///< the first lost corner
  Vec3 corner_place = Vec3::Zero();  ///< the farthest corner

  /// Whether all creases are within 0.5 % of the diagonal and all corners within 0.1 %.
  bool same() const;
};

/// Measures creases by samples 1/2,000 of the diagonal apart, and by a bound between these.
///
/// \param expected creases and corners to measure from
/// \param found creases to measure to; their corners are ignored
/// \param points candidates for the counterpart of a corner
/// \param diagonal of the bounding box, input units, above 0
/// \return the comparison; distances of creases are infinite if `found` has no segments, those of corners if
/// `points` is empty
CreaseComparison compare_creases(const CreaseCurves& expected, const std::vector<CreaseCurves>& found,
                                 std::span<const Vec3> points, double diagonal);

/// Measures creases to the creases and junctions of a mesh, and corners to the points of its interfaces.
///
/// \return the comparison; distances of creases are the diagonal if the mesh has no creases; all is 0 if it
/// has no interfaces
/// \pre `mesh` has its interfaces with their patches.
CreaseComparison compare_creases(const CreaseCurves& expected, const TetMesh& mesh);

/// A named or numbered patch in the input and in the result.
struct PatchComparison {
  SurfaceRegion group;
  double input_area = 0, area = 0;  ///< input units squared
  std::size_t triangles = 0;        ///< in the result
  Vec3 place = Vec3::Zero();        ///< a point of the patch in the input, input units

  bool lost() const { return triangles == 0; }
};

/// The name of a group, or its number if it has no name.
std::string patch_name(const SurfaceRegion& group);

/// The named or numbered patches of an input, without their result.
std::vector<PatchComparison> patches_of_input(const MesherInput& input);
std::vector<PatchComparison> patches_of_input(const TetMesh& mesh);

/// Fills in triangles and area of each patch in the result.
///
/// \pre `result` has its interfaces.
void compare_patches(const TetMesh& result, std::vector<PatchComparison>& patches);

/// An edge meets its target length within this factor.
inline constexpr double edge_length_factor = 1.5;

/// Edge lengths of a mesh compared with their target and their bounds. Input units.
struct EdgeLengthReport {
  /// The worst violation of a bound; its length is 0 if there is none.
  struct Offender {
    double length = 0;
    Vec3 place = Vec3::Zero();  ///< midpoint of the edge
    std::size_t count = 0;      ///< edges that violate the bound
  };
  std::size_t edges = 0;
  double shortest = 0, longest = 0;
  Offender above_max, below_min;
  // Zero without a target length.
  std::size_t within = 0;              ///< edges within edge_length_factor of their target
  double median = 0;                   ///< of the ratios of length to target
  std::size_t with_target_length = 0;  ///< edges compared with a target
  double within_share() const {
    return with_target_length ? static_cast<double>(within) / static_cast<double>(with_target_length) : 1;
  }
};

/// Compares all edges of a mesh with a target length and bounds; the target is evaluated at their midpoints.
///
/// \param target_length null: no target
/// \param source of `target_length`, which samples it on a grid; the smaller length of the two counts. May be
/// null only if `target_length` is
/// \param min_edge input units; 0: no bound
/// \param max_edge input units; infinite: no bound
EdgeLengthReport compare_edge_lengths(const TetMesh& mesh, const SizeField* target_length,
                                      const SizeSource* source, double min_edge, double max_edge);

/// A mesh compared with the surfaces that it should follow. Input units.
struct SurfaceComparison {
  /// A distance that a tolerance limits.
  struct Bound {
    double upper;      ///< infinite if there is no counterpart
    std::string what;  ///< "the mesh is up to 1.5 from the surface, at (0, 1, 2)"
  };

  double diagonal = 0;           ///< of the surfaces' bounding box
  std::size_t outside_tets = 0;  ///< tets of the material `outside`, which are not compared
  bool inverted = false;         ///< all other tets are inverted; compared as if turned
  SurfaceDeviation from_mesh, from_surfaces;
  std::size_t open_edges = 0;  ///< boundary edges of the surfaces
  /// Parts of the mesh that close holes of the surfaces: their closest points are on boundary edges. Left out
  /// of `from_mesh`.
  struct Caps {
    SurfaceDeviation from_mesh;  ///< distance of the caps alone
    double area = 0, share = 0;  ///< and its fraction of the compared area
  };
  std::optional<Caps> caps;
  /// Volume and topology of the mesh's boundary; only if there is one surface, closed and manifold.
  std::optional<SolidComparison> solid;
  /// Creases of the surfaces measured to edges of the mesh that turn by at least half a crease's angle, and
  /// vice versa; std::nullopt if the surfaces have no creases.
  std::optional<CreaseComparison> creases, mesh_creases;
  bool intersecting = false;      ///< a surface intersects itself
  bool creases_left_out = false;  ///< such a surface has creases, which are not compared

  /// Proven upper bounds: between mesh and surfaces both ways, from creases of the surfaces to such edges of
  /// the mesh, and from their corners to its points. Creases of the mesh have no bound, since a round face of
  /// large tets has some. Caps over more than half of the mesh's area make an infinite bound.
  std::vector<Bound> bounds() const;
  /// The largest of bounds().
  double upper() const;
};

/// Compares the boundary of a mesh, without the material `outside`, with surfaces that it need not be made
/// from. With several surfaces its interfaces are compared too, with all surfaces together. Distances refer
/// to the surfaces as given; volume, topology and creases to the surfaces with equal points joined and
/// triangles wound alike.
///
/// \param mesh in the units of the surfaces
/// \param surfaces may be open
/// \param names one for each surface, for messages
/// \throws InputError as make_mesher_input() and find_patches()
/// \throws UsageError if all tets are of the material `outside`
/// \pre `mesh` has its interfaces.
SurfaceComparison compare_with_surfaces(const TetMesh& mesh, const std::vector<TriangleMesh>& surfaces,
                                        const std::vector<std::string>& names);

/// The lines that `check` prints, without line ends.
std::vector<std::string> comparison_lines(const SurfaceComparison& comparison);

/// A line that says whether all bounds are within the tolerance, and which are not.
///
/// \param tolerance input units
std::string tolerance_line(const SurfaceComparison& comparison, double tolerance);

}  // namespace tetwright

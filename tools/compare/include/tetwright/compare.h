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

/// The numbers of a solid that are compared.
struct SolidNumbers {
  double volume = 0;  ///< input units cubed
  std::size_t components = 0, cavities = 0;
  std::ptrdiff_t handles = 0;

  bool same_counts(const SolidNumbers& other) const {
    return components == other.components && handles == other.handles && cavities == other.cavities;
  }
};

/// A material of a mesh beside the solid that it is meant to be.
struct SolidComparison {
  std::string name;
  MaterialTag tag = 0;
  enum class Against { surface, distances, voxels } against = Against::surface;
  SurfaceFlaw flaw = SurfaceFlaw::none;  ///< of the surfaces that define the material
  /// False where `expected` is only an estimate: the surfaces have a flaw, and what they say and what the
  /// distances say is not the same, or only one of them says anything.
  bool certain = true;
  /// False where components, handles and cavities are not compared: an edge of the material is shared by more
  /// than two of its faces. By voxels handles are never compared.
  bool counted = true;
  /// By voxels only volumes and components are known.
  SolidNumbers expected, result;
  /// By voxels as many components are possible as expected or more, up to this.
  std::size_t max_components = 0;
  /// "256 handles instead of 0, volume 3.1 % less"; empty where the solid is the same.
  std::string difference;
  /// A point of the largest shell without a counterpart, input units. By voxels: a point of the smallest
  /// component, of the mesh where it has too many, else of the volume.
  std::optional<Vec3> place;

  bool same() const { return difference.empty(); }
  bool same_counts() const {
    if (against == Against::voxels)
      return expected.components <= result.components && result.components <= max_components;
    return expected.same_counts(result);
  }
};

/// Whether a volume is within 1 % of the one that is meant.
bool is_same_volume(double volume, double meant);

/// Compares materials with what they are meant to be: components, handles and cavities must be equal, volumes
/// within 1 %. Where surfaces have a flaw and the mesh differs from the distances, it may be as the surfaces
/// say. `mesh` has its interfaces.
std::vector<SolidComparison> compare_solids(const std::vector<ExpectedSolid>& expected, const TetMesh& mesh);

/// Compares labels with their voxels: volumes, and components with the parts that voxels may mean. What is
/// called "outside" there are the cavities of all labels together, with `outside` if that is not meshed; its
/// volume is not compared. `mesh` has its interfaces.
std::vector<SolidComparison> compare_labels(const std::vector<LabelMaterial>& labels,
                                            const std::optional<LabelParts>& outside, double voxel_volume,
                                            const TetMesh& mesh);

/// The creases and corners of an input beside those of the mesh made of it.
struct CreaseComparison {
  double diagonal = 0;  ///< that shares are of, of the mesh's box, input units, as all lengths
  double length = 0;    ///< of the input's creases
  /// That no place on them is farther than from the mesh's creases: at most 1 % or 1e-9 of the diagonal more
  /// than some place is.
  double max_distance = 0;
  double p99_distance = 0;           ///< that 99 % of them are within
  Vec3 place = Vec3::Zero();         ///< the farthest one
  std::size_t corners = 0;           ///< of the input
  double max_corner_distance = 0;    ///< of one of them from the nearest point of the mesh's boundary
  std::size_t lost_corners = 0;      ///< farther than 0.1 % of the diagonal
  Vec3 lost_corner = Vec3::Zero();   ///< the first one
  Vec3 corner_place = Vec3::Zero();  ///< the farthest one

  /// All creases within 0.5 % of the diagonal and all corners within 0.1 %.
  bool same() const;
};

/// Compares 2,000 places to the diagonal with the segments of all of `found`, and corners with `points`,
/// whatever `found` calls a corner. Distances are infinite where there is nothing to be near.
CreaseComparison compare_creases(const CreaseCurves& expected, const std::vector<CreaseCurves>& found,
                                 std::span<const Vec3> points, double diagonal);

/// Compares them with the creases and junctions of a mesh and the points of its boundary. `mesh` has its
/// interfaces with their patches; where it has no creases the diagonal stands for their distance.
CreaseComparison compare_creases(const CreaseCurves& expected, const TetMesh& mesh);

/// A patch that the user named or numbered, in the input and in the result.
struct PatchComparison {
  SurfaceRegion group;
  double input_area = 0, area = 0;  ///< input units squared
  std::size_t triangles = 0;        ///< of the result
  Vec3 place = Vec3::Zero();        ///< on it in the input, input units

  bool lost() const { return triangles == 0; }
};

/// The name of a group, or its number.
std::string patch_name(const SurfaceRegion& group);

/// The patches of an input, by their numbers and names.
std::vector<PatchComparison> patches_of_input(const MesherInput& input);
std::vector<PatchComparison> patches_of_input(const TetMesh& mesh);

/// Fills in what the result has of them.
void compare_patches(const TetMesh& result, std::vector<PatchComparison>& patches);

/// An edge is as long as it should be within this factor of the wanted length.
inline constexpr double edge_length_factor = 1.5;

/// The lengths of a mesh's edges against those that are wanted, and their bounds. Input units.
struct EdgeLengthReport {
  /// The edge that breaks a bound by most; its length is 0 where none does.
  struct Offender {
    double length = 0;
    Vec3 place = Vec3::Zero();  ///< its middle
    std::size_t count = 0;      ///< of edges that break the bound
  };
  std::size_t edges = 0;
  double shortest = 0, longest = 0;
  Offender above_max, below_min;
  // With a target length; else 0.
  std::size_t within = 0;              ///< edges within edge_length_factor of it
  double median = 0;                   ///< of lengths over wanted ones
  std::size_t with_target_length = 0;  ///< edges in all, or 0 without a target length
  double within_share() const {
    return with_target_length ? static_cast<double>(within) / static_cast<double>(with_target_length) : 1;
  }
};

/// `target_length` may be null; `min_edge` 0 and `max_edge` infinite are no bounds.
EdgeLengthReport compare_edge_lengths(const TetMesh& mesh, const SizeField* target_length,
                                      const SizeSource* source, double min_edge, double max_edge);

/// A mesh beside the surfaces that it should have. Input units.
struct SurfaceComparison {
  /// Something that may not be farther from its counterpart than a tolerance.
  struct Bound {
    double upper;      ///< infinite where there is no counterpart
    std::string what;  ///< "the mesh is up to 1.5 from the surface, at (0, 1, 2)"
  };

  double diagonal = 0;           ///< of the surfaces' bounding box
  std::size_t outside_tets = 0;  ///< of the material that --keep-outside makes: not compared
  bool inverted = false;         ///< all other tets, which count as turned
  SurfaceDeviation from_mesh, from_surfaces;
  std::size_t open_edges = 0;  ///< edges of the surfaces with one triangle
  /// Parts of the mesh that close the surfaces there: their nearest points of the surfaces are on such edges.
  /// They are left out of `from_mesh`.
  struct Caps {
    SurfaceDeviation from_mesh;  ///< of the caps alone
    double area = 0, share = 0;  ///< and of all of the mesh's area that is compared
  };
  std::optional<Caps> caps;
  /// Volume, components, handles and cavities of one closed surface beside those of the mesh's boundary.
  std::optional<SolidComparison> solid;
  /// Where the surfaces have any: their creases beside the mesh's edges that turn at least half as far as a
  /// crease does, and the mesh's creases beside such edges of the surfaces.
  std::optional<CreaseComparison> creases, mesh_creases;
  bool intersecting = false;      ///< some surface intersects itself
  bool creases_left_out = false;  ///< and such a one has creases, which are not compared

  /// Distances that are proven: no point of one is farther from the other than this, no place of a crease of
  /// the surfaces from such an edge of the mesh, no corner of them from a point of it. Creases of the mesh
  /// are not among them: where tets are large a round face has some.
  std::vector<Bound> bounds() const;
  /// The largest one.
  double upper() const;
};

/// Compares the boundary of the mesh without the outside that it may keep, and its interfaces too if there
/// are several surfaces, with all of them together, whatever the mesh was made from. Distances are from the
/// surfaces as they are given; volume, topology and creases are theirs once equal points are joined and
/// triangles wound alike. `names` are those of the surfaces' files, for messages. The mesh has its
/// interfaces. Throws InputError as make_mesher_input() and find_patches() do, and UsageError where only the
/// outside is meshed.
SurfaceComparison compare_with_surfaces(const TetMesh& mesh, const std::vector<TriangleMesh>& surfaces,
                                        const std::vector<std::string>& names);

/// The lines that `check` prints, without their ends.
std::vector<std::string> comparison_lines(const SurfaceComparison& comparison);

/// Whether all is within the tolerance (input units), and what is not.
std::string tolerance_line(const SurfaceComparison& comparison, double tolerance);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/features/surface_patches.h"
#include "common/mesh/solid_shape.h"
#include "common/progress.h"
#include "common/reference_surface.h"
#include "common/sizes/size_field.h"
#include "common/tet_mesh.h"
#include "mesher/distance/vdb_files.h"
#include "mesher/domain/refinement_region.h"
#include "mesher/domain/regions.h"
#include "mesher/input/label_input.h"
#include "mesher/input/mesher_input.h"

namespace tetwright {

struct MesherOptions {
  int resolution = 128;   ///< finest cells along the longest side, 4 to 4096; ignored if voxel_size is given
  double voxel_size = 0;  ///< edge of a finest cell, input units; 0: determined by the resolution
  bool uniform = false;   ///< finest cells everywhere instead of an octree
  /// The error that a coarser cell may have at an interface, finest cells; 0: no coarser cells at interfaces.
  double adaptivity = 0.05;
  /// How many times cells are halved where walls and gaps of a surface are thin, 0 to 8; by default 3, and up
  /// to 8 where that adds fewer tets than the mesh has anyway.
  std::optional<int> max_refinement;
  /// Gaps of a surface that are narrower are closed, and walls that are thinner left out; input units.
  double min_gap = 0, min_thickness = 0;
  /// Where cells are halved besides, up to max_refinement times, as long as that at most doubles the mesh;
  /// input units.
  std::vector<RefinementRegion> refinement_regions;
  /// The largest cell that is wanted at a place, input units: cells inside, and with keep_outside all, are
  /// split until they are no larger, at surfaces down to a finest cell. Empty: any. Not with `uniform`.
  std::function<double(const Vec3&)> max_cell;
  /// Which edges of the surfaces stay sharp.
  FeatureAngle feature_angle;
  /// Mesh the outside too, in a box (that of the volume for labels), as the material `outside` of tag 0.
  bool keep_outside = false;
  /// Memory that the caller needs afterwards for each dense tet, bytes; meshing is refused if that does not
  /// fit.
  double later_bytes_per_tet = 0;
};

/// A material, or the outside, that is too thin for the cells in some places.
struct ThinPartReport {
  std::string name;  ///< empty for the outside: a gap
  std::size_t places = 0;
  Vec3 first = Vec3::Zero();  ///< one of the places, input units
  /// True if cells there were refined as far as possible: a sheet between two surfaces, or a thin label.
  bool refined = false;
};

/// Walls that are shown thicker than they are, since cells are too large for them.
struct ThickenedWallsReport {
  std::size_t points = 0;     ///< of the boundary that could not be moved back; the numbers of the worst:
  double offset = 0;          ///< of one side, input units
  double thickness = 0;       ///< that the wall has, input units
  Vec3 place = Vec3::Zero();  ///< input units
};

/// Gaps of a surface that were closed, or walls that were left out: connected ones together.
struct ClosedGapReport {
  std::string name;           ///< of the material
  bool gap = true;            ///< false: a wall that was left out
  bool on_purpose = false;    ///< within min_gap or min_thickness
  double width = 0;           ///< the smallest one, input units
  double area = 0;            ///< input units squared
  Vec3 place = Vec3::Zero();  ///< where it is smallest, input units
};

/// The solid that a material is meant to be.
struct ExpectedSolid {
  std::string name;
  MaterialTag tag = 0;
  SolidShape shape;  ///< input units
  /// True: by the surfaces as they were given. False: by the distances, where surfaces are open, intersect
  /// or meet those of other materials.
  bool by_surface = true;
  /// Shells smaller than this (input units cubed) say nothing: by the distances, those of less than a cell.
  double min_volume = 0;
  /// How far the volume may be off beside that, input units cubed: distances chamfer creases that the mesh
  /// has.
  double volume_slack = 0;
};

/// What meshing takes.
struct MesherEstimate {
  std::size_t tets = 0;   ///< of the dense mesh
  std::size_t bytes = 0;  ///< of memory at the peak, the program and its libraries among them
};

/// The patches of a surface.
struct FeatureReport {
  std::string name;      ///< of the material
  SurfacePatches found;  ///< without the list of the triangles
};

struct MesherReport {
  double cell_size = 0;               ///< edge of a finest cell (a voxel), input units
  int resolution = 0;                 ///< finest cells along the longest side
  int refinement = 0;                 ///< how many times cells were halved beyond that where sheets are thin
  std::size_t cells = 0;              ///< leaves of the octree
  std::size_t lattice_tets = 0;       ///< before cutting, without those far outside
  std::size_t isolated_vertices = 0;  ///< parts and cavities of a single lattice point, which are left out
  std::vector<ThinPartReport> thin_parts;
  ThickenedWallsReport thickened;
  std::vector<ClosedGapReport> closed_gaps;
  /// Tets that fill thin walls with parallel sides in good shapes, about; 0 without any.
  std::size_t filling_tets = 0;
  /// For each material of surfaces, in their order, what it is meant to be; not of layers and what they are
  /// cut from.
  std::vector<ExpectedSolid> expected;
  /// Of these the ones for which neither surfaces nor distances say it: cells were refined, or all of it is
  /// smaller than a cell.
  std::vector<std::string> unknown;
  std::vector<FeatureReport> features;  ///< of each surface, in their order
  CreaseCurves creases;                 ///< of all of them
  bool out_of_time = false;             ///< a deadline ended the search for cells small enough
  MesherEstimate estimate;              ///< from the input, see estimate_mesh()
  MesherEstimate lattice_estimate;      ///< from the regions of the lattice's points
  double seconds_sdf = 0, seconds_octree = 0, seconds_lattice = 0, seconds_move = 0, seconds_cut = 0;
};

class MaterialField;
class OutputFiles;

struct DenseMesh {
  TetMesh mesh;  ///< input units, with interface triangles; README.md lists its invariants
  std::shared_ptr<const MaterialField> field;  ///< the signed distances it was cut from
  /// What simplify() takes as its reference: the field, or where surfaces have creases or labels are cut off
  /// by their volume's border a surface that knows these and the field.
  std::shared_ptr<const ReferenceSurface> reference;
  /// The surfaces of all bodies as they were meshed, repaired; null for label volumes.
  std::shared_ptr<const TriangleMesh> surface;
  MesherReport report;
};

/// Writes a .vdb file with one level set for each material (not for the outside), named like it: the signed
/// distance from the material's interfaces, which is half the difference between its own distance and the
/// smallest other one. With `files` it appears when these are committed (see atomic_file.h). Throws
/// OutputError.
void write_fields(const MaterialField& field, const std::string& path, OutputFiles* files = nullptr);

/// What mesh_surfaces() would take, from samples of the surfaces, in some tenths of a second: mostly within
/// 25 %, see mesher/README.md. Throws UsageError and InputError as mesh_surfaces() does.
MesherEstimate estimate_mesh(const MesherInput& input, const MesherOptions& options);

/// Meshes surfaces: a dense tet mesh with the invariants of README.md, the same bytes for any number of
/// threads.
///
/// `progress` may be null. Throws UsageError (option values), InputError (too far from the origin for cells
/// this small, a material carved away entirely, a layer thicker than the body, a surface that is open and
/// encloses nothing), NothingToMeshError (no lattice point is inside), OutputError (the mesh would not fit in
/// memory), Interrupted. Time is proportional to the number of cells times the number of materials.
DenseMesh mesh_surfaces(const MesherInput& input, const MesherOptions& options, Progress* progress);

/// mesh_surfaces() with cells that bring the surfaces within half of `tolerance` (input units, above 0) of
/// the mesh: begins with cells of twice that size (where surfaces have creases, and may have flat faces, it
/// tries six times as large ones before) or, if they are smaller, those of `options`, measures at
/// vertices and centroids, and halves them up to max_refinement times where that is not enough; all become
/// smaller where that leaves more than most of the tolerance. Where cells of `options` are the smaller ones,
/// most of the tolerance is enough at once. What is reached in the end is for the caller to
/// find out. Throws as mesh_surfaces() does; UsageError where cells would be too small.
DenseMesh mesh_within(const MesherInput& input, MesherOptions options, double tolerance, Progress* progress);

/// Meshes a segmented volume: a dense tet mesh with the same invariants and a material for each label. Where
/// a label is thinner than two cells, cells are halved up to three times (not with `uniform`); the report
/// names what is still too thin. `options.voxel_size` should not exceed the smallest spacing unless a coarser
/// mesh is wanted.
///
/// `progress` may be null. Throws as mesh_surfaces() does; InputError where nothing is left of a label.
DenseMesh mesh_labels(const LabelInput& labels, const MesherOptions& options, Progress* progress);

/// What mesh_labels() would take, from the faces between voxels of different labels and the places where
/// labels are thin: mostly within 25 %. Throws as mesh_labels() does for options.
MesherEstimate estimate_mesh(const LabelInput& labels, const MesherOptions& options);

/// The smallest spacing, or the smallest possible cell size of a volume this long, input units.
double default_cell_size(const LabelInput& labels);

/// The cell size that gives about five dense tets for each of `target_tets`, at least a quarter of a voxel,
/// input units; where cells of two or four voxels still give 20 and save half of the tets, those. Of
/// `options` the cell size is not looked at. Throws UsageError for a target of 0.
double cell_size_for_target(const LabelInput& labels, std::size_t target_tets, const MesherOptions& options);

/// The resolution that gives about 40 dense tets for each of `target_tets`, as many as a simplifier needs to
/// have a choice, or 100 where surfaces have creases at this angle: at least 32, and at most some 20 million
/// dense tets. Throws UsageError for a target of 0, InputError as find_patches() does.
int resolution_for_target(const MesherInput& input, std::size_t target_tets, const FeatureAngle& angle);

/// Sets the resolution, at least that of `options`, and the fine places of `options` so that dense cells are
/// small enough for edges of the lengths that `target_length` asks for at the surfaces, or that are at most
/// `max_edge` long. `target_length` may be null, `max_edge` infinite.
void choose_cells_for_sizes(const MesherInput& input, const SizeField* target_length, double max_edge,
                            MesherOptions& options);

}  // namespace tetwright

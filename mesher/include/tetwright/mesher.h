// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tetwright/loop_times.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/mesher_input.h"
#include "tetwright/progress.h"
#include "tetwright/sheets.h"
#include "tetwright/sizes.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Request to halve the cells around a point.
struct RefinementRegion {
  Vec3 place;
  int halvings;
};

struct MesherOptions {
  int resolution = 128;   ///< finest cells along the longest side, 4 to 4096; ignored if voxel_size is given
  double voxel_size = 0;  ///< edge of a finest cell, input units; 0: determined by the resolution
  bool uniform = false;   ///< finest cells everywhere instead of an octree
  /// Maximum error of a coarser cell at an interface, finest cells; 0: no coarser cells at interfaces.
  double adaptivity = 0.05;
  /// How many times cells are halved where walls and gaps of a surface are thin, 0 to 8. Default: 3, and up
  /// to 8 if that at most doubles the number of tets.
  std::optional<int> max_refinement;
  /// Max number of tets that thin walls and gaps may add, or the number of tets without them if that is more
  /// (at least a million). 0: 8 million.
  double max_thin_tets = 0;
  /// Gaps of a surface narrower than this are closed, walls thinner than this omitted; input units.
  double min_gap = 0, min_thickness = 0;
  /// Additional points around which cells are halved, input units: up to max_refinement times, limited so
  /// that the number of tets at most doubles.
  std::vector<RefinementRegion> refinement_regions;
  /// The max cell size at a point, input units. Cells inside (with keep_outside, all cells) are split until
  /// they are no larger; at surfaces no further than to a finest cell. Empty: no limit. Not allowed with
  /// `uniform`.
  std::function<double(const Vec3&)> max_cell;
  /// Determines which edges of the surfaces stay sharp.
  FeatureAngle feature_angle;
  /// Also mesh the outside as the material `outside` with tag 0, up to a box; for labels, up to the border of
  /// the volume.
  bool keep_outside = false;
  /// Memory that the caller needs afterwards per dense tet, bytes. Meshing is refused if it would not be
  /// available.
  double later_bytes_per_tet = 0;
};

/// A material, or the outside, that is too thin for the cells somewhere.
struct ThinPartReport {
  std::string name;  ///< empty for the outside: a gap
  std::size_t places = 0;
  Vec3 first = Vec3::Zero();  ///< position of one of them, input units
  /// True if cells there were refined as far as possible: a sheet between two surfaces, or a thin label.
  bool refined = false;
};

/// Where a body's surface is less than a cell from a nearly parallel interface of labels, or from the border
/// of the volume, and cells there are still larger than the gap: tets there may be poor. Points of bodies,
/// one for each of the smallest cells.
struct NarrowLabelsReport {
  std::size_t places = 0;
  Vec3 first = Vec3::Zero();  ///< position of one of them, input units
  /// Likewise, where the border is nearer than the smallest cells beside bodies are wide.
  std::size_t at_border = 0;
  Vec3 first_at_border = Vec3::Zero();
};

/// Walls shown thicker than they are because the cells are too large. All but `points` describe the worst
/// point.
struct ThickenedWallsReport {
  std::size_t points = 0;     ///< boundary points that could not be moved back
  double offset = 0;          ///< distance of one side from the real surface, input units
  double thickness = 0;       ///< true thickness of the wall, input units
  Vec3 place = Vec3::Zero();  ///< input units
};

/// A connected gap of a surface that was closed, or a connected wall that was omitted.
struct ClosedGapReport {
  std::string name;           ///< of the material
  bool gap = true;            ///< false: an omitted wall
  bool on_purpose = false;    ///< within min_gap or min_thickness
  double width = 0;           ///< smallest width or thickness, input units
  double area = 0;            ///< input units squared
  Vec3 place = Vec3::Zero();  ///< where it is narrowest, input units
};

/// The expected solid of a material: certain if the surfaces have no flaw, otherwise an estimate.
struct ExpectedSolid {
  std::string name;
  MaterialTag tag = 0;
  SurfaceFlaw flaw = SurfaceFlaw::none;
  SolidShape shape;  ///< input units; derived from the surfaces as given, with a flaw from the distances
  /// A second estimate, derived from the surfaces if they are closed, manifold and joined where they meet.
  std::optional<SolidShape> by_flawed_surface = {};
  /// Shells smaller than this (input units cubed) are not significant; with a flaw, this is the volume of a
  /// cell.
  double min_volume = 0;
  /// Additional tolerance of the volume, input units cubed: distances chamfer creases that the mesh has.
  double volume_slack = 0;
};

/// A sheet inside bodies, without its parts that are in none.
struct ExpectedSheet {
  SheetStatistics shape;  ///< without the number of triangles
  std::string file;
  Vec3 place = Vec3::Zero();  ///< the centre of its largest triangle, input units
};

/// Expected size of a mesh, and memory needed to make it.
struct MesherEstimate {
  std::size_t tets = 0;   ///< of the dense mesh
  std::size_t bytes = 0;  ///< peak memory, including the program and its libraries
};

/// The patches of a surface, and the curves of its sharp edges.
struct FeatureReport {
  std::string name;      ///< of the material
  SurfacePatches found;  ///< without the list of the triangles
};

/// Faces between regions, or parts of one, that only meet in a curve.
struct StripReport {
  std::size_t faces = 0;
  Vec3 place = Vec3::Zero();  ///< of one of them, input units
};

/// The parts that bodies take of the labels that they carve, and of the outside.
struct CarvedLabels {
  std::map<MaterialOrOutside, double> voxels;  ///< by label; fractions at the surfaces of bodies
  /// Voxel faces between two labels with a side in a body, by pair; the outside or the smaller label first.
  std::map<std::pair<MaterialOrOutside, MaterialOrOutside>, std::uint64_t> faces;
};

struct MesherReport {
  double cell_size = 0;   ///< edge of a finest cell (a voxel), input units
  int resolution = 0;     ///< finest cells along the longest side
  int refinement = 0;     ///< how many times cells were halved beyond `resolution` where sheets are thin
  std::size_t cells = 0;  ///< leaves of the octree
  std::size_t lattice_tets = 0;       ///< before cutting, without tets far outside
  std::size_t isolated_vertices = 0;  ///< components and cavities of one lattice point, omitted
  std::vector<ThinPartReport> thin_parts;
  ThickenedWallsReport thickened;
  NarrowLabelsReport narrow_labels;  ///< of a segmented volume with bodies
  StripReport strips;
  std::vector<ClosedGapReport> closed_gaps;
  /// Approximate number of well-shaped tets that fill thin walls with parallel sides; 0 without any.
  std::size_t filling_tets = 0;
  /// The expected solids of materials given by surfaces, in their order. Omits layers and the body they are
  /// cut from.
  std::vector<ExpectedSolid> expected;
  /// Materials whose expected solid cannot be determined: the surfaces have a flaw, and cells were refined or
  /// all of the solid is smaller than a cell.
  std::vector<std::string> unknown;
  /// Bodies in a segmented volume that meet protected labels, so that their expected solid is unknown.
  std::vector<std::string> at_protected;
  /// Bodies that are in no label of the volume around them.
  std::vector<std::string> off_labels;
  std::vector<ExpectedSheet> sheets;    ///< inside bodies, as MesherInput::sheets
  std::vector<FeatureReport> features;  ///< of each surface, in their order
  CreaseCurves creases;                 ///< creases of all surfaces
  std::optional<CarvedLabels> carved;   ///< of a segmented volume with bodies
  bool out_of_time = false;             ///< a deadline ended the search for small enough cells
  MesherEstimate estimate;              ///< from the input, see estimate_mesh()
  MesherEstimate lattice_estimate;      ///< from the regions of the lattice points
  double seconds_sdf = 0, seconds_octree = 0, seconds_lattice = 0, seconds_move = 0, seconds_cut = 0;
  /// Loops of these stages, if the thread counts them.
  LoopTimes loops_sdf, loops_octree, loops_lattice, loops_move, loops_cut;
};

/// The faces of a mesh that close holes of the surfaces.
struct CapReport {
  struct Cap {
    std::string name;            ///< of its patch
    bool flat = false;           ///< the rim is flat, and so is the cap
    bool sharp = false;          ///< flat, and the rim is a crease
    bool named = false;          ///< its faces are a patch of the mesh
    std::size_t triangles = 0;   ///< 1 or more
    double area = 0;             ///< input units squared
    Vec3 centre = Vec3::Zero();  ///< mean of its faces, input units
    Vec3 normal = Vec3::Zero();  ///< unit, mean of its faces, out of the material of the smaller tag
  };
  std::vector<Cap> caps;     ///< those with faces; largest holes first
  std::size_t holes = 0;     ///< of the surfaces, also those without faces of their own
  std::size_t flat = 0;      ///< of these, closed in the plane of their rim
  double area = 0;           ///< of all caps on the boundary, input units squared
  double boundary_area = 0;  ///< of the boundary of all materials, input units squared
};

/// Which caps get a patch.
enum class CapNaming : std::uint8_t {
  sharp,  ///< those whose rim is a crease
  all     ///< also those whose rim is only a border between faces, which need not be smooth
};

/// Names the faces of meshes that close holes.
class CapFaces {
 public:
  virtual ~CapFaces() = default;
  /// Makes the faces of caps patches of `mesh.interfaces` that are named in `mesh.patch_groups`.
  /// \param mesh made from the surfaces, with its interfaces. With CapNaming::all nothing should change it
  ///   afterwards that keeps the borders of patches, as the simplifier does.
  virtual CapReport name(TetMesh& mesh, CapNaming naming) const = 0;
};

class MaterialField;
class OutputFiles;

struct DenseMesh {
  TetMesh mesh;  ///< input units, with interface triangles; README.md lists its invariants
  std::shared_ptr<const MaterialField> field;  ///< the signed distances it was cut from
  /// The reference for simplify(): the field. If surfaces have creases, or if labels are cut off by the
  /// border of the volume, a surface with these features and the field.
  std::shared_ptr<const ReferenceSurface> reference;
  /// The repaired surfaces of all bodies as meshed, if some of them meet without what others replace, and
  /// contacts once; null for label volumes.
  std::shared_ptr<const TriangleMesh> surface;
  /// Null if the surfaces have no holes. Patches of sharp flat caps are named already; the others are best
  /// named after simplifying, since their borders are no creases.
  std::shared_ptr<const CapFaces> caps;
  MesherReport report;
};

/// Writes a .vdb file with a level set for each material except the outside, named after it. Its values are
/// the signed distances from the material's interfaces: half the difference between the material's own
/// distance and the smallest other one.
/// \param files if given, the file appears when these are committed (see files.h)
/// \throws OutputError
void write_fields(const MaterialField& field, const std::string& path, OutputFiles* files = nullptr);

/// Estimates the result of mesh_surfaces() from samples of the surfaces, in a few tenths of a second and
/// mostly within 25 %; see mesher/README.md.
/// \throws UsageError and InputError as mesh_surfaces() does
MesherEstimate estimate_mesh(const MesherInput& input, const MesherOptions& options);

/// Meshes surfaces: a dense tet mesh with the invariants of README.md. The bytes do not depend on the number
/// of threads. Time is proportional to the number of cells times the number of materials.
///
/// \param progress may be null
/// \throws UsageError for option values out of range
/// \throws InputError for surfaces too far from the origin for cells this small, a material carved away
///   entirely, a layer thicker than the body, or a surface that is open and encloses nothing
/// \throws NothingToMeshError if no lattice point is inside
/// \throws OutputError if the mesh would not fit in memory
/// \throws Interrupted
DenseMesh mesh_surfaces(const MesherInput& input, const MesherOptions& options, Progress* progress);

/// mesh_surfaces() with cells that bring surface and mesh within half of `tolerance` of each other, measured
/// at vertices and centroids.
///
/// Starts with cells of twice the tolerance, or those of `options` if they are smaller. (Surfaces with
/// creases may have flat faces, so cells six times as large are tried first.) Cells where the distance is too
/// large are halved up to max_refinement times; if that leaves more than 80 % of the tolerance, all cells
/// become smaller. If the initial cells are those of `options`, 80 % suffices from the start. The caller must
/// measure the distance reached.
/// \param tolerance input units, above 0
/// \throws UsageError if cells would be too small, and as mesh_surfaces() does
DenseMesh mesh_within(const MesherInput& input, MesherOptions options, double tolerance, Progress* progress);

/// Meshes a segmented volume: a dense tet mesh with the invariants of mesh_surfaces() and a material for each
/// label. Where a label is thinner than two cells, cells are halved up to three times (not with `uniform`);
/// the report lists labels that are still too thin. `options.voxel_size` should not exceed the smallest
/// spacing unless a coarser mesh is intended.
///
/// \param progress may be null
/// \throws InputError if nothing is left of a label, and otherwise as mesh_surfaces() does
DenseMesh mesh_labels(const LabelInput& labels, const MesherOptions& options, Progress* progress);

/// Meshes a segmented volume with bodies in it: their surfaces are the interfaces there, with creases and
/// corners, and labels end at them. Cells are chosen and refined as by mesh_labels() at labels and as by
/// mesh_surfaces() at bodies; `options.voxel_size` is at most two voxels.
///
/// \param progress may be null
/// \throws Error in the cases of mesh_labels() and mesh_surfaces()
DenseMesh mesh_implanted(const ImplantedVolume& volume, const MesherOptions& options, Progress* progress);

/// Estimates the result of mesh_implanted(): that of both parts together.
MesherEstimate estimate_mesh(const ImplantedVolume& volume, const MesherOptions& options);

/// Estimates the result of mesh_labels() from the faces between voxels of different labels and the voxels
/// where labels are thin: mostly within 25 %.
/// \throws UsageError and InputError for options, as mesh_labels() does
MesherEstimate estimate_mesh(const LabelInput& labels, const MesherOptions& options);

/// The number of well-shaped tets that a material takes at the least.
struct MinTets {
  std::string name;
  double thickness = 0;      ///< its mean, twice the volume by the area, input units
  double tets = 0;           ///< approximate
  double tets_of_parts = 0;  ///< of these, those that the parts of its boundary take whatever the thickness
  std::size_t parts = 0;     ///< of its boundary
};

/// Estimates from volumes and areas alone how many tets each material takes so that hardly any is below 0.1
/// sr, thin ones the most: as many as have edges about as long as it is thick. A lower bound, within about
/// two for walls of one thickness, and several times too low for many sharp edges, junctions of many
/// materials and parts of different thickness (benchmarks/README.md, Smallest counts). Materials whose size
/// the surfaces leave open are left out. Takes a pass over the triangles or voxels.
std::vector<MinTets> min_tets(const MesherInput& input);
std::vector<MinTets> min_tets(const LabelInput& labels);
/// Estimates the bodies, and the labels as if there were none; labels that are mostly within the boxes of
/// bodies are left out.
std::vector<MinTets> min_tets(const ImplantedVolume& volume);

/// The smallest spacing, but at least the smallest possible cell size for a volume of this length; input
/// units.
double default_cell_size(const LabelInput& labels);

/// The cell size, input units, that gives about five dense tets per target tet; at least a quarter of a
/// voxel. Cells of four or two voxels are chosen if they still give 20 dense tets per target tet and save
/// half of the dense tets.
/// \param options its cell size is ignored
/// \throws UsageError for a target of 0
double cell_size_for_target(const LabelInput& labels, std::size_t target_tets, const MesherOptions& options);

double default_cell_size(const ImplantedVolume& volume);
double cell_size_for_target(const ImplantedVolume& volume, std::size_t target_tets,
                            const MesherOptions& options);

/// The resolution that gives about 40 dense tets per target tet, enough for the simplifier to have a choice,
/// or 100 if surfaces have creases at this angle. It is at least 32, and gives at most about 20 million dense
/// tets.
/// \throws UsageError for a target of 0
/// \throws InputError as find_patches() does
int resolution_for_target(const MesherInput& input, std::size_t target_tets, const FeatureAngle& angle);

/// Sets the resolution, max_cell and refinement regions of `options` so that dense cells are small enough for
/// the edge lengths required: `target_length`, and at most `max_edge`. With `max_edge` only, the resolution
/// of `options` is a lower bound; `target_length` replaces it.
/// \param target_length may be null
/// \param max_edge input units, may be infinite
void choose_cells_for_sizes(const MesherInput& input, const SizeField* target_length, double max_edge,
                            MesherOptions& options);

}  // namespace tetwright

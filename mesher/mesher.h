#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "common/progress.h"
#include "common/reference_surface.h"
#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"
#include "mesher/label_input.h"
#include "mesher/surface_input.h"

namespace tetwright {

struct MesherOptions {
  int resolution = 128;   ///< finest cells along the longest side, 4 to 4096; ignored if voxel_size is given
  double voxel_size = 0;  ///< edge of a finest cell, input units; 0: by resolution
  bool uniform = false;   ///< finest cells everywhere instead of an octree
  double adaptivity =
      0.05;  ///< how far a coarser cell may misplace an interface, finest cells; 0: never coarser
  /// Mesh the outside too, in a box, as the material `outside` of tag 0.
  bool keep_outside = false;
  /// What the caller will need for each dense tet afterwards, bytes: meshing is refused where that does not
  /// fit.
  double later_bytes_per_tet = 0;
};

/// A surface and the material it encloses.
struct MaterialSurface {
  std::string name;
  MaterialTag tag = 0;
  TriangleMesh surface;
  std::string file;  ///< for messages
};

/// A shell of the first surface's material, a material of its own.
struct MaterialLayer {
  std::string name;
  MaterialTag tag = 0;
  double thickness = 0;  ///< input units
};

/// Surfaces made ready for meshing.
struct PreparedInput {
  struct Body {
    std::string name;
    MaterialTag tag;
    std::string file;
    PreparedSurface surface;
  };
  std::vector<Body> bodies;           ///< later ones carve earlier ones
  std::vector<MaterialLayer> layers;  ///< of the first body, outermost first
  std::vector<InputFinding> findings;
  Vec3 low = Vec3::Zero(), high = Vec3::Zero();  ///< bounding box of all, input units
};

/// Checks and mends the surfaces, see prepare_surface(); with NestedRule::material what is enclosed becomes a
/// body of its own right after its encloser, with the smallest free tags from 1 up. Names must be different.
///
/// Throws InputError (see prepare_surface(); a size beyond what can be measured), UsageError (no surface, two
/// materials of one name or tag, a layer that is not thicker than 0, more than 60,000 materials).
PreparedInput prepare_input(std::vector<MaterialSurface> surfaces, std::vector<MaterialLayer> layers = {},
                            NestedRule nested = NestedRule::automatic);

/// A material, or the outside, that is too thin for the cells somewhere.
struct ThinPartReport {
  std::string name;  ///< empty for the outside: a gap
  std::size_t places = 0;
  Vec3 first = Vec3::Zero();  ///< one of them, input units
  /// True if it is a sheet between two surfaces for which the cells were refined as far as they go.
  bool refined = false;
};

struct MesherReport {
  double cell_size = 0;          ///< edge of a finest cell (a voxel), input units
  int resolution = 0;            ///< finest cells along the longest side
  int refinement = 0;            ///< how often cells were halved beyond that for thin sheets
  std::size_t cells = 0;         ///< leaves of the octree
  std::size_t lattice_tets = 0;  ///< before cutting, without those far outside
  std::size_t specks = 0;        ///< parts and cavities of a single lattice point, left out
  std::vector<ThinPartReport> thin_parts;
  double seconds_sdf = 0, seconds_octree = 0, seconds_lattice = 0, seconds_move = 0, seconds_cut = 0;
};

class MaterialField;

struct MeshedSurface {
  TetMesh mesh;  ///< input units, with interface triangles; README.md has the promises
  std::shared_ptr<const MaterialField> field;  ///< the signed distances it was cut from, a ReferenceSurface
  MesherReport report;
};

/// Writes the signed distances of each material (not of a kept outside) from where it meets others, which is
/// half of how much nearer the nearest other region is, as a level set of its name to a .vdb file. Throws
/// OutputError.
void write_fields(const MaterialField& field, const std::string& path);

/// What meshing would take.
struct MesherEstimate {
  std::size_t tets = 0;   ///< of the dense mesh, within a third or so; of several materials a factor of two
  std::size_t bytes = 0;  ///< largest memory while it is made, on the high side
};

/// Estimates from the surfaces' areas and volumes, without meshing. Throws UsageError and InputError as
/// mesh_surfaces() does.
MesherEstimate estimate_mesh(const PreparedInput& input, const MesherOptions& options);

/// Surfaces to a dense tet mesh with the invariants of README.md, the same bytes for any number of threads.
///
/// `progress` may be null. Throws UsageError (option values), InputError (too far from the origin for cells
/// this small, a material carved away entirely, a layer thicker than the body), NothingToMeshError (no
/// lattice point is inside), OutputError (the mesh would not fit in memory), Interrupted. Time grows with the
/// square of the number of materials where there are many: every body may carve every earlier one.
MeshedSurface mesh_surfaces(const PreparedInput& input, const MesherOptions& options, Progress* progress);

/// A segmented volume to a dense tet mesh with the same invariants: a material for each label. Where a label
/// is thinner than two cells, cells are halved, up to three times (not with `uniform`); what is still too
/// thin is named in the report. The finest cells otherwise are those of `options`, of which voxel_size should
/// be no larger than the smallest spacing unless something coarser is wanted.
///
/// `progress` may be null. Throws as mesh_surfaces() does; InputError where nothing is left of a label.
MeshedSurface mesh_labels(const PreparedLabels& labels, const MesherOptions& options, Progress* progress);

/// Estimates from the faces between voxels of different labels. Throws as mesh_labels() does for options.
MesherEstimate estimate_mesh(const PreparedLabels& labels, const MesherOptions& options);

/// One cell to the smallest spacing, as far as a volume so long can have.
double default_cell_size(const PreparedLabels& labels);

/// The largest cells that give about five dense tets or more for each of `target_tets`, at most those of
/// default_cell_size(), at least a quarter of a voxel. UsageError for a target of 0.
double cell_size_for_target(const PreparedLabels& labels, std::size_t target_tets);

/// The resolution that gives about 40 dense tets for each of `target_tets`, which is what a simplification
/// needs to have a choice: at least 32, no more than some 20 million dense tets. UsageError for a target of
/// 0.
int resolution_for_target(const PreparedInput& input, std::size_t target_tets);

}  // namespace tetwright

#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/label_volume.h"
#include "common/triangle_mesh.h"
#include "mesher/grid_frame.h"
#include "mesher/level_set.h"

namespace tetwright {

/// Files of OpenVDB (.vdb), which modellers and renderers exchange level sets in, and a segmented volume may
/// be in.

struct NamedSurface {
  std::string name;
  TriangleMesh surface;
};

/// The level sets of a file as surfaces where their values pass 0, in the file's world coordinates, wound
/// with the negative side inside; closed unless the level set itself breaks off. In the file's order.
///
/// A level set is a grid of floats whose class says so, or that has no class but a positive background and
/// values on both sides of 0. Other grids are passed over.
///
/// Throws InputError that begins with `file`: not a .vdb file, damaged or cut short, no level set in it (with
/// what there is), two of one name, one without a surface. Memory grows with the file.
std::vector<NamedSurface> read_level_sets(const std::string& file);

/// The labels of a file that has no level set but one grid of int32 or int64; nothing of one that has a level
/// set or no such grid. The bounding box of the active voxels becomes the volume; what is not active within
/// it has the value that OpenVDB gives it, the background as a rule. An index is a voxel's centre.
///
/// Throws InputError that begins with `file`: not a .vdb file, damaged or cut short, several such grids (with
/// their names), no active voxel, more than `most_voxels` voxels (2^31 or fewer), values beyond 32 bits, a
/// transform that isn't linear or can't be inverted. Memory grows with the file and 4 bytes for each voxel.
std::optional<LabelVolume> read_label_grid(const std::string& file,
                                           std::size_t most_voxels = std::size_t{1} << 31);

/// One level set to be written, as its leaves hand it out.
struct LevelSetSource {
  std::string name;
  /// All leaves with grid points within the band or beside the surface, in any order; what lies between them
  /// takes the sign of the leaves around it.
  std::vector<LeafOrigin> leaves;
  /// Signed distances of a leaf's grid points, finest cells, z fastest. Called concurrently.
  std::function<void(const LeafOrigin&, std::span<float, leaf_points>)> distances;
};

/// Writes a .vdb file of level sets, in input units, whole or not at all (see atomic_file.h); the same bytes
/// for any number of threads. Distances are true up to `band_cells` (finest cells, above 0) and cut off
/// there. Throws OutputError if it can't be written, and where the frame's cells are smaller than OpenVDB's
/// transforms allow (about 1.5e-5 input units).
void write_level_sets(const std::string& file, const GridFrame& frame, double band_cells,
                      std::span<const LevelSetSource> level_sets);

}  // namespace tetwright

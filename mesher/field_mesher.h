#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mesher/material_field.h"
#include "mesher/mesher.h"

namespace tetwright {

/// Runs the stages of meshing, tells about them and takes their times.
class Stages {
 public:
  explicit Stages(Progress* progress) : progress_(progress) {}
  void begin(const char* name) {
    if (progress_) {
      progress_->throw_if_cancelled();
      progress_->begin_stage(name);
    }
    start_ = std::chrono::steady_clock::now();
  }
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  Progress* progress() const { return progress_; }

 private:
  Progress* progress_;
  std::chrono::steady_clock::time_point start_;
};

inline constexpr int largest_resolution = 4096;  ///< finest cells along the longest side

/// What a mesh takes at least: the program and its libraries.
inline constexpr double bytes_at_least = 64e6;

/// Throws OutputError where a mesh would have more tets than can be numbered or take more memory than the
/// machine has.
void check_memory(const MesherEstimate& estimate);

/// The finest cell's edge, input units, of an input whose longest side and largest coordinate are given.
/// Throws UsageError for option values out of range, InputError (about `file`) where coordinates are too
/// large for cells so small.
double finest_cell_size(const MesherOptions& options, double longest_side, double largest_coordinate,
                        const std::string& file);

/// "%.6g", for messages.
std::string number_text(double value);

/// Cells that are to be smaller than they would be.
struct FinerCells {
  int refinement = 0;  ///< levels below a voxel
  /// To be split, by level of a lattice refined so, ascending.
  std::vector<std::vector<MortonKey>> cells;
  int coarsest_interface_level = 2;  ///< see OctreeOptions
};

/// Of a field all that follows, within the stage "octree": octree, lattice, moved points, cut tets. `finer`
/// says where cells are halved; `check_there` is handed a flag for each region, 0 for one that nothing is
/// left of, and throws if one is missed. Fills the rest of `report`. Throws what it throws, OutputError,
/// Interrupted.
MeshedSurface mesh_field(std::shared_ptr<const MaterialField> field, std::vector<MortonKey> interface_voxels,
                         FinerCells finer, const MesherOptions& options, MesherReport report, Stages& stages,
                         const std::function<void(const std::vector<std::uint8_t>&)>& check_there);

}  // namespace tetwright

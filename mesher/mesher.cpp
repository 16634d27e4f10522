#include "mesher/mesher.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "common/error.h"
#include "common/parallel.h"
#include "common/predicates.h"
#include "mesher/cutting.h"
#include "mesher/labelled_lattice.h"
#include "mesher/lattice.h"
#include "mesher/material_field.h"
#include "mesher/octree.h"
#include "mesher/point_mover.h"
#include "mesher/surface_input.h"

namespace tetwright {

namespace {

constexpr int smallest_resolution = 4;
constexpr int largest_resolution = 4096;
/// Cubes of input coordinates, as areas and volumes need them, must neither overflow nor vanish; single
/// precision fields hold 1e38.
constexpr double largest_coordinate = 1e50;
constexpr double smallest_in_cells = 1e-6;  ///< longest side of a surface that is looked at

/// Dense tets of an adaptive mesh for each squared finest cell of surface: they tend to the first number
/// where the solid is thick, and half of it fill one that is as thick as the second, in finest cells of
/// volume for each of surface. Fitted to scans at 32 to 256 cells: within 10 % there, up to twice too high
/// for flat ones.
constexpr double tets_per_area_thick = 29;
constexpr double half_full_thickness = 1.6;
/// Lattice tets along the surface that resolution_for_target() pays at most for each dense tet that is
/// wanted.
constexpr double most_lattice_per_dense = 4;
/// Dense tets of a uniform mesh for each finest cell of volume: the lattice has twelve.
constexpr double tets_per_volume_uniform = 12;
/// Peak memory for each dense tet, with the lattice outside; measured on scans, rounded up.
constexpr double bytes_per_tet = 140;
/// A uniform grid has leaves and lattice points all over its box.
constexpr double bytes_per_cell_uniform = 150;
/// What the program takes anyhow, libraries and the surface included.
constexpr double bytes_at_least = 64e6;

/// Dense tets for each tet that is wanted in the end: fewer leave the simplifier no choice, more take time.
constexpr double dense_per_target = 40;
constexpr double most_dense_tets = 20e6;
constexpr int smallest_target_resolution = 32;

/// Coordinates must resolve a finest cell this finely, or rounding them could turn a thin tet over.
constexpr double cell_share_of_rounding = 0x1p-20;

std::string number_text(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", v);
  return text;
}

double longest_side(const ClosedSurface& s) { return (s.high - s.low).maxCoeff(); }

ClosedSurface close_only_surface(const std::vector<MaterialSurface>& surfaces) {
  if (surfaces.size() != 1)
    throw UsageError("one surface can be meshed at a time, not " + std::to_string(surfaces.size()));
  ClosedSurface s = close_surface(surfaces[0].surface, surfaces[0].file);
  const double farthest = std::max(s.low.cwiseAbs().maxCoeff(), s.high.cwiseAbs().maxCoeff());
  if (farthest > largest_coordinate || longest_side(s) < 1 / largest_coordinate)
    throw InputError(
        surfaces[0].file, 0,
        "a size of " + number_text(longest_side(s)) + " with coordinates up to " + number_text(farthest) +
            " is beyond what can be measured safely; scale the surface to between 1e-50 and 1e50");
  return s;
}

void check_options(const MesherOptions& options) {
  if (options.voxel_size != 0 && !(options.voxel_size > 0 && std::isfinite(options.voxel_size)))
    throw UsageError("the voxel size must be a positive number, not " + number_text(options.voxel_size));
  if (options.voxel_size == 0 &&
      (options.resolution < smallest_resolution || options.resolution > largest_resolution))
    throw UsageError("the resolution must be from " + std::to_string(smallest_resolution) + " to " +
                     std::to_string(largest_resolution) + ", not " + std::to_string(options.resolution));
  if (!(options.adaptivity >= 0 && std::isfinite(options.adaptivity)))
    throw UsageError("the adaptivity must be 0 or more finest cells, not " + number_text(options.adaptivity));
}

/// The finest cell's edge in input units.
double cell_size(const ClosedSurface& s, const std::string& file, const MesherOptions& options) {
  check_options(options);
  const double longest = longest_side(s);
  const double h = options.voxel_size > 0 ? options.voxel_size : longest / options.resolution;
  if (longest > h * (largest_resolution + 0.5))
    throw UsageError("a voxel size of " + number_text(h) + " gives " + number_text(longest / h) +
                     " cells along the longest side; at most " + std::to_string(largest_resolution) +
                     " are possible");
  const double farthest = std::max(s.low.cwiseAbs().maxCoeff(), s.high.cwiseAbs().maxCoeff());
  if (farthest * 0x1p-52 > h * cell_share_of_rounding)
    throw InputError(
        file, 0,
        "with coordinates up to " + number_text(farthest) + " cells of " + number_text(h) +
            " cannot be told apart safely; move the surface nearer to the origin or take larger cells");
  return h;
}

MesherEstimate estimate(const ClosedSurface& s, double h, bool uniform) {
  const double area = s.area / (h * h), volume = std::max(0.0, s.volume) / (h * h * h);
  double tets = tets_per_volume_uniform * volume, bytes = bytes_at_least;
  if (uniform) {
    bytes += bytes_per_cell_uniform * ((s.high - s.low) / h).prod();
  } else if (area > 0) {
    const double thickness = volume / area;
    tets = tets_per_area_thick * area * thickness / (thickness + half_full_thickness);
  }
  return {static_cast<std::size_t>(tets),
          static_cast<std::size_t>(bytes + bytes_per_tet * std::max(tets, tets_per_area_thick * area / 2))};
}

void check_memory(const MesherEstimate& e) {
  const double machine =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (static_cast<double>(e.bytes) > machine)
    throw OutputError("the mesh would have about " + number_text(static_cast<double>(e.tets)) +
                      " tets and take " + number_text(static_cast<double>(e.bytes) / (1 << 30)) +
                      " GB, this machine has " + number_text(machine / (1 << 30)) +
                      " GB; use a lower resolution");
}

/// Runs the stages, tells about them and takes their times.
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

 private:
  Progress* progress_;
  std::chrono::steady_clock::time_point start_;
};

TetMesh to_input_units(CutMesh cut, const GridFrame& frame, const MaterialSurface& material) {
  TetMesh mesh;
  mesh.points = std::move(cut.points);
  parallel_for(0, mesh.points.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) mesh.points[i] = frame.to_input(mesh.points[i]);
  });
  mesh.tets = std::move(cut.tets);
  mesh.materials.assign(mesh.tets.size(), material.tag);
  if (!material.name.empty()) mesh.material_names[material.tag] = material.name;
  // The promise is about the coordinates as handed out; the frame leaves room for their rounding.
  parallel_for(0, mesh.tets.size(), 1 << 13, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Tet& t = mesh.tets[i];
      TETWRIGHT_CHECK(orient3d(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) >
                      0);
    }
  });
  return mesh;
}

}  // namespace

MesherEstimate estimate_mesh(const std::vector<MaterialSurface>& surfaces, const MesherOptions& options) {
  check_options(options);
  const ClosedSurface surface = close_only_surface(surfaces);
  return estimate(surface, cell_size(surface, surfaces[0].file, options), options.uniform);
}

MeshedSurface mesh_surfaces(const std::vector<MaterialSurface>& surfaces, const MesherOptions& options,
                            Progress* progress) {
  check_options(options);
  MeshedSurface result;
  MesherReport& report = result.report;
  Stages stages(progress);

  stages.begin("signed distances");
  const ClosedSurface surface = close_only_surface(surfaces);
  const MaterialSurface& material = surfaces[0];
  const NothingToMeshError nothing(
      material.file +
      ": the surface is smaller than a cell; use a higher resolution or a smaller "
      "voxel size");
  report.cell_size = cell_size(surface, material.file, options);
  // So much smaller that no lattice could be laid out in numbers that are still exact; a little smaller is
  // found out by the lattice itself.
  if (longest_side(surface) < report.cell_size * smallest_in_cells) throw nothing;
  report.resolution = static_cast<int>(std::ceil(longest_side(surface) / report.cell_size - 0.5));
  check_memory(estimate(surface, report.cell_size, options.uniform));
  const GridFrame frame = make_grid_frame(surface.low, surface.high, report.cell_size, options.uniform);
  const auto field = std::make_shared<const MaterialField>(
      surface, MaterialField::Material{material.name, material.tag}, frame, progress);
  report.seconds_sdf = stages.seconds();

  stages.begin("octree");
  const Octree octree = build_octree(*field, {options.uniform, options.adaptivity}, progress);
  report.cells = octree.size();
  report.seconds_octree = stages.seconds();

  stages.begin("lattice");
  LatticePoints points = lattice_points(octree);
  std::vector<float> distances = lattice_distances(points, *field);
  std::vector<Tet> tets = lattice_tets(octree, points, &distances);
  LabelledLattice lattice = label_lattice(std::move(points), std::move(distances), std::move(tets));
  report.lattice_tets = lattice.tets.size();
  report.specks = remove_specks(lattice);
  report.seconds_lattice = stages.seconds();

  stages.begin("moving points");
  move_points(lattice, *field, progress);
  report.seconds_move = stages.seconds();

  stages.begin("cutting");
  CutMesh cut = cut_lattice(lattice);
  if (cut.tets.empty()) throw nothing;
  result.mesh = to_input_units(std::move(cut), frame, material);
  report.seconds_cut = stages.seconds();

  result.reference = field;
  return result;
}

int resolution_for_target(const std::vector<MaterialSurface>& surfaces, std::size_t target_tets) {
  if (target_tets == 0) throw UsageError("the target must be at least one tet");
  const ClosedSurface surface = close_only_surface(surfaces);
  const double longest = longest_side(surface);
  const double dense = std::min(most_dense_tets, dense_per_target * static_cast<double>(target_tets));
  const auto enough = [&](int resolution) {
    const double h = longest / resolution;
    // A body thinner than a cell has few tets but a lattice as large as its surface: there is no end to
    // refining it.
    const double lattice = tets_per_area_thick * surface.area / (h * h);
    return static_cast<double>(estimate(surface, h, false).tets) >= dense ||
           lattice >= most_lattice_per_dense * dense;
  };
  // The smallest one that is enough; the estimate grows with the resolution.
  int low = smallest_target_resolution, high = largest_resolution;
  while (low < high) {
    const int middle = (low + high) / 2;
    if (enough(middle))
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

}  // namespace tetwright

#include "mesher/field_mesher.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ranges>

#include "common/error.h"
#include "common/interfaces.h"
#include "common/parallel.h"
#include "common/predicates.h"
#include "mesher/cutting.h"
#include "mesher/labelled_lattice.h"
#include "mesher/lattice.h"
#include "mesher/octree.h"
#include "mesher/point_mover.h"

namespace tetwright {

namespace {

constexpr int smallest_resolution = 4;
/// Numbers have 32 bits, and a lattice has some tets that no mesh keeps.
constexpr double most_tets = 2e9;
/// Tets of the lattice for each leaf of an octree.
constexpr double tets_per_leaf = 12;
/// Measured: 20 bytes on uniform cells, 27 where sheets are refined for, 31 to 36 elsewhere.
constexpr double bytes_per_lattice_tet = 40;
/// Coordinates must resolve a finest cell this finely, or rounding them could turn a thin tet over.
constexpr double cell_share_of_rounding = 0x1p-20;

/// True for a point on a face of the frame's box, which is the mesh's boundary where outside is kept.
bool on_box(const Vec3& point, const GridFrame& frame) {
  for (int k = 0; k < 3; ++k)
    if (point[k] == 0 || point[k] == frame.cells[k]) return true;  // exact: no point on the box moves
  return false;
}

TetMesh to_input_units(CutMesh cut, const MaterialField& field) {
  TetMesh mesh;
  const GridFrame& frame = field.frame();
  mesh.points = std::move(cut.points);
  std::vector<std::uint8_t> candidates = std::move(cut.on_interface);
  parallel_for(0, mesh.points.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (on_box(mesh.points[i], frame)) candidates[i] = 1;
      mesh.points[i] = frame.to_input(mesh.points[i]);
    }
  });
  mesh.tets = std::move(cut.tets);
  mesh.materials.resize(mesh.tets.size());
  parallel_for(0, mesh.tets.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) mesh.materials[i] = field.regions()[cut.regions[i]].tag;
  });
  std::vector<RegionIndex>().swap(cut.regions);
  for (const FieldRegion& region : field.regions())
    if (!region.name.empty()) mesh.material_names[region.tag] = region.name;
  // The promise is about the coordinates as handed out; the frame leaves room for their rounding.
  parallel_for(0, mesh.tets.size(), 1 << 13, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Tet& t = mesh.tets[i];
      TETWRIGHT_CHECK(orient3d(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) >
                      0);
    }
  });
  mesh.interfaces = find_interfaces(mesh, &candidates);
  return mesh;
}

/// A flag for each region of the field.
template <class Regions>
std::vector<std::uint8_t> regions_there(const MaterialField& field, const Regions& regions) {
  std::vector<std::uint8_t> there(field.regions().size(), 0);
  for (RegionIndex r : regions) there[r] = 1;
  return there;
}

}  // namespace

std::string number_text(double v) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", v);
  return text;
}

double finest_cell_size(const MesherOptions& options, double longest_side, double largest_coordinate,
                        const std::string& file) {
  if (options.voxel_size != 0 && !(options.voxel_size > 0 && std::isfinite(options.voxel_size)))
    throw UsageError("the voxel size must be a positive number, not " + number_text(options.voxel_size));
  if (options.voxel_size == 0 &&
      (options.resolution < smallest_resolution || options.resolution > largest_resolution))
    throw UsageError("the resolution must be from " + std::to_string(smallest_resolution) + " to " +
                     std::to_string(largest_resolution) + ", not " + std::to_string(options.resolution));
  if (!(options.adaptivity >= 0 && std::isfinite(options.adaptivity)))
    throw UsageError("the adaptivity must be 0 or more finest cells, not " + number_text(options.adaptivity));
  const double h = options.voxel_size > 0 ? options.voxel_size : longest_side / options.resolution;
  if (longest_side > h * (largest_resolution + 0.5))
    throw UsageError("a voxel size of " + number_text(h) + " gives " + number_text(longest_side / h) +
                     " cells along the longest side; at most " + std::to_string(largest_resolution) +
                     " are possible");
  if (largest_coordinate * 0x1p-52 > h * cell_share_of_rounding)
    throw InputError(file, 0,
                     "with coordinates up to " + number_text(largest_coordinate) + " cells of " +
                         number_text(h) +
                         " cannot be told apart safely; move it nearer to the origin or take larger cells");
  return h;
}

void check_memory(const MesherEstimate& e) {
  const double machine =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const double tets = static_cast<double>(e.tets), bytes = static_cast<double>(e.bytes);
  if (tets > most_tets)
    throw OutputError("the mesh would have about " + number_text(tets) + " tets, and at most " +
                      number_text(most_tets) + " can be numbered; use a lower resolution");
  if (bytes > machine)
    throw OutputError("the mesh would have about " + number_text(tets) + " tets and take " +
                      number_text(bytes / (1 << 30)) + " GB, this machine has " +
                      number_text(machine / (1 << 30)) + " GB; use a lower resolution");
}

MeshedSurface mesh_field(std::shared_ptr<const MaterialField> field, std::vector<MortonKey> interface_voxels,
                         FinerCells finer, const MesherOptions& options, MesherReport report, Stages& stages,
                         const std::function<void(const std::vector<std::uint8_t>&)>& check_there) {
  MeshedSurface result;
  Progress* progress = stages.progress();
  report.refinement = finer.refinement;
  if (finer.refinement > 0) field = field->refined(finer.refinement);
  Octree octree = build_octree(*field, {options.uniform, options.adaptivity, finer.coarsest_interface_level},
                               std::move(interface_voxels), finer.cells, progress);
  finer = {};
  report.cells = octree.size();
  // Thin sheets may have taken far more cells than the surface alone.
  const double lattice_tets_expected = tets_per_leaf * static_cast<double>(octree.size());
  check_memory({static_cast<std::size_t>(lattice_tets_expected),
                static_cast<std::size_t>(std::max(bytes_per_lattice_tet, options.later_bytes_per_tet) *
                                         lattice_tets_expected)});
  report.seconds_octree = stages.seconds();

  stages.begin("lattice");
  LatticePoints points = lattice_points(octree);
  std::vector<NearestRegion> regions = lattice_regions(points, *field);
  check_there(regions_there(*field, regions | std::views::transform(&NearestRegion::region)));
  TetList tets;
  if (options.keep_outside) {
    tets = lattice_tets(octree, points);
  } else {
    const std::vector<std::uint8_t> far = far_outside(regions, *field);
    tets = lattice_tets(octree, points, &far, field->refinement());
  }
  octree = {};
  LabelledLattice lattice = label_lattice(std::move(points), std::move(regions), std::move(tets),
                                          field->regions().size(), options.keep_outside, &report.specks);
  read_star_values(lattice, *field);
  report.lattice_tets = lattice.tets.size();
  report.seconds_lattice = stages.seconds();

  stages.begin("moving points");
  move_points(lattice, *field, progress);
  report.seconds_move = stages.seconds();

  stages.begin("cutting");
  lattice.stars.forget_tets();
  CutMesh cut = cut_lattice(std::move(lattice));
  // Moves and specks may have taken what had few lattice points.
  check_there(regions_there(*field, cut.regions));
  result.mesh = to_input_units(std::move(cut), *field);
  report.seconds_cut = stages.seconds();
  if (progress) progress->throw_if_cancelled();

  result.field = std::move(field);
  result.report = std::move(report);
  return result;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "mesher/field_mesher.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>
#include <string>

#include "common/geometry/predicates.h"
#include "common/message_text.h"
#include "mesher/cut/beyond_border.h"
#include "mesher/cut/cut_off_surface.h"
#include "mesher/cut/cutting.h"
#include "mesher/cut/thin_wall_recovery.h"
#include "mesher/cut/vertex_snapping.h"
#include "mesher/lattice/labelled_lattice.h"
#include "mesher/lattice/lattice.h"
#include "mesher/lattice/octree.h"
#include "mesher/mesh_estimate.h"
#include "mesher/sizing/sized_cells.h"
#include "mesher/thin/local_thickness.h"
#include "mesher/tuning/cell_tuning.h"
#include "mesher/tuning/domain_tuning.h"
#include "mesher/tuning/estimate_tuning.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Sets the patches 1 to 6 of the faces on the sides of a volume, also of those between a label and a body
/// that continues beyond.
/// \param sides side_planes() of each point
void number_box_patches(std::vector<InterfaceTriangle>& interfaces, const std::vector<std::uint8_t>& sides) {
  parallel_for(0, interfaces.size(), CellGrains::elements, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      InterfaceTriangle& t = interfaces[i];
      const unsigned common = sides[t.ids[0]] & sides[t.ids[1]] & sides[t.ids[2]];
      if (common) t.patch = static_cast<std::uint16_t>(1 + std::countr_zero(common));
    }
  });
}

/// Names of the patches on the sides of a box, by the coordinate along which each side's axis runs most.
/// \param axes of the box, as columns
std::array<std::string, 6> border_names(const Eigen::Matrix3d& axes) {
  std::array<std::string, 6> names;
  Eigen::Matrix3d left = axes.colwise().normalized().cwiseAbs();
  for (int named = 0; named < 3; ++named) {
    int coordinate = 0, axis = 0;
    left.maxCoeff(&coordinate, &axis);
    left.row(coordinate).setConstant(-1);
    left.col(axis).setConstant(-1);
    for (const int upper : {0, 1}) {
      const bool max = (upper == 1) == (axes(coordinate, axis) > 0);
      const int face = 2 * axis + upper;
      names[static_cast<std::size_t>(face)] =
          std::string("border_") + "xyz"[coordinate] + (max ? "_max" : "_min");
    }
  }
  return names;
}

TetMesh to_input_units(CutMesh cut, const MaterialField& field) {
  TetMesh mesh;
  const GridFrame& frame = field.frame();
  const CellBox volume = frame.volume();
  mesh.points = std::move(cut.points);
  std::vector<std::uint8_t> candidates = std::move(cut.on_interface);
  std::vector<std::uint8_t> sides(mesh.points.size());
  parallel_for(0, mesh.points.size(), CellGrains::elements, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      sides[i] = static_cast<std::uint8_t>(side_planes(mesh.points[i], volume));
      if (sides[i]) candidates[i] = 1;
      mesh.points[i] = frame.to_input(mesh.points[i]);
    }
  });
  mesh.tets = std::move(cut.tets);
  mesh.materials.resize(mesh.tets.size());
  parallel_for(0, mesh.tets.size(), CellGrains::elements, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) mesh.materials[i] = field.regions()[cut.regions[i]].tag;
  });
  std::vector<RegionIndex>().swap(cut.regions);
  for (const FieldRegion& region : field.regions())
    if (!region.name.empty()) mesh.material_names[region.tag] = region.name;
  // Tets must be positive in the final coordinates; finest_cell_size() leaves room for rounding.
  parallel_for(0, mesh.tets.size(), CellGrains::tets, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Tet& t = mesh.tets[i];
      TETWRIGHT_CHECK(orient3d(mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]], mesh.points[t[3]]) >
                      0);
    }
  });
  mesh.interfaces = find_interfaces(mesh, &candidates);
  if (field.volume()) number_box_patches(mesh.interfaces, sides);
  return mesh;
}

/// Likewise.
std::vector<std::uint8_t> regions_there(const MaterialField& field,
                                        const std::vector<NearestRegion>& regions) {
  std::vector<std::uint8_t> there(field.regions().size(), 0);
  for (const NearestRegion& r : regions) there[r.region] = 1;
  return there;
}

/// The estimate from the regions at the centres of leaves. Nearly exact, apart from cuts between two
/// materials, which it ignores.
MesherEstimate estimate_from_lattice(const Octree& octree, const LatticePoints& points,
                                     const std::vector<NearestRegion>& regions, const MemoryModel& memory,
                                     const MesherOptions& options) {
  std::size_t inside = 0, near = 0, beside = 0;
  for (std::size_t i = 0; i < octree.size(); ++i) {
    const NearestRegion& centre = regions[points.leaf_centres[i]];
    const double leaves_away = std::ldexp(centre.margin, -octree.leaf(i).level);
    if (centre.region != outside_region)
      ++inside;
    else if (leaves_away < 0.5)
      ++near;
    else if (leaves_away < 1)
      ++beside;
  }
  const auto in = static_cast<double>(inside), out = static_cast<double>(near);
  const auto leaves = static_cast<double>(octree.size());
  double dense = EstimateTuning::Leaves::dense_inside * in + EstimateTuning::Leaves::dense_near * out;
  double lattice = EstimateTuning::Leaves::lattice_inside * in + EstimateTuning::Leaves::lattice_near * out +
                   EstimateTuning::Leaves::lattice_beside * static_cast<double>(beside);
  if (options.keep_outside) {
    lattice =
        (options.uniform ? EstimateTuning::Leaves::kept_uniform : EstimateTuning::Leaves::kept_adaptive) *
        leaves;
    dense = EstimateTuning::Leaves::kept_dense * lattice;
  }
  return estimate_of({leaves, lattice, dense}, memory, options);
}

}  // namespace

double finest_cell_size(const MesherOptions& options, double longest_side, double max_coordinate,
                        const std::string& file) {
  if (options.voxel_size != 0 && !(options.voxel_size > 0 && std::isfinite(options.voxel_size)))
    throw UsageError("the voxel size must be a positive number, not " + short_number(options.voxel_size));
  if (options.voxel_size == 0 && (options.resolution < DomainTuning::Frames::min_resolution ||
                                  options.resolution > DomainTuning::Frames::max_resolution))
    throw UsageError("the resolution must be from " + std::to_string(DomainTuning::Frames::min_resolution) +
                     " to " + std::to_string(DomainTuning::Frames::max_resolution) + ", not " +
                     std::to_string(options.resolution));
  if (!(options.adaptivity >= 0 && std::isfinite(options.adaptivity)))
    throw UsageError("the adaptivity must be 0 or more finest cells, not " +
                     short_number(options.adaptivity));
  const double h = options.voxel_size > 0 ? options.voxel_size : longest_side / options.resolution;
  if (longest_side > h * (DomainTuning::Frames::max_resolution + 0.5))
    throw UsageError("a voxel size of " + short_number(h) + " gives " + short_number(longest_side / h) +
                     " cells along the longest side; at most " +
                     std::to_string(DomainTuning::Frames::max_resolution) + " are possible");
  if (max_coordinate * 0x1p-52 > h * DomainTuning::Frames::share_of_rounding)
    throw InputError(
        file, 0,
        "with coordinates up to " + short_number(max_coordinate) + " cells of " + short_number(h) +
            " cannot be distinguished safely; move it nearer to the origin or take larger cells");
  return h;
}

int max_possible_refinement(const GridFrame& frame, double max_coordinate) {
  const double cells = *std::max_element(frame.cells.begin(), frame.cells.end());
  int depth = 0;
  while (depth < max_wall_refinement && std::ldexp(cells, depth + 1) <= DomainTuning::Frames::max_cells &&
         max_coordinate * 0x1p-52 <=
             std::ldexp(frame.cell_size, -depth - 1) * DomainTuning::Frames::share_of_rounding)
    ++depth;
  return depth;
}

MesherEstimate estimate_of(const MeshSize& size, const MemoryModel& memory, const MesherOptions& options) {
  const double lattice = options.uniform ? EstimateTuning::Memory::per_uniform_lattice_tet * size.lattice +
                                               EstimateTuning::Memory::per_uniform_leaf * size.leaves
                                         : memory.per_lattice_tet * size.lattice;
  const double bytes = EstimateTuning::Memory::program + std::max({memory.before, memory.beside + lattice,
                                                                   options.later_bytes_per_tet * size.dense});
  constexpr double max_count = 1e18;  // fits in 64 bits
  return {static_cast<std::size_t>(std::min(size.dense, max_count)),
          static_cast<std::size_t>(std::min(bytes, max_count))};
}

void validate_estimate(const MesherEstimate& estimate) {
  const double tets = static_cast<double>(estimate.tets);
  if (tets > DomainTuning::Frames::max_tets)
    throw OutputError("the mesh would have about " + short_number(tets) + " tets, and at most " +
                      short_number(DomainTuning::Frames::max_tets) +
                      " can be numbered; use a lower resolution");
  require_memory(static_cast<double>(estimate.bytes), "a mesh of about " + short_number(tets) + " tets",
                 "use a lower resolution");
}

ThickenedWallsReport thickened_report(const ThickenedWalls& left, const GridFrame& frame) {
  if (left.points == 0) return {};
  return {left.points, left.max_offset * frame.cell_size, left.thickness * frame.cell_size,
          frame.to_input(left.place)};
}

std::vector<std::uint8_t> regions_there(const MaterialField& field, const std::vector<RegionIndex>& regions) {
  std::vector<std::uint8_t> there(field.regions().size(), 0);
  for (const RegionIndex r : regions) there[r] = 1;
  return there;
}

std::shared_ptr<const ReferenceSurface> reference_of(const TetMesh& mesh,
                                                     std::shared_ptr<const MaterialField> field) {
  const bool cut_off =
      field->volume() && std::any_of(mesh.interfaces.begin(), mesh.interfaces.end(),
                                     [](const InterfaceTriangle& t) { return t.patch != 0; });
  if (cut_off) return std::make_shared<CutOffSurface>(mesh, std::move(field));
  return field;
}

void name_border_patches(const std::vector<InterfaceTriangle>& faces, const GridFrame& frame, TetMesh& mesh) {
  const std::array<std::string, 6> names = border_names(frame.axes);
  std::array<std::set<MaterialTag>, 6> materials;
  std::set<InterfacePatch> patches;
  for (const InterfaceTriangle& t : faces) {
    if (t.patch == 0 || t.other) continue;
    TETWRIGHT_CHECK(t.patch <= names.size());
    if (patches.insert({t.pair(), t.patch}).second) materials[t.patch - 1u].insert(t.material);
  }
  for (const InterfacePatch& patch : patches) {
    const std::size_t side = patch.second - 1u;
    const auto name = mesh.material_names.find(patch.first.first);
    const std::string material =
        name != mesh.material_names.end() ? name->second : std::to_string(patch.first.first);
    mesh.patch_groups[patch] = {0, materials[side].size() == 1 ? names[side] : material + ":" + names[side]};
  }
}

void set_mesh(CutMesh cut, std::shared_ptr<const MaterialField> field, DenseMesh& result) {
  result.mesh = to_input_units(std::move(cut), *field);
  if (field->volume()) name_border_patches(result.mesh.interfaces, field->frame(), result.mesh);
  result.reference = reference_of(result.mesh, field);
  result.field = std::move(field);
}

FieldMesh mesh_field(std::shared_ptr<const MaterialField> field, std::vector<MortonKey> interface_voxels,
                     RefinementRegions finer, const MesherOptions& options, const MemoryModel& memory,
                     MesherReport report, Stages& stages,
                     const std::function<void(const std::vector<std::uint8_t>&)>& validate_regions) {
  FieldMesh made;
  DenseMesh& result = made.dense;
  Progress* progress = stages.progress();
  if (options.max_cell && !options.uniform)
    finer =
        combine(std::move(finer), find_sized_cells(*field, options.max_cell, options.keep_outside, progress));
  report.refinement = finer.refinement;
  if (finer.refinement > 0) field = field->refined(finer.refinement);
  Octree octree = build_octree(*field, {options.uniform, options.adaptivity, finer.coarsest_interface_level},
                               std::move(interface_voxels), finer.cells, progress);
  finer = {};
  report.cells = octree.size();
  // Thin sheets may require far more cells than the surface alone.
  require_memory(
      EstimateTuning::Memory::program + EstimateTuning::Memory::per_leaf * static_cast<double>(octree.size()),
      "an octree of " + std::to_string(octree.size()) + " leaves", "use a lower resolution");
  report.seconds_octree = stages.seconds();
  report.loops_octree = stages.loops();

  stages.begin("lattice");
  LatticePoints points = lattice_points(octree);
  stages.throw_if_stopped();
  std::vector<NearestRegion> regions = lattice_regions(points, *field);
  clear_far_beyond(*field, points, regions);
  validate_regions(regions_there(*field, regions));
  stages.throw_if_stopped();
  report.lattice_estimate = estimate_from_lattice(octree, points, regions, memory, options);
  validate_estimate(report.lattice_estimate);
  TetList tets;
  if (options.keep_outside) {
    tets = lattice_tets(octree, points);
  } else {
    const std::vector<std::uint8_t> far = far_outside(regions, *field);
    tets = lattice_tets(octree, points, &far, field->refinement());
  }
  octree = {};
  stages.throw_if_stopped();
  std::shared_ptr<const SheetedField> sheeted;
  if (field->sheets()) sheeted = SheetedField::of_points(field, points.positions, regions);
  const MaterialField& divided = sheeted ? *sheeted : *field;
  LabelledLattice lattice =
      label_lattice(std::move(points), std::move(regions), std::move(tets), divided.regions().size(),
                    options.keep_outside, &report.isolated_vertices);
  stages.throw_if_stopped();
  if (sheeted) mark_rims(lattice, *sheeted);
  read_star_values(lattice, divided);
  report.lattice_tets = lattice.tets.size();
  report.seconds_lattice = stages.seconds();
  report.loops_lattice = stages.loops();

  stages.begin("moving points");
  snap_vertices(lattice, divided, progress);
  report.seconds_move = stages.seconds();
  report.loops_move = stages.loops();

  stages.begin("cutting");
  lattice.stars.forget_tets();
  CutMesh cut = cut_lattice(std::move(lattice));
  drop_beyond_border(*field, cut);
  stages.throw_if_stopped();
  // Moves may have removed a region with few lattice points, or it was an isolated vertex.
  validate_regions(
      regions_there(*field, sheeted ? regions_without_sheets(cut.regions, *sheeted) : cut.regions));
  if (const WallChanges* walls = field->wall_changes()) {
    std::shared_ptr<const MaterialField> as_is = walls->with_true_walls();
    // Points on sheets next to thin walls stay.
    std::vector<std::uint8_t> with_sheets = cut.on_interface;
    if (field->volume()) cut.on_interface = on_interface_off_border(*field, cut);
    if (sheeted) cut.on_interface = on_interfaces_without_sheets(cut, *sheeted);
    report.thickened = thickened_report(recover_thin_walls(cut, *walls, *as_is), field->frame());
    cut.on_interface = std::move(with_sheets);
    field = std::move(as_is);
  }
  if (sheeted) {
    std::vector<RegionIndex> materials = regions_without_sheets(cut.regions, *sheeted);
    made.parts = {sheeted, std::move(cut.regions)};
    cut.regions = std::move(materials);
  }
  set_mesh(std::move(cut), std::move(field), result);
  report.seconds_cut = stages.seconds();
  report.loops_cut = stages.loops();
  stages.throw_if_stopped();
  result.report = std::move(report);
  return made;
}

}  // namespace tetwright

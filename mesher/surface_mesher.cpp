// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesher.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "common/message_text.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/cut/complex_patches.h"
#include "mesher/cut/crease_fitting.h"
#include "mesher/cut/strip_collapse.h"
#include "mesher/cut/thin_wall_recovery.h"
#include "mesher/distance/body_field.h"
#include "mesher/distance/field_solid.h"
#include "mesher/distance/field_thickness.h"
#include "mesher/distance/material_field.h"
#include "mesher/field_mesher.h"
#include "mesher/input/expected_solids.h"
#include "mesher/mesh_estimate.h"
#include "mesher/tuning/cell_tuning.h"
#include "mesher/tuning/complex_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// True if all points are on the plane of the largest triangle.
bool is_flat(const RepairedSurface& surface) {
  Vec3 normal = Vec3::Zero(), on_plane = Vec3::Zero();
  Box3 box;
  for (const Triangle& t : surface.triangles) {
    const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
    for (const Vec3& p : {a, b, c}) box.add(p);
    const Vec3 n = (b - a).cross(c - a);
    if (n.squaredNorm() <= normal.squaredNorm()) continue;
    normal = n;
    on_plane = a;
  }
  const double slack = CellTuning::Patches::flat_surface * normal.norm() * (box.high - box.low).norm();
  return std::all_of(surface.triangles.begin(), surface.triangles.end(), [&](const Triangle& t) {
    return std::all_of(t.begin(), t.end(),
                       [&](Index p) { return std::fabs(normal.dot(surface.points[p] - on_plane)) <= slack; });
  });
}

/// Throws InputError if a surface that vanished from the mesh is flat or not closed.
void validate_encloses(const MesherInput::Body& body) {
  if (is_flat(body.surface))
    throw InputError(body.file, 0,
                     "the surface lies in a plane and encloses nothing; give the surface of a solid");
  if (body.surface.closed < body.surface.triangles.size())
    throw InputError(
        body.file, 0,
        "the surface is not closed and encloses nothing that cells of this size can resolve; close "
        "its holes, or use a higher resolution if it is closed but for small ones");
}

/// Throws an error that names the vanished material and a remedy.
void validate_materials_left(const MesherInput& input, const MaterialField& field,
                             const std::vector<std::uint8_t>& there) {
  if (std::count(there.begin() + 1, there.end(), 1) == 0) {
    validate_encloses(input.bodies[0]);
    throw NothingToMeshError(
        input.bodies[0].file +
        ": the surface is smaller than a cell; use a higher resolution or a smaller voxel size");
  }
  for (std::size_t r = 1; r < there.size(); ++r) {
    if (there[r]) continue;
    const FieldRegion& region = field.regions()[r];
    const auto body = std::find_if(input.bodies.begin(), input.bodies.end(),
                                   [&](const MesherInput::Body& b) { return b.tag == region.tag; });
    if (body == input.bodies.end())
      throw InputError(
          input.bodies[0].file, 0,
          "nothing is left of the layer '" + region.name +
              "': it is thinner than the smallest cells or later surfaces cover it; use a higher "
              "resolution, or list the surfaces that enclose it first");
    if (body == input.bodies.begin() && !input.layers.empty())
      throw InputError(body->file, 0,
                       "nothing is left of '" + region.name +
                           "' inside its layers; make the layers thinner or use a higher resolution");
    validate_encloses(*body);
    throw InputError(
        body->file, 0,
        "nothing is left of the material '" + region.name +
            "': it is smaller than a cell or later surfaces cover it; list the outermost surface "
            "first, or use a higher resolution");
  }
}

/// Determines the expected solids: from the surfaces if they have no flaw, else from the distances if the
/// voxels resolve all of them.
void expect_materials(const MesherInput& input, const MaterialField& field,
                      const std::vector<MortonKey>& interface_voxels, bool refined, MesherReport& report) {
  std::vector<std::optional<SurfaceSolid>> solids = expected_solids(input);
  const double cell = field.voxels().cell_size, cell_volume = cell * cell * cell;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const MesherInput::Body& body = input.bodies[i];
    if (!solids[i]) continue;
    if (solids[i]->flaw == SurfaceFlaw::none) {
      report.expected.push_back({.name = body.name, .tag = body.tag, .shape = std::move(*solids[i]->shape)});
      continue;
    }
    const auto region = std::find_if(field.regions().begin() + 1, field.regions().end(),
                                     [&](const FieldRegion& r) { return r.tag == body.tag; });
    SolidShape solid;
    if (!refined)
      solid =
          field_solid(field, interface_voxels, static_cast<RegionIndex>(region - field.regions().begin()));
    if (std::none_of(solid.shells.begin(), solid.shells.end(),
                     [&](const SolidShell& s) { return s.volume >= cell_volume; }))
      report.unknown.push_back(body.name);
    else
      report.expected.push_back({.name = body.name,
                                 .tag = body.tag,
                                 .flaw = solids[i]->flaw,
                                 .shape = std::move(solid),
                                 .by_flawed_surface = std::move(solids[i]->shape),
                                 .min_volume = cell_volume});
  }
}

/// Closing and omitting measure cell by cell around each point of the surface.
void validate_limits(const MesherOptions& options, double cell) {
  for (const auto& [name, limit] :
       {std::pair("gap", options.min_gap), std::pair("thickness", options.min_thickness)}) {
    if (!(limit >= 0 && std::isfinite(limit)))
      throw UsageError("the min " + std::string(name) + " must be 0 or more, not " + short_number(limit));
    if (limit > CellTuning::WallBudget::max_limit_cells * cell)
      throw UsageError("a min " + std::string(name) + " of " + short_number(limit) + " is " +
                       short_number(limit / cell) + " finest cells; at most " +
                       short_number(CellTuning::WallBudget::max_limit_cells) +
                       " are possible: use a lower resolution or a smaller min " + name);
  }
  if (options.max_refinement &&
      !(*options.max_refinement >= 0 && *options.max_refinement <= max_wall_refinement))
    throw UsageError("the max refinement must be from 0 to " + std::to_string(max_wall_refinement) +
                     ", not " + std::to_string(*options.max_refinement));
}

/// Size of the cells that resolve a body's patches. Bodies that are thin everywhere get smaller cells.
double patch_cell(const RepairedSurface& surface, const MesherOptions& options, double cell) {
  if (options.uniform || surface.closed < surface.triangles.size()) return cell;
  const double mean_thickness = 2 * std::abs(surface.volume) / surface.area;
  const int halvings = options.max_refinement.value_or(max_wall_refinement);
  return std::clamp(mean_thickness, std::ldexp(cell, -halvings), cell);
}

/// The surfaces of all bodies, concatenated.
TriangleMesh all_surfaces(const MesherInput& input) {
  TriangleMesh all;
  for (const MesherInput::Body& body : input.bodies) {
    const auto first = static_cast<Index>(all.points.size());
    all.points.insert(all.points.end(), body.surface.points.begin(), body.surface.points.end());
    for (const Triangle& t : body.surface.triangles)
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return all;
}

/// The patches of all bodies.
std::vector<SurfacePatches> patches_of(const MesherInput& input, const MesherOptions& options, double cell) {
  constexpr std::size_t max_patches = 0xfffe;  // one more is for faces that lie on no surface
  std::size_t count = 0;
  std::vector<SurfacePatches> patches;
  for (const MesherInput::Body& body : input.bodies) {
    const RepairedSurface& surface = body.surface;
    const double shown = patch_cell(surface, options, cell);
    PatchOptions patch_options{options.feature_angle, CellTuning::Patches::min_area * shown * shown};
    // Intersections of parts are creases that are not edges of the surface.
    const bool intersecting =
        surface.intersects_itself && options.feature_angle.rule != FeatureAngle::Rule::off;
    if (intersecting) patch_options.angle.rule = FeatureAngle::Rule::off;
    SurfacePatches found =
        find_patches(surface.points, surface.triangles, patch_options, surface.groups, body.file);
    if (intersecting) found.verdict = SurfacePatches::Verdict::intersecting;
    count += found.count;
    if (count > max_patches)
      throw InputError(
          body.file, 0,
          "the surfaces have more than " + std::to_string(max_patches) +
              " patches between sharp edges; use a larger --feature-angle, or --feature-angle off");
    patches.push_back(std::move(found));
  }
  return patches;
}

/// The patches of the sheets inside bodies.
SheetPatches patches_of_sheets(const MesherInput& input, const MesherOptions& options, double cell) {
  SheetPatches result;
  if (!input.complex || input.complex->sheets.empty()) return result;
  const LabelledComplex& complex = *input.complex;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> groups;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> numbers;
  for (const LabelledComplex::SheetFace& f : complex.sheets) {
    triangles.push_back(f.ids);
    groups.push_back(
        numbers.try_emplace({f.component, f.region, f.sheet}, static_cast<std::uint32_t>(numbers.size()))
            .first->second);
  }
  result.found = find_patches(complex.points, triangles,
                              {options.feature_angle, CellTuning::Patches::min_area * cell * cell}, groups,
                              input.sheets[0].file);
  result.continued = ComplexTuning::Sheets::continued * cell;
  return result;
}

/// The sheets inside bodies.
std::vector<ExpectedSheet> expected_sheets(const MesherInput& input) {
  if (!input.complex || input.complex->sheets.empty()) return {};
  const LabelledComplex& complex = *input.complex;
  std::vector<ExpectedSheet> expected;
  for (std::uint32_t k = 0; k < input.sheets.size(); ++k) {
    TetMesh mesh{.points = complex.points};
    ExpectedSheet sheet{.file = input.sheets[k].file};
    mesh.patch_groups[{{1, 1}, 0}] = input.sheets[k].group;
    double largest = -1;
    for (const LabelledComplex::SheetFace& f : complex.sheets) {
      if (f.sheet != k) continue;
      mesh.interfaces.push_back({f.ids, 1, 1});
      const auto& [a, b, c] = f.ids;
      const Vec3 &p = mesh.points[a], &q = mesh.points[b], &r = mesh.points[c];
      const double size = (q - p).cross(r - p).norm();
      if (size > largest) largest = size, sheet.place = (p + q + r) / 3;
    }
    sheet.shape = sheet_statistics(mesh).front();
    sheet.shape.triangles = 0;
    expected.push_back(std::move(sheet));
  }
  return expected;
}

/// Drops the creases of a body except the borders of groups.
void give_up_creases(const MesherInput::Body& body, SurfacePatches& found) {
  if (!found.any()) return;
  PatchOptions options;
  options.angle.rule = FeatureAngle::Rule::off;
  found = find_patches(body.surface.points, body.surface.triangles, options, body.surface.groups, body.file);
  found.verdict = SurfacePatches::Verdict::meeting;
}

/// Drops the creases of surfaces that meet others. The curves in which they meet are accurate to half a cell
/// only, and no well-shaped tets fit between these and exact creases.
void give_up_where_surfaces_meet(const MesherInput& input, const TetMesh& mesh,
                                 std::vector<SurfacePatches>& patches) {
  if (input.bodies.size() == 1) return;
  std::map<MaterialTag, std::size_t> bodies;
  for (const MaterialLayer& layer : input.layers) bodies[layer.tag] = 0;
  for (std::size_t b = 0; b < input.bodies.size(); ++b) bodies[input.bodies[b].tag] = b;
  std::vector<const InterfaceTriangle*> first_at(mesh.points.size(), nullptr);
  std::set<std::size_t> meeting;
  const auto add = [&](const InterfaceTriangle& t) {
    for (const MaterialOrOutside material : {MaterialOrOutside(t.material), t.other})
      if (const auto body = material ? bodies.find(*material) : bodies.end(); body != bodies.end())
        meeting.insert(body->second);
  };
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) {
      if (!first_at[p]) first_at[p] = &t;
      if (first_at[p]->pair() == t.pair()) continue;
      add(*first_at[p]);
      add(t);
    }
  for (const std::size_t b : meeting) give_up_creases(input.bodies[b], patches[b]);
}

/// Drops the creases of surfaces whose own gaps are closed over more than a small part of their area, since
/// such creases would lie inside the solid.
void give_up_where_gaps_are_closed(const MesherInput& input, const MesherReport& report,
                                   std::vector<SurfacePatches>& patches) {
  for (std::size_t b = 0; b < patches.size(); ++b) {
    double closed = 0;
    for (const ClosedGapReport& g : report.closed_gaps)
      if (g.gap && g.name == input.bodies[b].name) closed += g.area;
    if (closed > CellTuning::WallBudget::max_closed_share * input.bodies[b].surface.area)
      give_up_creases(input.bodies[b], patches[b]);
  }
}

/// Reports patches and creases. Omits the creases of surfaces that meet others or themselves, as they may lie
/// inside the solid.
void report_features(const MesherInput& input, const std::vector<SurfacePatches>& patches,
                     MesherReport& report) {
  for (std::size_t b = 0; b < patches.size(); ++b) {
    const RepairedSurface& surface = input.bodies[b].surface;
    const bool exact = patches[b].verdict != SurfacePatches::Verdict::meeting &&
                       patches[b].verdict != SurfacePatches::Verdict::intersecting;
    if (patches[b].any() && exact && !input.complex)
      report.creases.add(find_creases(surface.points, surface.triangles, patches[b].patches,
                                      CellTuning::Patches::corner_reach * report.cell_size),
                         surface.points);
    report.features.push_back({input.bodies[b].name, patches[b]});
    report.features.back().found.patches = {};
  }
}

/// Reports the creases of a complex: for each sheet, those between its patches.
void report_complex_creases(const MesherInput& input, const std::vector<SurfacePatches>& patches,
                            const SheetPatches& of_sheets, MesherReport& report) {
  const ComplexPatches found = complex_patches(input, patches, of_sheets);
  std::vector<std::vector<Triangle>> triangles(found.sheets.size());
  std::vector<std::vector<std::uint16_t>> of_triangles(found.sheets.size());
  for (std::size_t t = 0; t < input.complex->faces.size(); ++t) {
    const std::size_t sheet = found.sheet_of_patch[found.patches[t]];
    triangles[sheet].push_back(found.triangles[t]);
    of_triangles[sheet].push_back(found.patches[t]);
  }
  for (std::size_t s = 0; s < triangles.size(); ++s)
    report.creases.add(find_creases(input.complex->points, triangles[s], of_triangles[s],
                                    CellTuning::Patches::corner_reach * report.cell_size),
                       input.complex->points);
}

/// Drops creases that later bodies carve away, and creases near curves where three regions meet, which are
/// accurate to half a cell only.
void keep_visible(CreaseCurves& creases, const MesherInput& input, const DenseMesh& dense) {
  if (input.bodies.size() == 1) return;
  const double near = CellTuning::Patches::junction_reach * dense.report.cell_size;
  CreaseCurves junctions = mesh_junctions(dense.mesh);
  std::vector<ProjectionTree::Item> segments;
  segments.reserve(junctions.segments.size());
  for (const auto& [a, b] : junctions.segments) segments.push_back({{a, b, b}, {}});
  const ProjectionTree tree(std::move(junctions.points), std::move(segments));
  const auto is_hidden = [&](const Vec3& p) {
    if (tree.nearest(p, {}, near)) return true;
    const auto shows = [&](MaterialTag tag) {
      return std::abs(dense.field->signed_distance(p, tag)) <= near;
    };
    return std::none_of(input.bodies.begin(), input.bodies.end(),
                        [&](const auto& b) { return shows(b.tag); }) &&
           std::none_of(input.layers.begin(), input.layers.end(),
                        [&](const auto& l) { return shows(l.tag); });
  };
  std::erase_if(creases.segments, [&](const std::array<Index, 2>& s) {
    return is_hidden(creases.points[s[0]]) || is_hidden(creases.points[s[1]]) ||
           is_hidden((creases.points[s[0]] + creases.points[s[1]]) / 2);
  });
  std::erase_if(creases.corners, is_hidden);
}

/// Sets the slack of volumes derived from distances, which chamfer creases that the mesh keeps sharp.
void allow_for_chamfers(MesherReport& report) {
  double length = 0;
  for (const auto& [a, b] : report.creases.segments)
    length += (report.creases.points[b] - report.creases.points[a]).norm();
  for (ExpectedSolid& e : report.expected)
    if (e.flaw != SurfaceFlaw::none) e.volume_slack = 0.5 * length * report.cell_size * report.cell_size;
}

/// Measures thickened walls again, since fitting creases has moved their vertices.
void measure_walls(DenseMesh& dense, const MaterialField& field) {
  const WallChanges* walls = field.wall_changes();
  if (!walls || dense.report.thickened.points == 0) return;
  const GridFrame& frame = field.frame();
  std::vector<Vec3> points;
  points.reserve(dense.mesh.points.size());
  for (const Vec3& p : dense.mesh.points) points.push_back(frame.to_grid(p));
  std::vector<std::uint8_t> on_interface(points.size(), 0);
  for (const InterfaceTriangle& t : dense.mesh.interfaces)
    for (const Index p : t.ids) on_interface[p] = 1;
  dense.report.thickened =
      thickened_report(find_thickened_walls(points, on_interface, *walls, *dense.field), frame);
}

void validate_outside_is_free(const MesherInput& input) {
  const auto taken = [](const std::string& name, MaterialTag tag) {
    if (name == outside_name || tag == outside_tag)
      throw UsageError("the material '" + name + "' of tag " + std::to_string(tag) +
                       " conflicts with the kept outside; give it another name or tag");
  };
  for (const MesherInput::Body& b : input.bodies) taken(b.name, b.tag);
  for (const MaterialLayer& l : input.layers) taken(l.name, l.tag);
}

}  // namespace

double cell_size(const MesherInput& input, const MesherOptions& options) {
  return finest_cell_size(options, longest_side(input), largest_coordinate(input), input.bodies[0].file);
}

DenseMesh mesh_surfaces(const MesherInput& input, const MesherOptions& options, Progress* progress) {
  MesherReport report;
  Stages stages(progress);

  stages.begin("signed distances");
  report.cell_size = cell_size(input, options);
  if (options.keep_outside) validate_outside_is_free(input);
  if (longest_side(input) < report.cell_size) {
    validate_encloses(input.bodies[0]);
    throw NothingToMeshError(
        input.bodies[0].file +
        ": the surface is smaller than a cell; use a higher resolution or a smaller voxel size");
  }
  report.resolution = static_cast<int>(std::ceil(longest_side(input) / report.cell_size - 0.5));
  report.estimate = estimate_mesh(input, options);
  validate_estimate(report.estimate);
  stages.throw_if_stopped();
  validate_limits(options, report.cell_size);
  const GridFrame voxels =
      make_grid_frame(input.low, input.high, report.cell_size, options.uniform, options.keep_outside);
  RefinementBudget budget;
  budget.max_depth = options.max_refinement.value_or(default_wall_refinement);
  budget.deeper_where_cheap = !options.max_refinement;
  if (options.uniform) budget.max_depth = 0, budget.deeper_where_cheap = false;
  budget.max_possible = max_possible_refinement(voxels, largest_coordinate(input));
  budget.base_tets =
      std::max(CellTuning::WallBudget::min_cheap_tets, static_cast<double>(report.estimate.tets));
  budget.max_tets = std::max(CellTuning::WallBudget::max_added_tets, budget.base_tets);
  std::vector<SurfacePatches> patches = patches_of(input, options, report.cell_size);
  const SheetPatches of_sheets = patches_of_sheets(input, options, report.cell_size);
  const auto has_patches = [](const SurfacePatches& p) { return p.any(); };
  const int max_depth = std::min(budget.max_depth, budget.max_possible);
  const NarrowPatches asked = cells_around(options.refinement_regions, voxels, max_depth, budget.base_tets);
  std::vector<BodyCells> cells;
  for (std::size_t b = 0; b < input.bodies.size(); ++b)
    cells.push_back(
        {find_narrow_patches(input.bodies[b].surface, patches[b], voxels, max_depth, budget.base_tets),
         asked});
  stages.throw_if_stopped();
  BodyField bodies =
      build_field(input, voxels, options.keep_outside, {options.min_gap, options.min_thickness}, budget,
                  std::move(cells), progress);
  const std::shared_ptr<const MaterialField> field = bodies.field;
  report.seconds_sdf = stages.seconds();

  stages.begin("octree");
  std::vector<MortonKey> interface_voxels = field->interface_voxels();
  ThinSheets sheets;
  if (!options.uniform) sheets = find_thin_sheets(*field, interface_voxels);
  const auto add_thin = [&](const std::vector<ThinPart>& parts, bool refined) {
    for (const ThinPart& p : parts)
      report.thin_parts.push_back({p.region == outside_region ? "" : field->regions()[p.region].name,
                                   p.places, voxels.to_input(p.first), refined});
  };
  add_thin(sheets.too_thin, true);
  {
    // Exclude voxels whose distances come from the triangles: their thin parts and gaps are reported
    // separately.
    std::vector<MortonKey> elsewhere = interface_voxels;
    if (const WallChanges* walls = field->wall_changes())
      std::erase_if(elsewhere, [&](MortonKey key) {
        const auto [x, y, z] = morton_decode(key);
        return walls->contains(Vec3(x, y, z) + Vec3::Constant(0.5));
      });
    add_thin(find_thin_parts(*field, elsewhere), false);
  }
  for (const auto& [body, wall] : bodies.changed)
    if (wall.gap || wall.on_purpose)
      report.closed_gaps.push_back(
          {input.bodies[body].name, wall.gap, wall.on_purpose, wall.thickness * report.cell_size,
           wall.area * report.cell_size * report.cell_size, voxels.to_input(wall.place)});
  sheets.finer = combine(std::move(sheets.finer), std::move(bodies.finer));
  report.sheets = expected_sheets(input);
  expect_materials(input, *field, interface_voxels, sheets.finer.refinement > 0, report);

  DenseMesh dense = mesh_field(
      field, std::move(interface_voxels), std::move(sheets.finer), options, MemoryModel{}, std::move(report),
      stages, [&](const std::vector<std::uint8_t>& there) { validate_materials_left(input, *field, there); });
  const auto has_groups = [](const MesherInput::Body& body) { return !body.surface.groups.empty(); };
  if (!input.complex) give_up_where_surfaces_meet(input, dense.mesh, patches);
  give_up_where_gaps_are_closed(input, dense.report, patches);
  report_features(input, patches, dense.report);
  if (input.complex) report_complex_creases(input, patches, of_sheets, dense.report);
  if (input.complex || std::any_of(patches.begin(), patches.end(), has_patches) ||
      std::any_of(input.bodies.begin(), input.bodies.end(), has_groups)) {
    stages.begin("creases");
    if (!input.complex) keep_visible(dense.report.creases, input, dense);
    allow_for_chamfers(dense.report);
    const auto features = std::make_shared<const FeatureSurface>(
        input, patches, CellTuning::Patches::corner_reach * dense.report.cell_size, dense.field, of_sheets);
    if (input.complex && input.complex->sheets.empty())
      collapse_strips(dense.mesh, *input.complex, *features, dense.report.cell_size);
    fit_creases(dense.mesh, *features, *field, dense.report.cell_size);
    measure_walls(dense, *field);
    for (const InterfaceTriangle& t : dense.mesh.interfaces)
      if (const SurfaceRegion group = features->group_of(t.patch))
        dense.mesh.patch_groups[{t.pair(), t.patch}] = group;
    // Where surfaces meet, the borders of groups are accurate to a cell only, like the curves in which they
    // meet.
    if (std::none_of(patches.begin(), patches.end(), [](const SurfacePatches& p) {
          return p.verdict == SurfacePatches::Verdict::meeting && p.any();
        }))
      dense.reference = features;
    dense.report.seconds_cut += stages.seconds();
  }
  dense.surface = std::make_shared<const TriangleMesh>(all_surfaces(input));
  dense.report.filling_tets = static_cast<std::size_t>(
      (dense.report.thickened.points > 0 ? bodies.filling_tets_thickened : bodies.filling_tets) *
      (std::any_of(patches.begin(), patches.end(), has_patches) ? CellTuning::WallBudget::filling_with_creases
                                                                : 1));
  return dense;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesher.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include "common/message_text.h"
#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "mesher/body_field.h"
#include "mesher/complex/labelled_complex.h"
#include "mesher/cut/thin_wall_recovery.h"
#include "mesher/domain/material_field.h"
#include "mesher/features/cap_faces.h"
#include "mesher/features/crease_fitting.h"
#include "mesher/features/curve_tubes.h"
#include "mesher/features/patches_beside_bodies.h"
#include "mesher/features/surface_features.h"
#include "mesher/field_mesher.h"
#include "mesher/input/expected_solids.h"
#include "mesher/labels/border_sides.h"
#include "mesher/labels/carved_field.h"
#include "mesher/labels/carved_volume.h"
#include "mesher/labels/label_films.h"
#include "mesher/level_sets/field_solid.h"
#include "mesher/materials_left.h"
#include "mesher/mesh_estimate.h"
#include "mesher/sizing/narrow_sheets.h"
#include "mesher/sizing/thin_bodies.h"
#include "mesher/thin/field_thickness.h"
#include "mesher/tuning/cell_tuning.h"
#include "mesher/tuning/label_tuning.h"
#include "mesher/volume_field.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

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

/// The faces between the regions of a complex. A body's own surface would include its parts inside later
/// bodies, where nothing of it is left.
TriangleMesh faces_of_regions(const LabelledComplex& complex) {
  TriangleMesh all;
  all.points = complex.points;
  all.triangles.reserve(complex.faces.size());
  for (const LabelledComplex::Face& f : complex.faces) {
    all.triangles.push_back(f.ids);
    if (f.behind == outside_region) std::swap(all.triangles.back()[1], all.triangles.back()[2]);
  }
  return all;
}

/// The surfaces of all bodies; each contact once.
TriangleMesh all_surfaces(const MesherInput& input) {
  if (input.complex) return faces_of_regions(*input.complex);
  TriangleMesh all;
  for (const MesherInput::Body& body : input.bodies) {
    const auto first = static_cast<Index>(all.points.size());
    all.points.insert(all.points.end(), body.surface.points.begin(), body.surface.points.end());
    for (const Triangle& t : body.surface.triangles)
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return all;
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

/// The estimate for the surfaces of a volume alone.
MesherEstimate estimate_of_bodies(const ImplantedVolume& volume, MesherOptions options) {
  options.voxel_size = cell_size(volume.labels, options);
  return estimate_mesh(volume.bodies, options);
}

/// The stages of mesh_surfaces() and mesh_implanted(), in this order.
class SurfaceMeshing {
 public:
  /// \param volume that the surfaces carve, or null
  SurfaceMeshing(const MesherInput& input, const MesherOptions& options, Progress* progress,
                 const ImplantedVolume* volume = nullptr)
      : input_(input), options_(options), volume_(volume), stages_(progress) {}

  DenseMesh run() {
    stages_.begin("signed distances");
    choose_cells();
    if (volume_)
      body_cells_ = cells_of_thin_bodies(input_, voxels_, options_.refinement_regions,
                                         std::min(budget_.max_depth, budget_.max_possible), budget_.max_tets);
    features_ = find_features(input_, options_, report_.cell_size, body_cells_.sizes);
    if (volume_) add_cells_of_films();
    build_distances();
    report_.seconds_sdf = stages_.seconds();
    report_.loops_sdf = stages_.loops();

    stages_.begin("octree");
    find_thin();
    report_.sheets = expected_sheets(input_);
    expect_materials(input_, *bodies_.field, interface_voxels_, thin_.finer.refinement > 0, report_);
    if (volume_) carve_volume();
    CreaseCurves border = std::exchange(report_.creases, {});
    if (volume_) border = creases_off_bodies(border);
    FieldMesh made = mesh_field(field_, std::move(interface_voxels_), std::move(thin_.finer), options_,
                                volume_ ? label_memory(volume_->labels, report_.cell_size) : MemoryModel{},
                                std::move(report_), stages_,
                                [&](const std::vector<std::uint8_t>& there) { validate_there(there); });

    DenseMesh dense = std::move(made.dense);
    dense.mesh.space = volume_ ? volume_->labels.space : input_.space;
    settle_features(input_, closed_gaps_, features_, dense, surroundings());
    if (has_features(input_, features_)) fit_features(dense, made.parts ? &*made.parts : nullptr);
    dense.report.creases.add(border);
    if (!volume_) dense.surface = std::make_shared<const TriangleMesh>(all_surfaces(input_));
    if (!input_.holes.empty())
      dense.caps = std::make_shared<const SurfaceCapFaces>(input_, bodies_.caps, dense.report.cell_size);
    dense.report.filling_tets = filling_tets(dense.report);
    return dense;
  }

 private:
  /// The frame of voxels, and how far cells may be split.
  void choose_cells() {
    if (volume_)
      choose_cells_of_volume();
    else
      choose_cells_of_surfaces();
    stages_.throw_if_stopped();
    validate_limits(options_, report_.cell_size);
    budget_.max_depth = options_.max_refinement.value_or(default_wall_refinement);
    budget_.deeper_where_cheap = !options_.max_refinement;
    if (options_.uniform) budget_.max_depth = 0, budget_.deeper_where_cheap = false;
    budget_.max_possible = max_possible_refinement(voxels_, largest_coordinate(input_));
    using Budget = CellTuning::WallBudget;
    const double allowed = options_.max_thin_tets > 0 ? options_.max_thin_tets : Budget::max_added_tets;
    budget_.base_tets =
        std::max(std::min(Budget::min_cheap_tets, allowed), static_cast<double>(report_.estimate.tets));
    budget_.max_tets = std::max(allowed, budget_.base_tets);
  }
  void choose_cells_of_surfaces() {
    report_.cell_size = cell_size(input_, options_);
    if (options_.keep_outside) validate_outside_is_free(input_);
    if (longest_side(input_) < report_.cell_size) {
      validate_encloses(input_, input_.bodies[0]);
      throw NothingToMeshError(
          input_.bodies[0].file +
          ": the surface is smaller than a cell; use a higher resolution or a smaller voxel size");
    }
    report_.resolution = static_cast<int>(std::ceil(longest_side(input_) / report_.cell_size - 0.5));
    report_.estimate = estimate_mesh(input_, options_);
    validate_estimate(report_.estimate);
    voxels_ =
        make_grid_frame(input_.low, input_.high, report_.cell_size, options_.uniform, options_.keep_outside);
  }
  /// Cells of the volume, and the distances of its labels.
  void choose_cells_of_volume() {
    const LabelInput& labels = volume_->labels;
    const double cell = cell_size(labels, options_);
    const double max_cell = CellTuning::LabelCells::max_with_bodies * voxel_size(labels);
    if (cell > (1 + tolerance::coinciding_cells) * max_cell)
      throw UsageError("cells of " + short_number(cell) +
                       " are too large beside bodies in a segmented volume; at most two voxels, " +
                       short_number(max_cell) + ", are possible");
    if (options_.keep_outside) validate_outside_is_free(input_);
    validate_estimate(estimate_mesh(*volume_, options_));
    VolumeField made = make_volume_field(labels, options_, report_, stages_.progress(), &input_);
    labels_ = std::move(made.field);
    label_cells_ = std::move(made.finer);
    voxels_ = labels_->voxels();
    crossed_ = crossed_sides(*volume_, voxels_);
    const MesherEstimate bodies = estimate_of_bodies(*volume_, options_);
    report_.estimate.tets += bodies.tets;
    report_.estimate.bytes += bodies.bytes;
    validate_estimate(report_.estimate);
  }

  /// Smaller cells where bodies leave films of labels, as far as the budget allows after those along bodies.
  void add_cells_of_films() {
    const int max_depth = std::min(budget_.max_depth, budget_.max_possible);
    using Films = LabelTuning::Films;
    const double layer = layer_around_bodies();
    const bool everywhere = volume_->protected_labels.empty();  // the layer
    const LabelFilms films =
        find_films(input_, features_.bodies, *labels_,
                   {layer, everywhere ? Films::min_share_of_layer * layer : Films::min_without_layer,
                    options_.keep_outside},
                   stages_.progress());
    NarrowPatches cells = cells_around(films.finer, voxels_, max_depth, budget_.base_tets);
    body_cells_.cells.finer = combine(std::move(body_cells_.cells.finer), std::move(cells.finer));
    std::vector<MortonKey>& voxels = body_cells_.cells.voxels;
    voxels.insert(voxels.end(), cells.voxels.begin(), cells.voxels.end());
    parallel_sort_unique(voxels);
    report_.narrow_labels = unresolved_films(films, voxels_, {&body_cells_.cells.finer, &label_cells_});
  }
  /// Combines bodies with the volume around them.
  void carve_volume() {
    field_ = CarvedField::make(labels_, bodies_.field, protected_regions(*volume_), layer_around_bodies(),
                               crossed_);
    Carving carving = measure_carving(*volume_, *bodies_.field, stages_.progress());
    report_.carved = std::move(carving.labels);
    in_labels_ = std::move(carving.bodies);
    interface_voxels_ = field_->interface_voxels();
    thin_.finer = combine(std::move(thin_.finer), std::move(label_cells_));
    for (std::size_t b = 0; b < in_labels_.size(); ++b) {
      const MesherInput::Body& body = input_.bodies[b];
      if (in_labels_[b].in_labels == 0) report_.off_labels.push_back(body.name);
      // The part of a body that protected labels leave is not known from its surface.
      if (in_labels_[b].beside_protected == 0) continue;
      std::erase_if(report_.expected, [&](const ExpectedSolid& s) { return s.tag == body.tag; });
      std::erase(report_.unknown, body.name);
      report_.at_protected.push_back(body.name);
    }
  }
  /// The parts of creases that are away from bodies.
  CreaseCurves creases_off_bodies(const CreaseCurves& creases) const {
    const std::unique_ptr<FieldSampler> sampler = bodies_.field->sampler();
    const double voxel = voxel_size(volume_->labels), reach = voxel / voxels_.cell_size;
    const auto is_free = [&](const Vec3& p) {
      const NearestRegion body = sampler->nearest(voxels_.to_grid(p));
      return body.region == outside_region && body.margin > std::min(reach, 0.9 * bodies_.field->band());
    };
    CreaseCurves kept;
    for (const auto& [a, b] : creases.segments) {
      const Vec3 &from = creases.points[a], &to = creases.points[b];
      const int count = std::max(1, static_cast<int>(std::ceil((to - from).norm() / voxel)));
      const auto at = [&](int i) -> Vec3 { return from + (to - from) * i / count; };
      for (int i = 0, k; i < count; i = k) {
        for (k = i; k < count && is_free(at(k)) && is_free(at(k + 1));) ++k;
        if (k == i) {
          ++k;
          continue;
        }
        const auto first = static_cast<Index>(kept.points.size());
        kept.points.push_back(at(i));
        kept.points.push_back(k == count ? to : at(k));
        kept.segments.push_back({first, first + 1});
      }
    }
    std::copy_if(creases.corners.begin(), creases.corners.end(), std::back_inserter(kept.corners), is_free);
    return kept;
  }
  /// The layer in which interfaces of labels turn towards bodies, voxels of the frame.
  double layer_around_bodies() const {
    const std::vector<double>& cells = features_.cells;
    return std::min(LabelTuning::Carving::layer * *std::max_element(cells.begin(), cells.end()),
                    LabelTuning::Carving::max_layer * voxel_size(volume_->labels)) /
           voxels_.cell_size;
  }
  Surroundings surroundings() const {
    if (!volume_) return Surroundings::outside;
    return volume_->protected_labels.empty() ? Surroundings::labels : Surroundings::protected_labels;
  }
  /// \param there by region of the field
  void validate_there(const std::vector<std::uint8_t>& there) const {
    if (!volume_) return validate_materials_left(input_, *bodies_.field, there);
    const auto labels = static_cast<std::ptrdiff_t>(volume_->labels.materials.size()) + 1;
    validate_carved_labels_left(*volume_, {there.begin(), there.begin() + labels});
    validate_unprotected_left(*volume_, in_labels_, {there.begin() + labels, there.end()});
    std::vector<std::uint8_t> of_bodies(there.begin() + labels - 1, there.end());
    of_bodies[outside_region] = there[outside_region];
    validate_materials_left(input_, *bodies_.field, of_bodies);
  }

  /// The signed distance of each region, with cells for narrow patches, thin walls and requested sizes.
  void build_distances() {
    const int max_depth = std::min(budget_.max_depth, budget_.max_possible);
    std::vector<RefinementRegion> regions = options_.refinement_regions;
    if (input_.complex) {
      const std::vector<RefinementRegion> narrow = find_narrow_sheets(*input_.complex, report_.cell_size);
      regions.insert(regions.end(), narrow.begin(), narrow.end());
    }
    const NarrowPatches asked =
        volume_ ? body_cells_.cells : cells_around(regions, voxels_, max_depth, budget_.base_tets);
    std::vector<BodyCells> cells;
    for (std::size_t b = 0; b < input_.bodies.size(); ++b)
      cells.push_back({find_narrow_patches(input_.bodies[b].surface, features_.bodies[b], voxels_, max_depth,
                                           budget_.base_tets),
                       asked});
    stages_.throw_if_stopped();
    bodies_ = build_field(with_continued_faces(), voxels_, options_.keep_outside,
                          {options_.min_gap, options_.min_thickness}, budget_, std::move(cells),
                          stages_.progress());
    field_ = bodies_.field;
  }

  /// The bodies as distances are measured from them.
  MesherInput with_continued_faces() const {
    MesherInput input = input_;
    if (volume_)
      for (MesherInput::Body& body : input.bodies)
        body.surface = continued_beyond(*volume_, voxels_, crossed_, std::move(body.surface));
    return input;
  }

  /// Sheets and parts that are thin for the cells: smaller cells where these help, else a report.
  void find_thin() {
    const MaterialField& field = *bodies_.field;
    interface_voxels_ = field.interface_voxels();
    if (!options_.uniform) thin_ = find_thin_sheets(field, interface_voxels_);
    const auto add_thin = [&](const std::vector<ThinPart>& parts, bool refined) {
      for (const ThinPart& p : parts)
        report_.thin_parts.push_back({p.region == outside_region ? "" : field.regions()[p.region].name,
                                      p.places, voxels_.to_input(p.first), refined});
    };
    add_thin(thin_.too_thin, true);
    // Exclude voxels whose distances come from the triangles: their thin parts and gaps are reported
    // separately.
    std::vector<MortonKey> elsewhere = interface_voxels_;
    if (const WallChanges* walls = field.wall_changes())
      std::erase_if(elsewhere, [&](MortonKey key) {
        const auto [x, y, z] = morton_decode(key);
        return walls->contains(Vec3(x, y, z) + Vec3::Constant(0.5));
      });
    add_thin(find_thin_parts(field, elsewhere), false);
    closed_gaps_.resize(input_.bodies.size());
    for (const auto& [body, wall] : bodies_.changed)
      for (const Vec3& p : wall.places) closed_gaps_[body].push_back(voxels_.to_input(p));
    for (const auto& [body, wall] : bodies_.changed)
      if (wall.gap || wall.on_purpose)
        report_.closed_gaps.push_back(
            {input_.bodies[body].name, wall.gap, wall.on_purpose, wall.thickness * report_.cell_size,
             wall.area * report_.cell_size * report_.cell_size, voxels_.to_input(wall.place)});
    thin_.finer = combine(std::move(thin_.finer), std::move(bodies_.finer));
  }

  /// Moves points onto creases, corners and junctions, and names the patches of boundary faces.
  /// \param parts if there are sheets, whose faces are added
  void fit_features(DenseMesh& dense, SheetParts* parts) {
    stages_.begin("creases");
    const double cell = features_.cell;
    const auto features = std::make_shared<FeatureSurface>(
        input_, features_.bodies, CellTuning::Patches::corner_reach * cell, dense.field,
        features_.complex ? &*features_.complex : nullptr, bodies_.caps, features_.given_up, features_.cells,
        volume_ ? dense.reference : nullptr);
    if (volume_) features->set_protected(volume_->protected_labels);
    const PatchesBesideBodies beside(dense.mesh, *features);
    // Labels around bodies are no part of their complex.
    if (input_.complex && !volume_)
      dense.report.strips =
          remesh_curve_tubes(dense.mesh, *input_.complex, *features, cell, parts, stages_.progress());
    if (parts) {
      const std::vector<InterfaceTriangle> sheets = sheet_faces(dense.mesh, *parts);
      dense.mesh.interfaces.insert(dense.mesh.interfaces.end(), sheets.begin(), sheets.end());
    }
    fit_creases(dense.mesh, *features, *field_, cell);
    beside.restore(dense.mesh, *features);
    measure_walls(dense, *field_);
    if (volume_) settle_border(dense, *features);
    // Faces across a closed gap are no part of the region on either side of it.
    for (const InterfaceTriangle& t : dense.mesh.interfaces)
      if (const SurfaceRegion group = features->group_of(t.patch);
          group && (t.is_sheet() || features->sheet_of(t)))
        dense.mesh.patch_groups[{t.pair(), t.patch}] = group;
    dense.reference = features;
    dense.report.seconds_cut += stages_.seconds();
    dense.report.loops_cut += stages_.loops();
  }

  /// Replaces what was known of the border of a volume before points moved.
  void settle_border(DenseMesh& dense, FeatureSurface& features) const {
    // Faces of bodies in the border have other patches now.
    std::erase_if(dense.mesh.patch_groups, [&](const auto& group) {
      const auto& [pair, patch] = group.first;
      return !features.is_beside_bodies({{}, pair.first, pair.second, patch});
    });
    TetMesh beside;
    beside.points = dense.mesh.points;
    std::copy_if(dense.mesh.interfaces.begin(), dense.mesh.interfaces.end(),
                 std::back_inserter(beside.interfaces),
                 [&](const InterfaceTriangle& t) { return features.is_beside_bodies(t); });
    features.set_surroundings(reference_of(beside, dense.field));
  }

  std::size_t filling_tets(const MesherReport& report) const {
    const double tets = report.thickened.points > 0 ? bodies_.filling_tets_thickened : bodies_.filling_tets;
    const bool creases = std::any_of(features_.bodies.begin(), features_.bodies.end(),
                                     [](const SurfacePatches& p) { return p.any(); });
    return static_cast<std::size_t>(tets * (creases ? CellTuning::WallBudget::filling_with_creases : 1));
  }

  const MesherInput& input_;
  const MesherOptions& options_;
  const ImplantedVolume* volume_;
  Stages stages_;
  MesherReport report_;
  std::shared_ptr<const LabelField> labels_;  ///< of the volume
  BodySizes body_cells_;                      ///< that are halved because bodies in it are thin
  RefinementRegions label_cells_;             ///< that are halved because its labels are thin
  GridFrame voxels_;
  std::vector<BodyInLabels> in_labels_;  ///< by body
  unsigned crossed_ = 0;                 ///< sides of the volume, see crossed_sides()
  RefinementBudget budget_;
  SurfaceFeatures features_;
  BodyField bodies_;
  std::shared_ptr<const MaterialField> field_;  ///< of the mesh: that of the bodies, and of a volume
  std::vector<std::vector<Vec3>> closed_gaps_;  ///< of each body, points on their sides, input units
  std::vector<MortonKey> interface_voxels_;
  ThinSheets thin_;
};

}  // namespace

double cell_size(const MesherInput& input, const MesherOptions& options) {
  return finest_cell_size(options, longest_side(input), largest_coordinate(input), input.bodies[0].file);
}

DenseMesh mesh_implanted(const ImplantedVolume& volume, const MesherOptions& options, Progress* progress) {
  return SurfaceMeshing(volume.bodies, options, progress, &volume).run();
}

MesherEstimate estimate_mesh(const ImplantedVolume& volume, const MesherOptions& options) {
  MesherEstimate both = estimate_mesh(volume.labels, options);
  const MesherEstimate bodies = estimate_of_bodies(volume, options);
  both.tets += bodies.tets;
  both.bytes += bodies.bytes;
  return both;
}

DenseMesh mesh_surfaces(const MesherInput& input, const MesherOptions& options, Progress* progress) {
  return SurfaceMeshing(input, options, progress).run();
}

}  // namespace tetwright

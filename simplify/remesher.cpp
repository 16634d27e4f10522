// SPDX-License-Identifier: Apache-2.0
#include "tetwright/remesher.h"

#include <algorithm>
#include <array>
#include <optional>

#include "simplify/constraints/constrained_mesh.h"
#include "simplify/constraints/surface_projection.h"
#include "simplify/mesh/input_check.h"
#include "simplify/mesh/neighbourhood.h"
#include "simplify/remesh/change_journal.h"
#include "simplify/remesh/field_carrier.h"
#include "simplify/remesh/point_tree.h"
#include "simplify/remesh/remesh_rounds.h"
#include "simplify/schedule/block_runner.h"
#include "simplify/schedule/round_recorder.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"
#include "tetwright/sheets.h"

namespace tetwright {

namespace {

using Grains = SimplifyTuning::Grains;
using Remeshing = SimplifyTuning::Remeshing;
using Slots = SimplifyTuning::Slots;

struct Field {
  Field(std::size_t count, std::vector<double>&& numbers) : components(count), values(std::move(numbers)) {
    values.reserve(2 * values.size());  // the mesh has room for twice as many slots
  }
  std::size_t components;
  std::vector<double> values;
};

/// A field's values after a renumbering.
std::vector<double> renumbered_values(const Field& field, const std::vector<Index>& numbers,
                                      std::size_t slots) {
  std::vector<double> values(field.components * slots, 0);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (numbers[i] != no_index)
      std::copy_n(field.values.begin() + static_cast<std::ptrdiff_t>(i * field.components), field.components,
                  values.begin() + static_cast<std::ptrdiff_t>(numbers[i] * field.components));
  return values;
}

TetMesh&& checked(TetMesh&& mesh, const RemesherOptions& options) {
  check_arrays(mesh, options.frozen, options.name);
  return std::move(mesh);
}

}  // namespace

struct Remesher::Impl {
  Impl(TetMesh&& input, const RemesherOptions& given, Renumbering* numbers)
      : options(given),
        constrained(checked(std::move(input), given), given.name, given.frozen, given.fix_boundary, true),
        runner(mesh, grid, constrained.ledger, given.seed, given.batch_size, given.progress),
        recorder(mesh, runner, given.report, given.progress) {
    recorder.begin_stage("improve");
    rules.objective.kind = Objective::Kind::shape;
    rules.objective.shape = options.objective;
    renumber(numbers);
    find_copies();
    keep_surfaces();
  }

  /// Compacts, and rebuilds all data that depends on the whole mesh.
  void renumber(Renumbering* numbers) {
    SlotNumbers slots;
    const std::size_t spare = mesh.live_tets() / Slots::remesher_spare_inverse + Slots::remesher_min_spare;
    mesh.compact(spare, spare, &slots);
    mesh.reserve_twice();
    if (numbers) *numbers = {std::move(slots.points), std::move(slots.tets)};
    diagonal = mesh.diagonal();
    look_at_all();
  }
  void keep_surfaces() {
    if (options.keep_surfaces) first_surfaces.emplace(mesh, options.reference);
  }
  void find_copies() {
    copies.clear();
    for (Index p = 0; p < mesh.point_slots(); ++p)
      if (mesh.original(p) != p) copies.push_back({mesh.original(p), p});
    std::sort(copies.begin(), copies.end());
  }
  void look_at_all() {
    parallel_for(0, mesh.tet_slots(), Grains::slots, [&](std::size_t begin, std::size_t end) {
      for (std::size_t t = begin; t < end; ++t) rate(static_cast<Index>(t));
    });
    grid.build(mesh);
    grid.reserve_twice();
    places.build(mesh);
  }
  void rate(Index t) {
    if (!mesh.dead(t)) mesh.set_quality(t, quality_of(mesh, rules, mesh.points(t)));
  }

  std::vector<Index> tets_of(const RemeshRegion& region);
  /// The interface faces of the tets, each once.
  /// \pre `tets` is ascending.
  std::vector<InterfaceFace> interface_faces_of(const std::vector<Index>& tets) const;
  /// Projection onto the surfaces at these points.
  /// \pre `points` is ascending.
  SurfaceProjection project_onto(const std::vector<Index>& points);
  RemeshAim usual_aim() const;
  template <class Work>
  RemeshChanges call(const RemeshRegion& region, const RemeshAim& aim, const Work& work);
  template <class Resize>
  RemeshChanges resize(const RemeshRegion& region, double size, const Resize& work);
  RemeshChanges changes() const;
  void carry_fields();
  void move_points(std::span<const Index> points, std::span<const Vec3> positions);

  RemesherOptions options;
  ConstrainedMesh constrained;
  EditableMesh& mesh = constrained.mesh;
  SurfaceGrid& grid = constrained.grid;
  BlockRunner runner;
  RoundRecorder recorder;
  PointTree places;
  ChangeJournal journal;
  BlockRules rules;
  double diagonal = 0;                              ///< when points were last renumbered
  std::optional<SurfaceProjection> first_surfaces;  ///< with RemesherOptions::keep_surfaces
  Neighbourhood near;
  std::vector<Field> point_fields, tet_fields;
  std::vector<std::array<Index, 2>> copies;  ///< points and copies split off from them; ascending
};

std::vector<Index> Remesher::Impl::tets_of(const RemeshRegion& region) {
  if (const auto* list = std::get_if<std::vector<Index>>(&region.value_)) {
    std::vector<Index> tets = *list;
    near.make_distinct(tets);
    for (Index t : tets)
      if (t >= mesh.tet_slots() || mesh.dead(t))
        throw UsageError("the region lists tet " + std::to_string(t) + ", which does not exist");
    return tets;
  }
  if (const auto* box = std::get_if<RemeshRegion::Box>(&region.value_)) {
    Box3 working;
    working.low = mesh.space().to_working(box->low);
    working.high = mesh.space().to_working(box->high);
    return near.tets_at(mesh, places.points_in(mesh, working));
  }
  const auto& inside = std::get<std::function<bool(const Vec3&)>>(region.value_);
  std::vector<std::uint8_t> chosen(mesh.point_slots(), 0);
  for (Index p = 0; p < mesh.point_slots(); ++p)
    if (mesh.incident_tet(p) != no_index) chosen[p] = inside(mesh.space().to_input(mesh.position(p)));
  std::vector<Index> tets;
  for (Index t = 0; t < mesh.tet_slots(); ++t)
    if (!mesh.dead(t) &&
        std::any_of(mesh.points(t).begin(), mesh.points(t).end(), [&](Index p) { return chosen[p] != 0; }))
      tets.push_back(t);
  return tets;
}

std::vector<InterfaceFace> Remesher::Impl::interface_faces_of(const std::vector<Index>& tets) const {
  std::vector<InterfaceFace> faces;
  for (Index t : tets)
    for (int f = 0; f < 4; ++f) {
      const FaceLink link = mesh.link(t, f);
      // List a face between two of the tets only once.
      if (!link.is_interface() ||
          (!link.is_outside() && link.tet() < t && std::binary_search(tets.begin(), tets.end(), link.tet())))
        continue;
      const Triangle ids = face_of(mesh.points(t), f);
      faces.push_back({ids, mesh.region(t), mesh.region_across(t, f),
                       link.is_outside() ? link.patch() : grid.patch(mesh, ids)});
    }
  return faces;
}

SurfaceProjection Remesher::Impl::project_onto(const std::vector<Index>& points) {
  return SurfaceProjection(mesh, mesh.positions(), interface_faces_of(near.tets_at(mesh, points)),
                           options.reference,
                           [&](Index p) { return std::binary_search(points.begin(), points.end(), p); });
}

RemeshAim Remesher::Impl::usual_aim() const {
  return {.angle = Remeshing::bad_margin * options.min_solid_angle,
          .leave_surface_angle = Remeshing::leave_surface_margin * options.min_solid_angle};
}

template <class Work>
RemeshChanges Remesher::Impl::call(const RemeshRegion& region, const RemeshAim& aim, const Work& work) {
  const std::vector<Index> tets = tets_of(region);
  journal.clear();
  if (tets.empty()) return {};
  const std::vector<Index> with_rim = near.tets_at(mesh, near.points_of(mesh, tets));
  SurfaceProjection found;
  if (!first_surfaces) found = project_onto(near.points_of(mesh, with_rim));
  rules.project_onto(first_surfaces ? *first_surfaces : found, diagonal);
  std::uint64_t operations = 0;
  int improved = 0;
  {
    RemeshRounds rounds({mesh, runner, rules, recorder}, journal, tets, with_rim);
    work(rounds);
    improved = rounds.improve({.kind = "improve",
                               .angle = aim.angle,
                               .leave_surface_angle = aim.leave_surface_angle,
                               .target_tets = aim.target_tets,
                               .min_tets = aim.min_tets,
                               .max_tets = aim.max_tets,
                               .fast = true,
                               .brief = aim.brief,
                               .max_rounds = aim.max_rounds});
    operations = rounds.operations();
  }
  rules.surface.projection = nullptr;
  runner.take_totals();
  carry_fields();
  places.repair(mesh, journal.points());
  RemeshChanges result = changes();
  result.operations = operations;
  result.rounds = improved;
  return result;
}

template <class Resize>
RemeshChanges Remesher::Impl::resize(const RemeshRegion& region, double size, const Resize& work) {
  if (!(size > 0)) throw UsageError("the size of edges must be above 0");
  const auto floor = static_cast<float>(Remeshing::floor_share *
                                        shape_quality_bound(options.objective, options.min_solid_angle));
  return call(region, usual_aim(),
              [&](RemeshRounds& rounds) { work(rounds, size * mesh.space().scale(), floor); });
}

RemeshChanges Remesher::Impl::changes() const {
  RemeshChanges c;
  for (const ChangeJournal::OldTet& t : journal.tets()) {
    const bool was = t.points != dead_tet, is = !mesh.dead(t.slot);
    if (was && is && t.points == mesh.points(t.slot) && t.region == mesh.region(t.slot)) continue;
    if (was) c.removed_tets.push_back(t.slot);
    if (is) c.added_tets.push_back(t.slot);
  }
  for (const ChangeJournal::OldPoint& p : journal.points()) {
    const bool is = mesh.incident_tet(p.point) != no_index;
    if (p.existed && !is) c.removed_points.push_back(p.point);
    if (!p.existed && is) c.added_points.push_back(p.point);
    if (p.existed && is && mesh.position(p.point) != p.position) c.moved_points.push_back(p.point);
  }
  for (auto* list : {&c.removed_tets, &c.added_tets, &c.removed_points, &c.added_points, &c.moved_points})
    std::sort(list->begin(), list->end());
  return c;
}

void Remesher::Impl::carry_fields() {
  for (Field& f : point_fields) f.values.resize(f.components * mesh.point_slots(), 0);
  for (Field& f : tet_fields) f.values.resize(f.components * mesh.tet_slots(), 0);
  if (journal.tets().empty() || (point_fields.empty() && tet_fields.empty())) return;
  const FieldCarrier carrier(mesh, journal);
  for (Field& f : point_fields) carrier.carry_point_field(f.values, f.components);
  for (Field& f : tet_fields) carrier.carry_tet_field(f.values, f.components);
}

void Remesher::Impl::move_points(std::span<const Index> points, std::span<const Vec3> positions) {
  std::vector<Index> moved;
  std::vector<Vec3> targets;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (mesh.original(points[i]) != points[i]) continue;  // a copy follows its original
    const Vec3 to = mesh.space().to_working(positions[i]);
    moved.push_back(points[i]);
    targets.push_back(to);
    for (auto c = std::lower_bound(copies.begin(), copies.end(), std::array<Index, 2>{points[i], 0});
         c != copies.end() && (*c)[0] == points[i]; ++c) {
      moved.push_back((*c)[1]);
      targets.push_back(to);
    }
  }
  const std::vector<Index> tets = near.tets_at(mesh, moved);
  std::vector<ChangeJournal::OldPoint> old;
  std::vector<Index> distinct = moved;
  near.make_distinct(distinct);
  old.reserve(distinct.size());
  for (Index p : distinct) old.push_back({p, true, mesh.position(p)});
  SurfaceGrid::Edit edit;
  const std::vector<InterfaceFace> faces = interface_faces_of(tets);
  const auto triangle = [&](const Triangle& ids) {
    return MeshTriangle{ids, {mesh.position(ids[0]), mesh.position(ids[1]), mesh.position(ids[2])}};
  };
  for (const InterfaceFace& f : faces) edit.removed.push_back(triangle(f.ids));
  for (std::size_t i = 0; i < moved.size(); ++i) mesh.set_position(moved[i], targets[i]);
  for (const InterfaceFace& f : faces) edit.added.push_back({triangle(f.ids), f.patch});
  grid.replace(edit);
  for (Index t : tets) rate(t);
  places.repair(mesh, old);
}

Remesher::Remesher(TetMesh mesh, const RemesherOptions& options, Renumbering* numbers)
    : impl_(std::make_unique<Impl>(std::move(mesh), options, numbers)) {}
Remesher::~Remesher() = default;
Remesher::Remesher(Remesher&&) noexcept = default;
Remesher& Remesher::operator=(Remesher&&) noexcept = default;

std::size_t Remesher::tet_count() const { return impl_->mesh.live_tets(); }
std::size_t Remesher::tet_slots() const { return impl_->mesh.tet_slots(); }
std::size_t Remesher::point_slots() const { return impl_->mesh.point_slots(); }
std::size_t Remesher::touching_points() const { return impl_->mesh.touching_points(); }
bool Remesher::has_tet(Index tet) const { return tet < tet_slots() && !impl_->mesh.dead(tet); }
bool Remesher::has_point(Index point) const {
  return point < point_slots() && impl_->mesh.incident_tet(point) != no_index;
}
const Tet& Remesher::tet(Index tet) const { return impl_->mesh.points(tet); }
MaterialTag Remesher::material(Index tet) const { return impl_->mesh.tag(impl_->mesh.region(tet)); }
Vec3 Remesher::position(Index point) const {
  return impl_->mesh.space().to_input(impl_->mesh.position(point));
}
float Remesher::quality(Index tet) const { return impl_->mesh.quality(tet); }

std::size_t Remesher::add_point_field(std::size_t components, std::vector<double> values) {
  if (components == 0 || values.size() != components * point_slots())
    throw UsageError("a field of points needs its components for each of " + std::to_string(point_slots()) +
                     " slots, not " + std::to_string(values.size()) + " numbers");
  impl_->point_fields.emplace_back(components, std::move(values));
  return impl_->point_fields.size() - 1;
}
std::size_t Remesher::add_tet_field(std::size_t components, std::vector<double> values) {
  if (components == 0 || values.size() != components * tet_slots())
    throw UsageError("a field of tets needs its components for each of " + std::to_string(tet_slots()) +
                     " slots, not " + std::to_string(values.size()) + " numbers");
  impl_->tet_fields.emplace_back(components, std::move(values));
  return impl_->tet_fields.size() - 1;
}
std::vector<double>& Remesher::point_field(std::size_t field) { return impl_->point_fields.at(field).values; }
std::vector<double>& Remesher::tet_field(std::size_t field) { return impl_->tet_fields.at(field).values; }

void Remesher::set_positions(std::span<const Vec3> positions) {
  EditableMesh& mesh = impl_->mesh;
  if (positions.size() != mesh.point_slots())
    throw UsageError("positions for all points need " + std::to_string(mesh.point_slots()) +
                     " of them, not " + std::to_string(positions.size()));
  for (Index p = 0; p < mesh.point_slots(); ++p)
    if (mesh.incident_tet(p) != no_index && !positions[p].allFinite())
      throw InputError(impl_->options.name, 0,
                       "the new position of point " + std::to_string(p) + " is not finite");
  for (Index p = 0; p < mesh.point_slots(); ++p)
    if (mesh.incident_tet(p) != no_index)
      mesh.set_position(p, mesh.space().to_working(positions[mesh.original(p)]));
  impl_->constrained.keep_patches();
  impl_->look_at_all();
  impl_->keep_surfaces();
}

void Remesher::set_positions(std::span<const Index> points, std::span<const Vec3> positions) {
  if (points.size() != positions.size())
    throw UsageError(std::to_string(points.size()) + " points, but " + std::to_string(positions.size()) +
                     " positions");
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!has_point(points[i])) throw UsageError("point " + std::to_string(points[i]) + " does not exist");
    if (!positions[i].allFinite())
      throw InputError(impl_->options.name, 0,
                       "the new position of point " + std::to_string(points[i]) + " is not finite");
  }
  impl_->move_points(points, positions);
}

RemeshChanges Remesher::improve(const RemeshRegion& region) { return improve(region, impl_->usual_aim()); }

RemeshChanges Remesher::improve(const RemeshRegion& region, const RemeshAim& aim) {
  if (!(aim.angle >= 0) || !(aim.leave_surface_angle >= 0))
    throw UsageError("the solid angles to improve to must be at least 0");
  if (aim.min_tets > aim.max_tets || aim.target_tets > aim.max_tets)
    throw UsageError("the largest number of tets must be at least the smallest and the usual one");
  return impl_->call(region, aim, [](RemeshRounds&) {});
}

RemeshChanges Remesher::coarsen(const RemeshRegion& region, double size) {
  return impl_->resize(region, size, [](RemeshRounds& r, double s, float floor) { r.coarsen(s, floor); });
}

RemeshChanges Remesher::refine(const RemeshRegion& region, double size) {
  return impl_->resize(region, size, [](RemeshRounds& r, double s, float floor) { r.refine(s, floor); });
}

Renumbering Remesher::compact() {
  Renumbering numbers;
  impl_->constrained.keep_patches();
  impl_->renumber(&numbers);
  for (Field& f : impl_->point_fields)
    f = {f.components, renumbered_values(f, numbers.points, point_slots())};
  for (Field& f : impl_->tet_fields) f = {f.components, renumbered_values(f, numbers.tets, tet_slots())};
  impl_->find_copies();
  return numbers;
}

TetMesh Remesher::mesh() const {
  const EditableMesh& mesh = impl_->mesh;
  TetMesh out;
  std::vector<Index> number(mesh.point_slots(), no_index), points, tets;
  for (Index p = 0; p < mesh.point_slots(); ++p)
    if (mesh.incident_tet(p) != no_index && mesh.original(p) == p) {
      number[p] = static_cast<Index>(points.size());
      points.push_back(p);
      out.points.push_back(position(p));
    }
  for (Index t = 0; t < mesh.tet_slots(); ++t) {
    if (mesh.dead(t)) continue;
    Tet corners = mesh.points(t);
    for (Index& p : corners) p = number[mesh.original(p)];
    tets.push_back(t);
    out.tets.push_back(corners);
    out.materials.push_back(material(t));
  }
  out.material_names = mesh.names();
  out.patch_groups = mesh.patch_groups();
  out.space = mesh.coordinate_system();
  const auto add_fields = [](const std::vector<Field>& fields, const char* name,
                             const std::vector<Index>& slots, std::vector<MeshField>& to) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const Field& f = fields[i];
      MeshField field{name + std::to_string(i), static_cast<int>(f.components), false, {}};
      field.values.reserve(slots.size() * f.components);
      for (Index s : slots)
        field.values.insert(field.values.end(),
                            f.values.begin() + static_cast<std::ptrdiff_t>(s * f.components),
                            f.values.begin() + static_cast<std::ptrdiff_t>((s + 1) * f.components));
      to.push_back(std::move(field));
    }
  };
  add_fields(impl_->point_fields, "point_field_", points, out.point_fields);
  add_fields(impl_->tet_fields, "tet_field_", tets, out.cell_fields);
  for (Index p = 0; p < mesh.point_slots(); ++p) number[p] = number[mesh.original(p)];
  const FacePatches patches = renumbered(impl_->grid.patches(), number);
  std::vector<InterfaceTriangle> sheets = mesh.sheets(number);
  put_patches(patches, sheets);
  out.interfaces = find_interfaces(out);
  put_patches(patches, out.interfaces);
  append_sheets(out.interfaces, std::move(sheets));
  return out;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/geometry/quality.h"
#include "common/tet_mesh.h"

namespace tetwright {

class Progress;
class ReferenceSurface;
struct SimplifyReport;

struct RemesherOptions {
  ShapeObjective objective = ShapeObjective::both;
  /// Steradians: improve() works on tets whose shape is worse than shape_quality_bound() of it; coarsen() and
  /// refine() end with it, and leave no tet much worse that was not so before.
  double min_solid_angle = 0.1;
  /// Vertices that never move nor go, by their numbers in the mesh given; tets with only such vertices stay.
  /// Empty: none.
  std::vector<std::uint8_t> frozen;
  bool fix_boundary = false;  ///< freezes the vertices of boundary and interfaces, and so their faces
  std::uint64_t seed = 1;
  std::string name = "mesh";   ///< what messages call the mesh
  std::size_t batch_size = 0;  ///< as in SimplifyOptions
  // Null, or they outlive the object.

  /// What points of boundary and interfaces are projected onto; null: the surfaces that each call finds.
  const ReferenceSurface* reference = nullptr;
  /// Points of surfaces are projected onto those that the mesh came with, or that the positions of all points
  /// last made, by all calls: a tree of the whole surface. Else onto what each call finds, so that small
  /// distances may add up.
  bool keep_surfaces = false;
  SimplifyReport* report = nullptr;  ///< gets the rounds of improvement
  Progress* progress = nullptr;      ///< is told of them; its end throws Interrupted or OutOfTime
};

/// What improve() goes for.
struct RemeshAim {
  double angle;  ///< steradians: tets whose shape is worse than shape_quality_bound() of it are improved
  /// Likewise: for tets worse than this, points of surfaces may leave them a little.
  double leave_surface_angle;
  /// Of the whole mesh: bounds of its count, and what collapses bring it back to where it has come halfway to
  /// the upper one.
  std::size_t target_tets = 0, min_tets = 0, max_tets = std::numeric_limits<std::size_t>::max();
  /// Ends as soon as a round gains little and no tet is below leave_surface_angle.
  bool brief = true;
  int max_rounds = 16;
};

/// The part of a mesh that a call works on. Tets that share a vertex with it are improved, too, where a call
/// changes what is around them; so vertices next to the region's may move or go, and the tets around these
/// change. Vertices beyond stay where they are.
class RemeshRegion {
 public:
  /// These tets, by number.
  static RemeshRegion tets(std::vector<Index> numbers) { return RemeshRegion(std::move(numbers)); }
  /// The tets with a vertex in a box, borders included; input units.
  static RemeshRegion box(const Vec3& low, const Vec3& high) { return RemeshRegion(Box{low, high}); }
  /// The tets with a vertex at a place for which `inside` is true. It is asked for every vertex of the mesh,
  /// from one thread: the one kind of region whose time goes with the mesh.
  static RemeshRegion where(std::function<bool(const Vec3&)> inside) {
    return RemeshRegion(std::move(inside));
  }

 private:
  friend class Remesher;
  struct Box {
    Vec3 low, high;
  };
  using Value = std::variant<std::vector<Index>, Box, std::function<bool(const Vec3&)>>;
  explicit RemeshRegion(Value value) : value_(std::move(value)) {}
  Value value_;
};

/// What a call changed. Numbers of what is not listed stay what they were. The number of a tet that went may
/// be given again in the same call; it then is in both lists. That of a point, too: it then is among those
/// that moved, as if the point had gone to the new one's place. All ascending.
struct RemeshChanges {
  std::vector<Index> removed_tets, added_tets;
  std::vector<Index> removed_points, added_points;
  std::vector<Index> moved_points;  ///< those that were there before
  std::uint64_t operations = 0;     ///< carried out
  int rounds = 0;                   ///< of improvement
};

/// Numbers before and after: renumbering.tets[old] is the new number, no_index where there was nothing.
struct Renumbering {
  std::vector<Index> points, tets;
};

/// A mesh that lives across calls, for remeshing within a running simulation (the aim that Cutler, Dorsey &
/// McMillan 2004 name in their section 7). It keeps its links, the grid of its surface, its qualities and its
/// fields, and repairs them where something changes: time and memory of a call go with the region, not with
/// the mesh. (There is room for twice the slots that there are at first, and after compact(); the call that
/// goes beyond copies the arrays once. The cells of the grid keep the size that suited the surface then: call
/// compact() where triangles have become many times smaller or larger.) benchmarks/README.md has times.
///
/// Vertices and tets have numbers, those of slots: 0 <= number < point_slots(), tet_slots(). Not every slot
/// is used; what is there keeps its number until it goes or compact() is called. Materials, topology and the
/// volumes of materials are kept as by simplify(): each call's surface is the one that it found. Lengths in
/// input units. Coordinates are those of the mesh that came, to the bit; places given to set_positions() may
/// be rounded in the last one.
///
/// The result of a call depends on the calls before it and their arguments, never on the number of threads.
/// One call at a time. Where a call throws UsageError or InputError, nothing was changed; after Interrupted
/// or OutOfTime there is mesh() alone, whose fields are not carried; after anything else the object must not
/// be used.
class Remesher {
 public:
  /// Takes a mesh over and renumbers it: `numbers`, unless it is null, says how. Errors as of simplify().
  explicit Remesher(TetMesh mesh, const RemesherOptions& options = {}, Renumbering* numbers = nullptr);
  ~Remesher();
  Remesher(Remesher&&) noexcept;
  Remesher& operator=(Remesher&&) noexcept;

  std::size_t tet_count() const;
  std::size_t tet_slots() const;
  std::size_t point_slots() const;
  /// Points where parts touch without a common face: they stay as they are, with all tets around.
  std::size_t touching_points() const;
  bool has_tet(Index tet) const;
  bool has_point(Index point) const;
  /// Of what is there.
  const Tet& tet(Index tet) const;
  MaterialTag material(Index tet) const;
  Vec3 position(Index point) const;
  /// Shape of a tet by the objective, 1 for the regular one, 0 for a flat or inverted one.
  float quality(Index tet) const;

  /// Adds a field: `components` numbers for each point or tet slot, one after the other (those of empty slots
  /// do not matter). Returns its number, from 0 on for each kind. Point fields are carried linearly; numbers
  /// of tets are densities, carried so that the sum over the tets of a material of number times volume stays
  /// to 1e-12 of its size, wherever the material still has tets in the region.
  std::size_t add_point_field(std::size_t components, std::vector<double> values);
  std::size_t add_tet_field(std::size_t components, std::vector<double> values);
  /// With a number for each slot; to be written, too, between calls.
  std::vector<double>& point_field(std::size_t field);
  std::vector<double>& tet_field(std::size_t field);

  /// New positions of all points, by number (those of empty slots do not matter): work on the whole mesh.
  /// Tets may come out inverted: then improve() has something to do. Throws InputError where one is not
  /// finite.
  void set_positions(std::span<const Vec3> positions);
  /// New positions of some; time goes with their number. Throws UsageError where a point is not there. Where
  /// parts of the mesh touch without a common face, each part has a point of its own at one place: they go
  /// with the first of them, and what is given for the others does not matter.
  void set_positions(std::span<const Index> points, std::span<const Vec3> positions);

  // They throw UsageError where the region lists tets that are not there, an angle of the aim is not a number
  // or below 0, its counts contradict each other, or the size is not above 0.

  /// Makes the tets of the region well shaped that are not (RemesherOptions::min_solid_angle), also by points
  /// that come or go.
  RemeshChanges improve(const RemeshRegion& region);
  RemeshChanges improve(const RemeshRegion& region, const RemeshAim& aim);
  /// Collapses edges much shorter than `size` in the region, as far as topology, surfaces and shapes allow,
  /// without making edges much longer than it; then improves.
  RemeshChanges coarsen(const RemeshRegion& region, double size);
  /// Halves edges much longer than `size` in the region, those of surfaces where they are; then improves.
  RemeshChanges refine(const RemeshRegion& region, double size);

  /// Numbers points and tets anew without gaps, along a space-filling curve: work on the whole mesh. Fields
  /// move along.
  Renumbering compact();
  /// The mesh as it stands, without gaps: points and tets in the order of their numbers, with the fields
  /// (named "point_field_0", "tet_field_0" and so on) and the interfaces.
  TetMesh mesh() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tetwright

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

#include "tetwright/mesh_quality.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

class Progress;
class ReferenceSurface;
struct SimplifyReport;

struct RemesherOptions {
  ShapeObjective objective = ShapeObjective::both;
  /// Steradians. improve() works on tets worse than the shape_quality_bound() of this angle. coarsen() and
  /// refine() end with improve(), and leave a tet much worse than this only if it was before.
  double min_solid_angle = 0.1;
  /// One value for each vertex of the given mesh, nonzero if frozen: a frozen vertex is never moved or
  /// removed, and tets with only frozen vertices are kept. Empty: none.
  std::vector<std::uint8_t> frozen;
  bool fix_boundary = false;  ///< freezes the vertices of boundary and interfaces, and so their faces
  std::uint64_t seed = 1;
  std::string name = "mesh";   ///< the mesh's name in messages
  std::size_t batch_size = 0;  ///< as in SimplifyOptions
  // The pointers may be null; otherwise their objects must outlive the Remesher.

  /// Surface onto which boundary and interface points are projected; null: the mesh's surface at the start of
  /// each call.
  const ReferenceSurface* reference = nullptr;
  /// Projects in all calls onto the surface of the given mesh, or of the mesh after the last call that set
  /// the positions of all points. Builds a tree of the whole surface. Otherwise each call projects onto the
  /// surface at its start, and small deviations may add up.
  bool keep_surfaces = false;
  SimplifyReport* report = nullptr;  ///< receives the rounds of improvement
  /// Notified of rounds. If it is cancelled or its deadline passes, Interrupted or OutOfTime is thrown.
  Progress* progress = nullptr;
};

/// Goal of improve().
struct RemeshAim {
  double angle;  ///< steradians: tets worse than the shape_quality_bound() of this angle are improved
  /// Likewise: for tets worse than this, surface points may leave their surface slightly.
  double leave_surface_angle;
  /// Number of tets of the whole mesh: its bounds, and the target to which collapses reduce it when it is
  /// more than halfway to the upper bound.
  std::size_t target_tets = 0, min_tets = 0, max_tets = std::numeric_limits<std::size_t>::max();
  /// Stop as soon as a round gains little and no tet is below leave_surface_angle.
  bool brief = true;
  int max_rounds = 16;
};

/// The part of a mesh on which a call works. Tets that share a vertex with the region are improved as well if
/// the call changes their surroundings. Vertices adjacent to the region may then move or be removed, which
/// changes the tets around them. All other vertices keep their positions.
class RemeshRegion {
 public:
  /// The tets with these numbers.
  static RemeshRegion tets(std::vector<Index> numbers) { return RemeshRegion(std::move(numbers)); }
  /// The tets with a vertex in a box, borders included; input units.
  static RemeshRegion box(const Vec3& low, const Vec3& high) { return RemeshRegion(Box{low, high}); }
  /// The tets with a vertex for whose position (input units) `inside` is true. Takes time proportional to the
  /// whole mesh, unlike the other kinds: `inside` is called for every vertex, from one thread.
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

/// Changes made by a call, ascending. Everything not listed keeps its number. The number of a removed tet may
/// be reused in the same call and is then in both lists. A reused point number is listed as moved, as if the
/// point had moved to the position of the new point.
struct RemeshChanges {
  std::vector<Index> removed_tets, added_tets;
  std::vector<Index> removed_points, added_points;
  std::vector<Index> moved_points;  ///< among the points that existed before
  std::uint64_t operations = 0;     ///< operations carried out
  int rounds = 0;                   ///< of improvement
};

/// Numbers before and after: renumbering.tets[old] is the new number, no_index for an unused slot.
struct Renumbering {
  std::vector<Index> points, tets;
};

/// A mesh that persists across calls, for remeshing within a running simulation (future work in section 7 of
/// Cutler, Dorsey & McMillan 2004). It keeps adjacency, the grid of its surface, qualities and fields, and
/// updates them locally: time and memory of a call are proportional to the region, not to the mesh.
/// benchmarks/README.md has timings.
///
/// After construction and after compact() there is room for twice the number of slots; the call that exceeds
/// it copies the arrays once. The grid keeps its cell size: call compact() after surface triangles have
/// become many times smaller or larger.
///
/// Vertices and tets are numbered by slots: 0 <= number < point_slots(), tet_slots(). Some slots are empty. A
/// vertex or tet keeps its number until it is removed or compact() is called. Materials, topology and the
/// volumes of materials are preserved as in simplify(), relative to the surface at the start of each call.
/// Lengths are in input units. Coordinates of the given mesh are kept bit by bit; positions given to
/// set_positions() may be rounded in the last bit.
///
/// The result of a call depends on its arguments and the previous calls, never on the number of threads. One
/// call at a time. If a call throws UsageError or InputError, nothing has changed. After Interrupted or
/// OutOfTime only mesh() may be called, and its fields are not carried over. After any other exception the
/// object must not be used.
class Remesher {
 public:
  /// Takes ownership of the mesh and renumbers it.
  ///
  /// \param numbers receives the new numbers; may be null.
  /// \throws as simplify().
  explicit Remesher(TetMesh mesh, const RemesherOptions& options = {}, Renumbering* numbers = nullptr);
  ~Remesher();
  Remesher(Remesher&&) noexcept;
  Remesher& operator=(Remesher&&) noexcept;

  std::size_t tet_count() const;
  std::size_t tet_slots() const;
  std::size_t point_slots() const;
  /// Number of points where parts touch without a common face. Such points and all tets around them are kept
  /// unchanged.
  std::size_t touching_points() const;
  bool has_tet(Index tet) const;
  bool has_point(Index point) const;
  /// \pre The tet or point exists.
  const Tet& tet(Index tet) const;
  MaterialTag material(Index tet) const;
  Vec3 position(Index point) const;
  /// Shape quality of a tet by the objective: 1 for the regular tet, 0 for a flat or inverted one.
  float quality(Index tet) const;

  /// Adds a field. Point fields are interpolated linearly. Tet fields are densities: the sum over a
  /// material's tets of value times volume is kept to 1e-12 of its size, wherever the material still has tets
  /// in the region.
  ///
  /// \param components values per slot.
  /// \param values `components` values for each point or tet slot, in the order of slots; values of empty
  ///   slots are ignored.
  /// \return the field's number, counted from 0 for each kind.
  /// \throws UsageError if `components` is 0 or the number of values is wrong.
  std::size_t add_point_field(std::size_t components, std::vector<double> values);
  std::size_t add_tet_field(std::size_t components, std::vector<double> values);
  /// Values by slot; the caller may write them between calls.
  std::vector<double>& point_field(std::size_t field);
  std::vector<double>& tet_field(std::size_t field);

  /// Sets the positions of all points; work is proportional to the whole mesh. Tets may become inverted;
  /// improve() repairs them.
  ///
  /// \param positions by number, input units; those of empty slots are ignored.
  /// \throws InputError if a position is not finite.
  /// \throws UsageError if their number is wrong.
  void set_positions(std::span<const Vec3> positions);
  /// Sets the positions of some points; time is proportional to their number. If parts of the mesh touch
  /// without a common face, each part has its own point at the common position. All of them follow the first
  /// one, and positions given for the others are ignored.
  ///
  /// \throws UsageError if a point does not exist or the two numbers differ.
  /// \throws InputError if a position is not finite.
  void set_positions(std::span<const Index> points, std::span<const Vec3> positions);

  // improve(), coarsen() and refine() throw UsageError if the region lists tets that do not exist, an angle
  // of the aim is not a number or below 0, its counts contradict each other, or the size is not above 0.

  /// Improves the badly shaped tets of the region (RemesherOptions::min_solid_angle, or `aim`). May insert
  /// and remove points.
  RemeshChanges improve(const RemeshRegion& region);
  RemeshChanges improve(const RemeshRegion& region, const RemeshAim& aim);
  /// Collapses edges much shorter than `size` (input units) in the region, as far as topology, surfaces and
  /// shapes allow, without creating edges much longer than `size`; then improves.
  RemeshChanges coarsen(const RemeshRegion& region, double size);
  /// Halves edges much longer than `size` (input units) in the region, surface edges at their midpoints; then
  /// improves.
  RemeshChanges refine(const RemeshRegion& region, double size);

  /// Renumbers points and tets without gaps, along a space-filling curve, together with their fields; work is
  /// proportional to the whole mesh.
  Renumbering compact();
  /// The current mesh without gaps: points and tets in the order of their numbers, with the fields (named
  /// "point_field_0", "tet_field_0" and so on) and the interfaces.
  TetMesh mesh() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A length, absolute or relative to the size of the input.
struct Length {
  double value = 0;  ///< above 0; input units, or percent of the diagonal of the inputs' bounding box
  bool percent = false;

  double in_input_units(double diagonal) const { return percent ? value / 100 * diagonal : value; }
};

/// Length in input units; 0 for std::nullopt.
inline double in_input_units(const std::optional<Length>& length, double diagonal) {
  return length ? length->in_input_units(diagonal) : 0;
}

/// Names of fields known to be edge lengths; the first one that a file has is used.
inline constexpr std::array<std::string_view, 4> size_names{"size", "sizing", "edge_length", "h"};

/// A target edge length, and the distance from the query point to where it is defined. Input units.
struct WantedLength {
  double length = 0;    ///< above 0
  double distance = 0;  ///< 0 inside the domain of the source
};

/// Target edge lengths by location, as read from a file by read_size_field(). Input units. Immutable; all
/// functions may be called concurrently.
class SizeSource {
 public:
  /// \param field name of the lengths in the file; empty if they have none
  /// \param space coordinate system of the source, see TetMesh::space; empty if unknown
  explicit SizeSource(std::string field = {}, std::string space = {})
      : field_(std::move(field)), space_(std::move(space)) {}
  SizeSource(const SizeSource&) = delete;
  SizeSource& operator=(const SizeSource&) = delete;
  virtual ~SizeSource() = default;

  /// True if the source is defined within a volume, false if lengths are taken from the nearest point of a
  /// surface.
  virtual bool fills_space() const { return true; }

  const std::string& field() const { return field_; }
  const std::string& space() const { return space_; }

  /// Target edge length at a point. Sources that fill space (tet meshes, grids) answer within their domain,
  /// with distance 0, and return std::nullopt elsewhere. Sources on a surface answer everywhere, with the
  /// length at the nearest point and the distance from it. The caller may let lengths grow with that
  /// distance: length + grading * distance.
  virtual std::optional<WantedLength> at(const Vec3& place) const = 0;

  /// Calls f(place, length) for every point with a value that at() depends on, in the file's order.
  virtual void for_each_value(const std::function<void(const Vec3& place, double length)>& f) const = 0;

 private:
  const std::string field_, space_;
};

/// The lengths of a source in another coordinate system.
/// \param from system of the source; counts instead of SizeSource::space(), which may be empty
/// \return null if nothing would change: the systems are equal, or one of them is unknown
std::shared_ptr<const SizeSource> change_space(std::shared_ptr<const SizeSource> sizes,
                                               const std::string& from, const std::string& to);

/// Default growth of the target edge length over distance: adjacent edges then differ by about this fraction,
/// which allows well-shaped tets between them.
inline constexpr double default_grading = 0.5;

/// Bounds of edge lengths, input units.
struct SizeLimits {
  double min_edge = 0;  ///< at least 0
  double max_edge = std::numeric_limits<double>::infinity();
  double grading = default_grading;  ///< growth of the length over distance, above 0
};

/// Edge lengths vary around their target: if targets stay inside the bounds by this factor, nearly all edges
/// are within the bounds.
inline constexpr double within_bounds = 1.48;

/// Limits for target lengths such that the edges stay within `edges`.
inline SizeLimits wanted_within(SizeLimits edges) {
  const double middle = std::sqrt(edges.min_edge * edges.max_edge);
  const double low = within_bounds * edges.min_edge, high = edges.max_edge / within_bounds;
  return low <= high ? SizeLimits{low, high, edges.grading} : SizeLimits{middle, middle, edges.grading};
}

/// Target edge length at each point of a box: the length of a source, clamped to the limits, growing nowhere
/// faster than the grading allows (Persson 2006, "Mesh size functions for implicit geometries and PDE-based
/// gradient limiting").
///
/// Stored on a grid of about 2 million nodes with trilinear interpolation. Every value of the source counts,
/// even if it has more values than the grid has nodes: the field never exceeds a value given on a surface,
/// and exceeds one given within the volume by at most the growth over a cell's diagonal. Input units. Const
/// functions may be called concurrently.
class SizeField {
 public:
  /// Samples the source in the box from `low` to `high`, with one query for each node.
  /// \pre at least one side of the box is above 0
  SizeField(const SizeSource& source, const Vec3& low, const Vec3& high, const SizeLimits& limits);

  /// Target edge length at a point. A point outside the box gets the length at the nearest point of the box.
  double at(const Vec3& place) const;
  /// First of `places` that is farther from the source's domain than the target edge length there plus two
  /// grid spacings. The tolerance is needed since a mesh with sizes may have chords where the body is round.
  /// \return std::nullopt if all are within that distance
  std::optional<Vec3> first_beyond(const SizeSource& source, const std::vector<Vec3>& places) const;
  const SizeLimits& limits() const { return limits_; }

 private:
  std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * size_[1] + static_cast<std::size_t>(y)) * size_[0] +
           static_cast<std::size_t>(x);
  }
  Vec3 node(int x, int y, int z) const { return low_ + spacing_ * Vec3(x, y, z); }
  /// Growth of the target length over the distance from a point of the source to a node.
  double growth(double distance, const SizeSource& source) const;
  void sample(const SizeSource& source);
  void lower_at_values(const SizeSource& source);
  void limit_growth();

  SizeLimits limits_;
  Vec3 low_;
  double spacing_ = 1;
  std::array<std::size_t, 3> size_{2, 2, 2};  ///< nodes along each axis
  std::vector<float> values_;                 ///< by node, the first axis fastest
  std::vector<std::uint8_t> known_;           ///< by node: 1 if the source reaches it
};

/// Edge lengths at the points of a mesh, linear in each tet. A position outside the tets by at most
/// tolerance::within_mesh times the diagonal (of the points that tets use) gets the length at the nearest
/// point of the tets. Inverted tets count as their mirror images. A query takes O(log tets). The tree is
/// built in parallel, and needs as much memory as TetTree.
/// \param lengths one for each point, above 0 and finite where a tet uses the point; other points and their
///   lengths are ignored
/// \param field name of the lengths
/// \pre mesh in range, coordinates finite
std::unique_ptr<const SizeSource> tet_mesh_sizes(TetMesh mesh, std::vector<double> lengths,
                                                 std::string field = {});

/// Edge lengths at the points of a surface, linear in each triangle; any position gets the length at the
/// nearest point of the surface. The choice among several equally near points is deterministic.
std::unique_ptr<const SizeSource> surface_sizes(TriangleMesh surface, std::vector<double> lengths,
                                                std::string field = {});

}  // namespace tetwright

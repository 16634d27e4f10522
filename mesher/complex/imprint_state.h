// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "mesher/complex/surface_imprint.h"

namespace tetwright {

using ImprintEdge = std::array<Index, 2>;  ///< ascending

/// Common part of two triangles of different surfaces that is not a common point yet. The kinds are ordered
/// by what must come first.
struct ImprintEvent {
  enum class Kind : std::uint8_t {
    points,
    point_on_edge,
    point_in_triangle,
    edges_cross,
    edge_pierces,
    diagonals,  ///< edges cross in one plane, and an end of one is a common point near the other
  };
  Kind kind{};
  Index point = no_index;          ///< points, point_on_edge, point_in_triangle; or a triangle: diagonals
  Index other = no_index;          ///< points; or the triangle of point_in_triangle, edge_pierces, diagonals
  ImprintEdge first{}, second{};   ///< edges
  std::uint32_t owner = 0;         ///< surface of the edge or triangle that receives the point
  std::uint32_t second_owner = 0;  ///< surface of the other edge
  auto operator<=>(const ImprintEvent&) const = default;
};

/// Nearest points of two segments, as fractions, and their squared distance.
struct SegmentPair {
  double s, t, squared;
};
SegmentPair nearest_points(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Foot of a point on a segment, as a fraction, and its squared distance.
std::pair<double, double> foot_on(const Vec3& p, const Vec3& a, const Vec3& b);

/// \throws OutputError if this many bytes are not available
void require_imprint_memory(double bytes);

/// Triangles of several surfaces, and where they meet (imprint_surfaces()).
class ImprintState {
 public:
  struct Part {
    Triangle ids;
    Index source;  ///< triangle of the input
    std::uint32_t surface;
    bool active;  ///< its box meets that of a triangle of another surface
    /// New, moved, or with events since find_events(): pairs of other triangles have none.
    bool changed = true;
  };

  /// \param progress may be null
  ImprintState(double tolerance, Progress* progress)
      : tolerance_(tolerance), squared_(tolerance * tolerance), progress_(progress) {}

 protected:
  const Vec3& at(Index p) const { return points_[p]; }
  static std::uint64_t key(const ImprintEdge& e) { return std::uint64_t{e[0]} << 32 | e[1]; }
  static bool has(const Triangle& t, Index p) { return t[0] == p || t[1] == p || t[2] == p; }

  /// \throws Interrupted, OutOfTime
  void throw_if_stopped() const {
    if (progress_) progress_->throw_if_stopped();
  }
  /// Lists the pairs of triangles of different surfaces whose boxes meet.
  /// \param all also triangles that were not active
  /// \throws OutputError if they need more memory than is available
  void find_pairs(bool all);
  std::vector<ImprintEvent> find_events();
  /// Removes from events those of edges that divide the same four points of one plane differently: which of
  /// them is above would be rounding. Returns events that give the later surface the diagonals of the
  /// earlier. \param events of find_events()
  std::vector<ImprintEvent> take_diagonals(std::vector<ImprintEvent>& events) const;
  /// Whether edges pass each other near the end of one that is a point of both surfaces already. Putting this
  /// point on the other edge makes a sliver there, whose removal takes it off again.
  bool passes_common_point(const ImprintEvent& e) const;
  /// Triangles whose height is at most `limit`, input units: the middle point is put on the longest edge,
  /// which makes them vanish. No two of them share an edge.
  /// \param only_folds only those that moves of points have turned over
  std::vector<ImprintEvent> find_slivers(double limit, bool only_folds = false) const;
  /// Fraction at which an edge crosses the interior of a triangle, with both ends farther than the tolerance
  /// from its plane.
  std::optional<double> crossing(const ImprintEdge& e, const Triangle& t) const;

  double tolerance_, squared_;
  Progress* progress_;
  std::vector<Vec3> points_;
  std::vector<Vec3> normals_;  ///< of the triangles of the input, of any length
  std::vector<Part> triangles_;
  std::vector<ImprintEdge> pairs_;  ///< of triangles of different surfaces whose boxes meet

 private:
  void find_memberships();
  bool is_on(Index p, std::uint32_t surface) const;
  bool is_on(const ImprintEdge& e, std::uint32_t surface) const;
  bool is_folded(const Part& t) const;
  void points_against(const Part& a, Index t, std::vector<ImprintEvent>& out) const;
  void edges_against(const ImprintEdge& pair, std::vector<ImprintEvent>& out) const;
  void pierce(const Part& a, Index t, std::vector<ImprintEvent>& out) const;

  using Membership = std::pair<std::uint64_t, std::uint32_t>;
  std::vector<Membership> point_uses_, edge_uses_;  ///< surfaces of points and edges, ascending
};

}  // namespace tetwright

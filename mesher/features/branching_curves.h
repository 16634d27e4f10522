// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/projection_tree.h"
#include "mesher/complex/labelled_complex.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// The curves of a complex in which four or more sheets meet, as chains of vertices that a mesh can have.
/// Curves end, and chains have a vertex, where the sheets that meet change.
class BranchingCurves {
 public:
  struct Vertex {
    Vec3 position;                     ///< on a curve, input units
    std::vector<RegionIndex> regions;  ///< of the complex there, ascending
    std::vector<Index> next;           ///< neighbours along curves, ascending
    bool is_on_boundary() const { return !regions.empty() && regions.front() == outside_region; }
  };
  /// A point of a curve.
  struct Location {
    Index curve;
    double along;     ///< distance from the start of the curve
    double distance;  ///< from the curve
  };

  /// \param edges of the complex, ascending, at which four or more sheets meet
  /// \param ends flags points of the complex at which further sheets meet
  BranchingCurves(const LabelledComplex& complex, std::span<const std::array<Index, 2>> edges,
                  const std::vector<std::uint8_t>& ends);

  /// The nearest point of all curves, or nothing if it is farther away than `reach`, input units.
  std::optional<Location> locate(const Vec3& p, double reach) const;
  /// Length of a curve, input units.
  double length(Index curve) const { return curves_[curve].along.back(); }
  std::size_t size() const { return curves_.size(); }
  /// Whether three or more curves meet at the start and at the end of a curve.
  std::array<bool, 2> branches(Index curve) const;

  /// Makes the chains.
  /// \param spacing of their vertices at a distance along a curve, input units, above 0
  /// \param step at which the spacing is read, input units, above 0
  void divide(const std::function<double(Index curve, double along)>& spacing, double step);
  /// Vertices of all chains; after divide().
  const std::vector<Vertex>& vertices() const { return vertices_; }
  /// The first and the last vertex of a curve; after divide().
  std::array<Index, 2> ends(Index curve) const {
    return {curves_[curve].vertices.front(), curves_[curve].vertices.back()};
  }
  /// The vertex nearest to a location along its curve. \pre divide() was called
  Index nearest_vertex(const Location& location) const;

 private:
  struct Curve {
    std::vector<Index> points;    ///< of the complex; a closed curve ends at its first point
    std::vector<double> along;    ///< of each point
    std::vector<Index> vertices;  ///< of the chain
    std::vector<double> at;       ///< of each vertex, distance along the curve
  };
  void trace(std::span<const std::array<Index, 2>> edges, const std::vector<std::uint8_t>& ends);
  Vec3 position(const Curve& curve, double along) const;
  Index vertex_at(Index point);

  std::vector<Vec3> points_;                       ///< of the complex
  std::vector<std::vector<RegionIndex>> regions_;  ///< of each point on a curve
  std::vector<Curve> curves_;
  std::vector<std::uint8_t> branches_;  ///< by point of the complex: three or more curves meet there
  std::vector<Vertex> vertices_;
  std::vector<Index> vertex_of_;  ///< by point of the complex: of ends of curves
  ProjectionTree tree_;           ///< kinds are a curve and the number of a segment
};

}  // namespace tetwright

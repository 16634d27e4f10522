// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/types.h"

namespace tetwright {

/// Maximum of the smallest solid angle of a tet, reached by the regular tet: 3 acos(1/3) - pi, steradians.
inline constexpr double regular_solid_angle = 0.55128559843253081;

/// Solid angles of a tet in steradians, in the order of its vertices; all 0 if it is flat or negative (Van
/// Oosterom & Strackee 1983).
std::array<double, 4> solid_angles(const std::array<Vec3, 4>& tet);

/// Minimum of solid_angles(), without computing the others.
double min_solid_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Tangent of half of min_solid_angle(), for comparisons: grows with the angle and is cheaper.
double min_solid_angle_tangent(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Dihedral angles in degrees, in the order of tet_edges; NaN where a face is degenerate.
std::array<double, 6> dihedral_angles(const std::array<Vec3, 4>& tet);

/// Signed volume, input units cubed.
double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Measure of a tet's shape for mesh improvement, a number in [0, 1]: 1 for the regular tet.
enum class ShapeObjective : std::uint8_t {
  /// Minimum of the smallest solid angle in steradians and 0.3 times the smallest sine of a dihedral angle:
  /// against slivers, needles and flat tets alike.
  both,
  solid_angle,  ///< the smallest solid angle
  dihedral      ///< the smallest sine of a dihedral angle: against small and large ones alike
};

/// Weight of a sine against a solid angle in steradians in ShapeObjective::both: 0.1 sr then corresponds to
/// dihedral angles of 19.5 and 160.5 degrees.
inline constexpr double sine_weight = 0.3;

/// Quality(t) of Cutler, Dorsey & McMillan 2004, section 3: the geometric mean of three factors in [0, 1]
/// that reward solid angles near the regular tet's, a volume of at least the ideal one and edges no longer
/// than beta ideal edges.
struct TetQuality {
  double ideal_volume;  ///< volume of the model / target count
  double ideal_edge;    ///< cube root of ideal_volume
  double beta;          ///< the paper uses 5
  /// Tets whose smallest solid angle (steradians) is below this are devalued by the square of its ratio to
  /// it; otherwise a needle would equal a small but well-shaped tet. 0: off, as in the paper.
  double needle_angle = 0;

  /// \param total_volume volume of the model
  /// \param target number of tets wanted
  static TetQuality for_target(double total_volume, double target, double beta = 5);

  /// Quality(t)^3 in [0, 1], which orders tets as Quality(t) does without the cube root. 0 for a tet that is
  /// negative or so flat that rounding may have decided its sign; a positive value proves a positive exact
  /// sign.
  double cubed(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;
  /// Upper bound of cubed() for a tet of six times the volume `det`, slightly enlarged for rounding.
  double max_for_volume(double det) const { return det * (1 + 0x1p-20) / (6 * ideal_volume); }
  /// Quality(t) in [0, 1].
  double operator()(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;
};

/// Shape quality, independent of size: the objective's value over the regular tet's, in [0, 1]; 0 as for
/// TetQuality::cubed().
double shape_quality(ShapeObjective objective, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
/// shape_quality() of a tet whose smallest solid angle is `solid_angle` (steradians) and whose dihedral
/// angles are no worse than the objective weighs against it: converts bounds on angles into bounds on the
/// objective. At most 0.99: no mesh consists of regular tets alone, and a bound on all tets must be
/// attainable.
double shape_quality_bound(ShapeObjective objective, double solid_angle);

}  // namespace tetwright

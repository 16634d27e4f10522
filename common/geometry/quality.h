// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "common/types.h"

namespace tetwright {

/// Largest solid angle that the smallest one of a tet can have: that of the regular tet, 3 acos(1/3) - pi,
/// steradians.
inline constexpr double regular_solid_angle = 0.55128559843253081;

/// The four solid angles of a tet in steradians, in the order of its vertices. A tet that is flat or negative
/// has 0s. (Van Oosterom & Strackee 1983.)
std::array<double, 4> solid_angles(const std::array<Vec3, 4>& tet);

/// The smallest of solid_angles(), without computing the others.
double min_solid_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The tangent of half of min_solid_angle(): grows with the angle and takes less time, for comparisons.
double min_solid_angle_tangent(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The six dihedral angles in degrees, in the order of tet_edges. Not a number where a face is degenerate.
std::array<double, 6> dihedral_angles(const std::array<Vec3, 4>& tet);

/// Signed volume, input units cubed.
double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// What makes a shape good when meshes are improved. Each is a number in [0, 1], 1 for the regular tet.
enum class ShapeObjective : std::uint8_t {
  /// The smaller of the smallest solid angle in steradians and 0.3 times the smallest sine of a dihedral
  /// angle:
  /// against slivers, needles and flat tets alike.
  both,
  solid_angle,  ///< the smallest solid angle
  dihedral      ///< the smallest sine of a dihedral angle: against small and large ones alike
};

/// Weight of a sine against a solid angle in steradians in ShapeObjective::both: 0.1 sr then stands for
/// dihedral angles of 19.5 and 160.5 degrees.
inline constexpr double sine_weight = 0.3;

/// Quality(t) of Cutler, Dorsey & McMillan 2004, section 3: the geometric mean of three factors in [0, 1]
/// that reward solid angles near the regular tet's, a volume of at least the ideal one and edges no longer
/// than beta ideal edges.
struct TetQuality {
  double ideal_volume;  ///< volume of the model / target count
  double ideal_edge;    ///< cube root of ideal_volume
  double beta;          ///< the paper uses 5
  /// Tets whose smallest solid angle (steradians) is below this are worth less, by the square of its share:
  /// else a needle passes for as good as a small but well-shaped tet. 0, as in the paper: not so.
  double needle_angle = 0;

  /// `volume` > 0, `longest_edge` > 0: the model's volume is total_volume and `target` tets are wanted.
  static TetQuality for_target(double total_volume, double target, double beta = 5);

  /// Quality(t)^3 in [0, 1], which orders tets as Quality(t) does without the cube root; 0 for a tet that is
  /// negative or so flat that rounding may have decided its sign: more than 0 means positive by exact sign.
  double cubed(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;
  /// The maximum of cubed() for a tet of six times this volume, a little above for rounding.
  double max_for_volume(double det) const { return det * (1 + 0x1p-20) / (6 * ideal_volume); }
  /// Quality(t) in [0, 1].
  double operator()(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const;
};

/// Shape alone, whatever the size: the objective's value over the regular tet's, in [0, 1]; 0 as for
/// TetQuality::cubed().
double shape_quality(ShapeObjective objective, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
/// shape_quality() of a tet whose smallest solid angle is `solid_angle` and whose dihedral angles are no
/// worse than the objective wants them beside it; what bounds on angles mean in terms of the objective. At
/// most 0.99: no mesh is made of regular tets alone, and what is asked of all must be within reach.
double shape_quality_bound(ShapeObjective objective, double solid_angle);

}  // namespace tetwright

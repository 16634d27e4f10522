// SPDX-License-Identifier: Apache-2.0
#include "tetwright/mesh_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/geometry/predicates.h"
#include "common/portable_math.h"

namespace tetwright {

namespace {

/// Terms of a tet's solid angles: tan(omega_k / 2) = det / denominator[k].
struct SolidAngleTerms {
  double det;                         ///< six times the volume
  std::array<double, 4> denominator;  ///< by vertex; negative for an angle above pi
  double longest_squared;             ///< maximum of the squared edge lengths
};

SolidAngleTerms terms(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b, cd = d - c;
  const double ab2 = ab.squaredNorm(), ac2 = ac.squaredNorm(), ad2 = ad.squaredNorm();
  const double bc2 = bc.squaredNorm(), bd2 = bd.squaredNorm(), cd2 = cd.squaredNorm();
  const double lab = std::sqrt(ab2), lac = std::sqrt(ac2), lad = std::sqrt(ad2);
  const double lbc = std::sqrt(bc2), lbd = std::sqrt(bd2), lcd = std::sqrt(cd2);
  // Scalar products of two edges at a vertex, from squared lengths: u.v = (u^2 + v^2 - (u-v)^2) / 2.
  const auto corner = [](double lu, double lv, double lw, double u2, double v2, double w2, double uv2,
                         double uw2, double vw2) {
    return lu * lv * lw + 0.5 * ((u2 + v2 - uv2) * lw + (u2 + w2 - uw2) * lv + (v2 + w2 - vw2) * lu);
  };
  SolidAngleTerms t;
  t.det = ab.cross(ac).dot(ad);
  t.denominator = {corner(lab, lac, lad, ab2, ac2, ad2, bc2, bd2, cd2),
                   corner(lab, lbc, lbd, ab2, bc2, bd2, ac2, ad2, cd2),
                   corner(lac, lbc, lcd, ac2, bc2, cd2, ab2, ad2, bd2),
                   corner(lad, lbd, lcd, ad2, bd2, cd2, ab2, ac2, bc2)};
  t.longest_squared = std::max({ab2, ac2, ad2, bc2, bd2, cd2});
  return t;
}

/// Denominator of the smallest solid angle; all four angles share the numerator. It is positive, since the
/// smallest solid angle is below pi: the four angles of a tet sum to less than 2 pi.
double max_denominator(const SolidAngleTerms& t) {
  return std::max(std::max(t.denominator[0], t.denominator[1]), std::max(t.denominator[2], t.denominator[3]));
}
double smallest_angle(const SolidAngleTerms& t) {
  return 2 * portable_atan2_upper(t.det, max_denominator(t));
}

/// Smallest solid angle to nine digits, which is enough for decisions; a full arc tangent would take most of
/// the time. The tangent of half the angle is at most the regular tet's, 0.283, so a short series suffices.
double min_angle_for_comparison(const SolidAngleTerms& t) {
  const double x = t.det / max_denominator(t), s = x * x;
  return 2 * x *
         (1 -
          s * (1.0 / 3 - s * (1.0 / 5 - s * (1.0 / 7 - s * (1.0 / 9 - s * (1.0 / 11 - s * (1.0 / 13)))))));
}

/// Whether the exact determinant is positive for certain. With edges of length at most l the rounding error
/// is below 40 l^3 2^-53 (differences, two products and two sums for each of three terms of size 2 l^3).
bool surely_positive(double det, double longest_cubed) { return det > 40 * 0x1p-53 * longest_cubed; }

}  // namespace

std::array<double, 4> solid_angles(const std::array<Vec3, 4>& p) {
  const SolidAngleTerms t = terms(p[0], p[1], p[2], p[3]);
  if (!(t.det > 0)) return {0, 0, 0, 0};
  std::array<double, 4> angles;
  for (int k = 0; k < 4; ++k) angles[k] = 2 * portable_atan2_upper(t.det, t.denominator[k]);
  return angles;
}

double min_solid_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const SolidAngleTerms t = terms(a, b, c, d);
  return t.det > 0 ? smallest_angle(t) : 0;
}

double min_solid_angle_tangent(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const SolidAngleTerms t = terms(a, b, c, d);
  return t.det > 0 ? t.det / max_denominator(t) : 0;
}

std::array<double, 6> dihedral_angles(const std::array<Vec3, 4>& p) {
  std::array<Vec3, 4> normal;  // outward for a positive tet
  for (int k = 0; k < 4; ++k) {
    const auto& f = tet_faces[k];
    normal[k] = (p[f[1]] - p[f[0]]).cross(p[f[2]] - p[f[0]]);
  }
  std::array<double, 6> angles;
  for (int e = 0; e < 6; ++e) {
    // The two faces at an edge lie opposite the two vertices that are not on it.
    const auto& other = tet_edges[5 - e];
    const Vec3 &n = normal[other[0]], &m = normal[other[1]];
    // The dihedral angle is pi minus the angle between the outward normals.
    const double across = n.cross(m).norm(), along = -n.dot(m);
    angles[e] = across == 0 && along == 0 ? std::numeric_limits<double>::quiet_NaN()
                                          : portable_atan2_upper(across, along) * (180 / std::numbers::pi);
  }
  return angles;
}

double tet_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return orient3d_value(a, b, c, d) / 6;
}

TetQuality TetQuality::for_target(double total_volume, double target, double beta) {
  TetQuality q;
  q.ideal_volume = total_volume / target;
  q.ideal_edge = portable_cbrt(q.ideal_volume);
  q.beta = beta;
  return q;
}

double TetQuality::cubed(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
  const SolidAngleTerms t = terms(a, b, c, d);
  const double longest = std::sqrt(t.longest_squared);
  if (!surely_positive(t.det, t.longest_squared * longest)) return 0;
  // The paper divides by 0.55, rounded down from the regular tet's angle, and clamps to 1.
  const double smallest = min_angle_for_comparison(t);
  const double needle = smallest < needle_angle ? smallest / needle_angle : 1;
  const double angle = std::min(1.0, smallest / 0.55) * needle * needle;
  const double volume = std::min(1.0, t.det / (6 * ideal_volume));
  const double limit = beta * ideal_edge;
  const double edge = longest > limit ? limit / longest : 1.0;
  return angle * volume * edge;
}

namespace {

/// Sine of a regular tet's dihedral angle, 2 sqrt(2) / 3.
constexpr double regular_sine = 0.94280904158206336;

/// Smallest sine of the six dihedral angles of a tet. At an edge of length l between faces of areas A and B
/// it is 3 V l / (2 A B).
/// \param det six times the volume V
double min_sine(double det, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ab = b - a, ac = c - a, ad = d - a, bc = c - b, bd = d - b, cd = d - c;
  // Squares of twice the areas of the faces opposite a, b, c, d.
  const double fa = bc.cross(bd).squaredNorm(), fb = ac.cross(ad).squaredNorm(),
               fc = ab.cross(ad).squaredNorm(), fd = ab.cross(ac).squaredNorm();
  const double min_factor =
      std::min({ab.squaredNorm() / (fc * fd), ac.squaredNorm() / (fb * fd), ad.squaredNorm() / (fb * fc),
                bc.squaredNorm() / (fa * fd), bd.squaredNorm() / (fa * fc), cd.squaredNorm() / (fa * fb)});
  return det * std::sqrt(min_factor);
}

}  // namespace

double shape_quality(ShapeObjective objective, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const SolidAngleTerms t = terms(a, b, c, d);
  if (!surely_positive(t.det, t.longest_squared * std::sqrt(t.longest_squared))) return 0;
  if (objective == ShapeObjective::solid_angle)
    return std::min(1.0, min_angle_for_comparison(t) / regular_solid_angle);
  const double sine = min_sine(t.det, a, b, c, d);
  if (objective == ShapeObjective::dihedral) return std::min(1.0, sine / regular_sine);
  const double value = std::min(min_angle_for_comparison(t), sine_weight * sine);
  return std::min(1.0, value / (sine_weight * regular_sine));
}

double shape_quality_bound(ShapeObjective objective, double solid_angle) {
  constexpr double max_bound = 0.99;
  if (objective == ShapeObjective::solid_angle) return std::min(max_bound, solid_angle / regular_solid_angle);
  return std::min(max_bound, solid_angle / (sine_weight * regular_sine));
}

double TetQuality::operator()(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) const {
  return portable_cbrt(cubed(a, b, c, d));
}

}  // namespace tetwright

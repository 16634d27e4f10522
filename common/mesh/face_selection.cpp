// SPDX-License-Identifier: Apache-2.0
#include "tetwright/face_selection.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/geometry/point_triangle.h"
#include "common/mesh/new_patches.h"
#include "common/message_text.h"
#include "common/portable_math.h"
#include "common/trimmed.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Rounding of the coordinates of corners, relative to the diagonal: corners on the border of a box are in
/// it.
constexpr double rounding_of_corners = 1e-9;
/// Rounding of angles: the normal of a face in a plane of any direction has its angle to 1e-7 degrees.
constexpr double rounding_of_degrees = 1e-6;
/// Max distance of a PatchAt rule's point from the boundary that goes without saying, as a share of the
/// diagonal: points picked on a surface are nearer to its mesh.
constexpr double max_share_beside_patch = 0.01;

// Parsing.

struct RuleForm {
  std::string_view name;
  const char* example;
};
constexpr std::array rule_forms{
    RuleForm{"plane", "plane:z=min,0.5%"}, RuleForm{"box", "box:0,0,0,1,1,1"},
    RuleForm{"sphere", "sphere:0,0,0,1"},  RuleForm{"cylinder", "cylinder:0,0,0,0,0,5,1"},
    RuleForm{"normal", "normal:0,0,1,20"}, RuleForm{"patch-at", "patch-at:0,0,1"}};

class RuleParser {
 public:
  RuleParser(const std::string& name, std::string_view rule) : name_(name), rule_(rule) {}

  SelectionTerm parse() const {
    const std::size_t colon = rule_.find(':');
    const std::string_view kind = trimmed(rule_.substr(0, colon));
    const auto form =
        std::find_if(rule_forms.begin(), rule_forms.end(), [&](const RuleForm& f) { return f.name == kind; });
    if (colon == std::string_view::npos || form == rule_forms.end()) {
      std::string known;
      for (const RuleForm& f : rule_forms) known += (known.empty() ? "" : ", ") + std::string(f.example);
      fail("is no rule; rules are " + known + ", joined by 'and'");
    }
    const std::string_view rest = rule_.substr(colon + 1);
    SelectionTerm term{{}, std::string(rule_)};
    if (kind == "plane")
      term.rule = plane(rest, *form);
    else if (kind == "box")
      term.rule = box(numbers(rest, 6, *form));
    else if (kind == "sphere")
      term.rule = sphere(numbers(rest, 4, *form));
    else if (kind == "cylinder")
      term.rule = cylinder(numbers(rest, 7, *form));
    else if (kind == "normal")
      term.rule = normal(numbers(rest, 4, *form));
    else
      term.rule = PatchAt{point(numbers(rest, 3, *form), 0)};
    return term;
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw UsageError("--select " + name_ + ": " + in_quotes(rule_) + " " + why);
  }

  double number(std::string_view text, const RuleForm& form) const {
    double value = 0;
    text = trimmed(text);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      fail("has " + in_quotes(text) + " where a number is expected, as in " + form.example);
    return value;
  }

  static std::vector<std::string_view> fields(std::string_view text) {
    std::vector<std::string_view> parts;
    for (std::size_t begin = 0;;) {
      const std::size_t comma = text.find(',', begin);
      parts.push_back(trimmed(text.substr(begin, comma == std::string_view::npos ? comma : comma - begin)));
      if (comma == std::string_view::npos) return parts;
      begin = comma + 1;
    }
  }

  std::vector<double> numbers(std::string_view text, std::size_t count, const RuleForm& form) const {
    const std::vector<std::string_view> parts = fields(text);
    if (parts.size() != count)
      fail("has " + std::to_string(parts.size()) + (parts.size() == 1 ? " number" : " numbers") +
           " instead of " + std::to_string(count) + ", as in " + form.example);
    std::vector<double> values;
    values.reserve(count);
    for (const std::string_view part : parts) values.push_back(number(part, form));
    return values;
  }

  static Vec3 point(const std::vector<double>& values, std::size_t first) {
    return {values[first], values[first + 1], values[first + 2]};
  }

  InPlane plane(std::string_view text, const RuleForm& form) const {
    InPlane rule{};
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) fail(std::string("has no =, as in ") + form.example);
    const std::string_view axis = trimmed(text.substr(0, equals));
    if (axis == "x" || axis == "y" || axis == "z")
      rule.normal = Vec3::Unit(axis[0] - 'x');
    else
      rule.normal = point(numbers(axis, 3, form), 0);
    if (!(rule.normal.stableNorm() > 0)) fail("has a normal of length 0");
    const std::vector<std::string_view> parts = fields(text.substr(equals + 1));
    if (parts.size() > 2)
      fail(std::string("has more than a coordinate and a tolerance, as in ") + form.example);
    if (parts[0] == "min" || parts[0] == "max")
      rule.at = parts[0] == "min" ? InPlane::At::min : InPlane::At::max;
    else
      rule.coordinate = number(parts[0], form);
    if (parts.size() == 2) {
      rule.tolerance.percent = parts[1].ends_with('%');
      rule.tolerance.value =
          number(rule.tolerance.percent ? parts[1].substr(0, parts[1].size() - 1) : parts[1], form);
      if (rule.tolerance.value < 0) fail("has a tolerance below 0");
    }
    return rule;
  }

  InBox box(const std::vector<double>& values) const {
    const Vec3 a = point(values, 0), b = point(values, 3);
    return {a.cwiseMin(b), a.cwiseMax(b)};
  }

  double radius(double value) const {
    if (!(value > 0)) fail("has a radius that is not above 0");
    return value;
  }

  InSphere sphere(const std::vector<double>& values) const { return {point(values, 0), radius(values[3])}; }

  InCylinder cylinder(const std::vector<double>& values) const {
    InCylinder rule{point(values, 0), point(values, 3), radius(values[6])};
    if (!((rule.to - rule.from).norm() > 0)) fail("has an axis of length 0");
    return rule;
  }

  WithNormal normal(const std::vector<double>& values) const {
    WithNormal rule{point(values, 0), values[3]};
    if (!(rule.direction.stableNorm() > 0)) fail("has a direction of length 0");
    if (!(rule.degrees >= 0 && rule.degrees <= 180)) fail("has an angle that is not from 0 to 180 degrees");
    return rule;
  }

  const std::string& name_;
  std::string_view rule_;
};

// Evaluation.

/// How far a face is from fulfilling a rule: 0 if it does, otherwise a length or degrees.
class Measure {
 public:
  explicit Measure(const TetMesh& mesh) : mesh_(mesh) {
    for (std::size_t i = 0; i < mesh.interfaces.size(); ++i)
      if (!mesh.interfaces[i].other) boundary_.push_back(i);
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const std::size_t i : boundary_)
      for (const Index p : mesh.interfaces[i].ids) {
        low = low.cwiseMin(mesh.points[p]);
        high = high.cwiseMax(mesh.points[p]);
      }
    if (!boundary_.empty()) diagonal_ = (high - low).norm();
  }

  const std::vector<std::size_t>& boundary() const { return boundary_; }

  /// \return for each boundary face
  std::vector<double> of(const SelectionTerm& term) const {
    return std::visit([&](const auto& rule) { return misses(rule); }, term.rule);
  }

  /// The distance of a PatchAt rule's point from the nearest face if it is large, else 0.
  double far_off(const SelectionTerm& term) const {
    const auto* patch = std::get_if<PatchAt>(&term.rule);
    if (patch == nullptr || boundary_.empty()) return 0;
    const std::vector<double> distances = distances_from(patch->point);
    const double distance = *std::min_element(distances.begin(), distances.end());
    return distance > max_share_beside_patch * diagonal_ ? distance : 0;
  }

  static bool in_degrees(const SelectionTerm& term) { return std::holds_alternative<WithNormal>(term.rule); }

  Vec3 centre(std::size_t boundary_face) const {
    const Triangle& ids = mesh_.interfaces[boundary_[boundary_face]].ids;
    return (mesh_.points[ids[0]] + mesh_.points[ids[1]] + mesh_.points[ids[2]]) / 3;
  }

  double area(std::size_t boundary_face) const { return normal(boundary_face).norm() / 2; }

 private:
  Vec3 normal(std::size_t boundary_face) const {
    const Triangle& ids = mesh_.interfaces[boundary_[boundary_face]].ids;
    const Vec3& a = mesh_.points[ids[0]];
    return (mesh_.points[ids[1]] - a).cross(mesh_.points[ids[2]] - a);
  }

  /// For each face the largest miss of its corners.
  template <class MissOf>
  std::vector<double> of_corners(const MissOf& miss_of) const {
    std::vector<double> result;
    result.reserve(boundary_.size());
    for (const std::size_t i : boundary_) {
      double largest = 0;
      for (const Index p : mesh_.interfaces[i].ids) largest = std::max(largest, miss_of(mesh_.points[p]));
      result.push_back(largest <= rounding_of_corners * diagonal_ ? 0 : largest);
    }
    return result;
  }

  std::vector<double> misses(const InPlane& rule) const {
    const Vec3 unit = rule.normal.stableNormalized();
    double at = rule.coordinate / rule.normal.stableNorm();
    if (rule.at != InPlane::At::value) {
      const double sign = rule.at == InPlane::At::min ? 1 : -1;
      at = std::numeric_limits<double>::infinity();
      for (const std::size_t i : boundary_)
        for (const Index p : mesh_.interfaces[i].ids) at = std::min(at, sign * unit.dot(mesh_.points[p]));
      at *= sign;
    }
    const double tolerance = rule.tolerance.in_input_units(diagonal_);
    return of_corners([&](const Vec3& p) { return std::fabs(unit.dot(p) - at) - tolerance; });
  }

  std::vector<double> misses(const InBox& rule) const {
    return of_corners(
        [&](const Vec3& p) { return (rule.low - p).cwiseMax(p - rule.high).cwiseMax(Vec3::Zero()).norm(); });
  }

  std::vector<double> misses(const InSphere& rule) const {
    return of_corners([&](const Vec3& p) { return (p - rule.centre).norm() - rule.radius; });
  }

  std::vector<double> misses(const InCylinder& rule) const {
    const double length = (rule.to - rule.from).norm();
    const Vec3 axis = (rule.to - rule.from) / length;
    return of_corners([&](const Vec3& p) {
      const double along = axis.dot(p - rule.from);
      const double beside = std::max(0.0, (p - rule.from - along * axis).norm() - rule.radius);
      const double beyond = std::max({0.0, -along, along - length});
      return std::sqrt(beside * beside + beyond * beyond);
    });
  }

  std::vector<double> misses(const WithNormal& rule) const {
    std::vector<double> result;
    result.reserve(boundary_.size());
    const Vec3 direction = rule.direction.stableNormalized();
    for (std::size_t f = 0; f < boundary_.size(); ++f) {
      const Vec3 n = normal(f);
      if (!(n.squaredNorm() > 0)) {
        result.push_back(180);  // a face without area has no normal
        continue;
      }
      const double angle = portable_atan2_upper(n.cross(direction).norm(), n.dot(direction));
      const double miss = angle * 180 / std::numbers::pi - rule.degrees;
      result.push_back(miss <= rounding_of_degrees ? 0 : miss);
    }
    return result;
  }

  std::vector<double> misses(const PatchAt& rule) const {
    std::vector<double> result = distances_from(rule.point);
    if (boundary_.empty()) return result;
    const auto nearest =
        static_cast<std::size_t>(std::min_element(result.begin(), result.end()) - result.begin());
    // Only connected faces fulfil the rule, also where others touch the point.
    for (double& miss : result) miss = std::max(miss, std::numeric_limits<double>::min());
    for (const std::size_t f : connected_with(nearest)) result[f] = 0;
    return result;
  }
  /// By boundary face.
  std::vector<double> distances_from(const Vec3& point) const {
    std::vector<double> result;
    result.reserve(boundary_.size());
    for (const std::size_t face : boundary_) {
      const Triangle& ids = mesh_.interfaces[face].ids;
      result.push_back(
          (closest_point(point, mesh_.points[ids[0]], mesh_.points[ids[1]], mesh_.points[ids[2]]) - point)
              .norm());
    }
    return result;
  }

  /// Boundary faces connected by edges within a patch.
  std::vector<std::size_t> connected_with(std::size_t first) const {
    std::map<std::array<Index, 2>, std::vector<std::size_t>> at_edges;
    const auto patch_of = [&](std::size_t f) {
      const InterfaceTriangle& t = mesh_.interfaces[boundary_[f]];
      return InterfacePatch{t.pair(), t.patch};
    };
    for (std::size_t f = 0; f < boundary_.size(); ++f)
      if (patch_of(f) == patch_of(first))
        for (std::size_t k = 0; k < 3; ++k) {
          const Triangle& ids = mesh_.interfaces[boundary_[f]].ids;
          at_edges[ascending_edge(ids[k], ids[(k + 1) % 3])].push_back(f);
        }
    std::vector<std::size_t> reached{first};
    std::set<std::size_t> known{first};
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        const Triangle& ids = mesh_.interfaces[boundary_[reached[i]]].ids;
        for (const std::size_t f : at_edges.at(ascending_edge(ids[k], ids[(k + 1) % 3])))
          if (known.insert(f).second) reached.push_back(f);
      }
    return reached;
  }

  const TetMesh& mesh_;
  std::vector<std::size_t> boundary_;  ///< indices into TetMesh::interfaces
  double diagonal_ = 0;
};

/// Says what was nearest to a selection without faces.
void find_nearest(const FaceSelection& selection, const std::vector<std::vector<double>>& misses,
                  const Measure& measure, SelectedFaces& result) {
  if (measure.boundary().empty()) {
    result.nearest = "the mesh has no boundary faces";
    return;
  }
  // The face that fulfils most rules; of equal ones that which misses the first of the others by least.
  std::size_t best = 0, best_failed = 0;
  std::pair<std::size_t, double> least{misses.size() + 1, 0};
  for (std::size_t f = 0; f < measure.boundary().size(); ++f) {
    std::size_t failed = misses.size();
    std::size_t count = 0;
    for (std::size_t t = misses.size(); t-- > 0;)
      if (misses[t][f] > 0) {
        failed = t;
        ++count;
      }
    const std::pair<std::size_t, double> key{count, failed < misses.size() ? misses[failed][f] : 0};
    if (key < least) {
      least = key;
      best = f;
      best_failed = failed;
    }
  }
  if (best_failed == misses.size()) {
    result.nearest = "an earlier selection has the faces";
  } else {
    const SelectionTerm& term = selection.terms[best_failed];
    result.nearest = "the nearest face misses " + in_quotes(term.text) + " by " +
                     short_number(misses[best_failed][best]) + (Measure::in_degrees(term) ? " degrees" : "");
  }
  result.nearest_place = measure.centre(best);
}

}  // namespace

FaceSelection parse_face_selection(const std::string& name, const std::string& rules) {
  FaceSelection selection{name, {}};
  if (name.empty()) throw UsageError("--select " + in_quotes(rules) + " has no name; give NAME=RULE");
  if (name.find_first_of(":|") != std::string::npos)
    throw UsageError("--select: the name " + in_quotes(name) +
                     " has : or |, which names of interfaces and their sides have; give another name");
  constexpr std::string_view joined_by = " and ";
  std::string_view rest = rules;
  for (;;) {
    const std::size_t next = rest.find(joined_by);
    selection.terms.push_back(RuleParser(name, trimmed(rest.substr(0, next))).parse());
    if (next == std::string_view::npos) return selection;
    rest.remove_prefix(next + joined_by.size());
  }
}

std::vector<SelectedFaces> select_faces(TetMesh& mesh, const std::vector<FaceSelection>& selections) {
  if (selections.empty()) return {};
  const Measure measure(mesh);
  const std::vector<std::size_t>& boundary = measure.boundary();
  std::vector<SelectedFaces> results;
  std::vector<std::size_t> of_faces(boundary.size(), selections.size());
  for (std::size_t s = 0; s < selections.size(); ++s) {
    SelectedFaces& result = results.emplace_back(SelectedFaces{.name = selections[s].name});
    std::vector<std::vector<double>> misses;
    for (const SelectionTerm& term : selections[s].terms) misses.push_back(measure.of(term));
    for (std::size_t f = 0; f < boundary.size(); ++f) {
      if (std::any_of(misses.begin(), misses.end(), [&](const auto& miss) { return miss[f] > 0; })) continue;
      if (of_faces[f] < selections.size()) {
        ++result.in_earlier;
        continue;
      }
      of_faces[f] = s;
      ++result.faces;
      result.area += measure.area(f);
    }
    if (result.faces == 0) find_nearest(selections[s], misses, measure, result);
    for (const SelectionTerm& term : selections[s].terms)
      if (const double distance = measure.far_off(term); distance > 0)
        result.far_points.emplace_back(term.text, distance);
  }
  NewPatches patches(mesh);
  std::map<std::pair<std::size_t, InterfacePatch>, std::uint16_t> patch_of;
  std::vector<std::map<std::string, std::size_t>> taken(selections.size());
  for (std::size_t f = 0; f < boundary.size(); ++f) {
    const std::size_t s = of_faces[f];
    if (s == selections.size()) continue;
    InterfaceTriangle& face = mesh.interfaces[boundary[f]];
    const InterfacePatch before{face.pair(), face.patch};
    if (const auto group = mesh.patch_groups.find(before);
        group != mesh.patch_groups.end() && group->second.name != selections[s].name)
      ++taken[s][group->second.name.empty() ? std::to_string(group->second.number) : group->second.name];
    // Creases between the faces stay borders of patches.
    const auto [known, added] = patch_of.try_emplace({s, before}, std::uint16_t{0});
    if (added) {
      known->second = patches.add(face.pair());
      mesh.patch_groups[{face.pair(), known->second}] = {0, selections[s].name};
    }
    face.patch = known->second;
  }
  for (std::size_t s = 0; s < selections.size(); ++s)
    results[s].taken.assign(taken[s].begin(), taken[s].end());
  drop_unused_groups(mesh);
  return results;
}

}  // namespace tetwright

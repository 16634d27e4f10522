// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/contact_groups.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "common/message_text.h"
#include "common/unique_names.h"

namespace tetwright {

namespace {

using TwoGroups = std::array<SurfaceRegion, 2>;

SurfaceRegion group_of(const MesherInput::Body& body, Index triangle) {
  return body.surface.groups.empty() ? SurfaceRegion{} : body.groups[body.surface.groups[triangle]];
}

/// The group of the last body with one there.
SurfaceRegion last_group(const MesherInput& input, Index face) {
  SurfaceRegion group;
  for (const LabelledComplex::Source& s : input.complex->sources(face))
    if (const SurfaceRegion own = group_of(input.bodies[s.body], s.triangle)) group = own;
  return group;
}

/// The different groups in which the bodies on both sides have a face, in the order of the bodies.
std::optional<TwoGroups> groups_of_both(const MesherInput& input, Index f) {
  const LabelledComplex& complex = *input.complex;
  if (!complex.is_contact(f)) return {};
  const auto [low, high] = std::minmax(complex.faces[f].behind, complex.faces[f].front);
  TwoGroups groups;
  for (const LabelledComplex::Source& s : complex.sources(f)) {
    const std::uint32_t region = s.body + 1;
    if (region == low || region == high)
      groups[region == low ? 0 : 1] = group_of(input.bodies[s.body], s.triangle);
  }
  if (!groups[0] || !groups[1] || groups[0] == groups[1]) return {};
  return groups;
}

std::string name_of(const SurfaceRegion& group) {
  return group.name.empty() ? std::to_string(group.number) : group.name;
}

/// A set of faces.
struct Faces {
  double area = 0, largest = -1;  ///< input units squared
  Vec3 place = Vec3::Zero();      ///< centre of the largest

  void add(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double own = (b - a).cross(c - a).norm() / 2;
    area += own;
    if (own <= largest) return;
    largest = own;
    place = (a + b + c) / 3;
  }
};

}  // namespace

void name_contact_groups(MesherInput& input) {
  const LabelledComplex& complex = *input.complex;
  std::set<SurfaceRegion> of_files, alone;
  for (const MesherInput::Group& g : input.groups) of_files.insert(g.group);
  std::map<TwoGroups, Faces> joined;
  for (Index f = 0; f < complex.faces.size(); ++f) {
    const std::optional<TwoGroups> both = groups_of_both(input, f);
    // Caps of holes have groups, too, which the input does not name.
    if (!both || !of_files.contains((*both)[0]) || !of_files.contains((*both)[1])) {
      alone.insert(last_group(input, f));
      continue;
    }
    const auto& [a, b, c] = complex.faces[f].ids;
    joined[*both].add(complex.points[a], complex.points[b], complex.points[c]);
  }
  if (joined.empty()) return;

  UniqueNames names([](const std::string& name) { return name; });
  for (const MesherInput::Group& g : input.groups) (void)names.add(g.group.name);
  std::map<SurfaceRegion, double> shared;
  std::string first;
  for (const auto& [both, faces] : joined) {
    const SurfaceRegion group{0, names.add(name_of(both[0]) + "+" + name_of(both[1]))};
    if (first.empty()) first = group.name;
    for (const SurfaceRegion& own : both) shared[own] += faces.area;
    input.groups.push_back({group, faces.area, faces.place, {both[0], both[1]}});
  }
  std::erase_if(input.groups, [&](MesherInput::Group& g) {
    const auto found = shared.find(g.group);
    if (found == shared.end()) return false;
    g.area = std::max(0.0, g.area - found->second);
    return !alone.contains(g.group);
  });
  std::sort(input.groups.begin(), input.groups.end(),
            [](const auto& a, const auto& b) { return a.group < b.group; });
  input.findings.push_back({.code = DiagnosticCode::patches_joined,
                            .what = "pairs of patches that share faces in contacts",
                            .count = joined.size(),
                            .done = std::string("named after both") +
                                    (joined.size() > 1 ? "; the first: " : ": ") + in_quotes(first),
                            .places = {joined.begin()->second.place}});
}

FaceGroups::FaceGroups(const MesherInput& input) : input_(input) {
  for (const MesherInput::Group& g : input.groups)
    if (g.of.size() == 2) joined_[{g.of[0], g.of[1]}] = g.group;
}

SurfaceRegion FaceGroups::of(Index face) const {
  if (const std::optional<TwoGroups> both = groups_of_both(input_, face))
    if (const auto found = joined_.find(*both); found != joined_.end()) return found->second;
  return last_group(input_, face);
}

}  // namespace tetwright

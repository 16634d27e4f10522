#include "tools/fidelity.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace tetwright {

namespace {

/// Relative change of a volume from which on a solid counts as another one.
constexpr double same_volume = 0.01;
/// The same for shells that may stand for each other.
constexpr double alike_volume = 0.1;

/// The material's solid in the mesh: its faces to others and to outside, wound outwards.
SolidShape solid_of(const TetMesh& mesh, MaterialTag tag) {
  std::vector<Triangle> triangles;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    if (t.material == tag) triangles.push_back(t.ids);
    if (t.other == tag) triangles.push_back({t.ids[0], t.ids[2], t.ids[1]});
  }
  return solid_shape(mesh.points, triangles);
}

/// The shells that count, the largest first.
std::vector<SolidShell> shells_of(const SolidShape& solid, double min_volume) {
  std::vector<SolidShell> shells = solid.shells;
  std::erase_if(shells, [&](const SolidShell& s) { return std::fabs(s.volume) < min_volume; });
  std::stable_sort(shells.begin(), shells.end(), [](const SolidShell& a, const SolidShell& b) {
    return std::fabs(a.volume) > std::fabs(b.volume);
  });
  return shells;
}

SolidNumbers numbers_of(const SolidShape& solid, const std::vector<SolidShell>& shells) {
  SolidNumbers numbers{.volume = solid.volume()};
  for (const SolidShell& s : shells) {
    ++(s.volume > 0 ? numbers.components : numbers.cavities);
    numbers.handles += s.handles;
  }
  return numbers;
}

template <class Count>
void add_difference(std::string& to, Count is, Count should, const char* one, const char* many) {
  if (is == should) return;
  to += (to.empty() ? "" : ", ") + std::to_string(is) + " " + (is == 1 ? one : many) + " instead of " +
        std::to_string(should);
}

/// Whether one may stand for the other.
bool alike(const SolidShell& a, const SolidShell& b) {
  return a.handles == b.handles && std::fabs(a.volume - b.volume) <= alike_volume * std::fabs(a.volume);
}

/// A shell, the largest first, that only one of the solids has.
std::optional<Vec3> first_difference(const std::vector<SolidShell>& expected,
                                     const std::vector<SolidShell>& result) {
  std::vector<char> found(result.size(), 0);
  for (const SolidShell& shell : expected) {
    std::size_t i = 0;
    while (i < result.size() && (found[i] || !alike(shell, result[i]))) ++i;
    if (i == result.size()) return shell.place;
    found[i] = 1;
  }
  const auto extra = std::find(found.begin(), found.end(), 0);
  if (extra == found.end()) return {};
  return result[static_cast<std::size_t>(extra - found.begin())].place;
}

MaterialFidelity compare(const ExpectedSolid& expected, const SolidShape& result) {
  MaterialFidelity f;
  f.name = expected.name;
  f.tag = expected.tag;
  f.by_surface = expected.by_surface;
  const std::vector<SolidShell> was = shells_of(expected.shape, expected.min_volume),
                                is = shells_of(result, expected.min_volume);
  f.expected = numbers_of(expected.shape, was);
  f.result = numbers_of(result, is);
  // A material may touch itself in an edge where others meet: then its counts mean nothing.
  const bool countable = expected.shape.manifold && result.manifold;
  if (countable)
    add_difference(f.difference, f.result.components, f.expected.components, "component", "components");
  if (countable) add_difference(f.difference, f.result.handles, f.expected.handles, "handle", "handles");
  if (countable) add_difference(f.difference, f.result.cavities, f.expected.cavities, "cavity", "cavities");
  if (!is_same_volume(f.result.volume, f.expected.volume) &&
      std::fabs(f.result.volume - f.expected.volume) > expected.volume_slack) {
    const double change = f.result.volume / f.expected.volume - 1;
    char text[80];
    if (f.expected.volume > 0)
      std::snprintf(text, sizeof text, "volume %.3g %% %s", 100 * std::fabs(change),
                    change > 0 ? "more" : "less");
    else
      std::snprintf(text, sizeof text, "volume %.6g instead of %.6g", f.result.volume, f.expected.volume);
    f.difference += (f.difference.empty() ? "" : ", ") + std::string(text);
  }
  if (countable && !f.same_counts()) f.place = first_difference(was, is);
  return f;
}

}  // namespace

bool is_same_volume(double volume, double meant) {
  return std::fabs(volume - meant) <= same_volume * std::fabs(meant);
}

std::vector<MaterialFidelity> compare_solids(const std::vector<ExpectedSolid>& expected,
                                             const TetMesh& mesh) {
  std::vector<MaterialFidelity> all;
  all.reserve(expected.size());
  for (const ExpectedSolid& e : expected) all.push_back(compare(e, solid_of(mesh, e.tag)));
  return all;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tetwright/surface_mesh.h"

#include <algorithm>
#include <map>
#include <set>

#include "common/features/crease_chains.h"
#include "common/features/edge_uses.h"
#include "common/features/inner_edges.h"
#include "common/features/surface_noise.h"
#include "common/mesh/disjoint_sets.h"
#include "common/parallel/parallel_sort.h"
#include "tetwright/error.h"
#include "tetwright/mesh_quality.h"

namespace tetwright {

namespace {

constexpr double degree = 3.14159265358979323846 / 180;

// Angles and fractions were tuned on 11 parts, 6 prints, 13 scans and 55 further files.
constexpr double automatic_angle = 35;   ///< degrees
constexpr double low_share = 15.0 / 35;  ///< times the angle: edges that turn less are never borders
constexpr double min_sharp_share = 0.5;  ///< borders with a smaller sharp fraction are removed
constexpr double max_loose_low = 0.09;   ///< parts: up to 0.07; scans that pass the other test: 0.10
constexpr double max_loose_high = 0.2;   ///< parts: up to 0.10; scans that pass the other test: 0.43
/// Fraction of the area with noise above which a surface is a scan: flat cuts through scans are 6 % of their
/// area and more, specks and the like 0.08 and 0.6 %.
constexpr double max_noisy_share = 0.99;
/// A surface is a staircase if its many patches have few triangles each, or if its sharp edges are those of
/// equal boxes.
constexpr std::size_t min_staircase_patches = 256;
constexpr std::size_t max_staircase_triangles = 4;
constexpr double same_length = 1e-3, right_angle = 90 * degree, same_angle = 1 * degree;
constexpr std::size_t max_patches = 0xffff;

std::vector<double> triangle_areas(std::span<const Vec3> points, std::span<const Triangle> triangles) {
  std::vector<double> areas;
  areas.reserve(triangles.size());
  for (const auto& [a, b, c] : triangles)
    areas.push_back((points[b] - points[a]).cross(points[c] - points[a]).norm() / 2);
  return areas;
}

/// The fraction of the area in flagged triangles.
double share_of(const std::vector<std::uint8_t>& flags, const std::vector<double>& areas) {
  double all = 0, flagged = 0;
  for (std::size_t t = 0; t < areas.size(); ++t) {
    all += areas[t];
    if (flags[t]) flagged += areas[t];
  }
  return all > 0 ? flagged / all : 0;
}

/// Whether all edges that turn by more than the angle turn by 90 degrees and have at most three different
/// lengths.
bool are_of_boxes(const std::vector<InnerEdge>& edges, double angle) {
  std::vector<double> lengths;
  for (const InnerEdge& e : edges) {
    if (e.turn <= angle) continue;
    if (std::abs(e.turn - right_angle) > same_angle) return false;
    if (std::none_of(lengths.begin(), lengths.end(),
                     [&](double l) { return std::abs(l - e.length) <= same_length * l; }))
      lengths.push_back(e.length);
    if (lengths.size() > 3) return false;
  }
  return true;
}

/// Merges parts of a surface across their weakest borders.
class PatchMerger {
 public:
  PatchMerger(std::vector<double> areas, const std::vector<InnerEdge>& edges, double angle)
      : sets_(areas.size()), areas_(std::move(areas)) {
    for (const InnerEdge& e : edges)
      if (e.turn <= low_share * angle) sets_.unite(e.triangles[0], e.triangles[1]);
    for (Index t = 0; t < areas_.size(); ++t)
      if (const Index root = sets_.root(t); root != t) areas_[root] += areas_[t];
    find_borders(edges, angle);
  }

  /// Merges across borders whose sharp fraction is too small.
  void merge_weak() {
    for (const auto& [a, neighbours] : borders_)
      for (const auto& [b, border] : neighbours)
        if (a < b) queue_.insert({border.sharp_share(), a, b});
    while (!queue_.empty() && queue_.begin()->share < min_sharp_share) {
      const Queued weakest = *queue_.begin();
      merge(weakest.a, weakest.b);
    }
  }
  std::size_t count() const {
    std::size_t roots = 0;
    for (Index t = 0; t < sets_.size(); ++t) roots += sets_.is_root(t);
    return roots;
  }
  /// Merges neighbouring parts in which sharp edges are noise.
  /// \return a flag for each triangle: it is in such a part
  std::vector<std::uint8_t> merge_noisy(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                        const std::vector<InnerEdge>& edges,
                                        const std::vector<std::uint8_t>& on_border, double angle) {
    std::vector<Index> numbers(sets_.size(), no_index), part(sets_.size());
    std::vector<double> areas;
    for (Index t = 0; t < part.size(); ++t) {
      const Index root = sets_.root(t);
      if (numbers[root] == no_index) {
        numbers[root] = static_cast<Index>(areas.size());
        areas.push_back(areas_[root]);
      }
      part[t] = numbers[root];
    }
    const std::vector<std::uint8_t> noisy =
        find_noisy_parts(points, triangles, edges, on_border, part, areas.size(), angle);
    for (const InnerEdge& e : edges) {
      const auto& [t, u] = e.triangles;
      if (!noisy[part[t]] || !noisy[part[u]]) continue;
      const Index a = sets_.root(t), b = sets_.root(u);
      if (a == b) continue;
      sets_.unite(a, b);
      areas_[std::min(a, b)] += areas_[std::max(a, b)];
    }
    borders_.clear();
    queue_.clear();
    find_borders(edges, angle);
    std::vector<std::uint8_t> of_triangles(part.size());
    for (std::size_t t = 0; t < part.size(); ++t) of_triangles[t] = noisy[part[t]];
    return of_triangles;
  }
  bool has_borders() const { return !borders_.empty(); }
  /// Merges parts below `min_area`, smallest first, with the neighbour across the weakest border.
  /// \return the number of parts merged
  std::size_t merge_small(double min_area) {
    std::set<std::pair<double, Index>> small;
    const auto list = [&](Index part) {
      if (areas_[part] < min_area && !borders_[part].empty()) small.insert({areas_[part], part});
    };
    std::vector<Index> parts;
    for (const auto& [part, neighbours] : borders_) parts.push_back(part);
    if (min_area > 0)
      for (const Index part : parts) list(part);
    std::size_t dropped = 0;
    while (!small.empty()) {
      const Index part = small.begin()->second;
      small.erase(small.begin());
      if (sets_.root(part) != part || borders_[part].empty()) continue;
      const auto weakest =
          std::min_element(borders_[part].begin(), borders_[part].end(), [](const auto& x, const auto& y) {
            if (x.second.sharp_share() != y.second.sharp_share())
              return x.second.sharp_share() < y.second.sharp_share();
            return x.second.length != y.second.length ? x.second.length > y.second.length : x.first < y.first;
          });
      const Index other = weakest->first;
      ++dropped;
      small.erase({areas_[other], other});
      merge(part, other);
      list(sets_.root(part));
    }
    return dropped;
  }
  /// Part of each triangle, as the index of one of its triangles.
  std::vector<Index> parts() {
    std::vector<Index> parts(sets_.size());
    for (std::size_t t = 0; t < parts.size(); ++t) parts[t] = sets_.root(static_cast<Index>(t));
    return parts;
  }

 private:
  struct Border {
    double length = 0, sharp = 0;
    void add(const Border& o) {
      length += o.length;
      sharp += o.sharp;
    }
    double sharp_share() const { return length > 0 ? sharp / length : 0; }
  };
  struct Queued {
    double share;
    Index a, b;  ///< a < b
    bool operator<(const Queued& o) const {
      if (share != o.share) return share < o.share;
      return a != o.a ? a < o.a : b < o.b;
    }
  };

  static Queued queued(Index a, Index b, const Border& border) {
    return {border.sharp_share(), std::min(a, b), std::max(a, b)};
  }

  void find_borders(const std::vector<InnerEdge>& edges, double angle) {
    for (const InnerEdge& e : edges) {
      const Index a = sets_.root(e.triangles[0]), b = sets_.root(e.triangles[1]);
      if (a == b) continue;
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)})
        borders_[from][to].add({e.length, e.turn > angle ? e.length : 0});
    }
  }

  void merge(Index a, Index b) {
    sets_.unite(a, b);
    const Index kept = sets_.root(a), gone = kept == a ? b : a;
    areas_[kept] += areas_[gone];
    const std::map<Index, Border> moved = std::move(borders_[gone]);
    borders_.erase(gone);
    for (const auto& [other, border] : moved) {
      queue_.erase(queued(gone, other, border));
      borders_[other].erase(gone);
      if (other == kept) continue;
      Border& joined = borders_[kept][other];
      queue_.erase(queued(kept, other, joined));
      joined.add(border);
      borders_[other][kept] = joined;
      queue_.insert(queued(kept, other, joined));
    }
  }

  DisjointSets sets_;
  std::vector<double> areas_;                         ///< of each part, by its root
  std::map<Index, std::map<Index, Border>> borders_;  ///< of each part, by neighbour
  std::set<Queued> queue_;
};

/// Makes each group one part, as if no edge were a crease.
std::vector<Index> whole_groups(std::span<const std::uint32_t> groups) {
  std::map<std::uint32_t, Index> firsts;
  std::vector<Index> parts(groups.size());
  for (std::size_t t = 0; t < groups.size(); ++t)
    parts[t] = firsts.emplace(groups[t], static_cast<Index>(t)).first->second;
  return parts;
}

/// Result of find_patches() before patches are numbered, and the part of each triangle as the index of one of
/// its triangles.
struct FoundParts {
  SurfacePatches found;
  std::vector<Index> parts;
  std::vector<std::uint8_t> noisy;  ///< a flag for each triangle, or empty
  /// Parts before small ones were merged, or before all were merged as a staircase; or empty.
  std::vector<Index> before;
  std::vector<SharpEdge> sharp;  ///< if PatchOptions::list_chains
};

CreaseChain::Fate fate_of(const InnerEdge& e, const FoundParts& result) {
  using Fate = CreaseChain::Fate;
  const auto& [t, u] = e.triangles;
  if (result.parts[t] != result.parts[u]) return Fate::kept;
  if (!result.noisy.empty() && (result.noisy[t] || result.noisy[u])) return Fate::noise;
  if (result.before.empty() || result.before[t] == result.before[u]) return Fate::faded;
  return result.found.verdict == SurfacePatches::Verdict::staircase ? Fate::given_up : Fate::small;
}

/// Decides which of the inner edges are borders of parts.
/// \param sharp radians; edges that turn by more are sharp
void find_parts(std::span<const Vec3> points, std::span<const Triangle> triangles,
                const PatchOptions& options, const std::vector<InnerEdge>& edges,
                const std::vector<std::uint8_t>& on_border, double sharp, FoundParts& result) {
  using Verdict = SurfacePatches::Verdict;
  SurfacePatches& found = result.found;
  const bool automatic = options.angle.rule == FeatureAngle::Rule::automatic;
  found.loose_ends_low = loose_ends(edges, on_border, low_share * automatic_angle * degree);
  found.loose_ends_high = loose_ends(edges, on_border, automatic_angle * degree);
  if (std::none_of(edges.begin(), edges.end(), [&](const InnerEdge& e) { return e.turn > sharp; })) {
    found.verdict = Verdict::smooth;
    return;
  }
  const bool noisy =
      automatic && (found.loose_ends_low > max_loose_low || found.loose_ends_high > max_loose_high);
  PatchMerger merger(triangle_areas(points, triangles), edges, sharp);
  merger.merge_weak();
  if (noisy) {
    result.noisy = merger.merge_noisy(points, triangles, edges, on_border, sharp);
    found.noisy_share = share_of(result.noisy, triangle_areas(points, triangles));
    if (!merger.has_borders() || found.noisy_share > max_noisy_share) {
      found.verdict = Verdict::scan;
      return;
    }
  }
  // Decided before small parts are merged, since merging depends on the cell size.
  const std::size_t count = merger.count();
  if (automatic && count >= min_staircase_patches &&
      (count > max_patches || count * max_staircase_triangles > triangles.size() ||
       are_of_boxes(edges, sharp))) {
    found.verdict = Verdict::staircase;
    if (options.list_chains) result.before = merger.parts();
    return;
  }
  found.verdict = Verdict::part;
  if (options.list_chains && options.min_area > 0) result.before = merger.parts();
  found.dropped = merger.merge_small(options.min_area);
  result.parts = merger.parts();
}

FoundParts find_parts(std::span<const Vec3> points, std::span<const Triangle> triangles,
                      const PatchOptions& options, std::span<const std::uint32_t> groups) {
  using Rule = FeatureAngle::Rule;
  FoundParts result;
  result.found.patches.assign(triangles.size(), 0);
  result.parts = groups.empty() ? std::vector<Index>(triangles.size(), 0) : whole_groups(groups);
  if (options.angle.rule == Rule::off || triangles.empty()) return result;
  const std::vector<EdgeUse> uses = edge_uses(triangles, groups);
  const std::vector<InnerEdge> edges = inner_edges(points, triangles, uses);
  const std::vector<std::uint8_t> on_border = points_on_borders(uses, points.size());
  const double sharp =
      (options.angle.rule == Rule::automatic ? automatic_angle : options.angle.degrees) * degree;
  find_parts(points, triangles, options, edges, on_border, sharp, result);
  if (!options.list_chains) return result;
  for (const InnerEdge& e : edges)
    if (e.turn > sharp) result.sharp.push_back({e.ends, e.length, e.turn, fate_of(e, result)});
  for (const InnerEdge& e : edges_between_groups(points, triangles, uses))
    if (e.turn > sharp) result.sharp.push_back({e.ends, e.length, e.turn, CreaseChain::Fate::kept_groups});
  return result;
}

/// Flags the patches that contain flagged triangles.
std::vector<std::uint8_t> rough_patches(const SurfacePatches& found, const std::vector<std::uint8_t>& noisy) {
  if (std::find(noisy.begin(), noisy.end(), 1) == noisy.end() || !found.any()) return {};
  std::vector<std::uint8_t> rough(found.count, 0);
  for (std::size_t t = 0; t < noisy.size(); ++t)
    if (noisy[t]) rough[found.patches[t]] = 1;
  return rough;
}

[[noreturn]] void throw_too_many(const std::string& file) {
  throw InputError(file, 0,
                   "its sharp edges and labels divide it into more than the maximum of " +
                       std::to_string(max_patches) +
                       " patches; use a larger --feature-angle or --feature-angle off, or remove labels of "
                       "single faces from the file");
}

}  // namespace

SurfacePatches find_patches(std::span<const Vec3> points, std::span<const Triangle> triangles,
                            const PatchOptions& options, std::span<const std::uint32_t> groups,
                            const std::string& file) {
  FoundParts found = find_parts(points, triangles, options, groups);
  found.found.chains = chains_of(points, found.sharp);
  // Number the patches in the order of their first triangles.
  std::vector<std::uint32_t> numbers(triangles.size(), no_index);
  std::uint32_t count = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    std::uint32_t& number = numbers[found.parts[t]];
    if (number == no_index) number = count++;
    if (count > max_patches) throw_too_many(file);
    found.found.patches[t] = static_cast<std::uint16_t>(number);
  }
  found.found.count = std::max(count, 1U);
  found.found.rough = rough_patches(found.found, found.noisy);
  return std::move(found.found);
}

CreaseChains find_crease_chains(std::span<const Vec3> points, std::span<const Triangle> triangles,
                                PatchOptions options, std::span<const std::uint32_t> groups,
                                const std::function<bool(const Vec3&)>& is_given_up, double piece) {
  options.list_chains = true;
  FoundParts found = find_parts(points, triangles, options, groups);
  if (!is_given_up) return chains_of(points, found.sharp);
  std::vector<Vec3> all(points.begin(), points.end());
  give_up_edges(all, found.sharp, piece, is_given_up);
  return chains_of(all, found.sharp);
}

SurfacePatches find_mesh_patches(TetMesh& mesh, const FeatureAngle& angle, const std::string& file) {
  if (mesh.interfaces.empty()) mesh.interfaces = find_interfaces(mesh);
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> groups;
  triangles.reserve(mesh.interfaces.size());
  groups.reserve(mesh.interfaces.size());
  std::map<std::pair<MaterialPair, std::uint16_t>, std::uint32_t> numbers;
  for (const InterfaceTriangle& t : mesh.interfaces) {
    triangles.push_back(t.ids);
    groups.push_back(numbers.emplace(std::pair(t.pair(), t.patch), static_cast<std::uint32_t>(numbers.size()))
                         .first->second);
  }
  FoundParts found = find_parts(mesh.points, triangles, {angle, 0, true}, groups);
  found.found.chains = chains_of(mesh.points, found.sharp);
  std::map<MaterialPair, std::map<Index, std::uint16_t>> of_pair;
  const std::map<InterfacePatch, SurfaceRegion> given = std::move(mesh.patch_groups);
  mesh.patch_groups.clear();
  found.found.count = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    std::map<Index, std::uint16_t>& known = of_pair[mesh.interfaces[i].pair()];
    const auto [number, added] = known.emplace(found.parts[i], static_cast<std::uint16_t>(known.size()));
    if (known.size() > max_patches) throw_too_many(file);
    found.found.count += added;
    if (added)
      if (const auto group = given.find({mesh.interfaces[i].pair(), mesh.interfaces[i].patch});
          group != given.end())
        mesh.patch_groups[{mesh.interfaces[i].pair(), number->second}] = group->second;
    mesh.interfaces[i].patch = found.found.patches[i] = number->second;
  }
  return std::move(found.found);
}

}  // namespace tetwright

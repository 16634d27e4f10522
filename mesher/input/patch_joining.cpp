// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/patch_joining.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "common/features/edge_uses.h"
#include "common/geometry/distance_tree.h"
#include "common/mesh/disjoint_sets.h"
#include "common/message_text.h"
#include "mesher/input/body_contacts.h"
#include "mesher/input/surface_cleaning.h"
#include "mesher/input/surface_holes.h"
#include "mesher/tuning/complex_tuning.h"
#include "mesher/tuning/input_tuning.h"

namespace tetwright {

namespace {

using PatchTuning = InputTuning::Patches;

/// An edge of one triangle only.
struct FreeEdge {
  double length;
  std::array<Vec3, 3> places;               ///< both ends and the middle
  std::array<std::set<std::size_t>, 3> at;  ///< the other open surfaces at each of these
};

/// A surface with a border.
struct OpenSurface {
  std::size_t number;  ///< of the call's surfaces
  CleanedSurface cleaned;
  Eigen::AlignedBox3d box;
  double area = 0;
  std::vector<FreeEdge> border;
  double border_length = 0;

  /// Decides the order of triangles in a joined surface.
  auto key() const {
    return std::tuple(box.min().z(), box.min().y(), box.min().x(), box.max().z(), box.max().y(),
                      box.max().x(), area, cleaned.triangles.size());
  }
};

OpenSurface measured(std::size_t number, CleanedSurface cleaned) {
  OpenSurface own;
  own.number = number;
  own.cleaned = std::move(cleaned);
  const std::vector<Vec3>& points = own.cleaned.points;
  for (const Vec3& p : points) own.box.extend(p);
  for (const auto& [a, b, c] : own.cleaned.triangles)
    own.area += (points[b] - points[a]).cross(points[c] - points[a]).norm() / 2;
  const std::vector<EdgeUse> uses = edge_uses(own.cleaned.triangles, {});
  for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
    while (j < uses.size() && uses[j].key == uses[i].key) ++j;
    if (j - i != 1) continue;
    const auto [a, b] = ends_of(uses[i].key);
    own.border.push_back(
        {(points[b] - points[a]).norm(), {points[a], points[b], Vec3((points[a] + points[b]) / 2)}, {}});
    own.border_length += own.border.back().length;
  }
  return own;
}

class PatchJoiner {
 public:
  PatchJoiner(std::vector<MaterialSurface>& surfaces, const ContactOptions& contact,
              std::vector<Diagnostic>& findings, Progress* progress)
      : surfaces_(surfaces), contact_(contact), findings_(findings), progress_(progress) {}

  std::map<std::size_t, WalledSurface> join() {
    find_open();
    if (open_.size() < 2) return {};
    find_neighbours();
    std::vector<char> joined(open_.size(), 0);
    for (const std::vector<Index>& set : connected(meeting(joined, PatchTuning::border_share)))
      if (join_set(set))
        for (const Index k : set) joined[k] = 1;
    for (const std::vector<Index>& set : connected(meeting(joined, PatchTuning::mentioned_share)))
      report_gap(set);
    return take_joined();
  }

 private:
  struct Joined {
    std::vector<std::size_t> surfaces;  ///< ascending
    MaterialSurface surface;
    WalledSurface walled;
  };

  void find_open() {
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
      // Merging equal points frees no edges, and a file that lists each triangle from both sides is a shell
      // of its own; most closed surfaces need no cleaning here.
      if (!has_free_edges(surfaces_[i].surface.triangles)) continue;
      std::vector<Diagnostic> unused;
      CleanedSurface cleaned = clean_surface(surfaces_[i].surface, surfaces_[i].file, unused);
      if (has_free_edges(cleaned.triangles)) open_.push_back(measured(i, std::move(cleaned)));
      if (progress_) progress_->throw_if_stopped();
    }
  }

  void find_neighbours() {
    Eigen::AlignedBox3d all;
    for (const OpenSurface& s : open_) all.extend(s.box);
    const double diagonal = all.diagonal().norm();
    if (!std::isfinite(diagonal)) return;
    const double tolerance = contact_tolerance(contact_, diagonal);
    for (std::size_t k = 0; k < open_.size(); ++k) {
      std::optional<DistanceTree> tree;  // built if a border is near
      for (std::size_t i = 0; i < open_.size(); ++i) {
        if (i == k) continue;
        for (FreeEdge& edge : open_[i].border)
          for (std::size_t p = 0; p < 3; ++p) {
            if (open_[k].box.squaredExteriorDistance(edge.places[p]) > tolerance * tolerance) continue;
            if (!tree) tree.emplace(open_[k].cleaned.points, open_[k].cleaned.triangles);
            if (tree->distance(edge.places[p], 2 * tolerance) <= tolerance) edge.at[p].insert(k);
          }
      }
      if (progress_) progress_->throw_if_stopped();
    }
  }

  static bool meets(const FreeEdge& edge, const std::vector<char>& others) {
    return std::all_of(edge.at.begin(), edge.at.end(), [&](const std::set<std::size_t>& at) {
      return std::any_of(at.begin(), at.end(), [&](std::size_t k) { return others[k] != 0; });
    });
  }

  /// The largest set of surfaces of which each has a share of its border on others of the set.
  std::vector<char> meeting(const std::vector<char>& without, double share) const {
    std::vector<char> set(without.size());
    std::transform(without.begin(), without.end(), set.begin(), [](char w) { return w == 0; });
    for (bool changed = true; changed;) {
      changed = false;
      for (std::size_t k = 0; k < open_.size(); ++k) {
        if (!set[k]) continue;
        double met = 0;
        for (const FreeEdge& edge : open_[k].border) met += meets(edge, set) ? edge.length : 0;
        if (met >= share * open_[k].border_length) continue;
        set[k] = 0;
        changed = true;
      }
    }
    return set;
  }

  /// Splits a set of open surfaces into those that are connected, each in the order of their keys.
  std::vector<std::vector<Index>> connected(const std::vector<char>& set) const {
    DisjointSets sets(open_.size());
    for (Index k = 0; k < open_.size(); ++k)
      for (const FreeEdge& edge : open_[k].border)
        for (const std::set<std::size_t>& at : edge.at)
          for (const std::size_t other : at)
            if (set[k] && set[other]) sets.unite(k, static_cast<Index>(other));
    std::map<Index, std::vector<Index>> parts;
    for (Index k = 0; k < open_.size(); ++k)
      if (set[k]) parts[sets.root(k)].push_back(k);
    std::vector<std::vector<Index>> result;
    for (auto& [root, part] : parts) {
      std::stable_sort(part.begin(), part.end(),
                       [&](Index a, Index b) { return open_[a].key() < open_[b].key(); });
      if (part.size() > 1) result.push_back(std::move(part));
    }
    return result;
  }

  /// Whether flat caps close all holes of a surface, so that it may be a body on its own.
  bool may_be_body(const OpenSurface& s) const {
    CleanedSurface copy = s.cleaned;
    std::vector<SurfaceRegion> groups = surfaces_[s.number].surface.groups;
    std::vector<Diagnostic> unused;
    const std::vector<SurfaceHole> holes =
        close_flat_holes(copy, groups, surfaces_[s.number].file, {.open = {.accept_sheets = true}}, unused);
    return std::all_of(holes.begin(), holes.end(), [](const SurfaceHole& hole) { return hole.flat; });
  }

  bool are_bodies(const std::vector<Index>& set) const {
    return std::all_of(set.begin(), set.end(), [&](Index k) { return may_be_body(open_[k]); });
  }

  /// The surfaces of a set as one, with a group for each.
  MaterialSurface merged(const std::vector<Index>& set, std::vector<std::size_t>& numbers) const {
    for (const Index k : set) numbers.push_back(open_[k].number);
    std::sort(numbers.begin(), numbers.end());
    const MaterialSurface& first = surfaces_[numbers[0]];
    MaterialSurface all{first.name, first.tag, {}, first.file};
    TriangleMesh& mesh = all.surface;
    for (const Index k : set) {
      const MaterialSurface& from = surfaces_[open_[k].number];
      const auto start = static_cast<Index>(mesh.points.size());
      const CleanedSurface& own = open_[k].cleaned;
      mesh.points.insert(mesh.points.end(), own.points.begin(), own.points.end());
      for (const auto& [a, b, c] : own.triangles) mesh.triangles.push_back({start + a, start + b, start + c});
      add_groups(from, own, mesh);
    }
    return all;
  }

  /// Adds the groups of a surface's triangles: one of its name, or, if it has several, NAME:GROUP for each.
  static void add_groups(const MaterialSurface& from, const CleanedSurface& cleaned, TriangleMesh& mesh) {
    std::map<std::uint32_t, std::uint32_t> numbers;
    for (const std::uint32_t g : cleaned.groups) numbers.try_emplace(g, 0);
    if (numbers.size() <= 1) {
      mesh.triangle_groups.resize(mesh.triangles.size(), static_cast<std::uint32_t>(mesh.groups.size()));
      mesh.groups.push_back({0, from.name});
      return;
    }
    for (auto& [g, number] : numbers) {
      number = static_cast<std::uint32_t>(mesh.groups.size());
      const SurfaceRegion& own = from.surface.groups[g];
      mesh.groups.push_back(
          {0, from.name + ":" + (own.name.empty() ? std::to_string(own.number) : own.name)});
    }
    for (const std::uint32_t g : cleaned.groups) mesh.triangle_groups.push_back(numbers.at(g));
  }

  /// \return false if the surfaces do not close together
  bool join_set(const std::vector<Index>& set) {
    if (are_bodies(set)) return false;
    Joined joined;
    joined.surface = merged(set, joined.surfaces);
    std::vector<Diagnostic> unused;
    CleanedSurface all = clean_surface(joined.surface.surface, joined.surface.file, unused);
    Eigen::AlignedBox3d box;
    for (const Vec3& p : all.points) box.extend(p);
    const double tolerance = contact_tolerance(contact_, box.diagonal().norm());
    if (box.diagonal().norm() < ComplexTuning::Contact::min_body * tolerance) return false;
    joined.walled.divided = divide_surface(all, tolerance, progress_);
    const DividedSurface& divided = joined.walled.divided;
    if (divided.unresolved || divided.cells.empty() || divided.border_edges > 0) return false;
    joined.walled.patches = find_connected_patches(all.points, all.triangles);
    joined.walled.given = std::move(all);
    const std::size_t cells = divided.cells.size();
    findings_.push_back({.code = DiagnosticCode::surfaces_joined,
                         .file = joined.surface.file,
                         .what = "open surfaces that close together",
                         .count = set.size(),
                         .done = "joined into " + std::to_string(cells) + (cells == 1 ? " cell" : " cells") +
                                 "; their names are those of patches",
                         .places = {divided.cells[0].surface.points[0]}});
    joined_.push_back(std::move(joined));
    return true;
  }

  /// Reports surfaces that meet along most of their border.
  void report_gap(const std::vector<Index>& set) {
    if (are_bodies(set)) return;
    std::vector<char> members(open_.size(), 0);
    for (const Index k : set) members[k] = 1;
    const FreeEdge* longest = nullptr;
    Index owner = set[0];
    for (const Index k : set)
      for (const FreeEdge& edge : open_[k].border)
        if (!meets(edge, members) && (!longest || edge.length > longest->length)) {
          longest = &edge;
          owner = k;
        }
    const MaterialSurface& from = surfaces_[open_[owner].number];
    findings_.push_back(
        {.code = DiagnosticCode::surfaces_not_joined,
         .file = from.file,
         .what = "open surfaces that meet along most of their borders, but do not close together" +
                 (longest ? ", as an edge of '" + from.name + "' meets no other" : std::string()),
         .count = set.size(),
         .done = "each treated as a body",
         .places = {longest ? longest->places[2] : open_[owner].cleaned.points[0]}});
  }

  /// Replaces the surfaces by those that were joined.
  std::map<std::size_t, WalledSurface> take_joined() {
    std::vector<char> gone(surfaces_.size(), 0);
    std::map<std::size_t, WalledSurface*> cells;
    for (Joined& j : joined_) {
      for (const std::size_t number : j.surfaces) gone[number] = 1;
      gone[j.surfaces[0]] = 0;
      surfaces_[j.surfaces[0]] = std::move(j.surface);
      cells[j.surfaces[0]] = &j.walled;
    }
    std::map<std::size_t, WalledSurface> result;
    std::vector<MaterialSurface> left;
    for (std::size_t i = 0; i < surfaces_.size(); ++i) {
      if (gone[i]) continue;
      if (const auto own = cells.find(i); own != cells.end())
        result.emplace(left.size(), std::move(*own->second));
      left.push_back(std::move(surfaces_[i]));
    }
    surfaces_ = std::move(left);
    return result;
  }

  std::vector<MaterialSurface>& surfaces_;
  const ContactOptions& contact_;
  std::vector<Diagnostic>& findings_;
  Progress* progress_;
  std::vector<OpenSurface> open_;
  std::vector<Joined> joined_;
};

}  // namespace

std::map<std::size_t, WalledSurface> join_patches(std::vector<MaterialSurface>& surfaces,
                                                  const ContactOptions& contact,
                                                  std::vector<Diagnostic>& findings, Progress* progress) {
  if (surfaces.size() < 2) return {};
  return PatchJoiner(surfaces, contact, findings, progress).join();
}

}  // namespace tetwright

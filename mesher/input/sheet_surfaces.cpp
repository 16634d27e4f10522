// SPDX-License-Identifier: Apache-2.0
#include "mesher/input/sheet_surfaces.h"

#include <algorithm>
#include <map>

#include "common/features/edge_uses.h"
#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Parts of a surface that are connected across edges of exactly two triangles.
class SheetParts {
 public:
  SheetParts(const CleanedSurface& surface, const std::string& file)
      : surface_(surface), file_(file), triangles(surface.triangles) {
    const std::vector<EdgeUse> uses = edge_uses(triangles, {});
    std::vector<std::vector<Neighbour>> beside(triangles.size());
    std::vector<char> on_border(triangles.size(), 0);
    for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
      while (j < uses.size() && uses[j].key == uses[i].key) ++j;
      for (std::size_t k = i; k < j && j - i != 2; ++k) on_border[uses[k].triangle] = 1;
      if (j - i != 2) continue;
      const bool alike = uses[i].ascending == uses[i + 1].ascending;
      beside[uses[i].triangle].push_back({uses[i + 1].triangle, alike});
      beside[uses[i + 1].triangle].push_back({uses[i].triangle, alike});
    }
    part.assign(triangles.size(), no_part);
    for (Index t = 0; t < triangles.size(); ++t)
      if (part[t] == no_part) flood(t, beside, on_border);
  }

 private:
  struct Neighbour {
    Index triangle;
    bool alike;  ///< both traverse the edge in the same direction
  };
  static constexpr std::uint32_t no_part = 0xffffffff;

  void flood(Index seed, const std::vector<std::vector<Neighbour>>& beside,
             const std::vector<char>& on_border) {
    std::vector<Index> queue{seed};
    std::map<Index, bool> turned{{seed, false}};
    part[seed] = count;
    bool closed = true;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      const Index t = queue[i];
      closed &= on_border[t] == 0;
      for (const auto& [other, alike] : beside[t]) {
        const bool turn = turned.at(t) != alike;
        if (part[other] == no_part) {
          part[other] = count;
          turned[other] = turn;
          queue.push_back(other);
        } else if (turned.at(other) != turn) {
          throw InputError(file_, 0,
                           "the sheet is one-sided, like a Moebius strip, at " +
                               place_text(surface_.points[triangles[t][0]]) +
                               ": it has no sides between which to lie; cut it");
        }
      }
    }
    if (closed)
      throw InputError(file_, 0,
                       "the sheet is closed at " + place_text(surface_.points[triangles[seed][0]]) +
                           ": it encloses a body; give it as an input or with --material NAME=FILE instead, "
                           "or leave it out");
    for (const auto& [t, turn] : turned)
      if (turn) std::swap(triangles[t][1], triangles[t][2]);
    ++count;
  }

  const CleanedSurface& surface_;
  const std::string& file_;

 public:
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> part;
  std::uint32_t count = 0;
};

/// The name of a group of a sheet's file.
SurfaceRegion name_of(const SheetSurface& surface, std::uint32_t group, bool only) {
  const SurfaceRegion& own = surface.surface.groups[group];
  if (only || !own) return {0, surface.name};
  if (!own.name.empty()) return {0, own.name};
  return {0, surface.name + "_" + std::to_string(own.number)};
}

}  // namespace

void SheetSoup::add(const SheetSurface& surface, std::vector<MesherInput::Sheet>& sheets,
                    std::vector<Diagnostic>& findings) {
  std::vector<Diagnostic> own;
  const CleanedSurface cleaned = clean_surface(surface.surface, surface.file, own);
  for (Diagnostic& f : own) {
    f.file = surface.file;
    findings.push_back(std::move(f));
  }
  const SheetParts parts(cleaned, surface.file);
  std::map<std::uint32_t, std::uint32_t> sheet_of_group;
  for (const std::uint32_t g : cleaned.groups) sheet_of_group[g] = 0;
  if (sheet_of_group.empty()) sheet_of_group[0] = 0;
  for (auto& [group, sheet] : sheet_of_group) {
    const SurfaceRegion name = cleaned.groups.empty() ? SurfaceRegion{0, surface.name}
                                                      : name_of(surface, group, sheet_of_group.size() == 1);
    const auto known = std::find_if(sheets.begin(), sheets.end(),
                                    [&](const MesherInput::Sheet& s) { return s.group == name; });
    sheet = static_cast<std::uint32_t>(known - sheets.begin());
    if (known == sheets.end()) sheets.push_back({name, surface.file});
  }
  const auto first = static_cast<Index>(points_.size());
  points_.insert(points_.end(), cleaned.points.begin(), cleaned.points.end());
  for (Index t = 0; t < parts.triangles.size(); ++t) {
    const auto& [a, b, c] = parts.triangles[t];
    triangles_.push_back({first + a, first + b, first + c});
    part_.push_back(parts_ + parts.part[t]);
    sheet_.push_back(sheet_of_group.at(cleaned.groups.empty() ? 0 : cleaned.groups[t]));
  }
  parts_ += parts.count;
}

void SheetSoup::append_to(SurfaceSoup& soup, std::uint32_t first_surface,
                          std::vector<std::uint32_t>& sheet_of_triangle) const {
  const auto first = static_cast<Index>(soup.points.size());
  soup.points.insert(soup.points.end(), points_.begin(), points_.end());
  sheet_of_triangle.assign(soup.triangles.size(), 0);
  sheet_of_triangle.insert(sheet_of_triangle.end(), sheet_.begin(), sheet_.end());
  for (Index t = 0; t < triangles_.size(); ++t) {
    const auto& [a, b, c] = triangles_[t];
    soup.triangles.push_back({first + a, first + b, first + c});
    soup.surface.push_back(first_surface + part_[t]);
  }
}

}  // namespace tetwright

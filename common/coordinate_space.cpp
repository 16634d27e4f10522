// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tetwright/label_volume.h"
#include "tetwright/sizes.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

namespace {

/// Directions of the three axes: "left", "posterior", "superior". Empty unless there are three.
std::vector<std::string> directions_of(const std::string& space) {
  std::vector<std::string> words(1);
  for (const char c : space)
    if (c == '-')
      words.emplace_back();
    else
      words.back() += c;
  constexpr std::array<std::array<std::string_view, 2>, 3> known{
      {{"left", "right"}, {"anterior", "posterior"}, {"inferior", "superior"}}};
  if (words.size() != known.size()) return {};
  for (std::size_t a = 0; a < known.size(); ++a)
    if (std::find(known[a].begin(), known[a].end(), words[a]) == known[a].end()) return {};
  return words;
}

using Reversed = std::array<bool, 3>;

/// Whether each axis points the other way in the second space; std::nullopt: the spaces are equal, or one of
/// them is unknown.
std::optional<Reversed> reversed_axes(const std::string& first, const std::string& second) {
  const std::vector<std::string> from = directions_of(first), to = directions_of(second);
  if (from.empty() || to.empty() || from == to) return {};
  return Reversed{from[0] != to[0], from[1] != to[1], from[2] != to[2]};
}

Vec3 with_reversed_axes(Vec3 p, const Reversed& reversed) {
  for (int a = 0; a < 3; ++a)
    if (reversed[static_cast<std::size_t>(a)]) p[a] = -p[a];
  return p;
}

/// Sizes in a system with some axes reversed.
class SizesInOtherSpace : public SizeSource {
 public:
  SizesInOtherSpace(std::shared_ptr<const SizeSource> sizes, const Reversed& reversed,
                    const std::string& space)
      : SizeSource(sizes->field(), space), sizes_(std::move(sizes)), reversed_(reversed) {}

  bool fills_space() const override { return sizes_->fills_space(); }

  std::optional<WantedLength> at(const Vec3& place) const override {
    return sizes_->at(with_reversed_axes(place, reversed_));
  }

  void for_each_value(const std::function<void(const Vec3&, double)>& f) const override {
    sizes_->for_each_value(
        [&](const Vec3& place, double length) { f(with_reversed_axes(place, reversed_), length); });
  }

 private:
  const std::shared_ptr<const SizeSource> sizes_;
  const Reversed reversed_;
};

}  // namespace

bool change_space(LabelGrid& grid, const std::string& space) {
  const auto reversed = reversed_axes(grid.space, space);
  if (!reversed) return false;
  for (int a = 0; a < 3; ++a) {
    if (!(*reversed)[static_cast<std::size_t>(a)]) continue;
    grid.origin[a] = -grid.origin[a];
    grid.directions.row(a) = -grid.directions.row(a);
  }
  grid.space = space;
  return true;
}

bool change_space(TriangleMesh& surface, const std::string& space) {
  const auto reversed = reversed_axes(surface.space, space);
  if (!reversed) return false;
  for (Vec3& p : surface.points) p = with_reversed_axes(p, *reversed);
  // An odd number of reversed axes is a reflection.
  if (std::count(reversed->begin(), reversed->end(), true) % 2 == 1)
    for (Triangle& t : surface.triangles) std::swap(t[1], t[2]);
  surface.space = space;
  return true;
}

std::shared_ptr<const SizeSource> change_space(std::shared_ptr<const SizeSource> sizes,
                                               const std::string& from, const std::string& to) {
  const auto reversed = reversed_axes(from, to);
  if (!reversed) return nullptr;
  return std::make_shared<const SizesInOtherSpace>(std::move(sizes), *reversed, to);
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "common/types.h"

namespace tetwright {

/// Names of fields that are known to be edge lengths: the first of them that a file has is taken.
inline constexpr std::array<std::string_view, 4> size_names{"size", "sizing", "edge_length", "h"};

/// An edge length that a user wants, and how far from the place in question. Input units.
struct WantedLength {
  double length = 0;    ///< above 0
  double distance = 0;  ///< 0 where the source reaches
};

/// Edge lengths that a user wants, where they were given: read from a file by read_size_field(). Input units.
/// Immutable; all functions may be called concurrently.
class SizeSource {
 public:
  /// `field`: what the lengths are called where they come from; empty if they have no name.
  explicit SizeSource(std::string field = {}) : field_(std::move(field)) {}
  SizeSource(const SizeSource&) = delete;
  SizeSource& operator=(const SizeSource&) = delete;
  virtual ~SizeSource() = default;

  /// Whether it answers within a volume, and not with the nearest place of a surface.
  virtual bool fills_space() const { return true; }

  const std::string& field() const { return field_; }

  /// The edge length wanted at a place. Sources that fill space (tet meshes, grids) answer within it, with
  /// distance 0, and give nothing elsewhere. Sources on a surface answer everywhere, with the length at its
  /// nearest place and the distance from there, by which the caller may let lengths grow:
  /// length + grading * distance.
  virtual std::optional<WantedLength> at(const Vec3& place) const = 0;

  /// Calls f(place, length) for every place at which the file gives a number that at() depends on, in the
  /// file's order.
  virtual void for_each_value(const std::function<void(const Vec3& place, double length)>& f) const = 0;

 private:
  const std::string field_;
};

}  // namespace tetwright

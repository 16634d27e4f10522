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

/// Names of fields known to be edge lengths; the first that a file has is used.
inline constexpr std::array<std::string_view, 4> size_names{"size", "sizing", "edge_length", "h"};

/// A target edge length, and its distance from the query point. Input units.
struct WantedLength {
  double length = 0;    ///< above 0
  double distance = 0;  ///< 0 where the source reaches
};

/// Target edge lengths where they were given: read from a file by read_size_field(). Input units. Immutable;
/// all functions may be called concurrently.
class SizeSource {
 public:
  /// \param field name of the lengths in their file; empty if they have none
  explicit SizeSource(std::string field = {}) : field_(std::move(field)) {}
  SizeSource(const SizeSource&) = delete;
  SizeSource& operator=(const SizeSource&) = delete;
  virtual ~SizeSource() = default;

  /// Whether it is defined within a volume, rather than by the nearest point of a surface.
  virtual bool fills_space() const { return true; }

  const std::string& field() const { return field_; }

  /// Target edge length at a point. Sources that fill space (tet meshes, grids) answer within their domain,
  /// with distance 0, and return nothing elsewhere. Sources on a surface answer everywhere, with the length
  /// at the nearest point and the distance from it, by which the caller may let lengths grow: length +
  /// grading * distance.
  virtual std::optional<WantedLength> at(const Vec3& place) const = 0;

  /// Calls f(place, length) for every point at which the file gives a number that at() depends on, in the
  /// file's order.
  virtual void for_each_value(const std::function<void(const Vec3& place, double length)>& f) const = 0;

 private:
  const std::string field_;
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "common/error.h"

namespace tetwright {

/// Limits the vertices and triangles of formats that place an object many times: a few lines of such a file
/// can ask for more than any machine holds.
class PlacedLimit {
 public:
  /// \throws InputError beyond the limit
  void add(std::size_t count, const std::string& file) {
    count_ += count;
    if (count_ > max_count)
      throw InputError(file, 0,
                       "its objects, as often as they are placed, have more than " +
                           std::to_string(max_count) + " vertices and triangles; place fewer");
  }

 private:
  static constexpr std::size_t max_count = 500'000'000;
  std::size_t count_ = 0;
};

}  // namespace tetwright

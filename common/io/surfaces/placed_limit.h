// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "tetwright/error.h"

namespace tetwright {

/// Limits the number of vertices and triangles in formats that can place an object many times: a few lines of
/// such a file can request more than any machine can hold.
class PlacedLimit {
 public:
  /// \throws InputError if the total exceeds the limit
  void add(std::size_t count, const std::string& file) {
    count_ += count;
    if (count_ > max_count)
      throw InputError(file, 0,
                       "its placed objects have in total more than " + std::to_string(max_count) +
                           " vertices and triangles; place fewer");
  }

 private:
  static constexpr std::size_t max_count = 500'000'000;
  std::size_t count_ = 0;
};

}  // namespace tetwright

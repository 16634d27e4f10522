// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

#include "common/io/encodings/byte_order.h"
#include "common/io/volumes/data_file.h"
#include "tests/common/io/expect_error.h"
#include "tetwright/label_volume.h"

namespace tetwright {

/// Bytes of numbers as stored in a file.
template <class Number>
std::string bytes_of(const std::vector<Number>& numbers, bool big = false) {
  std::string out;
  for (const Number n : numbers) {
    auto bytes = std::bit_cast<std::array<char, sizeof(Number)>>(n);
    if (big == little_endian_machine) std::reverse(bytes.begin(), bytes.end());
    out.append(bytes.data(), bytes.size());
  }
  return out;
}

/// Compresses bytes.
/// \param wrapper zlib's parameter windowBits: 31 for gzip, 15 for zlib
inline std::string deflated(const std::string& bytes, int wrapper = 31) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, wrapper, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string out(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  return out;
}

/// A volume of 2 x 3 x 4 voxels with the labels 0 to 23.
inline std::vector<MaterialTag> counted_labels() {
  std::vector<MaterialTag> labels(24);
  for (std::size_t i = 0; i < labels.size(); ++i) labels[i] = static_cast<MaterialTag>(i);
  return labels;
}

template <class Number>
std::string counted_voxels(bool big = false) {
  std::vector<Number> numbers;
  for (const MaterialTag label : counted_labels()) numbers.push_back(static_cast<Number>(label));
  return bytes_of(numbers, big);
}

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// A FileReader for a single file, `path`, whose content is `bytes`.
inline FileReader one_file(const std::string& path, const std::string& bytes) {
  return [=](const std::string& asked) {
    if (asked != path) throw InputError("cannot read " + asked + ": No such file or directory");
    return bytes;
  };
}

}  // namespace tetwright

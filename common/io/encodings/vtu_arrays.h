// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/io/encodings/byte_order.h"
#include "common/utf8.h"
#include "tetwright/files.h"

namespace tetwright {

/// Beginning of a VTK XML file with a dataset ("UnstructuredGrid", "PolyData"), for arrays encoded by
/// write_vtu_array().
inline std::string vtu_head(const std::string& dataset) {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + dataset +
         "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
         "compressor=\"vtkZLibDataCompressor\">\n<" +
         dataset + ">\n";
}

/// Writes an array of `size` bytes as VTK encodes it inline for format="binary", header_type="UInt32" and
/// compressor="vtkZLibDataCompressor". Blocks are compressed by zlib in parallel; the bytes written do not
/// depend on the number of threads. Needs memory for the compressed array, and 64 blocks of 2^18 bytes.
/// \param fill `fill(begin, bytes)` fills `bytes` with the bytes of the array from offset `begin` on, a
///   multiple of 2^18; called concurrently
void write_vtu_array(std::size_t size, const std::function<void(std::size_t begin, std::span<char>)>& fill,
                     const ByteSink& sink);

/// Writes a data array of `size` numbers `number(i)`.
template <class NumberAt>
void write_vtu_numbers(const ByteSink& sink, const char* type, const std::string& name,
                       const std::string& more, std::size_t size, NumberAt&& number) {
  using Number = decltype(number(std::size_t{}));
  sink(std::string("<DataArray type=\"") + type + "\" Name=\"" + name + "\" " + more +
       "format=\"binary\">\n");
  write_vtu_array(
      size * sizeof(Number),
      [&](std::size_t begin, std::span<char> bytes) {
        for (std::size_t at = 0; at < bytes.size(); at += sizeof(Number)) {
          auto raw = std::bit_cast<std::array<char, sizeof(Number)>>(number((begin + at) / sizeof(Number)));
          if (!little_endian_machine) std::reverse(raw.begin(), raw.end());
          std::copy(raw.begin(), raw.end(), bytes.data() + at);
        }
      },
      sink);
  sink("\n</DataArray>\n");
}

/// Writes names as an array of bytes with a line "NUMBER<tab>NAME" for each, since other readers do not
/// support VTK's text arrays.
inline void write_vtu_names(const ByteSink& sink, const char* array,
                            const std::vector<std::pair<std::int64_t, std::string>>& names) {
  std::string text;
  for (const auto& [number, name] : names)
    text += std::to_string(number) + '\t' + printable_name(name) + '\n';
  write_vtu_numbers(sink, "UInt8", array, "NumberOfTuples=\"" + std::to_string(text.size()) + "\" ",
                    text.size(), [&](std::size_t i) { return text[i]; });
}

}  // namespace tetwright

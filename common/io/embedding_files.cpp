// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/files/file_names.h"
#include "common/io/encodings/byte_order.h"
#include "common/io/encodings/zip_writer.h"
#include "common/lower_case.h"
#include "common/message_text.h"
#include "tetwright/error.h"
#include "tetwright/files.h"
#include "tetwright/io.h"

namespace tetwright {

namespace {

enum class EmbeddingFormat : std::uint8_t { npz, json };

EmbeddingFormat embedding_format(const std::string& path, const std::string& name) {
  const std::string extension = lower_case(name.empty()            ? extension_of(path)
                                           : name.starts_with('.') ? name
                                                                   : "." + name);
  if (extension == ".npz") return EmbeddingFormat::npz;
  if (extension == ".json") return EmbeddingFormat::json;
  throw UsageError((name.empty() ? path + ": " + in_quotes(extension) + " is not an extension"
                                 : "there is no format " + in_quotes(name)) +
                   " of weights; supported: .npz .json");
}

/// An array of NumPy in a file of version 1.0.
/// \param columns 0: the array has one axis
template <class Number>
class NpyArray {
 public:
  NpyArray(const char* type, std::size_t rows, std::size_t columns) {
    constexpr std::size_t magic_bytes = 8, length_bytes = 2, alignment = 64;
    std::string header = "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (" +
                         std::to_string(rows) + "," + (columns > 0 ? " " + std::to_string(columns) : "") +
                         "), }";
    const std::size_t unpadded = magic_bytes + length_bytes + header.size() + 1;
    header.append((alignment - unpadded % alignment) % alignment, ' ').append("\n");
    constexpr std::string_view magic("\x93NUMPY\x01\x00", magic_bytes);
    bytes_.reserve(magic_bytes + length_bytes + header.size() +
                   rows * std::max<std::size_t>(columns, 1) * sizeof(Number));
    bytes_ = magic;
    append_bytes(bytes_, static_cast<std::uint16_t>(header.size()));
    bytes_ += header;
  }
  void add(Number value) { append_bytes(bytes_, value); }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

constexpr const char *npy_int64 = "<i8", *npy_double = "<f8";

template <class Number, class Items>
std::string npy_of(const char* type, const Items& items) {
  NpyArray<Number> array(type, items.size(), 0);
  for (const auto item : items) array.add(static_cast<Number>(item));
  return array.take();
}

template <class Number, class Rows>
std::string npy_of_rows(const char* type, const Rows& rows) {
  NpyArray<Number> array(type, rows.size(), 4);
  for (const auto& row : rows)
    for (const auto item : row) array.add(static_cast<Number>(item));
  return array.take();
}

std::string npz_of(const Embedding& embedding, const std::string& name) {
  const std::array<ZipEntry, 4> entries{{{"tets.npy", npy_of<std::int64_t>(npy_int64, embedding.tets)},
                                         {"nodes.npy", npy_of_rows<std::int64_t>(npy_int64, embedding.nodes)},
                                         {"weights.npy", npy_of_rows<double>(npy_double, embedding.weights)},
                                         {"distances.npy", npy_of<double>(npy_double, embedding.distances)}}};
  return zip_bytes(entries, name);
}

/// A line for each array, since a document of nlohmann's would take several times its memory.
void write_json(const Embedding& embedding, const ByteSink& sink) {
  const auto write_array = [&](const char* start, const auto& items) {
    constexpr std::size_t piece_bytes = std::size_t{1} << 20;
    std::string text = start;
    bool first = true;
    for (const auto& item : items) {
      if (!first) text += ',';
      first = false;
      text += nlohmann::json(item).dump();
      if (text.size() < piece_bytes) continue;
      sink(text);
      text.clear();
    }
    sink(text + "]");
  };
  write_array("{\"tets\": [", embedding.tets);
  write_array(",\n\"nodes\": [", embedding.nodes);
  write_array(",\n\"weights\": [", embedding.weights);
  write_array(",\n\"distances\": [", embedding.distances);
  sink("}\n");
}

}  // namespace

void check_embedding_path(const std::string& path, const std::string& format) {
  (void)embedding_format(path, format);
  check_output_file(path);
}

void write_embedding(const Embedding& embedding, const std::string& path, OutputFiles* files,
                     const std::string& format) {
  const bool json = embedding_format(path, format) == EmbeddingFormat::json;
  const std::function<void(const ByteSink&)> content = [&](const ByteSink& sink) {
    if (json)
      write_json(embedding, sink);
    else
      sink(npz_of(embedding, path));
  };
  if (files)
    files->write(path, content);
  else
    write_file_atomically(path, content);
}

}  // namespace tetwright

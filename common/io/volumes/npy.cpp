// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/npy.h"

#include <algorithm>
#include <vector>

#include "common/io/encodings/byte_order.h"
#include "common/io/text/text_scanner.h"
#include "common/io/volumes/volume_axes.h"
#include "common/trimmed.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr std::string_view npy_magic = "\x93NUMPY";
/// NumPy's limit.
constexpr std::size_t max_npy_axes = 64;

/// Header "{'descr': '<f8', 'fortran_order': False, 'shape': (3, 4, 5), }": a dictionary of Python.
class NpyHeader {
 public:
  NpyHeader(std::string_view text, const std::string& name) : rest_(trimmed(text)), name_(name) {
    expect('{');
    bool has_type = false, has_order = false, has_shape = false;
    while (!next_is('}')) {
      const std::string_view key = quoted();
      expect(':');
      if (key == "descr") {
        has_type = true;
        read_type();
      } else if (key == "fortran_order") {
        has_order = true;
        read_order();
      } else if (key == "shape") {
        has_shape = true;
        read_shape();
      } else {
        fail("its header has the unknown entry " + in_quotes(key));
      }
      if (!next_is(',') && !rest_.starts_with('}'))
        fail("expected a comma in its header, found " + in_quotes(rest_));
    }
    if (!has_type || !has_order || !has_shape)
      fail("its header lacks descr, fortran_order or shape; the file is damaged");
  }

  const VoxelFormat& format() const { return format_; }
  /// Items along each axis, the one that varies fastest last.
  std::vector<std::int64_t> shape() const {
    std::vector<std::int64_t> shape = shape_;
    if (fortran_order_) std::reverse(shape.begin(), shape.end());
    return shape;
  }

 private:
  void read_type() {
    if (rest_.starts_with('[')) fail("its items are records of several fields; save one of them as an array");
    const std::string_view type = quoted();
    const std::optional<VoxelFormat> format = format_of_typestr(type);
    if (!format) fail("items of type " + in_quotes(type) + " are not supported; save the array as numbers");
    format_ = *format;
  }

  void read_order() {
    for (const bool value : {true, false}) {
      const std::string_view word = value ? "True" : "False";
      if (!rest_.starts_with(word)) continue;
      fortran_order_ = value;
      skip(word.size());
      return;
    }
    fail("fortran_order is neither True nor False: " + in_quotes(rest_));
  }

  void read_shape() {
    expect('(');
    while (!next_is(')')) {
      const std::size_t n = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
      std::int64_t items = 0;
      if (n == 0 || !parse_number(rest_.substr(0, n), items) || shape_.size() == max_npy_axes)
        fail("its shape is not a list of sizes: " + in_quotes(rest_));
      shape_.push_back(items);
      skip(n);
      if (rest_.starts_with('L')) skip(1);  // a long integer of Python 2
      if (!next_is(',') && !rest_.starts_with(')'))
        fail("its shape is not a list of sizes: " + in_quotes(rest_));
    }
  }

  std::string_view quoted() {
    const char quote = rest_.empty() ? '\0' : rest_[0];
    const std::size_t end = quote == '\'' || quote == '"' ? rest_.find(quote, 1) : std::string_view::npos;
    if (end == std::string_view::npos)
      fail("expected a text in quotes in its header, found " + in_quotes(rest_));
    const std::string_view text = rest_.substr(1, end - 1);
    skip(end + 1);
    return text;
  }
  bool next_is(char c) {
    if (!rest_.starts_with(c)) return false;
    skip(1);
    return true;
  }
  void expect(char c) {
    if (!next_is(c)) fail("expected '" + std::string(1, c) + "' in its header, found " + in_quotes(rest_));
  }
  void skip(std::size_t n) { rest_ = trimmed(rest_.substr(n)); }
  [[noreturn]] void fail(const std::string& message) const { throw InputError(name_, 0, message); }

  std::string_view rest_;
  const std::string& name_;
  VoxelFormat format_;
  bool fortran_order_ = false;
  std::vector<std::int64_t> shape_;
};

/// \param head the beginning of the file
RawVolume volume_of(std::string_view head, const std::string& name, VoxelUse use, std::int64_t max_voxels) {
  if (head.empty()) throw InputError(name, 0, "the file is empty");
  if (!head.starts_with(npy_magic))
    throw InputError(name, 0,
                     "expected \"\\x93NUMPY\" at the beginning, found " +
                         in_quotes(head.substr(0, npy_magic.size())) + "; is this a .npy file?");
  const std::size_t version_at = npy_magic.size();
  const int version = head.size() > version_at ? static_cast<unsigned char>(head[version_at]) : 0;
  const std::size_t length_at = version_at + 2, length_bytes = version == 1 ? 2 : 4;
  if (head.size() < length_at + length_bytes)
    throw InputError(name, 0, "the header is cut short; the file is truncated");
  if (version < 1 || version > 3)
    throw InputError(
        name, 0, "version " + std::to_string(version) + " of the format is not known; save it as 1, 2 or 3");
  const std::size_t length = version == 1
                                 ? load<std::uint16_t>(head.data() + length_at, !little_endian_machine)
                                 : load<std::uint32_t>(head.data() + length_at, !little_endian_machine);
  const std::size_t text_at = length_at + length_bytes;
  if (length > head.size() - text_at)
    throw InputError(
        name, 0, "its header of " + std::to_string(length) + " bytes is cut short; the file is truncated");
  const NpyHeader header(head.substr(text_at, length), name);
  const std::vector<std::int64_t> shape = header.shape();
  const VolumeAxes axes = volume_axes(shape, {}, use, name);
  RawVolume volume{{}, name, text_at + length, header.format()};
  std::array<std::int64_t, 3> size;
  for (std::size_t k = 0; k < 3; ++k) size[k] = shape[axes.spatial[k]];
  volume.grid.size = checked_size(size, name, 0, max_voxels);
  volume.grid.spacing_assumed = true;
  if (axes.channel) {
    volume.channels.count = shape[*axes.channel];
    check_channels(volume.channels.count, volume.grid.size, use, name, 0, max_voxels);
  }
  return volume;
}

}  // namespace

EncodedVolume open_npy(std::string_view bytes, const std::string& name, const FileReader& /*others*/,
                       VoxelUse use) {
  const RawVolume volume = volume_of(bytes, name, use, max_volume_voxels);
  return {volume.grid, volume.channels, volume.format,
          ByteSource(bytes.substr(static_cast<std::size_t>(volume.offset)), ByteSource::Packing::none, name)};
}

std::optional<RawVolume> find_npy(const HeaderBytes& head, const std::string& name, VoxelUse use) {
  return volume_of(head.bytes, name, use, max_source_voxels);
}

}  // namespace tetwright

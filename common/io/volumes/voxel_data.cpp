// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/voxel_data.h"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "common/io/encodings/byte_order.h"
#include "common/number_text.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Number of bytes of compressed voxels that are inflated and converted at a time.
constexpr std::size_t block_bytes = std::size_t{1} << 22;

constexpr std::size_t voxel_grain = std::size_t{1} << 17;

std::uint64_t voxel_count(const std::array<int, 3>& size) {
  return static_cast<std::uint64_t>(size[0]) * static_cast<std::uint64_t>(size[1]) *
         static_cast<std::uint64_t>(size[2]);
}

std::string text(const std::array<int, 3>& size) {
  return std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]);
}

bool to_label(double value, MaterialTag& label) {
  if (!(value >= std::numeric_limits<MaterialTag>::min() &&
        value <= std::numeric_limits<MaterialTag>::max()) ||
      value != std::floor(value))
    return false;
  label = static_cast<MaterialTag>(value);
  return true;
}

template <class Stored>
bool to_label(const char* from, const VoxelFormat& format, bool scaled, MaterialTag& label) {
  const auto stored = load<Stored>(from, format.swap);
  if (scaled) return to_label(format.slope * static_cast<double>(stored) + format.intercept, label);
  if constexpr (std::is_floating_point_v<Stored>) {
    return to_label(stored, label);
  } else {
    // NOLINTNEXTLINE(bugprone-signed-char-misuse): an int8 is a number here, not a character.
    label = static_cast<MaterialTag>(stored);
    return std::in_range<MaterialTag>(stored);
  }
}

/// Converts `n` numbers to labels.
/// \return the index of the first number that is not a label, or `n`
template <class Stored>
std::size_t convert(const char* from, std::size_t n, const VoxelFormat& format, MaterialTag* labels) {
  const bool scaled = format.slope != 1 || format.intercept != 0;
  std::atomic<std::size_t> first_bad = n;
  parallel_for(0, n, voxel_grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (to_label<Stored>(from + i * sizeof(Stored), format, scaled, labels[i])) continue;
      std::size_t before = first_bad;
      while (i < before && !first_bad.compare_exchange_weak(before, i)) {
      }
      break;
    }
  });
  return first_bad;
}

/// Calls `call` with a zero of the C++ type that corresponds to `type`.
template <class Call>
auto with_type(VoxelType type, const Call& call) {
  switch (type) {
    case VoxelType::int8:
      return call(std::int8_t{});
    case VoxelType::uint8:
      return call(std::uint8_t{});
    case VoxelType::int16:
      return call(std::int16_t{});
    case VoxelType::uint16:
      return call(std::uint16_t{});
    case VoxelType::int32:
      return call(std::int32_t{});
    case VoxelType::uint32:
      return call(std::uint32_t{});
    case VoxelType::int64:
      return call(std::int64_t{});
    case VoxelType::uint64:
      return call(std::uint64_t{});
    case VoxelType::float32:
      return call(float{});
    default:
      return call(double{});
  }
}

std::array<int, 3> voxel_at(std::size_t voxel, const std::array<int, 3>& size) {
  const auto nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]);
  return {static_cast<int>(voxel % nx), static_cast<int>(voxel / nx % ny), static_cast<int>(voxel / nx / ny)};
}

/// Message "voxel (1, 2, 3) has the value 0.5, ..." with the reason why the value is not a label.
std::string bad_value(const std::array<int, 3>& voxel, const std::string& value, bool whole) {
  return "voxel (" + std::to_string(voxel[0]) + ", " + std::to_string(voxel[1]) + ", " +
         std::to_string(voxel[2]) + ") has the value " + value +
         (whole ? ", which is not a 32-bit label; number the labels from 0"
                : ", not a whole number; a volume of labels is needed, not an image");
}

}  // namespace

std::size_t voxel_bytes(VoxelType type) {
  return with_type(type, [](auto number) { return sizeof(number); });
}

std::uint64_t voxel_data_bytes(const std::array<int, 3>& size, VoxelType type) {
  return voxel_count(size) * voxel_bytes(type);
}

std::string needed_bytes(const std::array<int, 3>& size, VoxelType type) {
  const std::size_t each = voxel_bytes(type);
  return "its " + text(size) + " voxels of " + std::to_string(each) +
         (each == 1 ? " byte need " : " bytes need ") + std::to_string(voxel_data_bytes(size, type)) +
         " bytes, but ";
}

std::size_t convert_row(const char* from, std::size_t step, std::size_t n, const VoxelFormat& format,
                        MaterialTag* labels) {
  const bool scaled = format.slope != 1 || format.intercept != 0;
  return with_type(format.type, [&](auto number) {
    for (std::size_t i = 0; i < n; ++i)
      if (!to_label<decltype(number)>(from + i * step, format, scaled, labels[i])) return i;
    return n;
  });
}

std::string bad_voxel(const std::array<int, 3>& voxel, const char* from, const VoxelFormat& format) {
  return with_type(format.type, [&](auto number) {
    using Stored = decltype(number);
    const auto stored = load<Stored>(from, format.swap);
    std::string value;
    bool whole = std::is_integral_v<Stored>;
    if (format.slope != 1 || format.intercept != 0 || !whole) {
      const double scaled = format.slope * static_cast<double>(stored) + format.intercept;
      append_number(value, scaled);
      whole = std::isfinite(scaled) && scaled == std::floor(scaled);
    } else {
      append_number(value, stored);
    }
    return bad_value(voxel, value, whole);
  });
}

std::array<int, 3> checked_size(std::span<const std::int64_t> sizes, const std::string& file,
                                std::size_t line, std::int64_t max_voxels) {
  if (sizes.size() != 3) throw InputError(file, line, std::to_string(sizes.size()) + " axes; a volume has 3");
  std::array<int, 3> out;
  std::int64_t voxels = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    if (sizes[k] < 1)
      throw InputError(
          file, line,
          "the size along axis " + std::to_string(k) + " is " + std::to_string(sizes[k]) + ", not 1 or more");
    if (sizes[k] > std::min<std::int64_t>(max_voxels / voxels, std::numeric_limits<int>::max()))
      throw InputError(file, line,
                       "the size " + std::to_string(sizes[k]) + " along axis " + std::to_string(k) +
                           " makes more than " + std::to_string(max_voxels) +
                           " voxels; crop the volume or make it coarser");
    voxels *= sizes[k];
    out[k] = static_cast<int>(sizes[k]);
  }
  return out;
}

std::vector<MaterialTag> read_voxels(ByteSource& body, const VoxelFormat& format,
                                     const std::array<int, 3>& size) {
  const std::size_t n = voxel_count(size), each = voxel_bytes(format.type);
  const std::uint64_t needed = voxel_data_bytes(size, format.type);
  if (needed > body.max_left())
    throw InputError(body.name() + ": " + needed_bytes(size, format.type) +
                     (body.packed()
                          ? "the compressed data hold " + std::to_string(body.max_left()) +
                                " at most; the file is truncated or its header is wrong"
                          : "only " + std::to_string(body.max_left()) +
                                " follow the header; the file is truncated or its header is wrong"));
  const std::uint64_t before = body.taken();
  std::vector<MaterialTag> labels;
  // Reserved pages use no memory until voxels are written to them.
  labels.reserve(n);
  while (labels.size() < n) {
    const std::size_t done = labels.size();
    const std::size_t wanted = body.packed() ? std::min(n - done, block_bytes / each) : n - done;
    const std::string_view bytes = body.take(wanted * each);
    if (bytes.size() < wanted * each)
      throw InputError(body.name() + ": " + needed_bytes(size, format.type) + "only " +
                       std::to_string(body.taken() - before) + " are there; the file is truncated");
    labels.resize(done + wanted);
    with_type(format.type, [&](auto number) {
      using Stored = decltype(number);
      const std::size_t bad = convert<Stored>(bytes.data(), wanted, format, labels.data() + done);
      if (bad == wanted) return;
      throw InputError(body.name() + ": " +
                       bad_voxel(voxel_at(done + bad, size), bytes.data() + bad * each, format));
    });
  }
  body.check_end();
  return labels;
}

std::vector<MaterialTag> read_voxels_as_text(TextScanner& body, const std::array<int, 3>& size) {
  const std::size_t n = voxel_count(size);
  if (n > (body.left() + 1) / 2)
    body.fail("its " + text(size) + " voxels need " + std::to_string(2 * n - 1) +
              " bytes or more, but only " + std::to_string(body.left()) +
              " follow; the file is truncated or its header is wrong");
  std::vector<MaterialTag> labels(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::string_view word = body.word();
    double value = 0;
    if (word.empty())
      body.fail("the file ends after " + std::to_string(i) + " of " + std::to_string(n) +
                " voxels; it is truncated");
    if (!parse_number(word, value)) body.fail("expected the number of a voxel, found " + in_quotes(word));
    if (!to_label(value, labels[i]))
      body.fail(
          bad_value(voxel_at(i, size), in_quotes(word), std::isfinite(value) && value == std::floor(value)));
  }
  return labels;
}

}  // namespace tetwright

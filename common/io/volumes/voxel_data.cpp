// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/voxel_data.h"

#include <algorithm>
#include <array>
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

/// A floating-point number of 16 bits (IEEE 754 binary16).
struct Half {
  std::uint16_t bits = 0;

  explicit operator double() const {
    const int exponent = bits >> 10 & 31, fraction = bits & 1023;
    double value = 0;
    if (exponent == 31)
      value =
          fraction == 0 ? std::numeric_limits<double>::infinity() : std::numeric_limits<double>::quiet_NaN();
    else
      value = std::ldexp(exponent == 0 ? fraction : 1024 + fraction, (exponent == 0 ? 1 : exponent) - 25);
    return bits >> 15 ? -value : value;
  }
};

/// Converts a number to a label, or to a value of an image.
/// \return false if it is none
bool to_value(double number, MaterialTag& label) {
  if (!(number >= std::numeric_limits<MaterialTag>::min() &&
        number <= std::numeric_limits<MaterialTag>::max()) ||
      number != std::floor(number))
    return false;
  label = static_cast<MaterialTag>(number);
  return true;
}
bool to_value(double number, float& value) {
  if (!(std::fabs(number) <= static_cast<double>(std::numeric_limits<float>::max()))) return false;
  value = static_cast<float>(number);
  return true;
}

template <class Stored, class Value>
bool to_value(const char* from, const VoxelFormat& format, bool scaled, Value& value) {
  const auto stored = load<Stored>(from, format.swap);
  if (scaled) return to_value(format.slope * static_cast<double>(stored) + format.intercept, value);
  if constexpr (!std::is_integral_v<Stored>) {
    return to_value(static_cast<double>(stored), value);
  } else {
    // NOLINTNEXTLINE(bugprone-signed-char-misuse): an int8 is a number here, not a character.
    value = static_cast<Value>(stored);
    if constexpr (std::is_integral_v<Value>)
      return std::in_range<Value>(stored);
    else
      return true;
  }
}

/// The channels and voxels to which the numbers of a body belong, in the order of the body.
class NumberOrder {
 public:
  NumberOrder(std::array<int, 3> size, const ChannelAxis& axis)
      : size_(size), channels_(static_cast<std::size_t>(axis.count)) {
    for (std::size_t k = 0; k < 3; ++k)
      if (axis.count == 1 || k < axis.position) run_ *= static_cast<std::size_t>(size[k]);
  }

  std::size_t channels() const { return channels_; }
  /// Numbers of one channel that follow each other.
  std::size_t run() const { return run_; }
  std::size_t voxel(std::size_t number) const { return number / run_ / channels_ * run_ + number % run_; }
  std::size_t channel(std::size_t number) const { return number / run_ % channels_; }
  /// How many of the first `numbers` numbers a channel has.
  std::size_t count(std::size_t numbers, std::size_t channel) const {
    const std::size_t rest = numbers % (run_ * channels_), before = channel * run_;
    return numbers / (run_ * channels_) * run_ + std::min(run_, rest - std::min(rest, before));
  }
  VoxelName name(std::size_t number) const {
    const std::size_t at = voxel(number);
    const auto nx = static_cast<std::size_t>(size_[0]), ny = static_cast<std::size_t>(size_[1]);
    return {{static_cast<int>(at % nx), static_cast<int>(at / nx % ny), static_cast<int>(at / nx / ny)},
            static_cast<std::int64_t>(channel(number)),
            static_cast<std::int64_t>(channels_)};
  }

 private:
  std::array<int, 3> size_;
  std::size_t channels_, run_ = 1;
};

/// Converts the numbers from `begin` to before `end` of a body.
/// \param bytes those of number `begin`
/// \return the first number that cannot be converted, or `end`
template <class Value>
std::size_t convert_part(const char* bytes, std::size_t begin, std::size_t end, const VoxelFormat& format,
                         const NumberOrder& order, std::vector<std::vector<Value>>& out) {
  const std::size_t each = voxel_bytes(format.type), channels = order.channels();
  std::size_t first_bad = end;
  if (order.run() == 1) {
    for (std::size_t i = begin; i < std::min(end, begin + channels); ++i) {
      const std::size_t n = (end - 1 - i) / channels + 1;
      const std::size_t bad = convert_row(bytes + (i - begin) * each, channels * each, n, format,
                                          out[order.channel(i)].data() + order.voxel(i));
      if (bad < n) first_bad = std::min(first_bad, i + bad * channels);
    }
    return first_bad;
  }
  for (std::size_t i = begin; i < end;) {
    const std::size_t n = std::min(end - i, order.run() - i % order.run());
    const std::size_t bad = convert_row(bytes + (i - begin) * each, each, n, format,
                                        out[order.channel(i)].data() + order.voxel(i));
    if (bad < n) return i + bad;
    i += n;
  }
  return end;
}

/// Converts numbers of a body in parallel. Parameters and result as for convert_part().
template <class Value>
std::size_t convert_parts(const char* bytes, std::size_t begin, std::size_t end, const VoxelFormat& format,
                          const NumberOrder& order, std::vector<std::vector<Value>>& out) {
  std::atomic<std::size_t> first_bad = end;
  parallel_for(begin, end, voxel_grain, [&](std::size_t from, std::size_t to) {
    const std::size_t bad =
        convert_part(bytes + (from - begin) * voxel_bytes(format.type), from, to, format, order, out);
    if (bad == to) return;
    std::size_t before = first_bad;
    while (bad < before && !first_bad.compare_exchange_weak(before, bad)) {
    }
  });
  return first_bad;
}

std::string name_text(const VoxelName& name) {
  const std::array<int, 3>& v = name.voxel;
  return "voxel (" + std::to_string(v[0]) + ", " + std::to_string(v[1]) + ", " + std::to_string(v[2]) + ")" +
         (name.channels > 1 ? " of channel " + std::to_string(name.channel) : "");
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
    case VoxelType::float16:
      return call(Half{});
    case VoxelType::float32:
      return call(float{});
    default:
      return call(double{});
  }
}

/// Message "voxel (1, 2, 3) has the value 0.5, ..." with the reason why the value is not a label.
std::string bad_value(const VoxelName& name, const std::string& value, double number, MaterialTag /*kind*/) {
  return name_text(name) + " has the value " + value +
         (std::isfinite(number) && number == std::floor(number)
              ? ", which is not a 32-bit label; number the labels from 0"
              : ", not a whole number; a volume of labels is needed; mesh an image with --iso");
}
/// Message with the reason why the value is not one of an image.
std::string bad_value(const VoxelName& name, const std::string& value, double number, float /*kind*/) {
  return name_text(name) + " has the value " + value +
         (std::isfinite(number) ? ", beyond the range of 32-bit floats; scale the values of the image"
                                : ", not a finite number; give each voxel one, such as the background's");
}

/// Checks that the values of an image fit into memory. Labels are checked by their callers.
template <class Value>
void require_values_memory(std::size_t n, const std::string& file) {
  if constexpr (std::is_same_v<Value, float>)
    require_memory(static_cast<double>(n) * sizeof(float), "the values of " + file,
                   "crop the image or make it coarser");
}

}  // namespace

std::string name_of_use(VoxelUse use) { return use == VoxelUse::labels ? "a volume of labels" : "an image"; }

std::string numbers_to_save(VoxelUse use, const std::string& labels) {
  return use == VoxelUse::labels ? labels : "save the values of the image as floats of 32 bits";
}

std::optional<VoxelType> voxel_type_called(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, VoxelType>, 11> types{{{"int8", VoxelType::int8},
                                                                          {"uint8", VoxelType::uint8},
                                                                          {"int16", VoxelType::int16},
                                                                          {"uint16", VoxelType::uint16},
                                                                          {"int32", VoxelType::int32},
                                                                          {"uint32", VoxelType::uint32},
                                                                          {"int64", VoxelType::int64},
                                                                          {"uint64", VoxelType::uint64},
                                                                          {"float16", VoxelType::float16},
                                                                          {"float32", VoxelType::float32},
                                                                          {"float64", VoxelType::float64}}};
  for (const auto& [known, type] : types)
    if (name == known) return type;
  return std::nullopt;
}

std::size_t voxel_bytes(VoxelType type) {
  return with_type(type, [](auto number) { return sizeof(number); });
}

std::uint64_t voxel_data_bytes(const std::array<int, 3>& size, VoxelType type, std::int64_t channels) {
  return voxel_count(size) * voxel_bytes(type) * static_cast<std::uint64_t>(channels);
}

std::string needed_bytes(const std::array<int, 3>& size, VoxelType type, std::int64_t channels) {
  const std::size_t each = voxel_bytes(type);
  return "its " + text(size) + " voxels of " + (channels > 1 ? std::to_string(channels) + " x " : "") +
         std::to_string(each) + (each == 1 ? " byte need " : " bytes need ") +
         std::to_string(voxel_data_bytes(size, type, channels)) + " bytes, but ";
}

template <class Value>
std::size_t convert_row(const char* from, std::size_t step, std::size_t n, const VoxelFormat& format,
                        Value* to) {
  const bool scaled = format.slope != 1 || format.intercept != 0;
  return with_type(format.type, [&](auto number) {
    for (std::size_t i = 0; i < n; ++i)
      if (!to_value<decltype(number)>(from + i * step, format, scaled, to[i])) return i;
    return n;
  });
}
template std::size_t convert_row(const char*, std::size_t, std::size_t, const VoxelFormat&, MaterialTag*);
template std::size_t convert_row(const char*, std::size_t, std::size_t, const VoxelFormat&, float*);

template <class Value>
std::string bad_voxel(const VoxelName& name, const char* from, const VoxelFormat& format) {
  return with_type(format.type, [&](auto number) {
    using Stored = decltype(number);
    const auto stored = load<Stored>(from, format.swap);
    const double scaled = format.slope * static_cast<double>(stored) + format.intercept;
    std::string value;
    if constexpr (std::is_integral_v<Stored>)
      format.slope == 1 && format.intercept == 0 ? append_number(value, stored)
                                                 : append_number(value, scaled);
    else
      append_number(value, scaled);
    return bad_value(name, value, scaled, Value{});
  });
}
template std::string bad_voxel<MaterialTag>(const VoxelName&, const char*, const VoxelFormat&);
template std::string bad_voxel<float>(const VoxelName&, const char*, const VoxelFormat&);

std::optional<VoxelFormat> format_of_typestr(std::string_view typestr) {
  constexpr std::array<std::pair<std::string_view, VoxelType>, 12> types{{{"b1", VoxelType::uint8},
                                                                          {"i1", VoxelType::int8},
                                                                          {"u1", VoxelType::uint8},
                                                                          {"i2", VoxelType::int16},
                                                                          {"u2", VoxelType::uint16},
                                                                          {"i4", VoxelType::int32},
                                                                          {"u4", VoxelType::uint32},
                                                                          {"i8", VoxelType::int64},
                                                                          {"u8", VoxelType::uint64},
                                                                          {"f2", VoxelType::float16},
                                                                          {"f4", VoxelType::float32},
                                                                          {"f8", VoxelType::float64}}};
  const bool ordered = typestr.starts_with('<') || typestr.starts_with('>');
  for (const auto& [name, type] : types)
    if (typestr.size() == 3 && typestr.substr(1) == name && (ordered || voxel_bytes(type) == 1)) {
      VoxelFormat format;
      format.type = type;
      format.swap = voxel_bytes(type) > 1 && typestr.starts_with('<') != little_endian_machine;
      return format;
    }
  return std::nullopt;
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

void check_channels(std::int64_t channels, const std::array<int, 3>& size, VoxelUse use,
                    const std::string& file, std::size_t line, std::int64_t max_voxels) {
  if (channels < 1 || channels > (use == VoxelUse::labels ? 1 : max_channels))
    throw InputError(file, line,
                     std::to_string(channels) + " channels; " +
                         (use == VoxelUse::labels ? "a volume with one label per voxel is needed"
                                                  : "an image has 1 to " + std::to_string(max_channels)));
  if (channels > max_voxels / static_cast<std::int64_t>(voxel_count(size)))
    throw InputError(file, line,
                     std::to_string(channels) + " channels of " + text(size) + " voxels have more than " +
                         std::to_string(max_voxels) + " values; crop the image or make it coarser");
}

template <class Value>
std::vector<std::vector<Value>> read_voxels(ByteSource& body, const VoxelFormat& format,
                                            const std::array<int, 3>& size, const ChannelAxis& channels) {
  const NumberOrder order(size, channels);
  const std::size_t n = voxel_count(size) * order.channels(), each = voxel_bytes(format.type);
  const std::uint64_t needed = voxel_data_bytes(size, format.type, channels.count);
  if (needed > body.max_left())
    throw InputError(body.name() + ": " + needed_bytes(size, format.type, channels.count) +
                     (body.packed()
                          ? "the compressed data hold " + std::to_string(body.max_left()) +
                                " at most; the file is truncated or its header is wrong"
                          : "only " + std::to_string(body.max_left()) +
                                " follow the header; the file is truncated or its header is wrong"));
  require_values_memory<Value>(n, body.name());
  const std::uint64_t before = body.taken();
  std::vector<std::vector<Value>> out(order.channels());
  // Reserved pages use no memory until voxels are written to them.
  for (std::vector<Value>& channel : out) channel.reserve(voxel_count(size));
  for (std::size_t done = 0; done < n;) {
    const std::size_t wanted = body.packed() ? std::min(n - done, block_bytes / each) : n - done;
    const std::string_view bytes = body.take(wanted * each);
    if (bytes.size() < wanted * each)
      throw InputError(body.name() + ": " + needed_bytes(size, format.type, channels.count) + "only " +
                       std::to_string(body.taken() - before) + " are there; the file is truncated");
    const std::size_t end = done + wanted;
    for (std::size_t c = 0; c < out.size(); ++c) out[c].resize(order.count(end, c));
    const std::size_t bad = convert_parts(bytes.data(), done, end, format, order, out);
    if (bad != end)
      throw InputError(body.name() + ": " +
                       bad_voxel<Value>(order.name(bad), bytes.data() + (bad - done) * each, format));
    done = end;
  }
  body.check_end();
  return out;
}
template std::vector<std::vector<MaterialTag>> read_voxels(ByteSource&, const VoxelFormat&,
                                                           const std::array<int, 3>&, const ChannelAxis&);
template std::vector<std::vector<float>> read_voxels(ByteSource&, const VoxelFormat&,
                                                     const std::array<int, 3>&, const ChannelAxis&);

template <class Value>
std::vector<std::vector<Value>> read_voxels_as_text(TextScanner& body, const std::array<int, 3>& size,
                                                    const ChannelAxis& channels) {
  const NumberOrder order(size, channels);
  const std::size_t n = voxel_count(size) * order.channels();
  if (n > (body.left() + 1) / 2)
    body.fail("its " + text(size) + " voxels need " + std::to_string(2 * n - 1) +
              " bytes or more, but only " + std::to_string(body.left()) +
              " follow; the file is truncated or its header is wrong");
  require_values_memory<Value>(n, body.name());
  std::vector<std::vector<Value>> out(order.channels(), std::vector<Value>(voxel_count(size)));
  for (std::size_t i = 0; i < n; ++i) {
    const std::string_view word = body.word();
    double number = 0;
    if (word.empty())
      body.fail("the file ends after " + std::to_string(i) + " of " + std::to_string(n) +
                " voxels; it is truncated");
    if (!parse_number(word, number)) body.fail("expected the number of a voxel, found " + in_quotes(word));
    if (!to_value(number, out[order.channel(i)][order.voxel(i)]))
      body.fail(bad_value(order.name(i), in_quotes(word), number, Value{}));
  }
  return out;
}
template std::vector<std::vector<MaterialTag>> read_voxels_as_text(TextScanner&, const std::array<int, 3>&,
                                                                   const ChannelAxis&);
template std::vector<std::vector<float>> read_voxels_as_text(TextScanner&, const std::array<int, 3>&,
                                                             const ChannelAxis&);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/vtk_numbers.h"

#include <cctype>
#include <cmath>
#include <type_traits>

#include "common/io/encodings/byte_order.h"

namespace tetwright {

namespace {

/// Checks that `n` items of `bytes_each` bytes, a count from the file, fit into the rest of the file.
void expect_bytes(const TextScanner& in, std::size_t n, std::size_t bytes_each, const std::string& what) {
  // The last word may lack trailing white space.
  if (n > (in.left() + 1) / bytes_each)
    in.fail("the header gives " + std::to_string(n) + " numbers (" + what + "), but only " +
            std::to_string(in.left()) + " bytes follow; the file is truncated or its header is wrong");
}

template <class Value, class Stored>
std::vector<Value> read_binary(TextScanner& in, std::size_t n, const std::string& what) {
  in.skip_line();
  expect_bytes(in, n, sizeof(Stored), what);
  const std::string_view bytes = in.take_bytes(n * sizeof(Stored));
  if (bytes.size() != n * sizeof(Stored)) in.fail_cut_short(what);
  std::vector<Value> values(n);
  for (std::size_t i = 0; i < n; ++i) {
    const auto stored = load<Stored>(bytes.data() + i * sizeof(Stored), little_endian_machine);
    if constexpr (std::is_integral_v<Value> && std::is_floating_point_v<Stored>) {
      if (!(stored == std::floor(stored) && std::fabs(stored) < 0x1p53))
        in.fail("expected whole numbers (" + what + "), found " + std::to_string(stored));
    } else if constexpr (std::is_integral_v<Value> && std::is_same_v<Stored, std::uint64_t>) {
      if (stored > static_cast<std::uint64_t>(INT64_MAX)) in.fail("a value beyond 2^63 (" + what + ")");
    }
    // NOLINTNEXTLINE(bugprone-signed-char-misuse): a char represents a number here, not a character.
    values[i] = static_cast<Value>(stored);
  }
  return values;
}

/// Reads bits, eight to a byte, the first in the highest bit.
template <class Value>
std::vector<Value> read_bits(TextScanner& in, std::size_t n, const std::string& what) {
  in.skip_line();
  if (n / 8 > in.left()) expect_bytes(in, n, 1, what);
  const std::string_view bytes = in.take_bytes(n / 8 + (n % 8 != 0));
  if (bytes.size() != n / 8 + (n % 8 != 0)) in.fail_cut_short(what);
  std::vector<Value> values(n);
  for (std::size_t i = 0; i < n; ++i)
    values[i] = static_cast<Value>((static_cast<unsigned char>(bytes[i / 8]) >> (7 - i % 8)) & 1);
  return values;
}

}  // namespace

bool is_integer_type(const std::string& type) { return type != "float" && type != "double"; }

template <class Value>
std::vector<Value> read_vtk_numbers(TextScanner& in, bool binary, const std::string& type, std::size_t n,
                                    const std::string& what) {
  const auto is = [&](std::initializer_list<const char*> names) {
    return std::find(names.begin(), names.end(), type) != names.end();
  };
  enum class Kind { bit, i8, u8, i16, u16, i32, u32, i64, u64, f32, f64 } kind{};
  if (is({"bit"}))
    kind = Kind::bit;
  else if (is({"char", "signed_char", "vtktypeint8"}))
    kind = Kind::i8;
  else if (is({"unsigned_char", "vtktypeuint8"}))
    kind = Kind::u8;
  else if (is({"short", "vtktypeint16"}))
    kind = Kind::i16;
  else if (is({"unsigned_short", "vtktypeuint16"}))
    kind = Kind::u16;
  else if (is({"int", "vtkidtype", "vtktypeint32"}))  // a vtkIdType has 32 bits in files
    kind = Kind::i32;
  else if (is({"unsigned_int", "vtktypeuint32"}))
    kind = Kind::u32;
  else if (is({"long", "long_long", "vtktypeint64"}))
    kind = Kind::i64;
  else if (is({"unsigned_long", "unsigned_long_long", "vtktypeuint64"}))
    kind = Kind::u64;
  else if (is({"float"}))
    kind = Kind::f32;
  else if (is({"double"}))
    kind = Kind::f64;
  else
    in.fail("unknown number type " + in_quotes(type));
  if (!binary) {
    expect_bytes(in, n, 2, what);
    std::vector<Value> values(n);
    for (Value& value : values) {
      if constexpr (std::is_integral_v<Value>)
        value = in.integer(what);
      else
        value = in.number(what);
    }
    return values;
  }
  switch (kind) {
    case Kind::bit:
      return read_bits<Value>(in, n, what);
    case Kind::i8:
      return read_binary<Value, std::int8_t>(in, n, what);
    case Kind::u8:
      return read_binary<Value, std::uint8_t>(in, n, what);
    case Kind::i16:
      return read_binary<Value, std::int16_t>(in, n, what);
    case Kind::u16:
      return read_binary<Value, std::uint16_t>(in, n, what);
    case Kind::i32:
      return read_binary<Value, std::int32_t>(in, n, what);
    case Kind::u32:
      return read_binary<Value, std::uint32_t>(in, n, what);
    case Kind::i64:
      return read_binary<Value, std::int64_t>(in, n, what);
    case Kind::u64:
      return read_binary<Value, std::uint64_t>(in, n, what);
    case Kind::f32:
      return read_binary<Value, float>(in, n, what);
    case Kind::f64:
      return read_binary<Value, double>(in, n, what);
  }
  return {};
}

template std::vector<double> read_vtk_numbers(TextScanner&, bool, const std::string&, std::size_t,
                                              const std::string&);
template std::vector<std::int64_t> read_vtk_numbers(TextScanner&, bool, const std::string&, std::size_t,
                                                    const std::string&);

void skip_vtk_strings(TextScanner& in, bool binary, std::size_t n) {
  in.skip_line();
  for (std::size_t i = 0; i < n; ++i) {
    if (in.left() == 0) in.fail_cut_short("text");
    if (!binary) {
      in.skip_line();
      continue;
    }
    // The two highest bits of the first byte encode the size of the length: 8, 4, 2 or 1 bytes. The other
    // bits are the beginning of the length.
    const std::string_view head = in.take_bytes(1);
    const auto first = static_cast<unsigned char>(head[0]);
    const std::size_t more = first >> 6 == 0 ? 7 : first >> 6 == 1 ? 3 : first >> 6 == 2 ? 1 : 0;
    std::uint64_t length = first & 0x3fU;
    for (const char c : in.take_bytes(more)) length = length << 8 | static_cast<unsigned char>(c);
    if (length > in.left()) in.fail_cut_short("text");
    (void)in.take_bytes(static_cast<std::size_t>(length));
  }
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/msh_numbers.h"

#include <cmath>
#include <string>

#include "common/io/encodings/byte_order.h"

namespace tetwright {

template <class Number>
Number MshNumbers::load_next(std::string_view what) {
  const std::string_view bytes = in_.take_bytes(sizeof(Number));
  if (bytes.size() < sizeof(Number)) in_.fail_cut_short(what);
  return load<Number>(bytes.data(), swap_);
}

std::int64_t MshNumbers::integer(std::string_view what) {
  return binary_ ? load_next<std::int32_t>(what) : in_.integer(what);
}

std::int64_t MshNumbers::size(std::string_view what) {
  if (!binary_) return in_.integer(what);
  return size_bytes_ == 4 ? std::int64_t{load_next<std::uint32_t>(what)} : load_next<std::int64_t>(what);
}

double MshNumbers::number(std::string_view what) {
  return binary_ ? load_next<double>(what) : in_.number(what);
}

double MshNumbers::coordinate() {
  if (!binary_) return in_.coordinate();
  const double value = load_next<double>("coordinate");
  if (!std::isfinite(value))
    in_.fail("a coordinate is not finite: " + std::to_string(value) + "; remove or repair it");
  return value;
}

std::size_t MshNumbers::count(std::string_view what, std::size_t text_bytes, std::size_t binary_bytes) {
  return checked_count(size(what), what, text_bytes, binary_bytes);
}

std::size_t MshNumbers::checked_count(std::int64_t n, std::string_view what, std::size_t text_bytes,
                                      std::size_t binary_bytes) const {
  if (n < 0) in_.fail("the " + std::string(what) + " is negative: " + std::to_string(n));
  // The last number of a text may lack trailing white space.
  const std::size_t room = binary_ ? in_.left() / binary_bytes : (in_.left() + 1) / text_bytes;
  if (static_cast<std::uint64_t>(n) > room)
    in_.fail("the " + std::string(what) + " is " + std::to_string(n) + ", but only " +
             std::to_string(in_.left()) + " bytes follow; the file is truncated or its header is wrong");
  return static_cast<std::size_t>(n);
}

}  // namespace tetwright

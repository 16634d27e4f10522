// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "common/io/text/text_scanner.h"

namespace tetwright {

/// Reads the numbers of an MSH file's sections, as text or binary.
class MshNumbers {
 public:
  /// Reads text until set_binary() is called. `in` must outlive this object.
  explicit MshNumbers(TextScanner& in) : in_(in) {}

  /// Switches to binary numbers.
  /// \param swap true if the bytes are not in this machine's order
  /// \param size_bytes size of the numbers that size() reads, 4 or 8 bytes
  void set_binary(bool swap, std::size_t size_bytes) {
    binary_ = true;
    swap_ = swap;
    size_bytes_ = size_bytes;
  }
  bool binary() const { return binary_; }
  /// Returns a reader with the same encoding at another position of the file.
  MshNumbers of(TextScanner& in) const {
    MshNumbers numbers(in);
    if (binary_) numbers.set_binary(swap_, size_bytes_);
    return numbers;
  }

  /// Reads an int (4 bytes), a size or node number (4 or 8 bytes), or a double.
  /// \param what names the number in messages
  /// \throws InputError at the end of the file or if there is no number
  std::int64_t integer(std::string_view what);
  std::int64_t size(std::string_view what);
  double number(std::string_view what);
  /// Reads a finite number.
  double coordinate();
  /// Reads the number of subsequent items, each of at least `text_bytes` or `binary_bytes` bytes.
  std::size_t count(std::string_view what, std::size_t text_bytes, std::size_t binary_bytes);
  /// Checks a count that has been read.
  std::size_t checked_count(std::int64_t n, std::string_view what, std::size_t text_bytes,
                            std::size_t binary_bytes) const;

  /// Skips the line feed between a header line of text and binary numbers.
  void begin_binary() {
    if (binary_) in_.skip_line();
  }

 private:
  template <class Number>
  Number load_next(std::string_view what);

  TextScanner& in_;
  bool binary_ = false, swap_ = false;
  std::size_t size_bytes_ = 8;
};

}  // namespace tetwright

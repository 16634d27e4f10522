// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "common/io/text/text_scanner.h"

namespace tetwright {

/// The numbers of an MSH file's sections, as text or binary.
class MshNumbers {
 public:
  /// `in` must outlive this object; it is text unless set_binary() is called.
  explicit MshNumbers(TextScanner& in) : in_(in) {}

  /// `swap`: the bytes are in the other order than this machine's. `size_bytes`: of what size() reads, 4
  /// or 8.
  void set_binary(bool swap, std::size_t size_bytes) {
    binary_ = true;
    swap_ = swap;
    size_bytes_ = size_bytes;
  }
  bool binary() const { return binary_; }
  /// The same kind of numbers from another place of the file.
  MshNumbers of(TextScanner& in) const {
    MshNumbers numbers(in);
    if (binary_) numbers.set_binary(swap_, size_bytes_);
    return numbers;
  }

  /// The next number: an int (4 bytes), a size or node number (4 or 8 bytes), a double. `what` names it in
  /// messages. All throw InputError at the end of the file or for what is no number.
  std::int64_t integer(std::string_view what);
  std::int64_t size(std::string_view what);
  double number(std::string_view what);
  /// A finite one.
  double coordinate();
  /// A size that counts items that follow, each of at least `text_bytes` bytes or `binary_bytes`.
  std::size_t count(std::string_view what, std::size_t text_bytes, std::size_t binary_bytes);
  /// The same of a number that was read already.
  std::size_t checked_count(std::int64_t n, std::string_view what, std::size_t text_bytes,
                            std::size_t binary_bytes) const;

  /// Skips one line feed after a header line of text, behind which binary numbers begin.
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

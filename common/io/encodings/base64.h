// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tetwright {

/// Appends `bytes` in base64, padded.
void append_base64(std::string& out, std::string_view bytes);

/// Decodes base64 in pieces. White space is skipped. Padding is allowed anywhere, since a text may hold
/// several encoded blocks, one after the other. The text must outlive the reader.
///
/// Our own, since a decoder for VTK has to go on after padding and to stop where it is told.
class Base64Reader {
 public:
  explicit Base64Reader(std::string_view text) : text_(text) {}

  /// Decodes the next `n` bytes into `to` and returns their number, which is smaller if the text ends before
  /// or has a character that is not base64.
  std::size_t read(char* to, std::size_t n);

  /// An upper bound of the number of bytes that are left.
  std::size_t max_left() const { return ready_ + (text_.size() - position_) / 4 * 3 + 3; }

 private:
  bool decode_quad();

  std::string_view text_;
  std::size_t position_ = 0;
  char buffer_[3] = {};
  std::size_t ready_ = 0;  ///< bytes of buffer_ that read() has not returned yet: the last of its `size_`
  std::size_t size_ = 0;
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace tetwright {

/// Appends `bytes` in base64 with padding.
void append_base64(std::string& out, std::string_view bytes);

/// `bytes` in base64 with padding, encoded in parallel.
std::string base64(std::string_view bytes);

/// Decodes `to.size()` bytes from offset `begin` on.
/// \return false if the text is too short, or has other characters than those of base64 before the last of
///   these bytes, such as white space or padding
bool decode_base64(std::string_view text, std::size_t begin, std::span<char> to);

/// Decodes base64 in pieces. Skips white space. Accepts padding anywhere, since a text may consist of several
/// encoded blocks. The text must outlive the reader.
///
/// No library is used: a decoder for VTK must continue after padding and stop at a given byte.
class Base64Reader {
 public:
  explicit Base64Reader(std::string_view text) : text_(text) {}

  /// Decodes the next `n` bytes into `to`.
  /// \return the number of bytes, below `n` at the end of the text or before a character that is not base64
  std::size_t read(char* to, std::size_t n);

  /// The text that is not decoded yet, for decode_base64(); empty within three bytes that four characters
  /// encode.
  std::string_view rest() const { return ready_ == 0 ? text_.substr(position_) : std::string_view(); }

  /// Upper bound of the number of remaining bytes.
  std::size_t max_left() const { return ready_ + (text_.size() - position_) / 4 * 3 + 3; }

 private:
  bool decode_quad();

  std::string_view text_;
  std::size_t position_ = 0;
  char buffer_[3] = {};
  std::size_t ready_ = 0;  ///< bytes of buffer_ not yet returned by read(): the last of its `size_`
  std::size_t size_ = 0;
};

}  // namespace tetwright

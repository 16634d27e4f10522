#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tetwright {

/// Appends `bytes` in base64, padded.
void append_base64(std::string& out, std::string_view bytes);

/// Decodes base64 piece by piece. White space is skipped; padding may stand in the middle, where one encoded
/// block ends and the next begins. The text must outlive it.
class Base64Reader {
 public:
  explicit Base64Reader(std::string_view text) : text_(text) {}

  /// The next `n` bytes into `to`; returns how many there were before the end or a character that is no
  /// base64.
  std::size_t read(char* to, std::size_t n);

  /// At least as many bytes as are still to come.
  std::size_t most_left() const { return ready_ + (text_.size() - position_) / 4 * 3 + 3; }

 private:
  bool decode_quad();

  std::string_view text_;
  std::size_t position_ = 0;
  char buffer_[3] = {};
  std::size_t ready_ = 0;  ///< bytes of buffer_ not handed out yet: its last ones of `size_`
  std::size_t size_ = 0;
};

}  // namespace tetwright

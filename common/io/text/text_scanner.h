// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/message_text.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Parses a whole token. "nan" and "inf" are numbers; overflow gives infinity, underflow 0 or a subnormal
/// number.
/// \return false if the token is not a number
bool parse_number(std::string_view token, double& value);
bool parse_number(std::string_view token, std::int64_t& value);

/// Splits a text file into words and counts its lines, which end with \n, \r\n or \r. The bytes must outlive
/// the scanner.
///
/// No library is used: messages need the line of every word, and numbers must parse exactly in every locale.
class TextScanner {
 public:
  /// \param comment character that starts a comment, up to the end of its line; 0: no comments
  TextScanner(std::string_view bytes, std::string name, char comment = 0)
      : bytes_(bytes), name_(std::move(name)), comment_(comment) {
    // Skips the byte order mark that some editors write before UTF-8.
    if (bytes_.starts_with("\xef\xbb\xbf")) position_ = 3;
  }

  /// Next word on this or a later line; empty at the end of the file.
  std::string_view word();
  /// Next word on this line; empty at the end of the line.
  std::string_view word_on_line();
  /// Rest of this line without its line end. Advances to the next line.
  std::string_view rest_of_line();
  /// Skips the rest of this line.
  void skip_line() { (void)rest_of_line(); }
  /// Next `n` bytes unchanged, or fewer at the end. Line feeds in them count as lines.
  std::string_view take_bytes(std::size_t n);

  /// Reads the next word as a number.
  /// \param what names the number in messages ("coordinate", "index of a point")
  /// \throws InputError at the end of the file, if the word is not a number, or if a coordinate is not finite
  double coordinate(std::string_view what = "coordinate");
  std::int64_t integer(std::string_view what);
  /// Reads any number, including NaN and infinities.
  double number(std::string_view what);
  /// Reads the number of subsequent items in the file, each of at least `bytes_each` bytes.
  /// \throws InputError if it is negative or the items do not fit into the rest of the file
  std::size_t count(std::string_view what, std::size_t bytes_each);

  bool at_end();                                    ///< true if only white space and comments are left
  std::size_t offset() const { return position_; }  ///< bytes consumed
  std::size_t left() const { return bytes_.size() - position_; }
  std::size_t line() const { return line_; }  ///< line of the last word, from 1
  const std::string& name() const { return name_; }

  /// \throws InputError with the file and the line of the last word
  [[noreturn]] void fail(const std::string& message) const;
  /// \throws InputError: the file ends where `what` was expected
  [[noreturn]] void fail_cut_short(std::string_view what) const;

 private:
  void skip_space(bool across_lines);
  std::string_view take_word();

  std::string_view bytes_;
  std::string name_;
  std::size_t position_ = 0;
  std::size_t line_ = 1;
  char comment_;
};

/// Converts a number to a material tag.
/// \throws InputError unless `value` is a 32-bit integer
MaterialTag checked_material(std::int64_t value, const std::string& file, std::size_t line);

}  // namespace tetwright

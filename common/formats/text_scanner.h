#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/types.h"

namespace tetwright {

/// A value from a file as it may stand in a message: in quotes, cut after 40 characters, everything but
/// printable ASCII replaced by '?'.
std::string in_quotes(std::string_view value);

/// Parses a whole token. Returns false if it is not a number; "nan", "inf" and what overflows come back as
/// such, what underflows as 0.
bool parse_number(std::string_view token, double& value);
bool parse_number(std::string_view token, std::int64_t& value);

/// Words of a text file with the line they stand on. Lines end with \n, \r\n or \r. The bytes must outlive
/// it.
class TextScanner {
 public:
  /// `comment`: the character that hides the rest of its line; 0 for none.
  TextScanner(std::string_view bytes, std::string name, char comment = 0)
      : bytes_(bytes), name_(std::move(name)), comment_(comment) {
    // The byte order mark that some editors put before UTF-8.
    if (bytes_.starts_with("\xef\xbb\xbf")) position_ = 3;
  }

  /// The next word, on whatever line; empty at the end.
  std::string_view word();
  /// The next word of this line; empty at its end.
  std::string_view word_on_line();
  /// What is left of this line, without what ends it; goes on to the next line.
  std::string_view rest_of_line();
  /// Drops what is left of this line.
  void skip_line() { (void)rest_of_line(); }
  /// The next `n` bytes as they are; less at the end. Lines in them count as elsewhere.
  std::string_view take_bytes(std::size_t n);

  /// The next word as a number; `what` names it in messages ("coordinate", "index of a point").
  /// Throws InputError at the end, if it is not one or (coordinate) not finite.
  double coordinate(std::string_view what = "coordinate");
  std::int64_t integer(std::string_view what);
  /// Any number, nan and infinities among them.
  double number(std::string_view what);
  /// An integer that counts things still to come, of which each takes at least `bytes_each` bytes: throws
  /// InputError if it is negative or more than the rest of the file can hold.
  std::size_t count(std::string_view what, std::size_t bytes_each);

  bool at_end();                                    ///< nothing but white space and comments is left
  std::size_t offset() const { return position_; }  ///< bytes consumed
  std::size_t left() const { return bytes_.size() - position_; }
  std::size_t line() const { return line_; }  ///< of the last word, from 1
  const std::string& name() const { return name_; }

  /// Throws InputError with the file and the line of the last word.
  [[noreturn]] void fail(const std::string& message) const;
  /// Throws InputError: the file ends where `what` was expected.
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

/// Throws InputError unless `value` is a material tag (a 32-bit integer).
MaterialTag checked_material(std::int64_t value, const std::string& file, std::size_t line);

}  // namespace tetwright

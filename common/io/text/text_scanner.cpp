// SPDX-License-Identifier: Apache-2.0
#include "common/io/text/text_scanner.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "tetwright/error.h"

namespace tetwright {

namespace {

bool is_line_end(char c) { return c == '\n' || c == '\r'; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f'; }

/// Removes a leading plus, which from_chars rejects; a second sign is an error.
std::string_view without_plus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-') token.remove_prefix(1);
  return token;
}

}  // namespace

bool parse_number(std::string_view token, double& value) {
  token = without_plus(token);
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (end != token.data() + token.size() || token.empty()) return false;
  if (error == std::errc::result_out_of_range) {
    // from_chars does not distinguish overflow from underflow; strtod returns 0, a subnormal or infinity.
    value = std::strtod(std::string(token).c_str(), nullptr);
    return true;
  }
  return error == std::errc();
}

bool parse_number(std::string_view token, std::int64_t& value) {
  token = without_plus(token);
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  return end == token.data() + token.size() && !token.empty() && error == std::errc();
}

void TextScanner::skip_space(bool across_lines) {
  while (position_ < bytes_.size()) {
    const char c = bytes_[position_];
    if (comment_ && c == comment_) {
      while (position_ < bytes_.size() && !is_line_end(bytes_[position_])) ++position_;
    } else if (is_line_end(c)) {
      if (!across_lines) return;
      if (c == '\r' && position_ + 1 < bytes_.size() && bytes_[position_ + 1] == '\n') ++position_;
      ++position_;
      ++line_;
    } else if (is_space(c)) {
      ++position_;
    } else {
      return;
    }
  }
}

std::string_view TextScanner::take_word() {
  const std::size_t begin = position_;
  while (position_ < bytes_.size() && !is_space(bytes_[position_]) &&
         !(comment_ && bytes_[position_] == comment_))
    ++position_;
  return bytes_.substr(begin, position_ - begin);
}

std::string_view TextScanner::word() {
  skip_space(true);
  return take_word();
}

std::string_view TextScanner::word_on_line() {
  skip_space(false);
  return take_word();
}

std::string_view TextScanner::rest_of_line() {
  const std::size_t begin = position_;
  while (position_ < bytes_.size() && !is_line_end(bytes_[position_])) ++position_;
  const std::string_view rest = bytes_.substr(begin, position_ - begin);
  if (position_ < bytes_.size()) {
    if (bytes_[position_] == '\r' && position_ + 1 < bytes_.size() && bytes_[position_ + 1] == '\n')
      ++position_;
    ++position_;
    ++line_;
  }
  return rest;
}

std::string_view TextScanner::take_bytes(std::size_t n) {
  const std::string_view bytes = bytes_.substr(position_, n);
  position_ += bytes.size();
  line_ += static_cast<std::size_t>(std::count(bytes.begin(), bytes.end(), '\n'));
  return bytes;
}

bool TextScanner::at_end() {
  skip_space(true);
  return position_ == bytes_.size();
}

double TextScanner::coordinate(std::string_view what) {
  const std::string_view token = word();
  if (token.empty()) fail_cut_short(what);
  double value = 0;
  if (!parse_number(token, value)) fail("expected a " + std::string(what) + ", found " + in_quotes(token));
  if (!std::isfinite(value))
    fail(std::string(what) + " " + in_quotes(token) + " is not finite; remove or repair this point");
  return value;
}

double TextScanner::number(std::string_view what) {
  const std::string_view token = word();
  if (token.empty()) fail_cut_short(what);
  double value = 0;
  if (!parse_number(token, value))
    fail("expected a number (" + std::string(what) + "), found " + in_quotes(token));
  return value;
}

std::int64_t TextScanner::integer(std::string_view what) {
  const std::string_view token = word();
  if (token.empty()) fail_cut_short(what);
  std::int64_t value = 0;
  if (!parse_number(token, value))
    fail("expected a whole number (" + std::string(what) + "), found " + in_quotes(token));
  return value;
}

std::size_t TextScanner::count(std::string_view what, std::size_t bytes_each) {
  const std::int64_t value = integer(what);
  if (value < 0) fail("the " + std::string(what) + " is negative: " + std::to_string(value));
  const auto n = static_cast<std::uint64_t>(value);
  // The last item may lack trailing white space.
  if (n > (left() + 1) / bytes_each)
    fail("the " + std::string(what) + " is " + std::to_string(n) + ", but only " + std::to_string(left()) +
         " bytes follow; the file is truncated or its header is wrong");
  return static_cast<std::size_t>(n);
}

void TextScanner::fail(const std::string& message) const { throw InputError(name_, line_, message); }

void TextScanner::fail_cut_short(std::string_view what) const {
  fail("the file ends where a " + std::string(what) + " was expected; it is truncated");
}

MaterialTag checked_material(std::int64_t value, const std::string& file, std::size_t line) {
  if (value < std::numeric_limits<MaterialTag>::min() || value > std::numeric_limits<MaterialTag>::max())
    throw InputError(
        file, line,
        "material " + std::to_string(value) + " does not fit into 32 bits; renumber the materials");
  return static_cast<MaterialTag>(value);
}

}  // namespace tetwright

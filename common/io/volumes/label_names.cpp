// SPDX-License-Identifier: Apache-2.0
#include "tetwright/io.h"

#include <algorithm>
#include <vector>

#include "common/io/text/text_scanner.h"
#include "common/trimmed.h"
#include "tetwright/error.h"
#include "tetwright/files.h"

namespace tetwright {

namespace {

/// Bytes. The name of an interface consists of two such names, and Gmsh reads names of up to 255 bytes.
constexpr std::size_t max_label_name_size = 120;

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

/// Removes a comment: everything from a # or // on that is outside double quotes and starts the line or
/// follows white space.
std::string_view without_comment(std::string_view line) {
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') quoted = !quoted;
    if (quoted || (i > 0 && !is_blank(line[i - 1]))) continue;
    if (line[i] == '#' || line.substr(i, 2) == "//") return line.substr(0, i);
  }
  return line;
}

/// Removes and returns the first word, up to white space or, if `comma` is true, a comma.
std::string_view take_word(std::string_view& text, bool comma) {
  std::size_t end = 0;
  while (end < text.size() && !is_blank(text[end]) && !(comma && text[end] == ',')) ++end;
  const std::string_view word = text.substr(0, end);
  text = trimmed(text.substr(end));
  if (comma && text.starts_with(',')) text = trimmed(text.substr(1));
  return word;
}

/// Removes and returns the last word.
std::string_view take_last_word(std::string_view& text) {
  std::size_t begin = text.size();
  while (begin > 0 && !is_blank(text[begin - 1])) --begin;
  const std::string_view word = text.substr(begin);
  text = trimmed(text.substr(0, begin));
  return word;
}

bool is_quoted(std::string_view text) {
  return text.size() >= 2 && text.front() == '"' && text.back() == '"';
}

bool is_colour(std::string_view word) {
  std::int64_t value = 0;
  return parse_number(word, value) && value >= 0 && value <= 255;
}

struct Line {
  std::size_t number;
  std::string_view tag, rest;
};

/// "NAME R G B A" -> "NAME". The name may be missing in an incorrect colour table.
bool drop_colour_behind(std::string_view& text) {
  for (int i = 0; i < 4; ++i)
    if (!is_colour(take_last_word(text))) return false;
  return true;
}

/// "R G B A VISIBLE MESH "NAME"" -> ""NAME"". Alpha is between 0 and 1.
bool drop_colour_before(std::string_view& text) {
  for (int i = 0; i < 6; ++i) {
    const std::string_view word = take_word(text, false);
    double value = 0;
    if (i == 3 ? !parse_number(word, value) : !is_colour(word)) return false;
  }
  return is_quoted(text);
}

std::vector<Line> split_lines(std::string_view bytes, const std::string& file) {
  TextScanner in(bytes, file);
  std::vector<Line> lines;
  while (in.left() > 0) {
    const std::size_t number = in.line();
    std::string_view text = trimmed(without_comment(in.rest_of_line()));
    if (text.empty()) continue;
    const std::string_view tag = take_word(text, true);
    lines.push_back({number, tag, text});
  }
  return lines;
}

std::string name_of(const Line& line, const std::string& file) {
  std::string_view name = line.rest;
  const auto fail = [&](const std::string& message) { throw InputError(file, line.number, message); };
  if (is_quoted(name) || (name.size() >= 2 && name.front() == '\'' && name.back() == '\''))
    name = trimmed(name.substr(1, name.size() - 2));
  else if (name.starts_with('"'))
    fail("the name " + in_quotes(name.substr(1)) + " lacks its closing quote");
  if (name.empty()) fail("label " + std::string(line.tag) + " has no name");
  if (name.size() > max_label_name_size)
    fail("label " + std::string(line.tag) + " has a name of " + std::to_string(name.size()) +
         " bytes; at most " + std::to_string(max_label_name_size) + " are possible");
  if (std::any_of(name.begin(), name.end(), [](char c) { return (c >= 0 && c < ' ') || c == 127; }))
    fail("the name " + in_quotes(name) + " has a control character; is this a text file?");
  return std::string(name);
}

}  // namespace

std::map<MaterialTag, std::string> parse_label_names(std::string_view bytes, const std::string& file,
                                                     std::map<MaterialTag, std::size_t>* line_numbers) {
  std::vector<Line> lines = split_lines(bytes, file);
  if (lines.empty()) throw InputError(file, 0, "lists no labels; expected lines such as: 1 liver");
  // A single line may match another form by chance ("3 rib 1 2 3 4"), but not all lines do.
  for (bool (*const drop_colour)(std::string_view&) : {drop_colour_behind, drop_colour_before}) {
    std::vector<Line> bare = lines;
    if (!std::all_of(bare.begin(), bare.end(), [&](Line& line) { return drop_colour(line.rest); })) continue;
    lines = std::move(bare);
    break;
  }
  std::map<MaterialTag, std::string> names;
  for (const Line& line : lines) {
    std::int64_t value = 0;
    if (!parse_number(line.tag, value))
      throw InputError(file, line.number, "expected the number of a label, found " + in_quotes(line.tag));
    const MaterialTag tag = checked_material(value, file, line.number);
    const std::string name = name_of(line, file);
    const auto [known, added] = names.emplace(tag, name);
    if (!added && known->second != name)
      throw InputError(file, line.number,
                       "label " + std::to_string(tag) + " is called " + in_quotes(name) + ", and " +
                           in_quotes(known->second) + " on an earlier line");
    if (line_numbers && added) line_numbers->emplace(tag, line.number);
  }
  return names;
}

std::map<MaterialTag, std::string> read_label_names(const std::string& path,
                                                    std::map<MaterialTag, std::size_t>* line_numbers) {
  return parse_label_names(read_whole_file(path), path, line_numbers);
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/declared_space.h"

#include <cctype>

#include "common/io/text/text_scanner.h"

namespace tetwright {

namespace {

bool is_alphanumeric(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0; }

}  // namespace

std::string space_called(std::string_view name) {
  if (name == "LPS") return "left-posterior-superior";
  if (name == "RAS") return "right-anterior-superior";
  return {};
}

std::string short_name_of_space(std::string_view space) {
  for (const char* name : {"LPS", "RAS"})
    if (space_called(name) == space) return name;
  return {};
}

std::string declared_space(std::string_view header) {
  constexpr std::string_view tag = "SPACE=";
  for (std::size_t at = header.find(tag); at != std::string_view::npos; at = header.find(tag, at + 1)) {
    const std::size_t begin = at + tag.size();
    std::size_t end = begin;
    // A hyphen continues the name of another system.
    while (end < header.size() && (is_alphanumeric(header[end]) || header[end] == '-')) ++end;
    const bool whole_word = at == 0 || !is_alphanumeric(header[at - 1]);
    if (std::string space = space_called(header.substr(begin, end - begin)); whole_word && !space.empty())
      return space;
  }
  return {};
}

std::string space_in_comments(std::string_view bytes, char comment) {
  TextScanner in(bytes, {});
  while (in.left() > 0) {
    const std::string_view line = in.rest_of_line();
    const std::size_t begin = line.find_first_not_of(" \t");
    if (begin == std::string_view::npos) continue;
    if (line[begin] != comment) break;
    if (std::string space = declared_space(line); !space.empty()) return space;
  }
  return {};
}

}  // namespace tetwright

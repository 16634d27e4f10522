// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/abaqus_lines.h"

#include <cmath>

#include "common/io/tets/abaqus.h"
#include "common/trimmed.h"
#include "tetwright/error.h"

namespace tetwright {

std::string in_capitals(std::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  return out;
}

std::vector<std::string_view> abaqus_fields(std::string_view line) {
  std::vector<std::string_view> fields;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = line.find(',', begin);
    std::string_view field =
        trimmed(line.substr(begin, comma == std::string_view::npos ? comma : comma - begin));
    if (field.size() > 1 && field.front() == '"' && field.back() == '"')
      field = field.substr(1, field.size() - 2);
    fields.push_back(field);
    if (comma == std::string_view::npos) break;
    begin = comma + 1;
  }
  return fields;
}

namespace {

/// Reads a comment that gives a name in the mesh.
void read_name_comment(std::string_view text, std::string_view comment,
                       std::map<std::string, std::string>& names) {
  if (!text.starts_with(comment)) return;
  text.remove_prefix(comment.size());
  if (const std::size_t colon = text.find(": "); colon != std::string_view::npos)
    names[in_capitals(text.substr(0, colon))] = text.substr(colon + 2);
}

}  // namespace

bool AbaqusLines::next() {
  if (pushed_back_) {
    pushed_back_ = false;
    return true;
  }
  while (in_.left() > 0) {
    number_ = in_.line();
    const std::string_view text = trimmed(in_.rest_of_line());
    if (text.starts_with(abaqus_material_comment)) read_comment(text);
    read_name_comment(text, abaqus_material_name_comment, material_names_);
    read_name_comment(text, abaqus_surface_name_comment, surface_names_);
    if (text.empty() || text.starts_with("**")) continue;
    text_ = text;
    return true;
  }
  return false;
}

bool AbaqusLines::next_data() {
  if (!next()) return false;
  if (!text_.starts_with('*')) return true;
  pushed_back_ = true;
  return false;
}

/// Reads a comment "** material TAG: NAME".
void AbaqusLines::read_comment(std::string_view text) {
  text.remove_prefix(std::string_view(abaqus_material_comment).size());
  const std::size_t colon = text.find(": ");
  std::int64_t tag = 0;
  if (colon == std::string_view::npos || !parse_number(text.substr(0, colon), tag)) return;
  tags_[in_capitals(text.substr(colon + 2))] = checked_material(tag, in_.name(), number_);
}

AbaqusKeyword AbaqusLines::keyword() const {
  AbaqusKeyword keyword{{}, {}, number_};
  const std::vector<std::string_view> all = fields();
  for (const char c : in_capitals(all[0].substr(1)))
    if (c != ' ') keyword.name += c;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const std::size_t equals = all[i].find('=');
    std::string_view value = equals == std::string_view::npos ? "" : trimmed(all[i].substr(equals + 1));
    if (value.size() > 1 && value.front() == '"' && value.back() == '"')
      value = value.substr(1, value.size() - 2);
    keyword.parameters[in_capitals(trimmed(all[i].substr(0, equals)))] = std::string(value);
  }
  return keyword;
}

std::int64_t AbaqusLines::whole_number(std::string_view field, const char* what) const {
  std::int64_t value = 0;
  if (!parse_number(field, value))
    fail("expected a whole number (" + std::string(what) + "), found " + in_quotes(field));
  return value;
}

double AbaqusLines::finite_number(std::string_view field, const char* what) const {
  double value = 0;
  if (!parse_number(field, value) || !std::isfinite(value))
    fail(std::string(what) + " " + in_quotes(field) + " is not a finite number");
  return value;
}

void AbaqusLines::fail(std::size_t line, const std::string& message) const {
  throw InputError(in_.name(), line, message);
}

}  // namespace tetwright

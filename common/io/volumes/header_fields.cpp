// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/header_fields.h"

#include "common/io/encodings/vtk_numbers.h"
#include "common/io/text/text_scanner.h"
#include "common/lower_case.h"
#include "common/trimmed.h"
#include "tetwright/error.h"

namespace tetwright {

void HeaderFields::add(std::string_view field, std::string_view value, std::size_t line) {
  if (!fields_.try_emplace(lower_case(trimmed(field)), Field{trimmed(value), line}).second)
    throw InputError(file_, line, in_quotes(trimmed(field)) + " appears twice in the header; remove one");
}

std::string HeaderFields::any_of(std::initializer_list<const char*> names) const {
  for (const char* name : names)
    if (has(name)) return name;
  return *names.begin();
}

const HeaderFields::Field& HeaderFields::find(const std::string& field) const {
  const auto at = fields_.find(field);
  if (at == fields_.end())
    throw InputError(file_ + ": the header has no line " + in_quotes(field) + "; it is damaged or truncated");
  return at->second;
}

std::string_view HeaderFields::text(const std::string& field) const { return find(field).value; }

std::string HeaderFields::lower_text(const std::string& field) const { return lower_case(text(field)); }

std::size_t HeaderFields::line(const std::string& field) const { return find(field).line; }

void HeaderFields::fail(const std::string& field, const std::string& message) const {
  throw InputError(file_, line(field), message);
}

std::int64_t HeaderFields::integer(const std::string& field) const {
  std::int64_t value = 0;
  if (!parse_number(text(field), value))
    fail(field, "expected a whole number as " + field + ", found " + in_quotes(text(field)));
  return value;
}

double HeaderFields::number(const std::string& field) const { return numbers(field, 1)[0]; }

std::vector<std::string_view> HeaderFields::words(const std::string& field) const {
  std::vector<std::string_view> out;
  TextScanner in(text(field), file_);
  for (std::string_view word; !(word = in.word()).empty();) out.push_back(word);
  return out;
}

std::vector<std::int64_t> HeaderFields::integers(const std::string& field) const {
  std::vector<std::int64_t> out;
  for (const std::string_view word : words(field)) {
    std::int64_t value = 0;
    if (!parse_number(word, value))
      fail(field, "expected whole numbers as " + field + ", found " + in_quotes(word));
    out.push_back(value);
  }
  return out;
}

std::vector<double> HeaderFields::numbers(const std::string& field, std::size_t count) const {
  std::vector<double> out;
  for (const std::string_view word : words(field)) {
    double value = 0;
    if (!parse_number(word, value))
      fail(field, "expected numbers as " + field + ", found " + in_quotes(word));
    out.push_back(value);
  }
  if (out.size() != count)
    fail(field, "expected " + std::to_string(count) + (count == 1 ? " number" : " numbers") + " as " + field +
                    ", found " + std::to_string(out.size()));
  return out;
}

}  // namespace tetwright

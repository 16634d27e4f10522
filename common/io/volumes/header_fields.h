// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tetwright {

/// Fields of a volume's text header, by their names in lower case. Functions that read a value throw an
/// InputError that names file, line, field and value if the value is missing or malformed.
class HeaderFields {
 public:
  explicit HeaderFields(std::string file) : file_(std::move(file)) {}

  /// Adds a field.
  /// \param value must outlive this object
  /// \throws InputError if the field was added before
  void add(std::string_view field, std::string_view value, std::size_t line);

  bool has(const std::string& field) const { return fields_.contains(field); }
  /// First of several synonymous names that the header has; the first name if it has none.
  std::string any_of(std::initializer_list<const char*> names) const;

  std::string_view text(const std::string& field) const;
  std::string lower_text(const std::string& field) const;
  std::int64_t integer(const std::string& field) const;
  double number(const std::string& field) const;
  std::vector<std::string_view> words(const std::string& field) const;
  std::vector<std::int64_t> integers(const std::string& field) const;
  /// \throws InputError unless the field has exactly `count` numbers
  std::vector<double> numbers(const std::string& field, std::size_t count) const;

  std::size_t line(const std::string& field) const;
  const std::string& file() const { return file_; }
  /// \throws InputError with the line of the field, or stating that the field is missing
  [[noreturn]] void fail(const std::string& field, const std::string& message) const;

 private:
  struct Field {
    std::string_view value;
    std::size_t line;
  };
  const Field& find(const std::string& field) const;

  std::string file_;
  std::map<std::string, Field> fields_;
};

}  // namespace tetwright

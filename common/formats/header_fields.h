#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace tetwright {

/// What is left without white space at both ends.
std::string_view trimmed(std::string_view text);

/// The fields of a volume's text header, by name in lower case, with their lines. Bad values are InputErrors
/// that name file, line, field and value.
class HeaderFields {
 public:
  explicit HeaderFields(std::string file) : file_(std::move(file)) {}

  /// `value` must live as long as this does. Throws InputError for a field that is there already.
  void add(std::string_view field, std::string_view value, std::size_t line);

  bool has(const std::string& field) const { return fields_.contains(field); }
  /// The first of some names for the same thing that is there; the first of all if none is.
  std::string any_of(std::initializer_list<const char*> names) const;

  std::string_view text(const std::string& field) const;
  std::string lower_text(const std::string& field) const;
  std::int64_t integer(const std::string& field) const;
  double number(const std::string& field) const;
  std::vector<std::string_view> words(const std::string& field) const;
  std::vector<std::int64_t> integers(const std::string& field) const;
  /// Throws InputError unless there are `count`.
  std::vector<double> numbers(const std::string& field, std::size_t count) const;

  std::size_t line(const std::string& field) const;
  const std::string& file() const { return file_; }
  /// Throws InputError at the field's line, or about its absence.
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

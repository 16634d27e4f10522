// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "common/io/text/text_scanner.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Text with the letters of ASCII in upper case; names in input files of Abaqus do not differ by case.
std::string in_capitals(std::string_view text);

/// Splits a line at commas, without the blanks around each field.
std::vector<std::string_view> abaqus_fields(std::string_view line);

/// A keyword line, such as "*ELEMENT, TYPE=C3D4, ELSET=bone".
struct AbaqusKeyword {
  std::string name;  ///< upper case, without blanks
  std::map<std::string, std::string> parameters;
  std::size_t line;

  /// Value of a parameter; null: it is not given.
  const std::string* find(const std::string& parameter) const {
    const auto found = parameters.find(parameter);
    return found == parameters.end() ? nullptr : &found->second;
  }
};

/// Lines of an input file of Abaqus or CalculiX, without comments and empty ones.
class AbaqusLines {
 public:
  AbaqusLines(std::string_view bytes, const std::string& name) : in_(bytes, name) {}

  /// Advances to the next line.
  /// \return false at the end
  bool next();
  /// Advances to the next data line.
  /// \return false before a keyword and at the end
  bool next_data();
  /// Skips the data lines of a keyword.
  void skip_data() {
    while (next_data()) {
    }
  }

  const std::string& file() const { return in_.name(); }
  std::string_view text() const { return text_; }  ///< without blanks at its ends
  std::size_t number() const { return number_; }   ///< from 1
  std::vector<std::string_view> fields() const { return abaqus_fields(text_); }
  /// \pre the line begins with an asterisk
  AbaqusKeyword keyword() const;

  /// Parse a field of the line.
  /// \param what names it in messages
  /// \throws InputError with the line
  std::int64_t whole_number(std::string_view field, const char* what) const;
  double finite_number(std::string_view field, const char* what) const;

  /// \throws InputError with the line
  [[noreturn]] void fail(std::size_t line, const std::string& message) const;
  [[noreturn]] void fail(const std::string& message) const { fail(number_, message); }

  /// Tags of materials in the comments of write_abaqus(), by name in upper case.
  const std::map<std::string, MaterialTag>& tags() const { return tags_; }
  /// Their names in the mesh, and those of surfaces, where the format could not hold them.
  const std::map<std::string, std::string>& material_names() const { return material_names_; }
  const std::map<std::string, std::string>& surface_names() const { return surface_names_; }

 private:
  void read_comment(std::string_view text);

  TextScanner in_;
  std::string_view text_;
  std::size_t number_ = 0;
  bool pushed_back_ = false;  ///< true: text_ must be read again
  std::map<std::string, MaterialTag> tags_;
  std::map<std::string, std::string> material_names_, surface_names_;
};

}  // namespace tetwright

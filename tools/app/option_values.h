// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tools/app/command_line.h"

namespace tetwright {

/// Range of numbers that an option accepts.
struct Range {
  double low, high;
  bool low_included;
  const char* text;  ///< description for messages

  bool contains(double x) const { return (low_included ? x >= low : x > low) && x <= high; }
};
inline constexpr double max_number = std::numeric_limits<double>::max();
inline constexpr Range any_number{-max_number, max_number, true, "a number"};
inline constexpr Range positive{0, max_number, false, "a number above 0"};
inline constexpr Range not_negative{0, max_number, true, "a number of at least 0"};
/// Steradians. The upper bound is the solid angle at a vertex of the regular tet, the maximum for a tet's
/// smallest angle.
inline constexpr Range solid_angle{0, 0.5513, true, "a solid angle from 0 to 0.5513, the regular tet's"};

/// Parses a number.
///
/// \throws CLI::ValidationError unless the whole text is a number within the range; no range contains nan or
///   inf
double parse_number(const std::string& option, const std::string& text, const Range& range);

/// Parses a whole number from `low` to `high`. CLI11's own conversion reads a leading 0 as octal and lets
/// negative numbers wrap around.
///
/// \throws CLI::ValidationError unless the whole text is such a number
std::uint64_t parse_whole_number(const std::string& option, const std::string& text, std::uint64_t low,
                                 std::uint64_t high);

/// Splits NAME=VALUE.
///
/// \param value how messages refer to VALUE
NamedValue split_named(const std::string& text, const char* option, const char* value);

/// Parses NAME@X,Y,Z.
///
/// \throws CLI::ValidationError unless there are a name and three finite numbers
RegionSeed parse_seed(const std::string& option, const std::string& text);

/// Formats a default value for the help, such as "0.05".
std::string short_text(double value);

/// Formats a list for help and messages, such as "a, b".
std::string comma_separated(const std::vector<std::string>& names);

/// Adds an option whose value is the result of `parse`.
template <class Value>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, Value& to, const char* type,
                        std::function<Value(const std::string&)> parse, const std::string& description) {
  return app
      .add_option_function<std::string>(
          name, [&to, parse](const std::string& text) { to = parse(text); }, description)
      ->type_name(type);
}

/// Type of an option's value, without std::optional.
template <class Value>
struct PlainOf {
  using Type = Value;
};
template <class Value>
struct PlainOf<std::optional<Value>> {
  using Type = Value;
};
template <class Value>
using Plain = typename PlainOf<Value>::Type;

/// Adds an option whose value is a whole number from `low` to `high`.
template <class Whole>
CLI::Option* add_whole_number(CLI::App& app, const std::string& name, Whole& to, std::uint64_t low,
                              std::uint64_t high, const std::string& description) {
  const auto parse = [name, low, high](const std::string& text) -> Whole {
    return static_cast<Plain<Whole>>(parse_whole_number(name, text, low, high));
  };
  return add_parsed<Whole>(app, name, to, "N", parse, description);
}

/// Adds an option whose value is a number within `range`; `Number` is double or std::optional<double>.
template <class Number>
CLI::Option* add_number(CLI::App& app, const std::string& name, Number& to, const Range& range,
                        const std::string& description) {
  return add_parsed<Number>(
      app, name, to, "NUMBER",
      [name, range](const std::string& text) -> Number { return parse_number(name, text, range); },
      description);
}

/// Adds an option whose value is a length, in input units or percent of the diagonal.
CLI::Option* add_length(CLI::App& app, const std::string& name, std::optional<Length>& to,
                        const std::string& description);

/// Adds --feature-angle.
CLI::Option* add_feature_angle(CLI::App& app, FeatureAngle& to);

}  // namespace tetwright

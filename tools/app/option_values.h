// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "tools/app/command_line.h"

namespace tetwright {

/// The numbers that an option accepts.
struct Range {
  double low, high;
  bool low_included;
  const char* text;  ///< for messages

  bool contains(double x) const { return (low_included ? x >= low : x > low) && x <= high; }
};
inline constexpr double max_number = std::numeric_limits<double>::max();
inline constexpr Range positive{0, max_number, false, "a number above 0"};
inline constexpr Range not_negative{0, max_number, true, "a number of at least 0"};
/// Up to the solid angle of a vertex of the regular tet, steradians: no tet has a larger smallest one.
inline constexpr Range solid_angle{0, 0.5513, true, "a solid angle from 0 to 0.5513, the regular tet's"};

/// Throws CLI::ValidationError unless all of the text is a number within the range; no range contains nan or
/// inf.
double parse_number(const std::string& option, const std::string& text, const Range& range);

/// The same of a whole number. Not the parser's own conversion, which takes numbers with a leading 0 for
/// octal and lets negative ones wrap around.
std::uint64_t parse_whole_number(const std::string& option, const std::string& text, std::uint64_t low,
                                 std::uint64_t high);

/// NAME=VALUE; `value` is what messages call the latter.
NamedValue split_named(const std::string& text, const char* option, const char* value);

/// For defaults in the help, "0.05".
std::string short_text(double value);

/// For lists in the help and in messages, "a, b".
std::string comma_separated(const std::vector<std::string>& names);

/// An option whose value `parse` makes of the text.
template <class Value>
CLI::Option* add_parsed(CLI::App& app, const std::string& name, Value& to, const char* type,
                        std::function<Value(const std::string&)> parse, const std::string& description) {
  return app
      .add_option_function<std::string>(
          name, [&to, parse](const std::string& text) { to = parse(text); }, description)
      ->type_name(type);
}

/// An option whose value is a whole number from `low` to `high`.
template <class Whole>
CLI::Option* add_whole_number(CLI::App& app, const std::string& name, Whole& to, std::uint64_t low,
                              std::uint64_t high, const std::string& description) {
  const auto parse = [name, low, high](const std::string& text) {
    const std::uint64_t value = parse_whole_number(name, text, low, high);
    if constexpr (std::is_same_v<Whole, std::optional<int>>)
      return Whole(static_cast<int>(value));
    else
      return static_cast<Whole>(value);
  };
  return add_parsed<Whole>(app, name, to, "N", parse, description);
}

/// An option whose value is a number within `range`.
CLI::Option* add_number(CLI::App& app, const std::string& name, double& to, const Range& range,
                        const std::string& description);

/// An option whose value is a length, in input units or as a share of the diagonal.
CLI::Option* add_length(CLI::App& app, const std::string& name, LengthOption& to,
                        const std::string& description);

/// --feature-angle.
CLI::Option* add_feature_angle(CLI::App& app, FeatureAngle& to);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tools/app/option_values.h"

#include <array>
#include <charconv>

namespace tetwright {

double parse_number(const std::string& option, const std::string& text, const Range& range) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !range.contains(value))
    throw CLI::ValidationError(option, "'" + text + "' is not " + range.text);
  return value;
}

std::uint64_t parse_whole_number(const std::string& option, const std::string& text, std::uint64_t low,
                                 std::uint64_t high) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < low || value > high)
    throw CLI::ValidationError(option, "'" + text + "' is not a whole number from " + std::to_string(low) +
                                           " to " + std::to_string(high));
  return value;
}

NamedValue split_named(const std::string& text, const char* option, const char* value) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw CLI::ValidationError(option, "'" + text + "' is not NAME=" + value);
  return {text.substr(0, equals), text.substr(equals + 1)};
}

RegionSeed parse_seed(const std::string& option, const std::string& text) {
  constexpr Range finite{-max_number, max_number, true, "a number"};
  const std::size_t at = text.rfind('@');
  RegionSeed seed{text.substr(0, at), Vec3::Zero()};
  std::vector<std::string> numbers{""};
  for (const char c : at == std::string::npos ? "" : text.substr(at + 1))
    if (c == ',')
      numbers.emplace_back();
    else
      numbers.back() += c;
  if (seed.name.empty() || numbers.size() != 3)
    throw CLI::ValidationError(option, "'" + text + "' is not NAME@X,Y,Z");
  for (int k = 0; k < 3; ++k)
    seed.point[k] = parse_number(option, numbers[static_cast<std::size_t>(k)], finite);
  return seed;
}

std::string comma_separated(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& n : names) out += (out.empty() ? "" : ", ") + n;
  return out;
}

std::string short_text(double value) {
  std::array<char, 32> buffer{};
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr};
}

CLI::Option* add_length(CLI::App& app, const std::string& name, std::optional<Length>& to,
                        const std::string& description) {
  const auto parse = [name](const std::string& text) -> std::optional<Length> {
    constexpr Range length{0, max_number, false,
                           "a length above 0 in input units, or in percent of the diagonal, such as 0.2%"};
    constexpr Range share{0, 100, false, "a share above 0 % and at most 100 % of the diagonal"};
    if (!text.ends_with('%')) return Length{parse_number(name, text, length), false};
    try {
      return Length{parse_number(name, text.substr(0, text.size() - 1), share), true};
    } catch (const CLI::ValidationError&) {
      throw CLI::ValidationError(name, "'" + text + "' is not " + share.text);
    }
  };
  return add_parsed<std::optional<Length>>(app, name, to, "LENGTH", parse, description);
}

CLI::Option* add_feature_angle(CLI::App& app, FeatureAngle& to) {
  static const std::string name = "--feature-angle";
  const auto parse = [](const std::string& text) -> FeatureAngle {
    // Below 1 degree every facet of a curved surface would become a patch.
    constexpr Range angle{1, 179, true, "an angle from 1 to 179 degrees, auto or off"};
    if (text == "auto") return {FeatureAngle::Rule::automatic, 0};
    if (text == "off") return {FeatureAngle::Rule::off, 0};
    return {FeatureAngle::Rule::degrees, parse_number(name, text, angle)};
  };
  return add_parsed<FeatureAngle>(app, name, to, "auto|off|DEGREES", parse,
                                  "Keep edges sharp whose faces turn by more than this; auto: by more than "
                                  "35 where edges look like those of a part and not of a scan")
      ->default_str("auto");
}

}  // namespace tetwright

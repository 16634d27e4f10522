// SPDX-License-Identifier: Apache-2.0
#include "tools/app/volume_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tools/app/option_values.h"

namespace tetwright {

namespace {

/// The three texts between separators.
/// \throws CLI::ValidationError unless there are `least` to three
std::vector<std::string> up_to_three(const std::string& option, const std::string& text,
                                     const std::string& separators, std::size_t least, const char* form) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (separators.find(c) != std::string::npos)
      parts.emplace_back();
    else
      parts.back() += c;
  if (parts.size() != 3 && parts.size() != least)
    throw CLI::ValidationError(option, "'" + text + "' is not " + form);
  return parts;
}

std::optional<Vec3> parse_spacing(const std::string& text) {
  const std::vector<std::string> parts = up_to_three("--spacing", text, ",", 1, "H or SX,SY,SZ");
  Vec3 spacing;
  for (std::size_t k = 0; k < 3; ++k)
    spacing[static_cast<Eigen::Index>(k)] = parse_number("--spacing", parts[k % parts.size()], positive);
  return spacing;
}

std::optional<std::array<int, 3>> parse_dimensions(const std::string& text) {
  const std::vector<std::string> parts = up_to_three("--dimensions", text, ",xX", 3, "NX,NY,NZ or NXxNYxNZ");
  std::array<int, 3> size{};
  for (std::size_t k = 0; k < 3; ++k)
    size[k] =
        static_cast<int>(parse_whole_number("--dimensions", parts[k], 1, std::numeric_limits<int>::max()));
  return size;
}

std::string parse_voxel_type(const std::string& text) {
  try {
    check_volume_options({.voxel_type = text});
  } catch (const UsageError& error) {
    throw CLI::ValidationError(error.what());
  }
  return text;
}

}  // namespace

void add_volume_file(CLI::App& app, VolumeFileOptions& options) {
  add_parsed<std::optional<Vec3>>(
      app, "--spacing", options.spacing, "H|SX,SY,SZ", parse_spacing,
      "Distance between voxels, input units, for volumes whose files give none, and instead of the file's");
  add_parsed<std::optional<std::array<int, 3>>>(
      app, "--dimensions", options.dimensions, "NX,NY,NZ", parse_dimensions,
      "Voxels of a .raw file along each axis; the first one varies fastest");
  add_parsed<std::string>(
      app, "--voxel-type", options.voxel_type, "TYPE", parse_voxel_type,
      "Type of the voxels of a .raw file: int8 to uint64, float16 to float64, with le or be "
      "for the byte order (default: le), such as uint16be");
}

}  // namespace tetwright

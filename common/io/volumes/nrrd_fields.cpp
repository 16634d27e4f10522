// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/nrrd_fields.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/io/encodings/vtk_numbers.h"
#include "common/lower_case.h"
#include "common/trimmed.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

bool known_field(const std::string& field) {
  constexpr std::array<std::string_view, 40> names{"dimension",
                                                   "type",
                                                   "block size",
                                                   "blocksize",
                                                   "encoding",
                                                   "endian",
                                                   "content",
                                                   "min",
                                                   "max",
                                                   "old min",
                                                   "oldmin",
                                                   "old max",
                                                   "oldmax",
                                                   "data file",
                                                   "datafile",
                                                   "line skip",
                                                   "lineskip",
                                                   "byte skip",
                                                   "byteskip",
                                                   "number",
                                                   "sample units",
                                                   "sampleunits",
                                                   "sizes",
                                                   "spacings",
                                                   "thicknesses",
                                                   "axis mins",
                                                   "axismins",
                                                   "axis maxs",
                                                   "axismaxs",
                                                   "centers",
                                                   "centerings",
                                                   "labels",
                                                   "units",
                                                   "kinds",
                                                   "space",
                                                   "space dimension",
                                                   "space units",
                                                   "space origin",
                                                   "space directions",
                                                   "measurement frame"};
  return std::find(names.begin(), names.end(), field) != names.end();
}

/// No segmentation has as many layers; sums with larger numbers could overflow.
constexpr std::int64_t max_layer = std::int64_t{1} << 31;

bool is_data_file(std::string_view field) {
  const std::string name = lower_case(trimmed(field));
  return name == "data file" || name == "datafile";
}

bool is_list(std::string_view value) {
  const std::string text = lower_case(trimmed(value));
  return text == "list" || text.starts_with("list ");
}

}  // namespace

void NrrdSegments::add(std::string_view key, std::string_view value) {
  constexpr std::string_view begin = "Segment";
  const std::size_t underscore = key.find('_');
  std::int64_t number = 0;
  if (!key.starts_with(begin) || underscore == std::string_view::npos ||
      !parse_number(key.substr(begin.size(), underscore - begin.size()), number))
    return;
  const std::string_view what = key.substr(underscore + 1);
  Segment& segment = segments_[number];
  if (what == "Name")
    segment.name = std::string(trimmed(value));
  else if (what == "LabelValue")
    segment.has_label = parse_number(trimmed(value), segment.label);
  else if (what == "Color")
    segment.colour = parse_colour(value);
  else if (what == "Layer" && parse_number(trimmed(value), segment.layer))
    layers_ = std::max(layers_, std::min(segment.layer, max_layer) + 1);
}

void NrrdSegments::give_names_and_colours(LabelGrid& volume, std::int64_t layer) const {
  for (const auto& [number, segment] : segments_) {
    if (segment.layer != layer || !segment.has_label ||
        segment.label < std::numeric_limits<MaterialTag>::min() ||
        segment.label > std::numeric_limits<MaterialTag>::max())
      continue;
    const auto tag = static_cast<MaterialTag>(segment.label);
    if (!segment.name.empty()) volume.names.emplace(tag, segment.name);
    if (segment.colour) volume.colours.emplace(tag, *segment.colour);
  }
}

/// \return std::nullopt for a malformed colour, since the volume need not be rejected for it
std::optional<NrrdSegments::Colour> NrrdSegments::parse_colour(std::string_view value) {
  Colour colour;
  for (double& part : colour) {
    value = trimmed(value);
    const std::size_t end = std::min(value.find(' '), value.size());
    if (!parse_number(value.substr(0, end), part) || !(part >= 0 && part <= 1)) return {};
    value.remove_prefix(end);
  }
  return colour;
}

HeaderFields read_nrrd_header(TextScanner& in, NrrdSegments& segments) {
  if (in.left() == 0) in.fail("the file is empty");
  HeaderFields header(in.name());
  const std::string_view magic = in.rest_of_line();
  if (!magic.starts_with("NRRD000") || magic.size() < 8)
    throw InputError(in.name(), 1,
                     "expected \"NRRD000\" and a digit at the beginning, found " + in_quotes(magic) +
                         "; is this an NRRD file?");
  while (in.left() > 0) {
    const std::size_t line = in.line();
    const std::string_view text = in.rest_of_line();
    if (text.empty()) break;
    if (text[0] == '#') continue;
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos)
      throw InputError(in.name(), line,
                       "expected \"field: value\", found " + in_quotes(text) +
                           "; the header is damaged or lacks the empty line at its end");
    if (text.substr(colon).starts_with(":=")) {  // a key/value pair with user-defined meaning
      segments.add(text.substr(0, colon), text.substr(colon + 2));
      continue;
    }
    const std::string_view field = text.substr(0, colon);
    if (!known_field(lower_case(trimmed(field))))
      throw InputError(in.name(), line,
                       "unknown field " + in_quotes(field) + "; write notes as comments or \"key:=value\"");
    header.add(field, text.substr(colon + 1), line);
    if (is_data_file(field) && is_list(text.substr(colon + 1))) break;  // file names follow
  }
  return header;
}

VoxelType nrrd_voxel_type(const HeaderFields& header, VoxelUse use) {
  constexpr std::array<std::pair<std::string_view, VoxelType>, 32> names{
      {{"signed char", VoxelType::int8},
       {"int8", VoxelType::int8},
       {"int8_t", VoxelType::int8},
       {"uchar", VoxelType::uint8},
       {"unsigned char", VoxelType::uint8},
       {"uint8", VoxelType::uint8},
       {"uint8_t", VoxelType::uint8},
       {"short", VoxelType::int16},
       {"short int", VoxelType::int16},
       {"signed short", VoxelType::int16},
       {"signed short int", VoxelType::int16},
       {"int16", VoxelType::int16},
       {"int16_t", VoxelType::int16},
       {"ushort", VoxelType::uint16},
       {"unsigned short", VoxelType::uint16},
       {"unsigned short int", VoxelType::uint16},
       {"uint16", VoxelType::uint16},
       {"uint16_t", VoxelType::uint16},
       {"int", VoxelType::int32},
       {"signed int", VoxelType::int32},
       {"int32", VoxelType::int32},
       {"int32_t", VoxelType::int32},
       {"uint", VoxelType::uint32},
       {"unsigned int", VoxelType::uint32},
       {"uint32", VoxelType::uint32},
       {"uint32_t", VoxelType::uint32},
       {"int64", VoxelType::int64},
       {"int64_t", VoxelType::int64},
       {"uint64", VoxelType::uint64},
       {"uint64_t", VoxelType::uint64},
       {"float", VoxelType::float32},
       {"double", VoxelType::float64}}};
  std::string type;
  for (const std::string_view word : header.words("type"))
    type += (type.empty() ? "" : " ") + lower_case(word);
  for (const auto& [name, value] : names)
    if (name == type) return value;
  // "long long" in all its spellings in C.
  if (type.find("long long") != std::string::npos || type == "longlong" || type == "ulonglong")
    return type[0] == 'u' ? VoxelType::uint64 : VoxelType::int64;
  header.fail("type", "type " + in_quotes(type) + " of the voxels is not supported; " +
                          numbers_to_save(use, "save the labels as unsigned char, short or int"));
}

}  // namespace tetwright

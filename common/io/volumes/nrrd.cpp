// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/nrrd.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "common/io/encodings/byte_order.h"
#include "common/io/encodings/vtk_numbers.h"
#include "common/io/volumes/header_fields.h"
#include "common/io/volumes/voxel_data.h"
#include "common/lower_case.h"
#include "common/trimmed.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr std::int64_t max_axes = 16;  // the format's own limit

VoxelType nrrd_voxel_type(const HeaderFields& header) {
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
  header.fail("type", "type " + in_quotes(type) +
                          " of the voxels is not supported; save the labels as unsigned char, short or int");
}

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

bool is_data_file(std::string_view field) {
  const std::string name = lower_case(trimmed(field));
  return name == "data file" || name == "datafile";
}

bool is_list(std::string_view value) {
  const std::string text = lower_case(trimmed(value));
  return text == "list" || text.starts_with("list ");
}

/// Fields of 3D Slicer that describe the segments of a .seg.nrrd: "Segment3_Name:=liver",
/// "Segment3_LabelValue:=4", "Segment3_Color:=0.87 0.51 0.4".
class Segments {
 public:
  void add(std::string_view key, std::string_view value) {
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
      layers_ = std::max(layers_, segment.layer + 1);
  }
  /// Number of layers; overlapping segments are stored in several layers.
  std::int64_t layers() const { return layers_; }
  void give_names_and_colours(LabelVolume& volume) const {
    for (const auto& [number, segment] : segments_) {
      if (!segment.has_label || segment.label < std::numeric_limits<MaterialTag>::min() ||
          segment.label > std::numeric_limits<MaterialTag>::max())
        continue;
      const auto tag = static_cast<MaterialTag>(segment.label);
      if (!segment.name.empty()) volume.names.emplace(tag, segment.name);
      if (segment.colour) volume.colours.emplace(tag, *segment.colour);
    }
  }

 private:
  using Colour = std::array<double, 3>;
  /// \return std::nullopt for a malformed colour, since the volume need not be rejected for it
  static std::optional<Colour> parse_colour(std::string_view value) {
    Colour colour;
    for (double& part : colour) {
      value = trimmed(value);
      const std::size_t end = std::min(value.find(' '), value.size());
      if (!parse_number(value.substr(0, end), part) || !(part >= 0 && part <= 1)) return {};
      value.remove_prefix(end);
    }
    return colour;
  }

  struct Segment {
    std::string name;
    std::optional<Colour> colour;
    std::int64_t label = 0, layer = 0;
    bool has_label = false;
  };
  std::map<std::int64_t, Segment> segments_;
  std::int64_t layers_ = 1;
};

/// Reads the header, including the empty line after it; a detached header may end without one.
HeaderFields read_nrrd_header(TextScanner& in, Segments& segments) {
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

/// Reads vectors "(1,0,0) (0, 1, 0) none". "none" and vectors of NaN become std::nullopt.
std::vector<std::optional<Vec3>> vectors(const HeaderFields& header, const std::string& field) {
  std::vector<std::optional<Vec3>> out;
  std::string_view rest = header.text(field);
  while (!rest.empty()) {
    if (lower_case(rest.substr(0, 4)) == "none") {
      out.emplace_back();
      rest = trimmed(rest.substr(4));
      continue;
    }
    const std::size_t close = rest.find(')');
    if (rest[0] != '(' || close == std::string_view::npos)
      header.fail(field, "expected vectors like (1,0,0) as " + field + ", found " + in_quotes(rest));
    std::string_view inside = rest.substr(1, close - 1);
    std::vector<double> numbers;
    for (;;) {
      const std::size_t comma = inside.find(',');
      double value = 0;
      if (!parse_number(trimmed(inside.substr(0, comma)), value))
        header.fail(field, "expected vectors like (1,0,0) as " + field + ", found " +
                               in_quotes(rest.substr(0, close + 1)));
      numbers.push_back(value);
      if (comma == std::string_view::npos) break;
      inside.remove_prefix(comma + 1);
    }
    if (numbers.size() != 3)
      header.fail(field, "a vector of " + std::to_string(numbers.size()) + " numbers, " +
                             in_quotes(rest.substr(0, close + 1)) + "; space has 3 dimensions");
    const Vec3 v(numbers[0], numbers[1], numbers[2]);
    if (v.array().isNaN().all())
      out.emplace_back();
    else
      out.emplace_back(v);
    rest = trimmed(rest.substr(close + 1));
  }
  return out;
}

/// Interprets the fields of a header.
class NrrdHeader {
 public:
  explicit NrrdHeader(const HeaderFields& fields) : fields_(fields) {
    const std::int64_t dimension = fields_.integer("dimension");
    if (dimension < 3 || dimension > max_axes)
      fields_.fail("dimension",
                   "dimension " + std::to_string(dimension) + "; a volume of labels has 3 spatial axes");
    axes_ = static_cast<std::size_t>(dimension);
    sizes_ = fields_.integers("sizes");
    need_one_each("sizes", sizes_.size());
    if (fields_.has("kinds")) {
      kinds_ = fields_.words("kinds");
      need_one_each("kinds", kinds_.size());
    }
    if (fields_.has("space directions")) {
      directions_ = vectors(fields_, "space directions");
      need_one_each("space directions", directions_.size());
    }
    choose_axes();
    read_geometry();
  }

  /// The volume without labels.
  LabelVolume volume() const { return volume_; }

 private:
  void need_one_each(const std::string& field, std::size_t n) const {
    if (n != axes_)
      fields_.fail(field, std::to_string(n) + " " + field + " for " + std::to_string(axes_) + " axes");
  }

  bool is_spatial(std::size_t axis) const {
    if (!directions_.empty() && !directions_[axis]) return false;
    if (kinds_.empty()) return true;
    const std::string kind = lower_case(kinds_[axis]);
    return kind == "domain" || kind == "space" || kind == "???" || kind == "none";
  }

  /// Chooses three axes. Other axes must have size 1 and are dropped, first those that are not spatial.
  void choose_axes() {
    for (std::size_t a = 0; a < axes_; ++a) chosen_.push_back(a);
    for (const bool only_others : {true, false})
      for (std::size_t k = chosen_.size(); k-- > 0 && chosen_.size() > 3;)
        if (sizes_[chosen_[k]] == 1 && !(only_others && is_spatial(chosen_[k])))
          chosen_.erase(chosen_.begin() + static_cast<std::ptrdiff_t>(k));
    for (const std::size_t a : chosen_)
      if (!is_spatial(a))
        fields_.fail("sizes", "axis " + std::to_string(a) + " (" + std::to_string(sizes_[a]) +
                                  " items of kind " + in_quotes(kinds_.empty() ? "none" : kinds_[a]) +
                                  ") is not a spatial axis; a volume with one label per voxel is needed");
    if (chosen_.size() != 3)
      fields_.fail("sizes",
                   std::to_string(chosen_.size()) +
                       " axes of more than one item; a volume of labels has 3, save one of its parts");
    std::array<std::int64_t, 3> sizes;
    for (std::size_t k = 0; k < 3; ++k) sizes[k] = sizes_[chosen_[k]];
    volume_.size = checked_size(sizes, fields_.file(), fields_.line("sizes"));
  }

  void read_geometry() {
    if (fields_.has("space dimension") && fields_.integer("space dimension") != 3)
      fields_.fail("space dimension",
                   in_quotes(fields_.text("space dimension")) + " dimensions of space; 3 are needed");
    if (fields_.has("space")) volume_.space = space_name();
    if (!directions_.empty()) {
      for (int k = 0; k < 3; ++k)
        volume_.directions.col(k) = *directions_[chosen_[static_cast<std::size_t>(k)]];
    } else if (fields_.has("spacings")) {
      const std::vector<double> spacings = fields_.numbers("spacings", axes_);
      for (int k = 0; k < 3; ++k) volume_.directions(k, k) = spacings[chosen_[static_cast<std::size_t>(k)]];
    } else {
      spacings_from_ends();
    }
    if (fields_.has("space origin")) {
      const auto origin = vectors(fields_, "space origin");
      if (origin.size() != 1 || !origin[0])
        fields_.fail("space origin", "expected one vector like (0,0,0) as space origin, found " +
                                         in_quotes(fields_.text("space origin")));
      volume_.origin = *origin[0];
    } else if (directions_.empty()) {
      origin_from_ends();
    }
  }

  std::string space_name() const {
    const std::string space = fields_.lower_text("space");
    if (space == "ras" || space == "right-anterior-superior") return "right-anterior-superior";
    if (space == "las" || space == "left-anterior-superior") return "left-anterior-superior";
    if (space == "lps" || space == "left-posterior-superior") return "left-posterior-superior";
    if (space == "scanner-xyz" || space == "3d-right-handed" || space == "3d-left-handed") {
      return space == "scanner-xyz" ? space : "3D" + space.substr(2);
    }
    fields_.fail("space", "space " + in_quotes(fields_.text("space")) +
                              " is not supported; use right-anterior-superior, left-anterior-superior, "
                              "left-posterior-superior, scanner-xyz, 3D-right-handed or 3D-left-handed");
  }

  /// Whether the samples along an axis lie half a step inside the range of `axis mins` and `axis maxs`,
  /// rather than at its ends.
  bool in_cells(std::size_t axis) const {
    const std::string field = fields_.any_of({"centerings", "centers"});
    if (!fields_.has(field)) return false;
    const auto words = fields_.words(field);
    need_one_each(field, words.size());
    return lower_case(words[axis]) == "cell";
  }

  void spacings_from_ends() {
    const std::string mins = fields_.any_of({"axis mins", "axismins"}),
                      maxs = fields_.any_of({"axis maxs", "axismaxs"});
    if (!fields_.has(mins) || !fields_.has(maxs)) return;
    const std::vector<double> low = fields_.numbers(mins, axes_), high = fields_.numbers(maxs, axes_);
    for (int k = 0; k < 3; ++k) {
      const std::size_t a = chosen_[static_cast<std::size_t>(k)];
      const auto steps = static_cast<double>(in_cells(a) ? sizes_[a] : sizes_[a] - 1);
      if (!std::isnan(low[a]) && !std::isnan(high[a]) && steps > 0)
        volume_.directions(k, k) = (high[a] - low[a]) / steps;
    }
  }

  void origin_from_ends() {
    const std::string mins = fields_.any_of({"axis mins", "axismins"});
    if (!fields_.has(mins)) return;
    const std::vector<double> low = fields_.numbers(mins, axes_);
    for (int k = 0; k < 3; ++k) {
      const std::size_t a = chosen_[static_cast<std::size_t>(k)];
      if (!std::isnan(low[a])) volume_.origin[k] = low[a] + (in_cells(a) ? volume_.directions(k, k) / 2 : 0);
    }
  }

  const HeaderFields& fields_;
  std::size_t axes_ = 0;
  std::vector<std::int64_t> sizes_;
  std::vector<std::string_view> kinds_;
  std::vector<std::optional<Vec3>> directions_;
  std::vector<std::size_t> chosen_;
  LabelVolume volume_;
};

std::int64_t optional_integer(const HeaderFields& header, const std::string& field) {
  return header.has(field) ? header.integer(field) : 0;
}

/// Offset of the body after the lines that must be skipped according to the header.
std::size_t skip_lines(const HeaderFields& header, TextScanner& body) {
  const std::string field = header.any_of({"line skip", "lineskip"});
  const std::int64_t lines = optional_integer(header, field);
  if (lines < 0) header.fail(field, std::to_string(lines) + " lines to skip");
  for (std::int64_t i = 0; i < lines; ++i) {
    if (body.left() == 0)
      header.fail(field, std::to_string(lines) + " lines to skip, but the data have " + std::to_string(i));
    body.skip_line();
  }
  return body.offset();
}

bool is_swapped(const HeaderFields& header, VoxelType type) {
  if (voxel_bytes(type) == 1) return false;
  const std::string endian = header.lower_text("endian");
  if (endian != "little" && endian != "big")
    header.fail("endian", "expected little or big as endian, found " + in_quotes(header.text("endian")));
  return (endian == "little") != little_endian_machine;
}

}  // namespace

LabelVolume read_nrrd(std::string_view bytes, const std::string& name, const FileReader& read) {
  TextScanner in(bytes, name);
  Segments segments;
  const HeaderFields header = read_nrrd_header(in, segments);
  if (segments.layers() > 1)
    header.fail("sizes", "its segments overlap, in " + std::to_string(segments.layers()) +
                             " layers; each voxel needs one label: export the segmentation as a label map "
                             "(3D Slicer: Segmentations, Export/import), or save it without overlap");
  const std::string encoding = header.lower_text("encoding");
  const bool gzip = encoding == "gzip" || encoding == "gz";
  const bool as_text = encoding == "txt" || encoding == "text" || encoding == "ascii";
  if (!gzip && !as_text && encoding != "raw")
    header.fail("encoding",
                "encoding " + in_quotes(encoding) + " is not supported; save the volume as raw or gzip");
  LabelVolume volume = NrrdHeader(header).volume();
  segments.give_names_and_colours(volume);
  check_geometry(volume, name);
  VoxelFormat format;
  format.type = nrrd_voxel_type(header);

  const std::string data_field = header.any_of({"data file", "datafile"});
  DataFile file{name, {}};
  const bool detached = header.has(data_field);
  if (detached) file = read_data_file(header, data_field, read);
  TextScanner body = detached ? TextScanner(file.bytes, file.path) : in;
  // Voxels may begin with the bytes of a byte order mark, which the scanner would skip.
  const std::size_t begin = detached ? 0 : body.offset();
  const std::size_t behind_lines = skip_lines(header, body);
  const bool has_lines = optional_integer(header, header.any_of({"line skip", "lineskip"})) > 0;
  std::string_view data =
      (detached ? std::string_view(file.bytes) : bytes).substr(has_lines ? behind_lines : begin);

  const std::string skip_field = header.any_of({"byte skip", "byteskip"});
  const std::int64_t skip = optional_integer(header, skip_field);
  if (skip < -1 || (skip == -1 && encoding != "raw"))
    header.fail(skip_field, std::to_string(skip) + " bytes to skip" +
                                (skip == -1 ? ", which is allowed only for raw data" : ""));
  if (as_text) {
    if (body.take_bytes(static_cast<std::size_t>(skip)).size() < static_cast<std::size_t>(skip))
      header.fail(skip_field, std::to_string(skip) + " bytes to skip, but the data are shorter");
    volume.labels = read_voxels_as_text(body, volume.size);
    return volume;
  }
  format.swap = is_swapped(header, format.type);
  if (skip == -1) {
    std::uint64_t needed = voxel_bytes(format.type);
    for (const int n : volume.size) needed *= static_cast<std::uint64_t>(n);
    if (needed < data.size()) data.remove_prefix(data.size() - static_cast<std::size_t>(needed));
  }
  ByteSource source(data, gzip ? ByteSource::Packing::deflate : ByteSource::Packing::none, file.path);
  if (skip > 0 && source.skip(static_cast<std::uint64_t>(skip)) < static_cast<std::uint64_t>(skip))
    header.fail(skip_field,
                std::to_string(skip) + " bytes to skip, but the data have " + std::to_string(source.taken()));
  volume.labels = read_voxels(source, format, volume.size);
  return volume;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/nrrd.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/io/encodings/byte_order.h"
#include "common/io/encodings/vtk_numbers.h"
#include "common/io/volumes/header_fields.h"
#include "common/io/volumes/nrrd_fields.h"
#include "common/io/volumes/voxel_data.h"
#include "common/lower_case.h"
#include "common/trimmed.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr std::int64_t max_axes = 16;  // the format's own limit

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
  /// \param layers if above 1, an axis that is not spatial has this size: those of overlapping segments
  NrrdHeader(const HeaderFields& fields, std::int64_t max_voxels, std::int64_t layers, VoxelUse use)
      : fields_(fields), max_voxels_(max_voxels), layers_(layers), use_(use) {
    const std::int64_t dimension = fields_.integer("dimension");
    if (dimension < 3 || dimension > max_axes)
      fields_.fail("dimension", "dimension " + std::to_string(dimension) + "; " + name_of_use(use) +
                                    " has 3 spatial axes");
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

  const LabelGrid& grid() const { return grid_; }
  /// Axis of the layers, or of an image's channels.
  const ChannelAxis& channels() const { return channels_; }

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

  /// Whether the axis may be that of layers or channels.
  bool is_of_channels(std::size_t axis) const {
    return !is_spatial(axis) && (layers_ > 1 ? sizes_[axis] == layers_ : sizes_[axis] > 1);
  }

  /// Chooses three axes and that of channels. Other axes must have size 1 and are dropped, first those that
  /// are not spatial.
  void choose_axes() {
    for (std::size_t a = 0; a < axes_; ++a) chosen_.push_back(a);
    const bool channels = layers_ > 1 || (use_ == VoxelUse::image &&
                                          std::any_of(chosen_.begin(), chosen_.end(),
                                                      [&](std::size_t a) { return is_of_channels(a); }));
    const std::size_t wanted = channels ? 4 : 3;
    for (const bool only_others : {true, false})
      for (std::size_t k = chosen_.size(); k-- > 0 && chosen_.size() > wanted;)
        if (sizes_[chosen_[k]] == 1 && !(only_others && is_spatial(chosen_[k])))
          chosen_.erase(chosen_.begin() + static_cast<std::ptrdiff_t>(k));
    if (channels) {
      const auto axis =
          std::find_if(chosen_.begin(), chosen_.end(), [&](std::size_t a) { return is_of_channels(a); });
      if (axis == chosen_.end())
        fields_.fail("sizes", "its segments are in " + std::to_string(layers_) +
                                  " layers, but no axis of that size is other than spatial (of kind list)");
      channels_ = {sizes_[*axis], static_cast<std::size_t>(axis - chosen_.begin())};
      chosen_.erase(axis);
    }
    for (const std::size_t a : chosen_)
      if (!is_spatial(a))
        fields_.fail("sizes", "axis " + std::to_string(a) + " (" + std::to_string(sizes_[a]) +
                                  " items of kind " + in_quotes(kinds_.empty() ? "none" : kinds_[a]) +
                                  ") is not a spatial axis; " +
                                  (use_ == VoxelUse::labels ? "a volume with one label per voxel is needed"
                                                            : "an image has three and one of channels"));
    if (chosen_.size() != 3)
      fields_.fail("sizes",
                   std::to_string(chosen_.size()) + " axes of more than one item; " + name_of_use(use_) +
                       " has 3, " +
                       (use_ == VoxelUse::labels ? "save one of its parts"
                                                 : "and one of another kind (list, vector) for channels"));
    std::array<std::int64_t, 3> sizes;
    for (std::size_t k = 0; k < 3; ++k) sizes[k] = sizes_[chosen_[k]];
    grid_.size = checked_size(sizes, fields_.file(), fields_.line("sizes"), max_voxels_);
    check_channels(channels_.count, grid_.size, layers_ > 1 ? VoxelUse::image : use_, fields_.file(),
                   fields_.line("sizes"), max_voxels_);
  }

  void read_geometry() {
    if (fields_.has("space dimension") && fields_.integer("space dimension") != 3)
      fields_.fail("space dimension",
                   in_quotes(fields_.text("space dimension")) + " dimensions of space; 3 are needed");
    if (fields_.has("space")) grid_.space = space_name();
    if (!directions_.empty()) {
      for (int k = 0; k < 3; ++k)
        grid_.directions.col(k) = *directions_[chosen_[static_cast<std::size_t>(k)]];
    } else if (fields_.has("spacings")) {
      const std::vector<double> spacings = fields_.numbers("spacings", axes_);
      for (int k = 0; k < 3; ++k) grid_.directions(k, k) = spacings[chosen_[static_cast<std::size_t>(k)]];
    } else {
      spacings_from_ends();
    }
    if (fields_.has("space origin")) {
      const auto origin = vectors(fields_, "space origin");
      if (origin.size() != 1 || !origin[0])
        fields_.fail("space origin", "expected one vector like (0,0,0) as space origin, found " +
                                         in_quotes(fields_.text("space origin")));
      grid_.origin = *origin[0];
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
        grid_.directions(k, k) = (high[a] - low[a]) / steps;
    }
  }

  void origin_from_ends() {
    const std::string mins = fields_.any_of({"axis mins", "axismins"});
    if (!fields_.has(mins)) return;
    const std::vector<double> low = fields_.numbers(mins, axes_);
    for (int k = 0; k < 3; ++k) {
      const std::size_t a = chosen_[static_cast<std::size_t>(k)];
      if (!std::isnan(low[a])) grid_.origin[k] = low[a] + (in_cells(a) ? grid_.directions(k, k) / 2 : 0);
    }
  }

  const HeaderFields& fields_;
  std::int64_t max_voxels_, layers_;
  VoxelUse use_;
  std::size_t axes_ = 0;
  std::vector<std::int64_t> sizes_;
  std::vector<std::string_view> kinds_;
  std::vector<std::optional<Vec3>> directions_;
  std::vector<std::size_t> chosen_;
  LabelGrid grid_;
  ChannelAxis channels_;
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

enum class NrrdEncoding { raw, gzip, text };

/// Content that is read from a file: labels, layers of labels, or values.
enum class NrrdContent { labels, layers, image };

NrrdContent content_for(VoxelUse use) {
  return use == VoxelUse::labels ? NrrdContent::labels : NrrdContent::image;
}

/// The header of an NRRD file, checked.
struct NrrdFile {
  NrrdFile(TextScanner& in, std::int64_t max_voxels, NrrdContent content)
      : fields(read_nrrd_header(in, segments)) {
    if (segments.layers() > 1 && content == NrrdContent::image)
      fields.fail("sizes", "its segments overlap, in " + std::to_string(segments.layers()) +
                               " layers: it is a segmentation, not an image");
    if (segments.layers() > 1 && content == NrrdContent::labels)
      fields.fail("sizes",
                  "its segments overlap, in " + std::to_string(segments.layers()) +
                      " layers; each voxel needs one label: give it as a file, whose segments are masks, "
                      "export the segmentation as a label map (3D Slicer: Segmentations, "
                      "Export/import), or save it without overlap");
    const std::string named = fields.lower_text("encoding");
    if (named == "gzip" || named == "gz")
      encoding = NrrdEncoding::gzip;
    else if (named == "txt" || named == "text" || named == "ascii")
      encoding = NrrdEncoding::text;
    else if (named != "raw")
      fields.fail("encoding",
                  "encoding " + in_quotes(named) + " is not supported; save the volume as raw or gzip");
    const VoxelUse use = content == NrrdContent::image ? VoxelUse::image : VoxelUse::labels;
    const NrrdHeader header(fields, max_voxels, segments.layers(), use);
    grid = header.grid();
    channels = header.channels();
    if (segments.layers() == 1) segments.give_names_and_colours(grid);
    check_geometry(grid, in.name());
    format.type = nrrd_voxel_type(fields, use);
    data_field = fields.any_of({"data file", "datafile"});
    detached = fields.has(data_field);
    lines_to_skip = optional_integer(fields, fields.any_of({"line skip", "lineskip"}));
    skip_field = fields.any_of({"byte skip", "byteskip"});
    bytes_to_skip = optional_integer(fields, skip_field);
  }

  void check_skip() const {
    if (bytes_to_skip < -1 || (bytes_to_skip == -1 && encoding != NrrdEncoding::raw))
      fields.fail(skip_field, std::to_string(bytes_to_skip) + " bytes to skip" +
                                  (bytes_to_skip == -1 ? ", which is allowed only for raw data" : ""));
  }

  NrrdSegments segments;
  HeaderFields fields;
  NrrdEncoding encoding = NrrdEncoding::raw;
  LabelGrid grid;
  ChannelAxis channels;
  VoxelFormat format;
  std::string data_field, skip_field;
  bool detached = false;
  std::int64_t lines_to_skip = 0, bytes_to_skip = 0;
};

/// Finds the voxels that follow a header.
EncodedVolume find_body(NrrdFile& nrrd, const TextScanner& in, std::string_view bytes,
                        const std::string& name, const FileReader& read) {
  const HeaderFields& header = nrrd.fields;
  DataFile file{name, {}};
  if (nrrd.detached) file = read_data_file(header, nrrd.data_field, read);
  const auto other = std::make_shared<const std::string>(std::move(file.bytes));
  TextScanner body = nrrd.detached ? TextScanner(*other, file.path) : in;
  // Voxels may begin with the bytes of a byte order mark, which the scanner would skip.
  const std::size_t begin = nrrd.detached ? 0 : body.offset();
  const std::size_t behind_lines = skip_lines(header, body);
  std::string_view data = (nrrd.detached ? std::string_view(*other) : bytes)
                              .substr(nrrd.lines_to_skip > 0 ? behind_lines : begin);
  nrrd.check_skip();
  const std::int64_t skip = nrrd.bytes_to_skip;
  if (nrrd.encoding == NrrdEncoding::text) {
    if (body.take_bytes(static_cast<std::size_t>(skip)).size() < static_cast<std::size_t>(skip))
      header.fail(nrrd.skip_field, std::to_string(skip) + " bytes to skip, but the data are shorter");
    return {nrrd.grid, nrrd.channels, nrrd.format, std::move(body), other};
  }
  nrrd.format.swap = is_swapped(header, nrrd.format.type);
  if (skip == -1)
    data.remove_prefix(static_cast<std::size_t>(
        offset_from_end(data.size(), nrrd.grid.size, nrrd.format.type, nrrd.channels.count)));
  ByteSource source(
      data, nrrd.encoding == NrrdEncoding::gzip ? ByteSource::Packing::deflate : ByteSource::Packing::none,
      file.path);
  if (skip > 0 && source.skip(static_cast<std::uint64_t>(skip)) < static_cast<std::uint64_t>(skip))
    header.fail(nrrd.skip_field,
                std::to_string(skip) + " bytes to skip, but the data have " + std::to_string(source.taken()));
  return {nrrd.grid, nrrd.channels, nrrd.format, std::move(source), other};
}

}  // namespace

EncodedVolume open_nrrd(std::string_view bytes, const std::string& name, const FileReader& read,
                        VoxelUse use) {
  TextScanner in(bytes, name);
  NrrdFile nrrd(in, max_volume_voxels, content_for(use));
  return find_body(nrrd, in, bytes, name, read);
}

LabelVolume read_nrrd(std::string_view bytes, const std::string& name, const FileReader& read) {
  return labels_of(open_nrrd(bytes, name, read, VoxelUse::labels));
}

std::int64_t nrrd_layers(const HeaderBytes& head, const std::string& name) {
  TextScanner in(head.bytes, name);
  NrrdSegments segments;
  (void)read_nrrd_header(in, segments);
  return segments.layers();
}

std::vector<LabelVolume> read_nrrd_layers(std::string_view bytes, const std::string& name,
                                          const FileReader& read) {
  TextScanner in(bytes, name);
  NrrdFile nrrd(in, max_volume_voxels, NrrdContent::layers);
  std::vector<std::vector<MaterialTag>> layers = labels_of_channels(find_body(nrrd, in, bytes, name, read));
  std::vector<LabelVolume> volumes;
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    LabelVolume& volume = volumes.emplace_back(LabelVolume{nrrd.grid, std::move(layers[layer])});
    nrrd.segments.give_names_and_colours(volume, static_cast<std::int64_t>(layer));
  }
  return volumes;
}

std::optional<RawVolume> find_nrrd(const HeaderBytes& head, const std::string& name, VoxelUse use) {
  // An empty line ends a header before voxels.
  if (!head.whole_file() && head.bytes.find("\n\n") == std::string_view::npos &&
      head.bytes.find("\n\r\n") == std::string_view::npos)
    return std::nullopt;
  TextScanner in(head.bytes, name);
  const NrrdFile nrrd(in, max_source_voxels, content_for(use));
  // Lines are found by reading, and are unusual before raw voxels.
  if (nrrd.encoding != NrrdEncoding::raw || nrrd.lines_to_skip != 0) return std::nullopt;
  nrrd.check_skip();
  RawVolume found{nrrd.grid, name, in.offset(), nrrd.format, nrrd.channels};
  found.format.swap = is_swapped(nrrd.fields, nrrd.format.type);
  std::uint64_t size = head.file_size;
  if (nrrd.detached) {
    found.file = data_file_path(nrrd.fields, nrrd.data_field);
    found.offset = 0;
    size = data_file_size(nrrd.fields, nrrd.data_field);
  }
  if (nrrd.bytes_to_skip == -1)
    found.offset +=
        offset_from_end(size - found.offset, found.grid.size, found.format.type, nrrd.channels.count);
  else if (static_cast<std::uint64_t>(nrrd.bytes_to_skip) > size - found.offset)
    nrrd.fields.fail(nrrd.skip_field, std::to_string(nrrd.bytes_to_skip) +
                                          " bytes to skip, but the data have " +
                                          std::to_string(size - found.offset));
  else
    found.offset += static_cast<std::uint64_t>(nrrd.bytes_to_skip);
  return found;
}

}  // namespace tetwright

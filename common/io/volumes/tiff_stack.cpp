// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/tiff_stack.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <mutex>
#include <optional>
#include <pugixml.hpp>
#include <utility>
#include <vector>

#include "common/io/encodings/byte_order.h"
#include "common/io/encodings/vtk_numbers.h"
#include "common/io/volumes/chunked_source.h"
#include "common/io/volumes/raw_volume.h"
#include "common/io/volumes/tiff_pages.h"
#include "common/lower_case.h"
#include "common/message_text.h"
#include "common/trimmed.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

namespace fs = std::filesystem;

/// Strips are joined to chunks of at least this size: a chunk of each row would cost more than its row.
constexpr std::size_t min_strips_bytes = std::size_t{1} << 18;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Removes the digits at the beginning of a name, and returns them without leading zeros.
std::string_view take_digits(std::string_view& name) {
  std::size_t n = 0;
  while (n < name.size() && is_digit(name[n])) ++n;
  std::string_view digits = name.substr(0, n);
  name.remove_prefix(n);
  while (digits.size() > 1 && digits[0] == '0') digits.remove_prefix(1);
  return digits;
}

bool is_tiff_file(const fs::directory_entry& entry) {
  const std::string name = lower_case(entry.path().filename().string());
  std::error_code error;
  return !name.starts_with('.') && (name.ends_with(".tif") || name.ends_with(".tiff")) &&
         entry.is_regular_file(error);
}

/// Where a page is, and how it is stored.
struct StackPage {
  std::uint64_t offset = 0;
  TiffPage shape;
};

/// A stack of pages of one size and type.
struct TiffStack {
  std::vector<std::string> files = {};  ///< one with all pages, or one for each page
  VoxelUse use;
  std::vector<StackPage> pages = {};
  TiffDescription description = {};

  std::string page_name(std::size_t page) const {
    return files.size() > 1 ? files[page] : files[0] + ": page " + std::to_string(page + 1);
  }

  void add(TiffFile& file, const std::string& name) {
    const StackPage page{file.offset(), file.page(name, use)};
    if (pages.size() == static_cast<std::size_t>(std::numeric_limits<int>::max()))
      throw InputError(name + ": it has more pages than a volume can have");
    if (pages.empty()) {
      description = file.description();
      description.text.shrink_to_fit();
    } else {
      check_like_first(page.shape, name);
    }
    pages.push_back(page);
  }

 private:
  void check_like_first(const TiffPage& page, const std::string& name) const {
    const TiffPage& first = pages[0].shape;
    if (page.width != first.width || page.height != first.height)
      throw InputError(name + ": it has " + std::to_string(page.width) + " x " + std::to_string(page.height) +
                       " pixels, and the first page " + std::to_string(first.width) + " x " +
                       std::to_string(first.height) + "; all pages of a stack have one size");
    if (page.type != first.type)
      throw InputError(name + ": its samples have another type than those of the first page");
    if (page.tiled != first.tiled || (page.tiled && page != first))
      throw InputError(name + ": its tiles have another size than those of the first page; save it again");
  }
};

TiffStack pages_of_file(const std::string& path, VoxelUse use) {
  TiffStack stack{.use = use};
  stack.files.push_back(path);
  TiffFile file(path);
  do stack.add(file, stack.page_name(stack.pages.size()));
  while (file.next());
  return stack;
}

TiffStack pages_of_folder(const std::string& path, VoxelUse use) {
  TiffStack stack{.use = use};
  std::error_code error;
  for (fs::directory_iterator entry(path, error), end; !error && entry != end; entry.increment(error))
    if (is_tiff_file(*entry)) stack.files.push_back(entry->path().string());
  if (error) throw InputError("cannot read " + path + ": " + error.message());
  if (stack.files.empty()) throw InputError(path + ": there is no .tif file in the folder");
  std::sort(stack.files.begin(), stack.files.end(), natural_less);
  if (stack.files.size() == 1) return pages_of_file(stack.files[0], use);
  for (const std::string& name : stack.files) {
    TiffFile file(name);
    stack.add(file, name);
    if (file.next())
      throw InputError(name +
                       ": it has several pages, and the folder several files; give one file, or a folder "
                       "of files of one page");
  }
  return stack;
}

/// The order of the pages of slices and channels.
struct PageOrder {
  std::int64_t channels = 1;
  std::size_t slice_step = 1, channel_step = 0;  ///< pages from one to the next
};

class TiffStackSource final : public ChunkedSource {
 public:
  TiffStackSource(LabelGrid grid, const ChunkLayout& layout, std::size_t cache_bytes, TiffStack stack,
                  const PageOrder& order)
      : ChunkedSource(std::move(grid), layout, cache_bytes), stack_(std::move(stack)), order_(order) {}

 protected:
  ByteBuffer load_chunk(const ChunkNumber& chunk) const override {
    const std::size_t page = page_of(chunk);
    ByteBuffer out(layout().bytes);
    TiffFile file = take_file(page);
    if (stack_.pages[page].shape.tiled)
      read_tile(file, chunk, out);
    else
      read_strips(file, chunk, out);
    // After an exception the file is closed.
    const std::lock_guard lock(mutex_);
    if (stack_.files.size() == 1) idle_.push_back(std::move(file));
    return out;
  }

  std::string chunk_name(const ChunkNumber& chunk) const override { return stack_.page_name(page_of(chunk)); }

  // No chunk is missing.
  MaterialTag fill_label(const ChunkNumber& /*chunk*/) const override { return 0; }
  float fill_value(const ChunkNumber& /*chunk*/) const override { return 0; }

 private:
  std::size_t page_of(const ChunkNumber& chunk) const {
    return static_cast<std::size_t>(chunk[2]) * order_.slice_step +
           static_cast<std::size_t>(chunk[3]) * order_.channel_step;
  }

  /// An open file that no other thread uses, at the page.
  TiffFile take_file(std::size_t page) const {
    if (stack_.files.size() > 1) return TiffFile(stack_.files[page]);
    std::optional<TiffFile> file;
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        file.emplace(std::move(idle_.back()));
        idle_.pop_back();
      }
    }
    if (!file) file.emplace(stack_.files[0]);
    file->go_to(stack_.pages[page].offset);
    return std::move(*file);
  }

  void read_tile(const TiffFile& file, const ChunkNumber& chunk, ByteBuffer& out) const {
    const auto across = static_cast<std::uint32_t>((grid().size[0] - 1) / layout().size[0] + 1);
    file.read_piece(true,
                    static_cast<std::uint32_t>(chunk[1]) * across + static_cast<std::uint32_t>(chunk[0]),
                    out.data.get(), out.size, chunk_name(chunk));
  }

  /// Reads the strips that have rows in the chunk.
  void read_strips(const TiffFile& file, const ChunkNumber& chunk, ByteBuffer& out) const {
    const std::size_t row = layout().strides[1];
    const std::int64_t height = grid().size[1], rows = stack_.pages[page_of(chunk)].shape.piece_height;
    const std::int64_t begin = std::int64_t{chunk[1]} * layout().size[1],
                       end = std::min(begin + layout().size[1], height);
    ByteBuffer apart;  // a strip that has rows of other chunks, too
    for (std::int64_t strip = begin / rows; strip * rows < end; ++strip) {
      const std::int64_t first = strip * rows, last = std::min(first + rows, height);
      const auto n = static_cast<std::size_t>(last - first) * row;
      const bool inside = begin <= first && last <= end;
      if (!inside && apart.size < n) apart = ByteBuffer(n);
      char* to = inside ? out.data.get() + static_cast<std::size_t>(first - begin) * row : apart.data.get();
      file.read_piece(false, static_cast<std::uint32_t>(strip), to, n, chunk_name(chunk));
      if (inside) continue;
      const std::int64_t from = std::max(first, begin), until = std::min(last, end);
      std::memcpy(out.data.get() + static_cast<std::size_t>(from - begin) * row,
                  to + static_cast<std::size_t>(from - first) * row,
                  static_cast<std::size_t>(until - from) * row);
    }
  }

  TiffStack stack_;
  PageOrder order_;
  mutable std::mutex mutex_;
  mutable std::vector<TiffFile> idle_;
};

/// Number after "key=" on a line of ImageJ's description.
std::optional<double> imagej_number(std::string_view text, std::string_view key) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
    double value = 0;
    if (line.starts_with(key) && line.substr(key.size()).starts_with('=') &&
        parse_number(line.substr(key.size() + 1), value) && std::isfinite(value))
      return value;
  }
  return std::nullopt;
}

/// Element of OME-TIFF that describes the pixels; null if the description has none.
pugi::xml_node ome_pixels(pugi::xml_document& document, const std::string& text) {
  if (text.find("<OME") == std::string::npos || !document.load_string(text.c_str())) return {};
  return document.child("OME").child("Image").child("Pixels");
}

/// Order of the pages of channels and slices that ImageJ or OME-TIFF describes.
/// \throws InputError if there are several times, or several channels and labels are wanted
PageOrder page_order(const std::string& path, const TiffStack& stack) {
  const std::string& text = stack.description.text;
  double channels = 1, times = 1;
  bool slices_first = false;  // all slices of a channel before the next channel
  pugi::xml_document document;
  if (const pugi::xml_node pixels = ome_pixels(document, text)) {
    channels = pixels.attribute("SizeC").as_double(1);
    times = pixels.attribute("SizeT").as_double(1);
    const std::string_view order = pixels.attribute("DimensionOrder").as_string();
    slices_first = order.find('Z') < order.find('C');
  } else if (text.starts_with("ImageJ=") || imagej_number(text, "spacing")) {
    channels = imagej_number(text, "channels").value_or(1);
    times = imagej_number(text, "frames").value_or(1);
  }
  const auto check_one = [&](const char* what, double n, bool image) {
    if (!(n > 1)) return;
    const std::string begin = path + ": it has " + short_number(n) + " " + what;
    if (stack.use == VoxelUse::labels)
      throw InputError(begin + ", and each voxel needs one label; save one of them as a stack");
    if (!image) throw InputError(begin + ", and an image has one; save one of them as a stack");
  };
  check_one("channels", channels, true);
  check_one("times", times, false);
  PageOrder order;
  if (!(channels > 1)) return order;
  if (channels > static_cast<double>(max_channels) || channels != std::floor(channels))
    throw InputError(path + ": " + short_number(channels) + " channels; an image has 1 to " +
                     std::to_string(max_channels));
  order.channels = static_cast<std::int64_t>(channels);
  const auto n = static_cast<std::size_t>(order.channels);
  order.slice_step = slices_first ? 1 : n;
  order.channel_step = slices_first ? stack.pages.size() / n : 1;
  return order;
}

/// Spacing of OME-TIFF, or std::nullopt if the description has none.
std::optional<Vec3> ome_spacing(const std::string& path, const std::string& text) {
  pugi::xml_document document;
  const pugi::xml_node pixels = ome_pixels(document, text);
  if (!pixels.attribute("PhysicalSizeX")) return std::nullopt;
  Vec3 spacing;
  std::string unit;
  for (int k = 0; k < 3; ++k) {
    const std::string name = std::string("PhysicalSize") + "XYZ"[k];
    spacing[k] = pixels.attribute(name.c_str()).as_double(1);
    const std::string its = pixels.attribute((name + "Unit").c_str()).as_string();
    if (k > 0 && its != unit)
      throw InputError(path + ": the spacings of its axes have different units; store them in one unit");
    unit = its;
  }
  return spacing;
}

/// Spacing of the voxels, or std::nullopt if the file says nothing of it.
std::optional<Vec3> spacing_of(const std::string& path, const TiffDescription& first) {
  const auto known = [](double resolution) {
    return std::isfinite(resolution) && resolution > 0 && resolution != 1;
  };
  const auto step = [&](double resolution, double unit) {
    return known(resolution) ? (unit > 0 ? unit : 1.0) / resolution : 1.0;
  };
  if (std::optional<Vec3> ome = ome_spacing(path, first.text)) return ome;
  const std::optional<double> between = imagej_number(first.text, "spacing");
  if (first.text.starts_with("ImageJ=") || between) {
    if (!between && !known(first.resolution_x)) return std::nullopt;
    // ImageJ takes the amount, too.
    const double z = between && *between != 0 ? std::fabs(*between) : 1;
    return Vec3(step(first.resolution_x, 0), step(first.resolution_y, 0), z);
  }
  if (!known(first.resolution_x)) return std::nullopt;
  const double x = step(first.resolution_x, first.unit_mm);
  return Vec3(x, step(first.resolution_y, first.unit_mm), x);
}

/// ImageJ writes stacks of more than 4 GB as one page, which other pages without an entry follow.
/// \return std::nullopt if the file has the first page alone
/// \throws InputError if there are more voxels than a volume can have
std::optional<RawVolume> follow_first_page(const TiffStack& stack, const LabelGrid& page,
                                           std::int64_t channels) {
  const TiffDescription& first = stack.description;
  const auto images = imagej_number(first.text, "images");
  if (stack.pages.size() != 1 || !images || !first.text.starts_with("ImageJ=") || first.compressed ||
      stack.pages[0].shape.tiled || !(*images > 1 && *images <= std::numeric_limits<int>::max()) ||
      static_cast<std::int64_t>(*images) % channels != 0)
    return std::nullopt;
  RawVolume raw{page, stack.files[0], first.first_offset, {}, {channels, 2}};
  raw.format.type = stack.pages[0].shape.type;
  const std::uint64_t page_bytes = voxel_data_bytes(page.size, raw.format.type);
  const std::uint64_t file_size = FileRanges(raw.file).size();
  const std::uint64_t there = file_size > raw.offset ? file_size - raw.offset : 0;
  // A page that was cut from a stack may keep its description. Two images and more without the others are a
  // stack that is truncated.
  if (there / 2 < page_bytes) return std::nullopt;
  const std::array<std::int64_t, 3> size{page.size[0], page.size[1],
                                         static_cast<std::int64_t>(*images) / channels};
  raw.grid.size = checked_size(size, raw.file, 0, max_source_voxels);
  // Nor do images follow each other where the page's entry is.
  const std::uint64_t directory = stack.pages[0].offset;
  if (directory >= raw.offset &&
      directory - raw.offset < voxel_data_bytes(raw.grid.size, raw.format.type, channels))
    return std::nullopt;
  raw.format.swap = first.big_endian == little_endian_machine;
  return raw;
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  const std::string_view whole_a = a, whole_b = b;
  while (!a.empty() && !b.empty()) {
    if (is_digit(a[0]) && is_digit(b[0])) {
      const std::string_view left = take_digits(a), right = take_digits(b);
      if (left.size() != right.size()) return left.size() < right.size();
      if (left != right) return left < right;
      continue;
    }
    if (a[0] != b[0]) return static_cast<unsigned char>(a[0]) < static_cast<unsigned char>(b[0]);
    a.remove_prefix(1);
    b.remove_prefix(1);
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole_a < whole_b;
}

bool has_tiff_files(const std::string& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (is_tiff_file(*entry)) return true;
  return false;
}

std::unique_ptr<VoxelSource> open_tiff_stack(const std::string& path, std::size_t cache_bytes, VoxelUse use) {
  std::error_code error;
  TiffStack stack = fs::is_directory(path, error) ? pages_of_folder(path, use) : pages_of_file(path, use);
  const TiffPage& first = stack.pages[0].shape;
  const PageOrder order = page_order(stack.files[0], stack);
  LabelGrid grid;
  const auto pages = static_cast<std::int64_t>(stack.pages.size());
  std::array<std::int64_t, 3> size{first.width, first.height, pages};
  grid.size = checked_size(size, path, 0, max_source_voxels);
  if (const std::optional<Vec3> spacing = spacing_of(stack.files[0], stack.description))
    grid.directions = spacing->asDiagonal();
  else
    grid.spacing_assumed = true;
  check_geometry(grid, path);
  if (std::optional<RawVolume> raw = follow_first_page(stack, grid, order.channels))
    return open_raw_volume(std::move(*raw));
  if (pages % order.channels != 0)
    throw InputError(path + ": its " + std::to_string(pages) + " pages are not those of " +
                     std::to_string(order.channels) + " channels; save it again");
  size[2] = pages / order.channels;
  grid.size = checked_size(size, path, 0, max_source_voxels);
  ChunkLayout layout;
  layout.format.type = first.type;
  const std::size_t each = voxel_bytes(first.type);
  std::size_t rows = first.piece_height;
  if (!first.tiled) {
    const std::size_t joined = min_strips_bytes / (rows * first.width * each);
    rows = std::min<std::size_t>(rows * std::max<std::size_t>(joined, 1), first.height);
  }
  layout.size = {static_cast<int>(first.piece_width), static_cast<int>(rows), 1};
  layout.strides = {each, first.piece_width * each, rows * first.piece_width * each};
  layout.bytes = layout.strides[2];
  layout.channels = order.channels;
  return std::make_unique<TiffStackSource>(std::move(grid), layout, cache_bytes, std::move(stack), order);
}

}  // namespace tetwright

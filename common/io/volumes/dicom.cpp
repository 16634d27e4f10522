// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/dicom.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/io/encodings/byte_order.h"
#include "common/io/volumes/chunked_source.h"
#include "common/io/volumes/dicom_images.h"
#include "common/io/volumes/tiff_stack.h"
#include "common/lower_case.h"
#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

namespace fs = std::filesystem;

/// Distances of slices are equal if they differ by this part of them.
constexpr double distance_tolerance = 1e-2;
/// Directions and spacings of slices are equal if they differ by this part, which rounding to a few digits
/// may do.
constexpr double slice_tolerance = 1e-3;
/// Slices are at one position if they are nearer than this part of the distance of pixels.
constexpr double doubled_tolerance = 1e-2;

/// Series that an error names.
constexpr std::size_t max_named_series = 8;

bool is_dicom_name(const fs::path& file) { return lower_case(file.extension().string()) == ".dcm"; }

bool is_hidden(const fs::path& file) { return file.filename().string().starts_with('.'); }

/// The images of a series, and all their slices.
struct DicomSeries {
  std::vector<DicomImage> images;
  std::vector<DicomSlice> slices;
  std::vector<std::string> ignored;  ///< other files in the folder, without their folder

  void add(DicomFrames frames) {
    for (DicomSlice& slice : frames.slices) slice.image = images.size();
    images.push_back(std::move(frames.image));
    slices.insert(slices.end(), frames.slices.begin(), frames.slices.end());
  }
  const DicomImage& image(const DicomSlice& slice) const { return images[slice.image]; }
  std::string name(const DicomSlice& slice) const { return frame_name(image(slice), slice.frame); }
};

std::string file_of(const std::string& path) { return fs::path(path).filename().string(); }

/// \throws InputError if the images belong to several series
void check_one_series(const std::string& folder, const DicomSeries& series) {
  struct Count {
    std::string description, file;
    std::int64_t slices = 0;
  };
  std::map<std::string, Count> counts;
  for (const DicomImage& image : series.images) {
    Count& count = counts[image.series];
    if (count.slices == 0) count = {image.description, file_of(image.file)};
    count.slices += image.frames;
  }
  if (counts.size() < 2) return;
  std::string text;
  std::size_t named = 0;
  for (const auto& [uid, count] : counts) {
    if (named++ == max_named_series) {
      text += ", and others";
      break;
    }
    text += (named == 1 ? "" : "; ") + count.description + " with " + std::to_string(count.slices) +
            (count.slices == 1 ? " slice (" : " slices, the first ") + count.file +
            (count.slices == 1 ? ")" : "");
  }
  throw InputError(folder, 0,
                   "it has " + std::to_string(counts.size()) + " series: " + text +
                       "; keep the slices of one series in a folder of their own");
}

DicomSeries series_of_folder(const std::string& folder) {
  std::error_code error;
  std::vector<std::string> files;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code unknown;
    if (!is_hidden(entry->path()) && entry->is_regular_file(unknown)) files.push_back(entry->path().string());
  }
  if (error) throw InputError(folder, 0, "cannot read this folder: " + error.message());
  std::sort(files.begin(), files.end(), natural_less);
  DicomSeries series;
  std::vector<DicomImage> without_pixels;
  for (const std::string& file : files) {
    // A slice that lost its beginning must not be left out silently.
    const bool dicom = is_dicom_name(file) || is_dicom_file(file);
    DicomFrames frames = dicom ? read_dicom_frames(file) : DicomFrames();
    if (!frames.slices.empty()) {
      series.add(std::move(frames));
      continue;
    }
    series.ignored.push_back(file_of(file));
    if (dicom) without_pixels.push_back(std::move(frames.image));
  }
  if (series.images.empty())
    throw InputError(folder, 0,
                     "its DICOM files, such as " + series.ignored.front() +
                         ", have no pixels; give the folder with the slices of a series");
  check_one_series(folder, series);
  // Nor one that lost its end.
  for (const DicomImage& image : without_pixels)
    if (image.series == series.images.front().series)
      throw InputError(image.file, 0,
                       "it has no pixels, although it belongs to the series of the slices; copy or export it "
                       "again, or remove it from the folder");
  return series;
}

DicomSeries series_at(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return series_of_folder(path);
  DicomFrames frames = read_dicom_frames(path);
  if (frames.slices.empty())
    throw InputError(path, 0, "it is a DICOM file without pixels; give the slices of a series");
  DicomSeries series;
  series.add(std::move(frames));
  return series;
}

/// \throws InputError unless all images have one size, and all slices one orientation and spacing
void check_equal(const DicomSeries& series) {
  const DicomSlice& first = series.slices.front();
  const DicomImage& image = series.image(first);
  const auto text = [](const Vec3& v) { return short_number(v[0]) + " x " + short_number(v[1]); };
  for (const DicomImage& other : series.images)
    if (other.columns != image.columns || other.rows != image.rows)
      throw InputError(other.file, 0,
                       "it has " + std::to_string(other.columns) + " x " + std::to_string(other.rows) +
                           " pixels, and " + file_of(image.file) + " " + std::to_string(image.columns) +
                           " x " + std::to_string(image.rows) +
                           "; remove the slices that do not belong to the volume, such as overviews");
  for (const DicomSlice& slice : series.slices) {
    if ((slice.along_row - first.along_row).norm() > slice_tolerance ||
        (slice.along_column - first.along_column).norm() > slice_tolerance ||
        slice.oriented != first.oriented)
      throw InputError(series.name(slice), 0,
                       "its rows point along " + place_text(slice.along_row) + " and its columns along " +
                           place_text(slice.along_column) + ", and those of " + file_of(series.name(first)) +
                           " along " + place_text(first.along_row) + " and " +
                           place_text(first.along_column) +
                           "; remove the slices that do not belong to the volume, such as overviews");
    if (slice.spacing.has_value() != first.spacing.has_value() ||
        (slice.spacing && (*slice.spacing - *first.spacing).norm() > slice_tolerance * first.spacing->norm()))
      throw InputError(series.name(slice), 0,
                       "its pixels are " + (slice.spacing ? text(*slice.spacing) : "of unknown size") +
                           ", and those of " + file_of(series.name(first)) + " " +
                           (first.spacing ? text(*first.spacing) : "of unknown size") +
                           "; remove the slices that do not belong to the volume");
  }
}

/// \throws InputError unless all slices have a position, an orientation and a spacing
void check_placed(const DicomSeries& series) {
  // Frames of one file that lie in a row may lack an orientation.
  const bool one_file = series.images.size() == 1;
  for (const DicomSlice& slice : series.slices) {
    const char* missing = !slice.position                ? dicom::image_position.keyword
                          : !slice.oriented && !one_file ? dicom::image_orientation.keyword
                          : !slice.spacing               ? dicom::pixel_spacing.keyword
                                                         : nullptr;
    if (missing)
      throw InputError(series.name(slice), 0,
                       std::string("it has no ") + missing +
                           ", without which slices cannot be put together; export the series again, or "
                           "convert the slices to TIFF and give --spacing");
  }
}

/// \throws InputError if a distance between neighbours differs from most others
void check_distances(const std::string& path, const DicomSeries& series, const Vec3& normal) {
  const std::vector<DicomSlice>& slices = series.slices;
  std::vector<double> distances;
  const double one_position = doubled_tolerance * slices.front().spacing->head<2>().minCoeff();
  std::size_t doubled = 0, first_doubled = 0;
  for (std::size_t i = 1; i < slices.size(); ++i) {
    distances.push_back((*slices[i].position - *slices[i - 1].position).dot(normal));
    if (distances.back() < one_position && ++doubled == 1) first_doubled = i;
  }
  const auto between = [&](std::size_t i) {
    return file_of(series.name(slices[i - 1])) + " and " + file_of(series.name(slices[i]));
  };
  if (doubled > 0)
    throw InputError(path, 0,
                     between(first_doubled) + " are at one position, " +
                         place_text(*slices[first_doubled].position) + "; the series has " +
                         std::to_string(slices.size()) + " slices at " +
                         std::to_string(slices.size() - doubled) +
                         " positions, so remove those that are doubled, or belong to another time or echo");
  std::vector<double> sorted = distances;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  for (std::size_t i = 1; i < slices.size(); ++i)
    if (const double distance = distances[i - 1];
        std::fabs(distance - *middle) > distance_tolerance * *middle)
      throw InputError(path, 0,
                       "the distance between " + between(i) + " is " + short_number(distance) +
                           ", and between most other slices " + short_number(*middle) +
                           (distance > 1.5 * *middle
                                ? "; slices are missing: copy the whole series"
                                : "; slices must have equal distances: remove those that do not belong to "
                                  "the volume, or resample it"));
  const Vec3 step =
      (*slices.back().position - *slices.front().position) / static_cast<double>(distances.size());
  for (std::size_t i = 1; i < slices.size(); ++i) {
    const Vec3 difference = *slices[i].position - *slices[i - 1].position - step;
    if (difference.norm() > 2 * distance_tolerance * step.norm())
      throw InputError(path, 0,
                       "the step from " + between(i) + " is " +
                           place_text(*slices[i].position - *slices[i - 1].position) +
                           ", and the mean of all is " + place_text(step) +
                           "; positions must be on a line: export the series again");
  }
}

/// Sorts the slices, and finds their grid.
LabelGrid grid_of(const std::string& path, DicomSeries& series) {
  std::vector<DicomSlice>& slices = series.slices;
  check_equal(series);
  const DicomImage& image = series.image(slices.front());
  LabelGrid grid;
  const std::array<std::int64_t, 3> size{image.columns, image.rows, static_cast<std::int64_t>(slices.size())};
  grid.size = checked_size(size, path, 0, max_source_voxels);
  grid.ignored_files = std::move(series.ignored);
  if (slices.size() == 1)
    throw InputError(path, 0,
                     "it is one slice alone, and a volume has several; give the folder with all slices of "
                     "the series");
  if (series.images.size() == 1 && std::none_of(slices.begin(), slices.end(), [](const DicomSlice& s) {
        return s.position && s.spacing;
      })) {
    grid.spacing_assumed = true;
    return grid;
  }
  check_placed(series);
  const DicomSlice first = slices.front();
  const Vec3 normal = first.along_row.cross(first.along_column).normalized();
  std::stable_sort(slices.begin(), slices.end(), [&](const DicomSlice& a, const DicomSlice& b) {
    return a.position->dot(normal) < b.position->dot(normal);
  });
  check_distances(path, series, normal);
  grid.origin = *slices.front().position;
  grid.directions.col(0) = first.along_row * (*first.spacing)[0];
  grid.directions.col(1) = first.along_column * (*first.spacing)[1];
  grid.directions.col(2) =
      (*slices.back().position - *slices.front().position) / static_cast<double>(slices.size() - 1);
  grid.space = "left-posterior-superior";
  check_geometry(grid, path);
  return grid;
}

/// Converts the pixels of a slice to values of 64 bits.
void scale_pixels(const ByteBuffer& pixels, const VoxelFormat& format, ByteBuffer& out) {
  const auto convert = [&]<class Number>(Number /*zero*/) {
    for (std::size_t i = 0; i < pixels.size / sizeof(Number); ++i) {
      const double value =
          format.slope * static_cast<double>(load<Number>(pixels.data.get() + i * sizeof(Number), false)) +
          format.intercept;
      std::memcpy(out.data.get() + i * sizeof value, &value, sizeof value);
    }
  };
  switch (format.type) {
    case VoxelType::int8:
      return convert(std::int8_t{});
    case VoxelType::uint8:
      return convert(std::uint8_t{});
    case VoxelType::int16:
      return convert(std::int16_t{});
    case VoxelType::uint16:
      return convert(std::uint16_t{});
    case VoxelType::int32:
      return convert(std::int32_t{});
    case VoxelType::uint32:
      return convert(std::uint32_t{});
    case VoxelType::int64:
      return convert(std::int64_t{});
    case VoxelType::uint64:
      return convert(std::uint64_t{});
    case VoxelType::float32:
      return convert(float{});
    default:
      return convert(double{});
  }
}

class DicomSource final : public ChunkedSource {
 public:
  DicomSource(LabelGrid grid, const ChunkLayout& layout, std::size_t cache_bytes, DicomSeries series,
              bool scaled)
      : ChunkedSource(std::move(grid), layout, cache_bytes), series_(std::move(series)), scaled_(scaled) {}

 protected:
  ByteBuffer load_chunk(const ChunkNumber& chunk) const override {
    const DicomSlice& slice = slice_of(chunk);
    const DicomImage& image = series_.image(slice);
    ByteBuffer pixels = read_dicom_frame(image, slice.frame);
    if (!scaled_) return pixels;
    ByteBuffer out(layout().bytes);
    scale_pixels(pixels, {image.format.type, false, slice.slope, slice.intercept}, out);
    return out;
  }

  std::string chunk_name(const ChunkNumber& chunk) const override { return series_.name(slice_of(chunk)); }

  // No chunk is missing.
  MaterialTag fill_label(const ChunkNumber& /*chunk*/) const override { return 0; }
  float fill_value(const ChunkNumber& /*chunk*/) const override { return 0; }

 private:
  const DicomSlice& slice_of(const ChunkNumber& chunk) const {
    return series_.slices[static_cast<std::size_t>(chunk[2])];
  }

  DicomSeries series_;
  bool scaled_;  ///< chunks are values, since slices differ in type or scale
};

}  // namespace

bool has_dicom_files(const std::string& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code unknown;
    if (is_hidden(entry->path()) || !entry->is_regular_file(unknown)) continue;
    // Folders with thousands of pages are not opened file by file.
    const std::string extension = lower_case(entry->path().extension().string());
    if (extension == ".tif" || extension == ".tiff") continue;
    if (is_dicom_name(entry->path()) || is_dicom_file(entry->path().string())) return true;
  }
  return false;
}

std::unique_ptr<VoxelSource> open_dicom(const std::string& path, std::size_t cache_bytes, VoxelUse /*use*/) {
  DicomSeries series = series_at(path);
  LabelGrid grid = grid_of(path, series);
  const DicomSlice& first = series.slices.front();
  const DicomPixelFormat& format = series.image(first).format;
  const bool equal = std::all_of(series.slices.begin(), series.slices.end(), [&](const DicomSlice& slice) {
    return slice.slope == first.slope && slice.intercept == first.intercept &&
           series.image(slice).format.type == format.type;
  });
  ChunkLayout layout;
  if (equal)
    layout.format = {format.type, false, first.slope, first.intercept};
  else
    layout.format.type = VoxelType::float64;
  const std::size_t each = voxel_bytes(layout.format.type);
  const auto columns = static_cast<std::size_t>(grid.size[0]), rows = static_cast<std::size_t>(grid.size[1]);
  layout.size = {grid.size[0], grid.size[1], 1};
  layout.strides = {each, columns * each, rows * columns * each};
  layout.bytes = layout.strides[2];
  return std::make_unique<DicomSource>(std::move(grid), layout, cache_bytes, std::move(series), !equal);
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/nifti.h"

#include <cmath>
#include <memory>
#include <utility>

#include "common/io/encodings/byte_order.h"
#include "common/io/volumes/voxel_data.h"
#include "common/number_text.h"
#include "common/tolerances.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Offsets and types of the header fields of a version.
struct Layout {
  int header_size;
  std::size_t magic;
  std::size_t dim, dim_bytes;      ///< integers of 2 or 8 bytes
  std::size_t type;                ///< int16
  std::size_t pixdim, real_bytes;  ///< floats of 4 or 8 bytes, as all following ones
  std::size_t offset;              ///< a float, or an 8-byte integer
  std::size_t slope, intercept;
  std::size_t qform, sform, code_bytes;  ///< integers of 2 or 4 bytes
  std::size_t quaternion, qoffset, srow;
};
constexpr Layout version_1{348, 344, 40, 2, 70, 76, 4, 108, 112, 116, 252, 254, 2, 256, 268, 280};
constexpr Layout version_2{540, 4, 16, 8, 12, 104, 8, 168, 176, 184, 344, 348, 4, 352, 376, 400};

class NiftiHeader {
 public:
  NiftiHeader(std::string_view bytes, const std::string& name, VoxelUse use)
      : bytes_(bytes), name_(name), use_(use) {
    if (bytes_.empty()) fail("the file is empty");
    if (bytes_.size() < sizeof(std::int32_t))
      fail("only " + std::to_string(bytes_.size()) + " bytes; it is truncated");
    const auto size = load<std::int32_t>(bytes_.data(), false),
               other = load<std::int32_t>(bytes_.data(), true);
    const bool second = size == version_2.header_size || other == version_2.header_size;
    if (second) layout_ = &version_2;
    if (size != layout_->header_size && other != layout_->header_size)
      fail("the header's size is " + std::to_string(size) + ", not 348 or 540; is this a NIfTI file?");
    swap_ = size != layout_->header_size;
    if (bytes_.size() < header_size())
      fail("only " + std::to_string(bytes_.size()) + " bytes, but the header has " +
           std::to_string(header_size()) + "; the file is truncated");
    const std::string_view magic = bytes_.substr(layout_->magic, 4);
    const std::string_view number = second ? "2" : "1";
    detached_ = magic == "ni" + std::string(number) + std::string(1, '\0');
    if (!detached_ && magic != "n+" + std::string(number) + std::string(1, '\0'))
      fail("expected \"n+" + std::string(number) + "\" at byte " + std::to_string(layout_->magic) +
           ", found " + in_quotes(magic) +
           "; ANALYZE files do not define left and right; save the volume as NIfTI");
  }

  std::size_t header_size() const { return static_cast<std::size_t>(layout_->header_size); }
  /// Whether the voxels are in a separate .img file.
  bool detached() const { return detached_; }
  bool swap() const { return swap_; }

  std::array<int, 3> size(std::int64_t max_voxels) const {
    const std::int64_t axes = dim(0);
    if (axes < 3 || axes > 7)
      fail("dim[0] is " + std::to_string(axes) + "; " + name_of_use(use_) + " has 3 dimensions");
    std::array<std::int64_t, 3> sizes;
    for (int k = 1; k <= axes; ++k) {
      const std::int64_t n = dim(static_cast<std::size_t>(k));
      if (k <= 3)
        sizes[static_cast<std::size_t>(k - 1)] = n;
      else if (n != 1 && use_ == VoxelUse::labels)
        fail("dim[" + std::to_string(k) + "] is " + std::to_string(n) +
             (k == 4 ? "; a volume of a single time point is needed, save one of them"
                     : "; a volume with one label per voxel is needed"));
    }
    return checked_size(sizes, name_, 0, max_voxels);
  }

  /// Items of the axis of times or vectors.
  ChannelAxis channels(const std::array<int, 3>& size, std::int64_t max_voxels) const {
    ChannelAxis channels;
    for (std::size_t k = 4; k <= static_cast<std::size_t>(dim(0)); ++k) {
      const std::int64_t n = dim(k);
      if (n == 1) continue;
      if (channels.count != 1)
        fail("dim[" + std::to_string(k) + "] is " + std::to_string(n) +
             ", and an axis before it has several items, too; save one of its items");
      channels.count = n;
      check_channels(n, size, use_, name_, 0, max_voxels);
    }
    return channels;
  }

  VoxelFormat format() const {
    VoxelFormat format;
    format.type = type();
    format.swap = swap_;
    // A slope that is 0 or not finite means no scaling.
    const double slope = real(layout_->slope), intercept = real(layout_->intercept);
    if (slope != 0 && std::isfinite(slope)) {
      if (!std::isfinite(intercept)) fail("scl_inter is not finite; repair the header");
      format.slope = slope;
      format.intercept = intercept;
    }
    return format;
  }

  /// Offset of the first voxel in its file, bytes.
  std::size_t offset() const {
    const double offset = layout_ == &version_2 ? static_cast<double>(number<std::int64_t>(layout_->offset))
                                                : real(layout_->offset);
    // Four bytes after the header announce extensions.
    const std::size_t min_offset = detached_ ? 0 : header_size() + 4;
    if (offset == 0) return min_offset;
    if (!(offset >= static_cast<double>(min_offset) && offset < 0x1p31 && offset == std::floor(offset)))
      fail("vox_offset is " + text(offset) + ", not " + std::to_string(min_offset) +
           " or more; repair the header");
    return static_cast<std::size_t>(offset);
  }

  void read_geometry(LabelGrid& volume) const {
    // NIfTI's convention: x points right, y to the front, z up.
    volume.space = "right-anterior-superior";
    if (code(layout_->sform) > 0) {
      for (std::size_t row = 0; row < 3; ++row) {
        const auto r = static_cast<int>(row);
        for (std::size_t column = 0; column < 3; ++column)
          volume.directions(r, static_cast<int>(column)) = real(layout_->srow, 4 * row + column);
        volume.origin[r] = real(layout_->srow, 4 * row + 3);
      }
      return;
    }
    Vec3 spacing;
    for (int k = 0; k < 3; ++k) {
      spacing[k] = real(layout_->pixdim, static_cast<std::size_t>(k) + 1);
      if (!(spacing[k] > 0))
        fail("pixdim[" + std::to_string(k + 1) + "] is " + text(spacing[k]) +
             "; a spacing must be positive, repair the header");
    }
    if (code(layout_->qform) > 0) {
      volume.directions = rotation();
      if (real(layout_->pixdim) < 0) volume.directions.col(2) *= -1;
      for (int k = 0; k < 3; ++k) volume.origin[k] = real(layout_->qoffset, static_cast<std::size_t>(k));
    } else {
      volume.space.clear();  // the direction of x is not specified
    }
    volume.directions = volume.directions * spacing.asDiagonal();
  }

 private:
  template <class Number>
  Number number(std::size_t offset) const {
    return load<Number>(bytes_.data() + offset, swap_);
  }
  /// The i-th real number at `offset`.
  double real(std::size_t offset, std::size_t i = 0) const {
    return layout_->real_bytes == 8 ? number<double>(offset + 8 * i)
                                    : static_cast<double>(number<float>(offset + 4 * i));
  }
  std::int64_t dim(std::size_t i) const {
    return layout_->dim_bytes == 8 ? number<std::int64_t>(layout_->dim + 8 * i)
                                   : std::int64_t{number<std::int16_t>(layout_->dim + 2 * i)};
  }
  int code(std::size_t offset) const {
    return layout_->code_bytes == 4 ? number<std::int32_t>(offset) : int{number<std::int16_t>(offset)};
  }

  VoxelType type() const {
    const int type = number<std::int16_t>(layout_->type);
    switch (type) {
      case 2:
        return VoxelType::uint8;
      case 4:
        return VoxelType::int16;
      case 8:
        return VoxelType::int32;
      case 16:
        return VoxelType::float32;
      case 64:
        return VoxelType::float64;
      case 256:
        return VoxelType::int8;
      case 512:
        return VoxelType::uint16;
      case 768:
        return VoxelType::uint32;
      case 1024:
        return VoxelType::int64;
      case 1280:
        return VoxelType::uint64;
      default:
        fail("type " + std::to_string(type) + " (" + type_name(type) + ") of the voxels is not supported; " +
             numbers_to_save(use_, "save the labels as integers"));
    }
  }

  static const char* type_name(int type) {
    switch (type) {
      case 1:
        return "single bits";
      case 128:
        return "RGB colours";
      case 2304:
        return "RGBA colours";
      case 32:
      case 1792:
      case 2048:
        return "complex numbers";
      case 1536:
        return "floats of 128 bits";
      default:
        return "unknown";
    }
  }

  /// Rotation matrix of the unit quaternion (a, b, c, d). The header stores b, c, d; a >= 0 follows from
  /// them.
  Eigen::Matrix3d rotation() const {
    double b = real(layout_->quaternion), c = real(layout_->quaternion, 1), d = real(layout_->quaternion, 2);
    const double rest = 1 - (b * b + c * c + d * d);
    if (!std::isfinite(rest)) fail("the quaternion of the qform is not finite; repair the header");
    double a = 0;
    // Rounding may have made the quaternion of a half turn longer than 1.
    if (rest < tolerance::unit_quaternion) {
      const double length = std::sqrt(b * b + c * c + d * d);
      b /= length;
      c /= length;
      d /= length;
    } else {
      a = std::sqrt(rest);
    }
    Eigen::Matrix3d r;
    r << a * a + b * b - c * c - d * d, 2 * (b * c - a * d), 2 * (b * d + a * c),  //
        2 * (b * c + a * d), a * a + c * c - b * b - d * d, 2 * (c * d - a * b),   //
        2 * (b * d - a * c), 2 * (c * d + a * b), a * a + d * d - b * b - c * c;
    return r;
  }

  static std::string text(double value) {
    std::string out;
    append_number(out, value);
    return out;
  }

  [[noreturn]] void fail(const std::string& message) const { throw InputError(name_ + ": " + message); }

  std::string_view bytes_;
  const std::string& name_;
  VoxelUse use_;
  const Layout* layout_ = &version_1;
  bool swap_ = false, detached_ = false;
};

/// Voxel file of a header: "a.img" for "a.hdr", in upper case if the extension is.
std::string image_file_of(const std::string& name) {
  if (name.ends_with(".HDR")) return name.substr(0, name.size() - 4) + ".IMG";
  return (name.ends_with(".hdr") ? name.substr(0, name.size() - 4) : name) + ".img";
}

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

ByteSource source_of(std::string_view bytes, const std::string& name) {
  return {bytes, is_gzip(bytes) ? ByteSource::Packing::deflate : ByteSource::Packing::none, name};
}

std::string begins_behind_end(const std::string& file, std::uint64_t offset, std::uint64_t size) {
  return file + ": the voxels begin at byte " + std::to_string(offset) + " of " + std::to_string(size) +
         "; the file is truncated";
}

}  // namespace

EncodedVolume open_nifti(std::string_view bytes, const std::string& name, const FileReader& read_file,
                         VoxelUse use) {
  ByteSource source = source_of(bytes, name);
  // The header begins with its own size.
  std::string header_bytes(source.take(static_cast<std::size_t>(version_1.header_size)));
  if (header_bytes.size() >= 4 && (load<std::int32_t>(header_bytes.data(), false) == version_2.header_size ||
                                   load<std::int32_t>(header_bytes.data(), true) == version_2.header_size))
    header_bytes += source.take(static_cast<std::size_t>(version_2.header_size - version_1.header_size));
  const NiftiHeader header(header_bytes, name, use);
  LabelGrid volume;
  volume.size = header.size(max_volume_voxels);
  header.read_geometry(volume);
  check_geometry(volume, name);
  const ChannelAxis channels = header.channels(volume.size, max_volume_voxels);
  const VoxelFormat format = header.format();
  const auto skip_to_voxels = [&](ByteSource& voxels, const std::string& file, std::size_t taken) {
    const std::size_t between = header.offset() - taken;
    if (voxels.skip(between) < between)
      throw InputError(begins_behind_end(file, header.offset(), voxels.taken()));
  };
  if (!header.detached()) {
    skip_to_voxels(source, name, header.header_size());
    return {volume, channels, format, std::move(source)};
  }
  const std::string image = image_file_of(name);
  const auto image_bytes = std::make_shared<const std::string>(read_file(image));
  ByteSource voxels = source_of(*image_bytes, image);
  skip_to_voxels(voxels, image, 0);
  return {volume, channels, format, std::move(voxels), image_bytes};
}

LabelVolume read_nifti(std::string_view bytes, const std::string& name, const FileReader& read_file) {
  return labels_of(open_nifti(bytes, name, read_file, VoxelUse::labels));
}

std::optional<RawVolume> find_nifti(const HeaderBytes& head, const std::string& name, VoxelUse use) {
  if (is_gzip(head.bytes)) return std::nullopt;
  const NiftiHeader header(head.bytes, name, use);
  RawVolume found{{}, name, header.offset(), header.format()};
  found.grid.size = header.size(max_source_voxels);
  found.channels = header.channels(found.grid.size, max_source_voxels);
  header.read_geometry(found.grid);
  check_geometry(found.grid, name);
  std::uint64_t size = head.file_size;
  if (header.detached()) {
    found.file = image_file_of(name);
    const FileRanges image(found.file);
    if (is_gzip(image.head(2).view())) return std::nullopt;
    size = image.size();
  }
  if (found.offset > size) throw InputError(begins_behind_end(found.file, found.offset, size));
  return found;
}

}  // namespace tetwright

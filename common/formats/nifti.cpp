// Numbers in read functions are byte offsets in the header (nifti1.h, 2004).
#include "common/formats/nifti.h"

#include <cmath>

#include "common/error.h"
#include "common/formats/byte_order.h"
#include "common/formats/voxel_data.h"
#include "common/number_text.h"
#include "common/tolerances.h"

namespace tetwright {

namespace {

constexpr std::size_t nifti_header_size = 348;
/// Header and four bytes that say whether extensions follow.
constexpr std::size_t first_voxel = 352;

class NiftiHeader {
 public:
  NiftiHeader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {
    if (bytes_.empty()) fail("the file is empty");
    if (bytes_.size() < nifti_header_size)
      fail("only " + std::to_string(bytes_.size()) + " bytes, but the header has 348; the file is cut short");
    const auto size = load<std::int32_t>(bytes_.data(), false),
               other = load<std::int32_t>(bytes_.data(), true);
    if (size == 540 || other == 540) fail("NIfTI-2 is not supported; save the volume as NIfTI-1");
    if (size != 348 && other != 348)
      fail("the header's size is " + std::to_string(size) + ", not 348; is this a NIfTI file?");
    swap_ = size != 348;
    const std::string_view magic = bytes_.substr(344, 4);
    if (magic == std::string_view("ni1\0", 4))
      fail("the voxels are in another file (.hdr and .img); save the volume as one file .nii");
    if (magic != std::string_view("n+1\0", 4))
      fail("expected \"n+1\" at byte 344, found " + in_quotes(magic) +
           "; ANALYZE files say nothing of left and right, save the volume as NIfTI");
  }

  bool swap() const { return swap_; }

  std::array<int, 3> size() const {
    const int axes = number<std::int16_t>(40);  // dim
    if (axes < 3 || axes > 7)
      fail("dim[0] is " + std::to_string(axes) + "; a volume of labels has 3 dimensions");
    std::array<std::int64_t, 3> sizes;
    for (int k = 1; k <= axes; ++k) {
      const std::int64_t n = number<std::int16_t>(40 + 2 * static_cast<std::size_t>(k));
      if (k <= 3)
        sizes[static_cast<std::size_t>(k - 1)] = n;
      else if (n != 1)
        fail("dim[" + std::to_string(k) + "] is " + std::to_string(n) +
             (k == 4 ? "; a volume of one moment is needed, save one of them"
                     : "; a volume with one label a voxel is needed"));
    }
    return checked_size(sizes, name_, 0);
  }

  VoxelFormat format() const {
    VoxelFormat format;
    format.type = type();
    format.swap = swap_;
    // A slope of 0, or none that is a number, means no scaling.
    const double slope = number<float>(112), intercept = number<float>(116);
    if (slope != 0 && std::isfinite(slope)) {
      if (!std::isfinite(intercept)) fail("scl_inter is not finite; repair the header");
      format.slope = slope;
      format.intercept = intercept;
    }
    return format;
  }

  std::size_t offset() const {
    const double offset = number<float>(108);
    if (offset == 0) return first_voxel;
    if (!(offset >= first_voxel && offset < 0x1p31 && offset == std::floor(offset)))
      fail("vox_offset is " + text(offset) + ", not 352 or more; repair the header");
    return static_cast<std::size_t>(offset);
  }

  void read_geometry(LabelVolume& volume) const {
    // NIfTI's own definition: x to the right, y to the front, z up.
    volume.space = "right-anterior-superior";
    if (number<std::int16_t>(254) > 0) {  // sform_code
      for (std::size_t row = 0; row < 3; ++row) {
        const auto r = static_cast<int>(row);
        for (std::size_t column = 0; column < 3; ++column)
          volume.directions(r, static_cast<int>(column)) = number<float>(280 + 16 * row + 4 * column);
        volume.origin[r] = number<float>(280 + 16 * row + 12);
      }
      return;
    }
    Vec3 spacing;
    for (int k = 0; k < 3; ++k) {
      spacing[k] = number<float>(80 + 4 * static_cast<std::size_t>(k));
      if (!(spacing[k] > 0))
        fail("pixdim[" + std::to_string(k + 1) + "] is " + text(spacing[k]) +
             "; a spacing must be positive, repair the header");
    }
    if (number<std::int16_t>(252) > 0) {  // qform_code
      volume.directions = rotation();
      if (number<float>(76) < 0) volume.directions.col(2) *= -1;  // pixdim[0]
      for (int k = 0; k < 3; ++k) volume.origin[k] = number<float>(268 + 4 * static_cast<std::size_t>(k));
    } else {
      volume.space.clear();  // nothing is said of where x points to
    }
    volume.directions = volume.directions * spacing.asDiagonal();
  }

 private:
  template <class Number>
  Number number(std::size_t offset) const {
    return load<Number>(bytes_.data() + offset, swap_);
  }

  VoxelType type() const {
    const int type = number<std::int16_t>(70);
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
        fail("type " + std::to_string(type) + " (" + type_name(type) +
             ") of the voxels is not supported; save the labels as integers");
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

  /// Of the quaternion (a, b, c, d), of which the header has the last three; a >= 0 makes it a unit one.
  Eigen::Matrix3d rotation() const {
    double b = number<float>(256), c = number<float>(260), d = number<float>(264);
    const double rest = 1 - (b * b + c * c + d * d);
    if (!std::isfinite(rest)) fail("the quaternion of the qform is not finite; repair the header");
    double a = 0;
    // Rounding may have made a half turn's quaternion too long.
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
  bool swap_ = false;
};

}  // namespace

LabelVolume read_nifti(std::string_view bytes, const std::string& name) {
  ByteSource source(
      bytes, bytes.starts_with("\x1f\x8b") ? ByteSource::Packing::deflate : ByteSource::Packing::none, name);
  const std::string header_bytes(source.take(nifti_header_size));
  const NiftiHeader header(header_bytes, name);
  LabelVolume volume;
  volume.size = header.size();
  header.read_geometry(volume);
  check_geometry(volume, name);
  const VoxelFormat format = header.format();
  const std::size_t between = header.offset() - nifti_header_size;
  if (source.skip(between) < between)
    throw InputError(name + ": the voxels begin at byte " + std::to_string(header.offset()) + " of " +
                     std::to_string(source.taken()) + "; the file is cut short");
  volume.labels = read_voxels(source, format, volume.size);
  return volume;
}

}  // namespace tetwright

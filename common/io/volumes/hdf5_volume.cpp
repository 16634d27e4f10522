// SPDX-License-Identifier: Apache-2.0
#include "common/io/volumes/hdf5_volume.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "common/io/encodings/hdf5_handle.h"
#include "common/io/volumes/chunked_source.h"
#include "common/io/volumes/volume_axes.h"
#include "common/lower_case.h"
#include "common/message_text.h"
#include "tetwright/error.h"
#include "tetwright/io.h"

namespace tetwright {

namespace {

/// Datasets without chunks are read in rows of about this size, bytes.
constexpr std::int64_t contiguous_bytes = std::int64_t{1} << 20;

/// Longest text of an attribute, bytes. ilastik writes some hundred.
constexpr std::size_t max_attribute_bytes = std::size_t{1} << 16;

/// Serialises the calls of the library, which need not be built for several threads.
std::mutex& hdf5_mutex() {
  static std::mutex mutex;
  return mutex;
}

/// Type of numbers in the file, and in memory.
struct Hdf5Type {
  VoxelType type = VoxelType::uint8;
  hid_t memory = -1;
};

std::optional<Hdf5Type> number_type(hid_t stored) {
  const H5T_class_t kind = H5Tget_class(stored);
  if (kind == H5T_ENUM) {  // h5py stores booleans so
    const Hdf5Handle base(H5Tget_super(stored), H5Tclose);
    return base.good() ? number_type(base.id()) : std::nullopt;
  }
  const std::size_t bytes = H5Tget_size(stored);
  if (kind == H5T_FLOAT && bytes == 4) return Hdf5Type{VoxelType::float32, H5T_NATIVE_FLOAT};
  if (kind == H5T_FLOAT && bytes == 8) return Hdf5Type{VoxelType::float64, H5T_NATIVE_DOUBLE};
  if (kind != H5T_INTEGER) return std::nullopt;
  const bool whole = H5Tget_sign(stored) == H5T_SGN_2;
  if (bytes == 1)
    return whole ? Hdf5Type{VoxelType::int8, H5T_NATIVE_INT8} : Hdf5Type{VoxelType::uint8, H5T_NATIVE_UINT8};
  if (bytes == 2)
    return whole ? Hdf5Type{VoxelType::int16, H5T_NATIVE_INT16}
                 : Hdf5Type{VoxelType::uint16, H5T_NATIVE_UINT16};
  if (bytes == 4)
    return whole ? Hdf5Type{VoxelType::int32, H5T_NATIVE_INT32}
                 : Hdf5Type{VoxelType::uint32, H5T_NATIVE_UINT32};
  if (bytes == 8)
    return whole ? Hdf5Type{VoxelType::int64, H5T_NATIVE_INT64}
                 : Hdf5Type{VoxelType::uint64, H5T_NATIVE_UINT64};
  return std::nullopt;
}

std::vector<std::int64_t> shape_of(hid_t dataset) {
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  const int axes = space.good() ? H5Sget_simple_extent_ndims(space.id()) : 0;
  std::vector<hsize_t> size(static_cast<std::size_t>(std::max(axes, 0)));
  if (!size.empty()) H5Sget_simple_extent_dims(space.id(), size.data(), nullptr);
  std::vector<std::int64_t> out;
  out.reserve(size.size());
  for (const hsize_t n : size)
    out.push_back(static_cast<std::int64_t>(std::min<hsize_t>(n, static_cast<hsize_t>(max_source_voxels))));
  return out;
}

/// Paths of the datasets of three axes, beside those of one item, and whole numbers. Those of images have any
/// numbers, and may have an axis of channels.
struct VolumeDatasets {
  VoxelUse use;
  std::vector<std::string> paths = {};

  static herr_t take(hid_t file, const char* name, const H5O_info_t* info, void* user) {
    if (info->type != H5O_TYPE_DATASET) return 0;
    const Hdf5Handle dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
    if (!dataset.good()) return 0;
    const Hdf5Handle type(H5Dget_type(dataset.id()), H5Tclose);
    const std::vector<std::int64_t> shape = shape_of(dataset.id());
    const auto longer = std::count_if(shape.begin(), shape.end(), [](std::int64_t n) { return n != 1; });
    const H5T_class_t kind = H5Tget_class(type.id());
    auto& found = *static_cast<VolumeDatasets*>(user);
    const bool image = found.use == VoxelUse::image;
    if (shape.size() >= 3 && longer <= (image ? 4 : 3) &&
        (kind == H5T_INTEGER || kind == H5T_ENUM || (image && kind == H5T_FLOAT)))
      found.paths.push_back("/" + std::string(name));
    return 0;
  }
};

std::string only_dataset(hid_t file, const std::string& path, VoxelUse use) {
  VolumeDatasets found{use};
  if (H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_INC, VolumeDatasets::take, &found, H5O_INFO_BASIC) < 0)
    throw InputError(path, 0, "its list of datasets cannot be read; the file is damaged");
  if (found.paths.empty())
    throw InputError(path, 0,
                     std::string("it has no dataset of three axes and ") +
                         (use == VoxelUse::labels ? "whole numbers" : "numbers"));
  if (found.paths.size() > 1)
    throw InputError(path, 0,
                     "it has " + std::to_string(found.paths.size()) + " datasets of three axes (" +
                         quoted_list(found.paths) + "); name one: FILE:/DATASET");
  return found.paths[0];
}

/// The text of an attribute, or std::nullopt if it is missing, has not exactly one text, or a very long one.
std::optional<std::string> attribute_text(hid_t dataset, const char* name) {
  if (H5Aexists(dataset, name) <= 0) return std::nullopt;
  const Hdf5Handle attribute(H5Aopen(dataset, name, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose), type(H5Aget_type(attribute.id()), H5Tclose);
  // The library writes as many texts as there are.
  if (H5Tget_class(type.id()) != H5T_STRING || H5Sget_simple_extent_npoints(space.id()) != 1)
    return std::nullopt;
  if (H5Tis_variable_str(type.id()) > 0) {
    char* read = nullptr;
    if (H5Aread(attribute.id(), type.id(), static_cast<void*>(&read)) < 0 || !read) return std::nullopt;
    const std::unique_ptr<char, herr_t (*)(void*)> value(read, H5free_memory);
    const std::size_t bytes = std::strlen(value.get());
    if (bytes > max_attribute_bytes) return std::nullopt;
    return std::string(value.get(), bytes);
  }
  const std::size_t bytes = H5Tget_size(type.id());
  if (bytes > max_attribute_bytes) return std::nullopt;
  std::string text(bytes, '\0');
  if (H5Aread(attribute.id(), type.id(), text.data()) < 0) return std::nullopt;
  text.resize(std::min(text.find('\0'), text.size()));
  return text;
}

/// Names of the axes in ilastik's attribute, or none.
std::vector<std::string> axis_tags(hid_t dataset) {
  const std::optional<std::string> text = attribute_text(dataset, "axistags");
  if (!text) return {};
  const nlohmann::json tags = nlohmann::json::parse(*text, nullptr, false);
  std::vector<std::string> names;
  if (!tags.is_object() || !tags.contains("axes") || !tags["axes"].is_array()) return {};
  for (const nlohmann::json& axis : tags["axes"])
    names.push_back(axis.is_object() && axis.contains("key") && axis["key"].is_string()
                        ? lower_case(axis["key"].get<std::string>())
                        : std::string());
  return names;
}

/// Spacing along z, y and x, or std::nullopt.
std::optional<std::array<double, 3>> element_size(hid_t dataset) {
  constexpr const char* name = "element_size_um";
  if (H5Aexists(dataset, name) <= 0) return std::nullopt;
  const Hdf5Handle attribute(H5Aopen(dataset, name, H5P_DEFAULT), H5Aclose);
  const Hdf5Handle space(H5Aget_space(attribute.id()), H5Sclose), type(H5Aget_type(attribute.id()), H5Tclose);
  const H5T_class_t kind = H5Tget_class(type.id());
  std::array<double, 3> size{};
  if ((kind != H5T_FLOAT && kind != H5T_INTEGER) || H5Sget_simple_extent_npoints(space.id()) != 3 ||
      H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, size.data()) < 0)
    return std::nullopt;
  return size;
}

/// A dataset of an open file.
struct Hdf5Dataset {
  Hdf5Handle file, dataset;
  std::string name;  ///< file and dataset for messages
  std::vector<std::int64_t> shape, chunk;
  VolumeAxes axes;
  VoxelType type = VoxelType::uint8;
  Hdf5Handle memory;  ///< type of the numbers in memory
};

void check_filters(hid_t creation, const std::string& name) {
  for (int i = 0; i < H5Pget_nfilters(creation); ++i) {
    unsigned flags = 0, config = 0;
    std::size_t values = 0;
    std::array<char, 64> text{};
    const H5Z_filter_t filter = H5Pget_filter2(creation, static_cast<unsigned>(i), &flags, &values, nullptr,
                                               text.size() - 1, text.data(), &config);
    if (filter >= 0 && H5Zfilter_avail(filter) <= 0)
      throw InputError(
          name, 0,
          "it is compressed by the filter " + in_quotes(text[0] ? text.data() : std::to_string(filter)) +
              ", which the HDF5 library does not have; store it with gzip or without compression");
  }
}

Hdf5Dataset open_dataset(const std::string& path, std::string inside, VoxelUse use) {
  (void)FileRanges(path);  // says why a file cannot be read
  quiet_hdf5();
  Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.good()) throw InputError(path, 0, "this is not an HDF5 file, or it is damaged");
  if (inside.empty()) inside = only_dataset(file.id(), path, use);
  // Chunks are kept by this program.
  const Hdf5Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access.id(), 0, 0, 0);
  Hdf5Handle dataset(H5Dopen2(file.id(), inside.c_str(), access.id()), H5Dclose);
  const std::string name = path + ": dataset " + in_quotes(inside);
  if (!dataset.good()) throw InputError(name, 0, "it is missing, or is a group");
  const Hdf5Handle stored(H5Dget_type(dataset.id()), H5Tclose);
  const std::optional<Hdf5Type> type = number_type(stored.id());
  if (!type)
    throw InputError(name, 0,
                     use == VoxelUse::labels
                         ? "its items are not whole numbers; store the labels as integers"
                         : "its items are not numbers of 8 to 64 bits; " + numbers_to_save(use, {}));
  // Enumerations are read as they are, since the library converts them only to themselves. Their native
  // numbers have fewer bytes than the file's if those do not use all of their bits. The library writes beyond
  // its own buffer when it looks for the native type of such an enumeration (HDF5 1.10), so it is not asked.
  const bool enumeration = H5Tget_class(stored.id()) == H5T_ENUM;
  if (enumeration) {
    const Hdf5Handle base(H5Tget_super(stored.id()), H5Tclose);
    const Hdf5Handle native(H5Tget_native_type(base.id(), H5T_DIR_DEFAULT), H5Tclose);
    if (!native.good() || H5Tget_size(native.id()) != voxel_bytes(type->type))
      throw InputError(name, 0,
                       "its items are an enumeration of numbers that do not fill their bytes; store the "
                       "labels as integers");
  }
  Hdf5Handle memory(enumeration ? H5Tget_native_type(stored.id(), H5T_DIR_DEFAULT) : H5Tcopy(type->memory),
                    H5Tclose);
  Hdf5Dataset out{std::move(file), std::move(dataset), name, {}, {}, {}, type->type, std::move(memory)};
  out.shape = shape_of(out.dataset.id());
  out.axes = volume_axes(out.shape, axis_tags(out.dataset.id()), use, name);
  const Hdf5Handle creation(H5Dget_create_plist(out.dataset.id()), H5Pclose);
  check_filters(creation.id(), name);
  const std::size_t axes = out.shape.size();
  if (H5Pget_layout(creation.id()) == H5D_CHUNKED) {
    std::vector<hsize_t> chunk(axes);
    if (H5Pget_chunk(creation.id(), static_cast<int>(axes), chunk.data()) != static_cast<int>(axes))
      throw InputError(name, 0, "the size of its chunks cannot be read; the file is damaged");
    for (const hsize_t n : chunk) out.chunk.push_back(static_cast<std::int64_t>(n));
  } else {
    out.chunk.assign(axes, 1);
    auto left = static_cast<std::int64_t>(contiguous_bytes / voxel_bytes(type->type));
    for (std::size_t k = axes; k-- > 0 && left > 1;) {
      out.chunk[k] = std::clamp<std::int64_t>(out.shape[k], 1, left);
      left /= out.chunk[k];
    }
  }
  return out;
}

class Hdf5Source final : public ChunkedSource {
 public:
  Hdf5Source(LabelGrid grid, const ChunkLayout& layout, std::size_t cache_bytes, Hdf5Dataset dataset)
      : ChunkedSource(std::move(grid), layout, cache_bytes), file_(std::in_place, std::move(dataset)) {}
  ~Hdf5Source() override {
    const std::lock_guard lock(hdf5_mutex());
    file_.reset();
  }

 protected:
  ByteBuffer load_chunk(const ChunkNumber& chunk) const override {
    const std::size_t axes = file_->shape.size();
    std::vector<hsize_t> begin(axes, 0), count(axes, 1), origin(axes, 0), size(axes);
    for (std::size_t k = 0; k < axes; ++k) size[k] = static_cast<hsize_t>(file_->chunk[k]);
    const auto select = [&](std::size_t axis, int number) {
      begin[axis] = static_cast<hsize_t>(number) * size[axis];
      count[axis] = std::min<hsize_t>(size[axis], static_cast<hsize_t>(file_->shape[axis]) - begin[axis]);
    };
    for (std::size_t k = 0; k < 3; ++k) select(file_->axes.spatial[k], chunk[k]);
    if (file_->axes.channel) select(*file_->axes.channel, chunk[3]);
    ByteBuffer out(layout().bytes);
    const std::lock_guard lock(hdf5_mutex());
    quiet_hdf5();
    const Hdf5Handle from(H5Dget_space(file_->dataset.id()), H5Sclose);
    const Hdf5Handle to(H5Screate_simple(static_cast<int>(axes), size.data(), nullptr), H5Sclose);
    // Parts of a chunk beyond the dataset stay undefined.
    if (!from.good() || !to.good() ||
        H5Sselect_hyperslab(from.id(), H5S_SELECT_SET, begin.data(), nullptr, count.data(), nullptr) < 0 ||
        H5Sselect_hyperslab(to.id(), H5S_SELECT_SET, origin.data(), nullptr, count.data(), nullptr) < 0 ||
        H5Dread(file_->dataset.id(), file_->memory.id(), to.id(), from.id(), H5P_DEFAULT, out.data.get()) < 0)
      throw InputError(chunk_name(chunk) + " cannot be read; the file is damaged or truncated");
    return out;
  }

  std::string chunk_name(const ChunkNumber& chunk) const override {
    return file_->name + ": chunk (" + std::to_string(chunk[0]) + ", " + std::to_string(chunk[1]) + ", " +
           std::to_string(chunk[2]) + ")" +
           (file_->axes.channel ? " of channels " + std::to_string(chunk[3]) : "");
  }

  // The library fills chunks.
  MaterialTag fill_label(const ChunkNumber& /*chunk*/) const override { return 0; }
  float fill_value(const ChunkNumber& /*chunk*/) const override { return 0; }

 private:
  std::optional<Hdf5Dataset> file_;
};

}  // namespace

std::unique_ptr<VoxelSource> open_hdf5_volume(const std::string& path, const std::string& dataset,
                                              std::size_t cache_bytes, VoxelUse use) {
  std::unique_lock lock(hdf5_mutex());
  Hdf5Dataset opened = open_dataset(path, dataset, use);
  LabelGrid grid;
  std::array<std::int64_t, 3> size;
  for (std::size_t k = 0; k < 3; ++k) size[k] = opened.shape[opened.axes.spatial[k]];
  grid.size = checked_size(size, opened.name, 0, max_source_voxels);
  if (const auto spacing = element_size(opened.dataset.id()))
    grid.directions = Vec3((*spacing)[2], (*spacing)[1], (*spacing)[0]).asDiagonal();
  else
    grid.spacing_assumed = true;
  check_geometry(grid, opened.name);
  ChunkLayout layout;
  layout.format.type = opened.type;
  const std::size_t each = voxel_bytes(layout.format.type);
  layout.bytes = static_cast<std::size_t>(checked_chunk_bytes(opened.chunk, each, opened.name));
  const std::vector<std::size_t> strides = strides_of(opened.chunk, row_major_order(opened.chunk.size()));
  for (std::size_t k = 0; k < 3; ++k) {
    layout.size[k] = static_cast<int>(opened.chunk[opened.axes.spatial[k]]);
    layout.strides[k] = strides[opened.axes.spatial[k]] * each;
  }
  if (const std::optional<std::size_t> axis = opened.axes.channel) {
    layout.channels = opened.shape[*axis];
    check_channels(layout.channels, grid.size, use, opened.name, 0, max_source_voxels);
    layout.chunk_channels = opened.chunk[*axis];
    layout.channel_stride = strides[*axis] * each;
  }
  return std::make_unique<Hdf5Source>(std::move(grid), layout, cache_bytes, std::move(opened));
}

}  // namespace tetwright

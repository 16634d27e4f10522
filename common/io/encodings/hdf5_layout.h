// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <variant>

#include "common/io/encodings/hdf5_handle.h"
#include "common/io/encodings/hdf5_writer.h"
#include "tetwright/error.h"

/// The contents of HDF5 files, for writers of one process and of several. The latter are compiled for another
/// build of the HDF5 library, hence all of this is inline.
namespace tetwright::hdf5_layout {

inline constexpr std::size_t max_chunk_bytes = std::size_t{1} << 20;
inline constexpr unsigned compression_level = 4;

/// Type of numbers in the file and in memory.
struct Type {
  hid_t stored, native;
  std::size_t bytes;
};
/// \param kind index of Hdf5Numbers
inline Type type_of(std::size_t kind) {
  switch (kind) {
    case 0:
      return {H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, 8};
    case 1:
      return {H5T_STD_I64LE, H5T_NATIVE_INT64, 8};
    case 2:
      return {H5T_STD_I32LE, H5T_NATIVE_INT32, 4};
    default:
      return {H5T_STD_U8LE, H5T_NATIVE_UINT8, 1};
  }
}
/// Likewise, the numbers of values and their first byte.
inline std::size_t count_of(const Hdf5Numbers& numbers) {
  return std::visit([](const auto& values) { return values.size(); }, numbers);
}
inline const void* data_of(const Hdf5Numbers& numbers) {
  return std::visit([](const auto& values) -> const void* { return values.data(); }, numbers);
}

/// Rows and columns of a dataset, and the rows of each of its chunks, 0 if it is empty.
struct Shape {
  int dimensions;
  std::array<hsize_t, 2> size;
  hsize_t rows_of_chunk;
};
/// \param columns as for Hdf5Writer::add()
inline Shape shape_of(std::size_t values, std::size_t columns, std::size_t bytes) {
  const std::size_t wide = std::max<std::size_t>(columns, 1);
  Shape shape{columns == 0 ? 1 : 2, {values / wide, wide}, 0};
  if (shape.size[0] > 0)
    shape.rows_of_chunk = std::clamp<hsize_t>(max_chunk_bytes / (bytes * wide), 1, shape.size[0]);
  return shape;
}

/// \throws OutputError if a function of the library has failed
/// \param what it should have done
inline void check(bool done, const std::string& what) {
  if (!done) throw OutputError("the HDF5 library cannot " + what);
}
inline void check(herr_t result, const std::string& what) { check(result >= 0, what); }

enum class Storage {
  compressed,  ///< in chunks
  plain        ///< without chunks and fill values: several processes may write it independently
};

/// Creates a dataset without values.
/// \throws OutputError if that fails, as the functions below do
inline Hdf5Handle create(hid_t file, const std::string& name, const Type& type, const Shape& shape,
                         Storage storage) {
  const std::string what = "add the dataset '" + name + "'";
  const Hdf5Handle space(H5Screate_simple(shape.dimensions, shape.size.data(), nullptr), H5Sclose);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  check(space.good() && creation.good(), what);
  check(H5Pset_obj_track_times(creation.id(), false), what);  // same bytes for the same content
  if (storage == Storage::plain) {
    check(H5Pset_fill_time(creation.id(), H5D_FILL_TIME_NEVER), what);
  } else if (shape.rows_of_chunk > 0) {
    const std::array<hsize_t, 2> chunk{shape.rows_of_chunk, shape.size[1]};
    check(H5Pset_chunk(creation.id(), shape.dimensions, chunk.data()), what);
    check(H5Pset_deflate(creation.id(), compression_level), what);
  }
  Hdf5Handle dataset(
      H5Dcreate2(file, name.c_str(), type.stored, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
      H5Dclose);
  check(dataset.good(), what);
  return dataset;
}

inline void add_group(hid_t file, const std::string& name) {
  Hdf5Handle group(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  check(group.good() && group.close() >= 0, "add the group '" + name + "'");
}

inline void add_attribute(hid_t file, const std::string& group, const std::string& name, hid_t stored,
                          hid_t space, hid_t native, const void* values) {
  const std::string what = "add the attribute '" + name + "'";
  check(stored >= 0 && space >= 0, what);
  Hdf5Handle attribute(H5Acreate_by_name(file, group.c_str(), name.c_str(), stored, space, H5P_DEFAULT,
                                         H5P_DEFAULT, H5P_DEFAULT),
                       H5Aclose);
  check(attribute.good(), what);
  check(H5Awrite(attribute.id(), native, values), what);
  check(attribute.close(), what);
}
inline void add_attribute(hid_t file, const std::string& group, const std::string& name,
                          const std::string& text) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  const std::string what = "add the attribute '" + name + "'";
  check(type.good(), what);
  check(H5Tset_size(type.id(), text.size()), what);
  check(H5Tset_strpad(type.id(), H5T_STR_NULLPAD), what);
  add_attribute(file, group, name, type.id(), space.id(), type.id(), text.data());
}
inline void add_attribute(hid_t file, const std::string& group, const std::string& name,
                          std::span<const std::int64_t> values) {
  const hsize_t size = values.size();
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  add_attribute(file, group, name, H5T_STD_I64LE, space.id(), H5T_NATIVE_INT64, values.data());
}

}  // namespace tetwright::hdf5_layout

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

/// Creates an empty dataset.
inline Hdf5Handle create(hid_t file, const std::string& name, const Type& type, const Shape& shape) {
  const Hdf5Handle space(H5Screate_simple(shape.dimensions, shape.size.data(), nullptr), H5Sclose);
  const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.id(), false);  // same bytes for the same content
  if (shape.rows_of_chunk > 0) {
    const std::array<hsize_t, 2> chunk{shape.rows_of_chunk, shape.size[1]};
    H5Pset_chunk(creation.id(), shape.dimensions, chunk.data());
    H5Pset_deflate(creation.id(), compression_level);
  }
  return {H5Dcreate2(file, name.c_str(), type.stored, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
          H5Dclose};
}

inline void add_group(hid_t file, const std::string& name) {
  const Hdf5Handle group(H5Gcreate2(file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
  if (!group.good()) throw OutputError("the HDF5 library cannot add the group '" + name + "'");
}

inline void add_attribute(hid_t file, const std::string& group, const std::string& name, hid_t stored,
                          hid_t space, hid_t native, const void* values) {
  const Hdf5Handle attribute(H5Acreate_by_name(file, group.c_str(), name.c_str(), stored, space, H5P_DEFAULT,
                                               H5P_DEFAULT, H5P_DEFAULT),
                             H5Aclose);
  if (!attribute.good() || H5Awrite(attribute.id(), native, values) < 0)
    throw OutputError("the HDF5 library cannot add the attribute '" + name + "'");
}
inline void add_attribute(hid_t file, const std::string& group, const std::string& name,
                          const std::string& text) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  H5Tset_size(type.id(), text.size());
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  add_attribute(file, group, name, type.id(), space.id(), type.id(), text.data());
}
inline void add_attribute(hid_t file, const std::string& group, const std::string& name,
                          std::span<const std::int64_t> values) {
  const hsize_t size = values.size();
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  add_attribute(file, group, name, H5T_STD_I64LE, space.id(), H5T_NATIVE_INT64, values.data());
}

}  // namespace tetwright::hdf5_layout

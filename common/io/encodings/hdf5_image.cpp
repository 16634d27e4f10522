// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/hdf5_image.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <utility>

#include "common/io/encodings/hdf5_handle.h"
#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// A unique name for each file: the library shares open files that have the same name, even between threads.
std::string unique_name() {
  static std::atomic<std::uint64_t> number{0};
  return "tetwright-" + std::to_string(number++);
}

/// Access properties of a file in memory that is never written to disk.
Hdf5Handle in_memory() {
  constexpr std::size_t increment = std::size_t{1} << 20;
  Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access.id(), increment, false);
  return access;
}

constexpr std::size_t max_chunk_bytes = std::size_t{1} << 20;
constexpr unsigned compression_level = 4;

}  // namespace

struct Hdf5Writer::File {
  Hdf5Handle handle;

  template <class Number>
  void add(const std::string& name, std::span<const Number> values, std::size_t columns, hid_t stored,
           hid_t native) {
    const int dimensions = columns == 0 ? 1 : 2;
    columns = std::max<std::size_t>(columns, 1);
    const std::array<hsize_t, 2> size{values.size() / columns, columns};
    const Hdf5Handle space(H5Screate_simple(dimensions, size.data(), nullptr), H5Sclose);
    const Hdf5Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(creation.id(), false);  // same bytes for the same content
    if (size[0] > 0) {
      const std::array<hsize_t, 2> chunk{
          std::clamp<hsize_t>(max_chunk_bytes / (sizeof(Number) * columns), 1, size[0]), columns};
      H5Pset_chunk(creation.id(), dimensions, chunk.data());
      H5Pset_deflate(creation.id(), compression_level);
    }
    const Hdf5Handle dataset(
        H5Dcreate2(handle.id(), name.c_str(), stored, space.id(), H5P_DEFAULT, creation.id(), H5P_DEFAULT),
        H5Dclose);
    if (!dataset.good() || H5Dwrite(dataset.id(), native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
      throw OutputError("the HDF5 library cannot write " + std::to_string(values.size()) + " numbers of '" +
                        name + "'; is there enough memory?");
  }

  void add_attribute(const std::string& group, const std::string& name, hid_t stored, hid_t space,
                     hid_t native, const void* values) {
    const Hdf5Handle attribute(H5Acreate_by_name(handle.id(), group.c_str(), name.c_str(), stored, space,
                                                 H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                               H5Aclose);
    if (!attribute.good() || H5Awrite(attribute.id(), native, values) < 0)
      throw OutputError("the HDF5 library cannot add the attribute '" + name + "'");
  }
};

Hdf5Writer::Hdf5Writer() {
  quiet_hdf5();
  const Hdf5Handle access = in_memory();
  file_ = std::make_unique<File>(
      File{Hdf5Handle(H5Fcreate(unique_name().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose)});
  if (!file_->handle.good()) throw OutputError("the HDF5 library cannot create a file in memory");
}
Hdf5Writer::~Hdf5Writer() = default;

void Hdf5Writer::add(const std::string& name, std::span<const double> values, std::size_t columns) {
  file_->add(name, values, columns, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE);
}
void Hdf5Writer::add(const std::string& name, std::span<const std::int64_t> values, std::size_t columns) {
  file_->add(name, values, columns, H5T_STD_I64LE, H5T_NATIVE_INT64);
}
void Hdf5Writer::add(const std::string& name, std::span<const std::int32_t> values, std::size_t columns) {
  file_->add(name, values, columns, H5T_STD_I32LE, H5T_NATIVE_INT32);
}
void Hdf5Writer::add(const std::string& name, std::span<const std::uint8_t> values, std::size_t columns) {
  file_->add(name, values, columns, H5T_STD_U8LE, H5T_NATIVE_UINT8);
}

void Hdf5Writer::add_group(const std::string& name) {
  const Hdf5Handle group(H5Gcreate2(file_->handle.id(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                         H5Gclose);
  if (!group.good()) throw OutputError("the HDF5 library cannot add the group '" + name + "'");
}

void Hdf5Writer::add_attribute(const std::string& group, const std::string& name, const std::string& text) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  H5Tset_size(type.id(), text.size());
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  file_->add_attribute(group, name, type.id(), space.id(), type.id(), text.data());
}
void Hdf5Writer::add_attribute(const std::string& group, const std::string& name,
                               std::span<const std::int64_t> values) {
  const hsize_t size = values.size();
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
  file_->add_attribute(group, name, H5T_STD_I64LE, space.id(), H5T_NATIVE_INT64, values.data());
}

std::string Hdf5Writer::bytes() {
  H5Fflush(file_->handle.id(), H5F_SCOPE_GLOBAL);
  const ssize_t size = H5Fget_file_image(file_->handle.id(), nullptr, 0);
  std::string out(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
  if (size <= 0 || H5Fget_file_image(file_->handle.id(), out.data(), out.size()) != size)
    throw OutputError("the HDF5 library cannot return its file from memory");
  return out;
}

struct Hdf5Reader::File {
  explicit File(std::string of_bytes) : bytes(std::move(of_bytes)) {
    const Hdf5Handle access = in_memory();
    H5Pset_file_image(access.id(), bytes.data(), bytes.size());
    id = H5Fopen(unique_name().c_str(), H5F_ACC_RDONLY, access.id());
  }
  ~File() {
    if (id >= 0) H5Fclose(id);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  std::string bytes;
  hid_t id = -1;
};

Hdf5Reader::Hdf5Reader(std::string bytes, std::string name) : name_(std::move(name)) {
  quiet_hdf5();
  file_ = std::make_unique<File>(std::move(bytes));
  if (file_->id < 0) throw InputError(name_ + ": this is not an HDF5 file, or it is damaged");
}
Hdf5Reader::~Hdf5Reader() = default;

std::vector<double> Hdf5Reader::numbers(const std::string& dataset, std::size_t max_count) const {
  const auto fail = [&](const std::string& what) -> void {
    throw InputError(name_ + ": dataset " + in_quotes(dataset) + " " + what);
  };
  const Hdf5Handle set(H5Dopen2(file_->id, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.good()) fail("is missing; do the files belong together?");
  const Hdf5Handle type(H5Dget_type(set.id()), H5Tclose), space(H5Dget_space(set.id()), H5Sclose);
  const H5T_class_t kind = H5Tget_class(type.id());
  if (kind != H5T_INTEGER && kind != H5T_FLOAT) fail("does not hold numbers");
  const hssize_t n = H5Sget_simple_extent_npoints(space.id());
  if (n < 0 || static_cast<std::uint64_t>(n) > max_count)
    fail("has " + std::to_string(n) + " numbers, more than the " + std::to_string(max_count) + " expected");
  std::vector<double> values(static_cast<std::size_t>(n));
  if (n > 0 && H5Dread(set.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    fail("cannot be read; the file is damaged, or compressed by something other than zlib");
  return values;
}

}  // namespace tetwright

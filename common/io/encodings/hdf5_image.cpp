// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/hdf5_image.h"

#include <atomic>
#include <cstdint>
#include <utility>

#include "common/io/encodings/hdf5_handle.h"
#include "common/io/encodings/hdf5_layout.h"
#include "common/message_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// A unique name for each file: the library shares open files that have the same name, even between threads.
std::string unique_name() {
  static std::atomic<std::uint64_t> number{0};
  return "tetwright-" + std::to_string(number++);
}

constexpr const char* no_file = "create a file in memory";

/// Access properties of a file in memory that is never written to disk.
Hdf5Handle in_memory() {
  constexpr std::size_t increment = std::size_t{1} << 20;
  Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  hdf5_layout::check(access.good() && H5Pset_fapl_core(access.id(), increment, false) >= 0, no_file);
  return access;
}

}  // namespace

struct Hdf5Image::File {
  Hdf5Handle handle;
};

Hdf5Image::Hdf5Image() {
  quiet_hdf5();
  const Hdf5Handle access = in_memory();
  file_ = std::make_unique<File>(
      File{Hdf5Handle(H5Fcreate(unique_name().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose)});
  hdf5_layout::check(file_->handle.good(), no_file);
}
Hdf5Image::~Hdf5Image() = default;

void Hdf5Image::add(const std::string& name, const Hdf5Numbers& values, std::size_t columns) {
  const hdf5_layout::Type type = hdf5_layout::type_of(values.index());
  const std::size_t count = hdf5_layout::count_of(values);
  Hdf5Handle dataset =
      hdf5_layout::create(file_->handle.id(), name, type, hdf5_layout::shape_of(count, columns, type.bytes),
                          hdf5_layout::Storage::compressed);
  hdf5_layout::check(
      H5Dwrite(dataset.id(), type.native, H5S_ALL, H5S_ALL, H5P_DEFAULT, hdf5_layout::data_of(values)) >= 0 &&
          dataset.close() >= 0,
      "write " + std::to_string(count) + " numbers of '" + name + "'; is there enough memory?");
}

void Hdf5Image::add_group(const std::string& name) { hdf5_layout::add_group(file_->handle.id(), name); }
void Hdf5Image::add_attribute(const std::string& group, const std::string& name, const std::string& text) {
  hdf5_layout::add_attribute(file_->handle.id(), group, name, text);
}
void Hdf5Image::add_attribute(const std::string& group, const std::string& name,
                              std::span<const std::int64_t> values) {
  hdf5_layout::add_attribute(file_->handle.id(), group, name, values);
}

std::string Hdf5Image::bytes() {
  hdf5_layout::check(H5Fflush(file_->handle.id(), H5F_SCOPE_GLOBAL), "end its file in memory");
  const ssize_t size = H5Fget_file_image(file_->handle.id(), nullptr, 0);
  std::string out(size > 0 ? static_cast<std::size_t>(size) : 0, '\0');
  if (size <= 0 || H5Fget_file_image(file_->handle.id(), out.data(), out.size()) != size)
    throw OutputError("the HDF5 library cannot return its file from memory");
  return out;
}

struct Hdf5Reader::File {
  explicit File(std::string of_bytes) : bytes(std::move(of_bytes)) {
    const Hdf5Handle access = in_memory();
    hdf5_layout::check(H5Pset_file_image(access.id(), bytes.data(), bytes.size()), "copy a file in memory");
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

// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/netcdf_image.h"

#include "tetwright/error.h"

#ifdef TETWRIGHT_WITH_NETCDF
#include <netcdf.h>
#include <netcdf_mem.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <mutex>
#include <string_view>
#include <utility>
#endif

namespace tetwright {

#ifdef TETWRIGHT_WITH_NETCDF

namespace {

void check_netcdf(int status, const std::string& what) {
  if (status != NC_NOERR)
    throw OutputError("the netCDF library cannot write " + what + ": " + nc_strerror(status) +
                      (status == NC_ENOMEM ? "; is there enough memory?" : ""));
}

nc_type type_in_file(NetcdfType type) {
  switch (type) {
    case NetcdfType::text:
      return NC_CHAR;
    case NetcdfType::int32:
      return NC_INT;
    case NetcdfType::int64:
      return NC_INT64;
    case NetcdfType::real:
      break;
  }
  return NC_DOUBLE;
}

std::mutex& netcdf_mutex() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

bool has_netcdf() { return true; }

struct NetcdfWriter::File {
  std::lock_guard<std::mutex> lock{netcdf_mutex()};
  int id = -1;

  ~File() {
    if (id < 0) return;
    NC_memio unused{};
    nc_close_memio(id, &unused);
    std::free(unused.memory);
  }

  /// Sizes of a variable's dimensions; a record dimension counts as one.
  std::vector<std::size_t> shape(int variable) const {
    int count = 0, record = -1;
    nc_inq_varndims(id, variable, &count);
    nc_inq_unlimdim(id, &record);
    std::vector<int> dimensions(static_cast<std::size_t>(count));
    nc_inq_vardimid(id, variable, dimensions.data());
    std::vector<std::size_t> sizes;
    for (const int dimension : dimensions) {
      std::size_t size = 1;
      if (dimension != record) nc_inq_dimlen(id, dimension, &size);
      sizes.push_back(size);
    }
    return sizes;
  }

  template <class Number>
  void put(int variable, std::span<const Number> values,
           int (*put_values)(int, int, const std::size_t*, const std::size_t*, const Number*)) const {
    const std::vector<std::size_t> count = shape(variable);
    std::size_t all = 1;
    for (const std::size_t n : count) all *= n;
    TETWRIGHT_CHECK(all == values.size());
    const std::vector<std::size_t> first(count.size(), 0);
    check_netcdf(put_values(id, variable, first.data(), count.data(), values.data()),
                 std::to_string(all) + " values");
  }
};

NetcdfWriter::NetcdfWriter(NetcdfForm form, std::size_t min_bytes) : file_(std::make_unique<File>()) {
  const int format = form == NetcdfForm::data64 ? NC_64BIT_DATA : NC_64BIT_OFFSET;
  check_netcdf(nc_create_mem("tetwright", format, min_bytes, &file_->id), "a file in memory");
}
NetcdfWriter::~NetcdfWriter() = default;

int NetcdfWriter::dimension(const std::string& name, std::size_t size) {
  // A size of 0 would make it a record dimension.
  TETWRIGHT_CHECK(size > 0);
  int dimension = 0;
  check_netcdf(nc_def_dim(file_->id, name.c_str(), size, &dimension), "the dimension " + name);
  return dimension;
}

int NetcdfWriter::record_dimension(const std::string& name) {
  int dimension = 0;
  check_netcdf(nc_def_dim(file_->id, name.c_str(), NC_UNLIMITED, &dimension), "the dimension " + name);
  return dimension;
}

int NetcdfWriter::variable(const std::string& name, NetcdfType type, const std::vector<int>& dimensions) {
  int variable = 0;
  check_netcdf(nc_def_var(file_->id, name.c_str(), type_in_file(type), static_cast<int>(dimensions.size()),
                          dimensions.data(), &variable),
               "the variable " + name);
  return variable;
}

void NetcdfWriter::attribute(int variable, const std::string& name, const std::string& text) {
  check_netcdf(nc_put_att_text(file_->id, variable, name.c_str(), text.size(), text.data()),
               "the attribute " + name);
}
void NetcdfWriter::attribute(int variable, const std::string& name, std::int32_t value) {
  check_netcdf(nc_put_att_int(file_->id, variable, name.c_str(), NC_INT, 1, &value), "the attribute " + name);
}
void NetcdfWriter::attribute(int variable, const std::string& name, float value) {
  check_netcdf(nc_put_att_float(file_->id, variable, name.c_str(), NC_FLOAT, 1, &value),
               "the attribute " + name);
}

void NetcdfWriter::end_definitions() { check_netcdf(nc_enddef(file_->id), "the header"); }

void NetcdfWriter::put(int variable, std::span<const double> values) {
  file_->put(variable, values, nc_put_vara_double);
}

void NetcdfWriter::put(int variable, std::span<const std::int64_t> values) {
  static_assert(sizeof(long long) == sizeof(std::int64_t));
  file_->put(variable, std::span(reinterpret_cast<const long long*>(values.data()), values.size()),
             nc_put_vara_longlong);
}

void NetcdfWriter::put(int variable, const std::vector<std::string>& texts) {
  const std::size_t length = file_->shape(variable).back();
  std::string padded;
  for (const std::string& text : texts) {
    TETWRIGHT_CHECK(text.size() < length);
    padded += text;
    padded.append(length - text.size(), '\0');
  }
  file_->put(variable, std::span<const char>(padded), nc_put_vara_text);
}

void NetcdfWriter::write_to(const ByteSink& sink) {
  NC_memio memory{};
  const int status = nc_close_memio(std::exchange(file_->id, -1), &memory);
  const std::unique_ptr<void, void (*)(void*)> owner(memory.memory, std::free);
  check_netcdf(status, "its file in memory");
  sink({static_cast<const char*>(memory.memory), memory.size});
}

#else

bool has_netcdf() { return false; }

struct NetcdfWriter::File {};

NetcdfWriter::NetcdfWriter(NetcdfForm /*form*/, std::size_t /*min_bytes*/) {
  throw OutputError("this program was built without the netCDF library");
}
NetcdfWriter::~NetcdfWriter() = default;
int NetcdfWriter::dimension(const std::string& /*name*/, std::size_t /*size*/) { return 0; }
int NetcdfWriter::record_dimension(const std::string& /*name*/) { return 0; }
int NetcdfWriter::variable(const std::string& /*name*/, NetcdfType /*type*/,
                           const std::vector<int>& /*dimensions*/) {
  return 0;
}
void NetcdfWriter::attribute(int /*variable*/, const std::string& /*name*/, const std::string& /*text*/) {}
void NetcdfWriter::attribute(int /*variable*/, const std::string& /*name*/, std::int32_t /*value*/) {}
void NetcdfWriter::attribute(int /*variable*/, const std::string& /*name*/, float /*value*/) {}
void NetcdfWriter::end_definitions() {}
void NetcdfWriter::put(int /*variable*/, std::span<const double> /*values*/) {}
void NetcdfWriter::put(int /*variable*/, std::span<const std::int64_t> /*values*/) {}
void NetcdfWriter::put(int /*variable*/, const std::vector<std::string>& /*texts*/) {}
void NetcdfWriter::write_to(const ByteSink& /*sink*/) {}

#endif

}  // namespace tetwright

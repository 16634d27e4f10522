// SPDX-License-Identifier: Apache-2.0
#include "tools/mpi/parallel_hdf5.h"

#include <fcntl.h>
#include <hdf5.h>
#include <mpi.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <utility>

#include "common/files/byte_archive.h"
#include "common/io/encodings/hdf5_handle.h"
#include "common/io/encodings/hdf5_layout.h"
#include "tetwright/error.h"
#include "tetwright/files.h"
#include "tools/app/exit_status.h"
#include "tools/app/printed_report.h"

namespace tetwright {

enum class StepKind : std::uint8_t { group, text, numbers, dataset, end };

namespace {

/// The rows that a rank writes: whole chunks.
std::pair<hsize_t, hsize_t> rows_of(int rank, int size, const hdf5_layout::Shape& shape) {
  if (shape.rows_of_chunk == 0) return {0, 0};
  const hsize_t chunks = (shape.size[0] + shape.rows_of_chunk - 1) / shape.rows_of_chunk;
  const auto row = [&](int at) {
    return std::min(shape.size[0],
                    chunks * static_cast<hsize_t>(at) / static_cast<hsize_t>(size) * shape.rows_of_chunk);
  };
  return {row(rank), row(rank + 1)};
}

/// Files of this rank, for end_all().
std::string temporary_in_work, path_in_work;

/// Ends all ranks, since writing has failed in this one: others may already wait for it within the HDF5
/// library, which would not tell them.
[[noreturn]] void end_all() {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  // The first rank removes the file, and says so.
  if (unlink(temporary_in_work.c_str()) == 0)
    print_line("cannot write " + path_in_work + ": writing failed; is the disk full? (rank " +
               std::to_string(rank) + ")");
  (void)abandon_output_files();
  MPI_Abort(MPI_COMM_WORLD, static_cast<int>(ExitStatus::output_failed));
  _exit(static_cast<int>(ExitStatus::output_failed));
}

/// Writes by a function of MPI, and ends all ranks if not everything is written. Not all MPI report a full
/// disk as an error.
template <class Write>
int write_or_end(const Write& write, int count, MPI_Datatype type, MPI_Status* status) {
  MPI_Status own;
  if (status == MPI_STATUS_IGNORE) status = &own;
  const int error = write(status);
  MPI_Count written = 0, size = 0;
  MPI_Type_size_x(type, &size);
  if (error == MPI_SUCCESS) MPI_Get_elements_x(status, MPI_BYTE, &written);
  if (error != MPI_SUCCESS || written != count * size) end_all();
  return error;
}

}  // namespace

}  // namespace tetwright

// The HDF5 library, too, calls these instead of MPI's own functions (the profiling interface of MPI).
extern "C" {
int MPI_File_write_at(MPI_File file, MPI_Offset offset, const void* bytes, int count, MPI_Datatype type,
                      MPI_Status* status) {
  return tetwright::write_or_end(
      [&](MPI_Status* to) { return PMPI_File_write_at(file, offset, bytes, count, type, to); }, count, type,
      status);
}
int MPI_File_write_at_all(MPI_File file, MPI_Offset offset, const void* bytes, int count, MPI_Datatype type,
                          MPI_Status* status) {
  return tetwright::write_or_end(
      [&](MPI_Status* to) { return PMPI_File_write_at_all(file, offset, bytes, count, type, to); }, count,
      type, status);
}
}

namespace tetwright {

/// A step that all ranks take together, as rank 0 sends it.
struct Hdf5Step {
  StepKind kind;
  std::string name, group, text;
  std::vector<std::int64_t> numbers;
  std::uint64_t type = 0, values = 0, columns = 0;  ///< of a dataset
  std::string slab;                                 ///< bytes of the rows that the receiver writes
};

template <class Archive, IsType<Hdf5Step> T>
void archive(Archive& members, T& step) {
  members(step.kind, step.name, step.group, step.text, step.numbers, step.type, step.values, step.columns,
          step.slab);
}

struct ParallelHdf5::File {
  Hdf5Handle handle;
  // Closing would wait for the others, which may have failed.
  ~File() { handle.release(); }
};

ParallelHdf5::ParallelHdf5(const std::string& temporary, std::string path, Transport transport)
    : temporary_(temporary), path_(std::move(path)), transport_(std::move(transport)) {
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  quiet_hdf5();
  // MPI would make files of their own on machines that have another folder.
  agree(::access(temporary.c_str(), W_OK) == 0
            ? ""
            : "its temporary file " + temporary + " is not seen; all ranks must see the folder");
  temporary_in_work = temporary_;
  path_in_work = path_;
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_mpio(access.id(), MPI_COMM_WORLD, MPI_INFO_NULL);
  file_.reset(
      new File{Hdf5Handle(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), H5Fclose)});
  agree(file_->handle.good() ? "" : "the HDF5 library cannot create it");
}
ParallelHdf5::~ParallelHdf5() = default;

void ParallelHdf5::agree(const std::string& failure) const {
  const int none = size_;
  int first = failure.empty() ? none : rank_;
  MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (first == none) return;
  // The text of the first rank that failed, for rank 0.
  std::array<char, 1000> text{};
  failure.copy(text.data(), text.size() - 1);
  MPI_Bcast(text.data(), static_cast<int>(text.size()), MPI_CHAR, first, MPI_COMM_WORLD);
  throw OutputError("cannot write " + path_ + ": " + text.data() +
                    (first > 0 ? " (rank " + std::to_string(first) + ")" : ""));
}

void ParallelHdf5::tell(const Hdf5Step& step) const {
  ByteWriter writer;
  writer(step);
  for (int rank = 1; rank < size_; ++rank) transport_.send(writer.bytes, rank);
}

void ParallelHdf5::carry_out(const Hdf5Step& step) {
  std::string failure;
  try {
    carry_out_here(step);
  } catch (const std::exception& e) {
    failure = e.what();
  }
  agree(failure);
}

void ParallelHdf5::carry_out_here(const Hdf5Step& step) {
  const hid_t file = file_->handle.id();
  if (step.kind == StepKind::group) hdf5_layout::add_group(file, step.name);
  if (step.kind == StepKind::text) hdf5_layout::add_attribute(file, step.group, step.name, step.text);
  if (step.kind == StepKind::numbers) hdf5_layout::add_attribute(file, step.group, step.name, step.numbers);
  if (step.kind != StepKind::dataset) return;
  const hdf5_layout::Type type = hdf5_layout::type_of(step.type);
  const hdf5_layout::Shape shape = hdf5_layout::shape_of(step.values, step.columns, type.bytes);
  const Hdf5Handle dataset = hdf5_layout::create(file, step.name, type, shape);
  if (!dataset.good()) throw OutputError("the HDF5 library cannot add the dataset '" + step.name + "'");
  if (shape.size[0] == 0) return;
  const auto [begin, end] = rows_of(rank_, size_, shape);
  const std::array<hsize_t, 2> start{begin, 0}, count{end - begin, shape.size[1]};
  const Hdf5Handle space(H5Dget_space(dataset.id()), H5Sclose),
      memory(H5Screate_simple(shape.dimensions, count.data(), nullptr), H5Sclose);
  if (count[0] > 0) {
    H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  } else {
    H5Sselect_none(space.id());
    H5Sselect_none(memory.id());
  }
  // Compressed chunks can only be written by all ranks together.
  const Hdf5Handle transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_dxpl_mpio(transfer.id(), H5FD_MPIO_COLLECTIVE);
  if (H5Dwrite(dataset.id(), type.native, memory.id(), space.id(), transfer.id(), step.slab.data()) < 0)
    throw OutputError("the HDF5 library cannot write the dataset '" + step.name + "'; is the disk full?");
}

void ParallelHdf5::add_group(const std::string& name) {
  const Hdf5Step step{.kind = StepKind::group, .name = name};
  tell(step);
  carry_out(step);
}
void ParallelHdf5::add_attribute(const std::string& group, const std::string& name, const std::string& text) {
  const Hdf5Step step{.kind = StepKind::text, .name = name, .group = group, .text = text};
  tell(step);
  carry_out(step);
}
void ParallelHdf5::add_attribute(const std::string& group, const std::string& name,
                                 std::span<const std::int64_t> values) {
  const Hdf5Step step{
      .kind = StepKind::numbers, .name = name, .group = group, .numbers = {values.begin(), values.end()}};
  tell(step);
  carry_out(step);
}

void ParallelHdf5::add(const std::string& name, const Hdf5Numbers& values, std::size_t columns) {
  const std::size_t bytes = hdf5_layout::type_of(values.index()).bytes;
  const std::size_t count = hdf5_layout::count_of(values);
  const hdf5_layout::Shape shape = hdf5_layout::shape_of(count, columns, bytes);
  Hdf5Step step{
      .kind = StepKind::dataset, .name = name, .type = values.index(), .values = count, .columns = columns};
  for (int rank = size_ - 1; rank >= 0; --rank) {
    const auto [begin, end] = rows_of(rank, size_, shape);
    step.slab.assign(static_cast<const char*>(hdf5_layout::data_of(values)) + begin * shape.size[1] * bytes,
                     (end - begin) * shape.size[1] * bytes);
    if (rank == 0) break;
    ByteWriter writer;
    writer(step);
    transport_.send(writer.bytes, rank);
  }
  carry_out(step);
}

void ParallelHdf5::close() {
  tell({.kind = StepKind::end});
  end();
}

void ParallelHdf5::follow() {
  for (;;) {
    const std::string bytes = transport_.receive();
    Hdf5Step step{};
    ByteReader reader(bytes, path_, "a message of rank 0 is incomplete");
    reader(step);
    if (step.kind == StepKind::end) break;
    carry_out(step);
  }
  end();
}

void ParallelHdf5::end() {
  const herr_t closed = H5Fclose(file_->handle.release());
  std::string failure = closed < 0 ? "the HDF5 library cannot end the file; is the disk full?" : "";
  const int file = open(temporary_.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0 || fsync(file) != 0)
    failure = std::string("syncing to the disk failed: ") + std::strerror(errno);
  if (file >= 0) ::close(file);
  agree(failure);
}

}  // namespace tetwright

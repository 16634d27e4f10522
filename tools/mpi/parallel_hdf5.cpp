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
#include "tools/app/interruption.h"
#include "tools/mpi/end_all_ranks.h"

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

/// The file that this rank writes, for MPI_File_write_at().
std::string temporary_in_work, path_in_work;

}  // namespace

}  // namespace tetwright

// The HDF5 library, too, calls this one instead of MPI's own (the profiling interface of MPI). It ends all
// ranks if writing fails: HDF5 may go on to wait for the others, though not in the call in which they wait
// for this rank. OpenMPI reports a full disk by the count alone.
extern "C" int MPI_File_write_at(MPI_File file, MPI_Offset offset, const void* bytes, int count,
                                 MPI_Datatype type, MPI_Status* status) {
  MPI_Status own;
  if (status == MPI_STATUS_IGNORE) status = &own;
  const int error = PMPI_File_write_at(file, offset, bytes, count, type, status);
  MPI_Count written = 0, size = 0;
  MPI_Type_size_x(type, &size);
  if (error == MPI_SUCCESS) MPI_Get_elements_x(status, MPI_BYTE, &written);
  if (error != MPI_SUCCESS || written != count * size)
    tetwright::end_all_ranks(tetwright::temporary_in_work, tetwright::path_in_work,
                             "writing failed; is the disk full?");
  return error;
}

namespace tetwright {

/// A step that all ranks take together, as rank 0 sends it.
struct Hdf5Step {
  StepKind kind;
  std::string name = {}, group = {}, text = {};
  std::vector<std::int64_t> numbers = {};
  std::uint64_t type = 0, values = 0, columns = 0;  ///< of a dataset
  std::string slab = {};                            ///< bytes of the rows that the receiver writes
};

template <class Archive, IsType<Hdf5Step> T>
void archive(Archive& members, T& step) {
  members(step.kind, step.name, step.group, step.text, step.numbers, step.type, step.values, step.columns,
          step.slab);
}

struct ParallelHdf5::File {
  File(const std::string& path, hid_t access, int for_sync)
      : handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose), sync(for_sync) {}
  // Ending the file would wait for the others, which may have failed.
  ~File() {
    handle.release();
    ::close(sync);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  Hdf5Handle handle;
  /// Opened before anything is written: syncing it reports what the system could not write since then.
  int sync;
};

ParallelHdf5::ParallelHdf5(const std::string& temporary, std::string path, Transport transport)
    : temporary_(temporary), path_(std::move(path)), transport_(std::move(transport)) {
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &size_);
  quiet_hdf5();
  // MPI would make files of their own on machines that have another folder.
  const int sync = open(temporary.c_str(), O_WRONLY | O_CLOEXEC);
  const std::string error = sync < 0 ? std::strerror(errno) : "";
  agree(sync >= 0 ? ""
                  : "its temporary file " + temporary +
                        " is not seen; all processes must see the folder: " + error);
  temporary_in_work = temporary_;
  path_in_work = path_;
  if (rank_ == 0) say_nothing_without(temporary_);
  end_all_if_it_throws([&] {
    const std::string what = "create its file";
    const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    hdf5_layout::check(access.good(), what);
    hdf5_layout::check(H5Pset_fapl_mpio(access.id(), MPI_COMM_WORLD, MPI_INFO_NULL), what);
    // OpenMPI reports success to all ranks if one of them fails in writing that they do together.
    hdf5_layout::check(H5Pset_coll_metadata_write(access.id(), false), what);
    file_ = std::make_unique<File>(temporary_, access.id(), sync);
    hdf5_layout::check(file_->handle.good(), what);
  });
}
ParallelHdf5::~ParallelHdf5() {
  if (rank_ == 0) say_nothing_without("");
}

void ParallelHdf5::end_all_if_it_throws(const std::function<void()>& action) const {
  try {
    action();
  } catch (const std::exception& e) {
    end_all_ranks(temporary_, path_, e.what());
  }
}

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

void ParallelHdf5::carry_out(const Hdf5Step& step) const {
  const hid_t file = file_->handle.id();
  if (step.kind == StepKind::group) hdf5_layout::add_group(file, step.name);
  if (step.kind == StepKind::text) hdf5_layout::add_attribute(file, step.group, step.name, step.text);
  if (step.kind == StepKind::numbers) hdf5_layout::add_attribute(file, step.group, step.name, step.numbers);
  if (step.kind == StepKind::dataset) add_dataset(step);
}

void ParallelHdf5::add_dataset(const Hdf5Step& step) const {
  const hdf5_layout::Type type = hdf5_layout::type_of(step.type);
  const hdf5_layout::Shape shape = hdf5_layout::shape_of(step.values, step.columns, type.bytes);
  Hdf5Handle dataset =
      hdf5_layout::create(file_->handle.id(), step.name, type, shape, hdf5_layout::Storage::plain);
  const std::string what = "write the dataset '" + step.name + "'; is the disk full?";
  const auto [begin, end] = rows_of(rank_, size_, shape);
  if (begin < end) {
    const std::array<hsize_t, 2> start{begin, 0}, count{end - begin, shape.size[1]};
    const Hdf5Handle space(H5Dget_space(dataset.id()), H5Sclose),
        memory(H5Screate_simple(shape.dimensions, count.data(), nullptr), H5Sclose),
        transfer(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
    hdf5_layout::check(space.good() && memory.good() && transfer.good(), what);
    hdf5_layout::check(
        H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr), what);
    // A failure is then that of the rank that writes.
    hdf5_layout::check(H5Pset_dxpl_mpio(transfer.id(), H5FD_MPIO_INDEPENDENT), what);
    hdf5_layout::check(
        H5Dwrite(dataset.id(), type.native, memory.id(), space.id(), transfer.id(), step.slab.data()), what);
  }
  hdf5_layout::check(dataset.close(), what);
}

void ParallelHdf5::take_step(const Hdf5Step& step) {
  ByteWriter writer;
  writer(step);
  for (int rank = 1; rank < size_; ++rank) transport_.send(writer.bytes, rank);
  end_all_if_it_throws([&] { carry_out(step); });
}

void ParallelHdf5::add_group(const std::string& name) { take_step({.kind = StepKind::group, .name = name}); }
void ParallelHdf5::add_attribute(const std::string& group, const std::string& name, const std::string& text) {
  take_step({.kind = StepKind::text, .name = name, .group = group, .text = text});
}
void ParallelHdf5::add_attribute(const std::string& group, const std::string& name,
                                 std::span<const std::int64_t> values) {
  take_step(
      {.kind = StepKind::numbers, .name = name, .group = group, .numbers = {values.begin(), values.end()}});
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
  end_all_if_it_throws([&] { carry_out(step); });
}

void ParallelHdf5::close() {
  take_step({.kind = StepKind::end});
  end();
}

void ParallelHdf5::follow() {
  end_all_if_it_throws([&] {
    for (;;) {
      const std::string bytes = transport_.receive();
      Hdf5Step step{};
      ByteReader reader(bytes, path_, "a message of rank 0 is incomplete");
      reader(step);
      if (step.kind == StepKind::end) return;
      carry_out(step);
    }
  });
  end();
}

void ParallelHdf5::end() {
  end_all_if_it_throws([&] {
    const std::string what = "end the file; is the disk full?";
    hdf5_layout::check(H5Fflush(file_->handle.id(), H5F_SCOPE_GLOBAL), what);
    hdf5_layout::check(file_->handle.close(), what);
  });
  // Here all ranks have written everything, or this one would wait or be ended.
  agree(fsync(file_->sync) == 0 ? "" : std::string("syncing to the disk failed: ") + std::strerror(errno));
}

}  // namespace tetwright

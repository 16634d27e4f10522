// SPDX-License-Identifier: Apache-2.0

// Writes arrays of 0, 1, 2.5 and 7 chunks by all ranks, and by rank 0 alone, for ranks_test.py to compare.
//   mpirun -n RANKS test_parallel_hdf5 TOGETHER.h5 ALONE.h5 [RANK]   whose third message is lost
#include <mpi.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <span>
#include <string>
#include <vector>

#include "common/io/encodings/hdf5_image.h"
#include "tetwright/error.h"
#include "tetwright/files.h"
#include "tools/mpi/parallel_hdf5.h"

namespace tetwright {
namespace {

constexpr std::size_t chunk = std::size_t{1} << 20;  ///< bytes

template <class Number>
void add(Hdf5Writer& file, const std::string& name, std::size_t rows, std::size_t columns) {
  std::vector<Number> numbers(rows * std::max<std::size_t>(columns, 1));
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<Number>(i % 251);
  file.add(name, std::span<const Number>(numbers), columns);
}

void add_all(Hdf5Writer& file) {
  file.add_group("group");
  file.add_attribute("group", "text", "a text");
  file.add_attribute("group", "numbers", std::vector<std::int64_t>{1, 2, 3});
  add<double>(file, "empty", 0, 3);
  add<double>(file, "empty list", 0, 0);
  add<std::uint8_t>(file, "one number", 1, 0);
  add<std::int32_t>(file, "one chunk", chunk / 4, 0);
  add<std::int64_t>(file, "group/two chunks and a half", chunk * 5 / 2 / (4 * 8), 4);
  add<std::uint8_t>(file, "seven chunks", 7 * chunk, 0);
  // A chunk has less than its greatest size, and the last one a single row.
  add<double>(file, "rows of three", 2 * (chunk / 24) + 1, 3);
}

std::string receive() {
  std::uint64_t size = 0;
  MPI_Recv(&size, 1, MPI_UINT64_T, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  std::string bytes(size, '\0');
  MPI_Recv(bytes.data(), static_cast<int>(size), MPI_BYTE, 0, 0, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return bytes;
}

void send(const std::string& bytes, int rank) {
  const std::uint64_t size = bytes.size();
  MPI_Send(&size, 1, MPI_UINT64_T, rank, 0, MPI_COMM_WORLD);
  MPI_Send(bytes.data(), static_cast<int>(size), MPI_BYTE, rank, 0, MPI_COMM_WORLD);
}

/// \param failing rank whose third message is lost
void write(const std::string& together, const std::string& alone, int failing) {
  int rank = 0;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  if (rank == 0) write_file_atomically(together, "");
  MPI_Barrier(MPI_COMM_WORLD);
  ParallelHdf5 file(together, together, {send, [&, messages = 0]() mutable {
                                           if (rank == failing && ++messages == 3)
                                             throw InternalError("a lost message");
                                           return receive();
                                         }});
  if (rank > 0) {
    file.follow();
    return;
  }
  add_all(file);
  file.close();
  Hdf5Image image;
  add_all(image);
  const std::string bytes = image.bytes();
  write_file_atomically(alone, bytes);
}

}  // namespace
}  // namespace tetwright

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  try {
    if (argc > 2) tetwright::write(argv[1], argv[2], argc > 3 ? std::atoi(argv[3]) : -1);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "test_parallel_hdf5: %s\n", e.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Finalize();
  return argc > 2 ? 0 : 2;
}

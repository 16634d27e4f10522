// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/io/encodings/hdf5_writer.h"

namespace tetwright {

struct Hdf5Step;

/// An HDF5 file that all ranks of MPI_COMM_WORLD write together, with the parallel build of the HDF5 library.
/// Each rank compresses and writes a range of the chunks of each dataset.
///
/// All ranks construct and close it at the same time. Rank 0 then adds contents as to any Hdf5Writer, and the
/// others call follow(), which does the same with what rank 0 sends. If a rank cannot write, it says so and
/// ends the processes of all, since others may already wait for it within the HDF5 library.
class ParallelHdf5 final : public Hdf5Writer {
 public:
  /// Sends bytes to a rank other than 0, and receives them from rank 0.
  struct Transport {
    std::function<void(const std::string& bytes, int rank)> send;
    std::function<std::string()> receive;
  };

  /// \param temporary an existing file, which is overwritten
  /// \param path for messages
  /// \throws OutputError in all ranks if any of them does not see the file, or cannot write it
  ParallelHdf5(const std::string& temporary, std::string path, Transport transport);
  ~ParallelHdf5() override;

  void add_group(const std::string& name) override;
  void add_attribute(const std::string& group, const std::string& name, const std::string& text) override;
  void add_attribute(const std::string& group, const std::string& name,
                     std::span<const std::int64_t> values) override;
  void add(const std::string& name, const Hdf5Numbers& values, std::size_t columns) override;

  /// Rank 0: ends the file, syncs it to disk and makes follow() return.
  void close();
  /// The other ranks: until close().
  void follow();

 private:
  struct File;

  /// Sends a step to all other ranks.
  void tell(const Hdf5Step& step) const;
  /// Does it in this rank, together with the others.
  void carry_out(const Hdf5Step& step);
  void carry_out_here(const Hdf5Step& step);
  /// Throws in all ranks if there is a failure in any of them.
  /// \param failure empty: none here
  void agree(const std::string& failure) const;
  void end();

  std::string temporary_, path_;
  Transport transport_;
  int rank_ = 0, size_ = 1;
  std::unique_ptr<File> file_;
};

}  // namespace tetwright

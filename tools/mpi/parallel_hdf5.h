// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/io/encodings/hdf5_writer.h"

namespace tetwright {

struct Hdf5Step;

/// An HDF5 file that all ranks of MPI_COMM_WORLD write together, with the parallel build of the HDF5 library.
/// Each rank writes a range of the rows of each dataset, independently of the others so that it knows whether
/// that has failed; hence datasets are not compressed, which ranks could only do together.
///
/// All ranks construct and close it at the same time. Rank 0 then adds contents as to any Hdf5Writer, and the
/// others call follow(), which does the same with what rank 0 sends. A rank that cannot write calls
/// end_all_ranks().
class ParallelHdf5 final : public Hdf5Writer {
 public:
  /// Sends bytes to a rank other than 0, and receives them from rank 0.
  struct Transport {
    std::function<void(const std::string& bytes, int rank)> send;
    std::function<std::string()> receive;
  };

  /// \param temporary an existing file, which is overwritten
  /// \param path for messages
  /// \throws OutputError in all ranks if any of them cannot open the file
  ParallelHdf5(const std::string& temporary, std::string path, Transport transport);
  ~ParallelHdf5() override;

  void add_group(const std::string& name) override;
  void add_attribute(const std::string& group, const std::string& name, const std::string& text) override;
  void add_attribute(const std::string& group, const std::string& name,
                     std::span<const std::int64_t> values) override;
  void add(const std::string& name, const Hdf5Numbers& values, std::size_t columns) override;

  /// Rank 0: ends the file, and returns once all ranks have written and synced it to disk.
  /// \throws OutputError in all ranks if any of them cannot sync it
  void close();
  /// The other ranks: until close(), whose errors it throws.
  void follow();

 private:
  struct File;

  /// Calls end_all_ranks() if `action` throws.
  void end_all_if_it_throws(const std::function<void()>& action) const;
  /// Rank 0: sends a step to the others, and carries it out with them.
  void take_step(const Hdf5Step& step);
  void carry_out(const Hdf5Step& step) const;
  void add_dataset(const Hdf5Step& step) const;
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

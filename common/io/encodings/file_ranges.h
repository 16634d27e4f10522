// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace tetwright {

/// Bytes that are allocated without being written, so that pages that stay unused take no memory.
struct ByteBuffer {
  ByteBuffer() = default;
  explicit ByteBuffer(std::size_t n) : data(std::make_unique_for_overwrite<char[]>(n)), size(n) {}
  std::string_view view() const { return {data.get(), size}; }

  std::unique_ptr<char[]> data;
  std::size_t size = 0;
};

/// A file that is read by ranges. May be used concurrently.
class ByteRanges {
 public:
  ByteRanges() = default;
  virtual ~ByteRanges() = default;
  ByteRanges(const ByteRanges&) = delete;
  ByteRanges& operator=(const ByteRanges&) = delete;

  virtual const std::string& name() const = 0;
  virtual std::uint64_t size() const = 0;
  /// Reads `n` bytes from `offset`.
  /// \throws InputError if the file is shorter, or cannot be read
  virtual void read(std::uint64_t offset, char* to, std::size_t n) const = 0;

  /// Reads into a new buffer, which is reserved only if the file has the bytes.
  ByteBuffer bytes(std::uint64_t offset, std::size_t n) const;
  /// Reads the first bytes: `n`, or all if there are fewer.
  ByteBuffer head(std::size_t n) const;

 protected:
  void check_range(std::uint64_t offset, std::size_t n) const;
};

/// A regular file on disk.
class FileRanges final : public ByteRanges {
 public:
  /// \throws InputError if the file is missing or cannot be read, or is not a regular file
  explicit FileRanges(const std::string& path);
  ~FileRanges() override;

  /// Opens a file that may be missing.
  /// \return null if there is no such file
  /// \throws InputError if it cannot be read, or is not a regular file
  static std::unique_ptr<ByteRanges> if_there(const std::string& path);

  const std::string& name() const override { return path_; }
  std::uint64_t size() const override { return size_; }
  void read(std::uint64_t offset, char* to, std::size_t n) const override;

 private:
  FileRanges(std::string path, int file);

  std::string path_;
  int file_ = -1;
  std::uint64_t size_ = 0;
};

}  // namespace tetwright

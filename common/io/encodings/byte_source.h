// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace tetwright {

/// The bytes of a part of a file, as they are or inflated (zlib, or gzip of one or more members).
///
/// What inflates to more than 64 MB is inflated as it is asked for, so that a few bytes that would inflate to
/// terabytes cost no more memory than the caller takes. A gzip file of one member that ends with a smaller
/// size is inflated at once: libdeflate, which can do nothing else, takes a quarter to a thirtieth of zlib's
/// time on segmented volumes.
class ByteSource {
 public:
  enum class Packing { none, deflate };

  /// `name` is the name of the file in messages. The bytes must outlive this object.
  ByteSource(std::string_view bytes, Packing packing, std::string name);
  ~ByteSource();
  ByteSource(ByteSource&&) noexcept;

  /// Returns the next `n` bytes, or fewer at the end; valid until the next call. Throws InputError if the
  /// compressed data are damaged.
  std::string_view take(std::size_t n);
  /// Skips the next `n` bytes, or fewer at the end, and returns their number.
  std::uint64_t skip(std::uint64_t n);
  /// To be called when all bytes were taken: reads compressed data to their end. Throws InputError if they
  /// end early, or their checksum is wrong.
  void check_end();

  std::uint64_t taken() const { return taken_; }
  /// An upper bound of the number of bytes that are left.
  std::uint64_t max_left() const;
  bool packed() const { return state_ != nullptr; }
  const std::string& name() const { return name_; }

 private:
  struct State;
  std::string_view inflate_next(std::size_t n);

  std::string_view bytes_;
  std::string name_;
  std::uint64_t taken_ = 0;
  std::unique_ptr<State> state_;  ///< of compressed bytes
};

}  // namespace tetwright

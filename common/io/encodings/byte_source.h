// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace tetwright {

/// Bytes of a part of a file, stored plainly or compressed (zlib, or gzip of one or more members).
///
/// Data of more than 64 MB when inflated are inflated on demand, so that a few bytes that expand to terabytes
/// need no more memory than the caller requests. A gzip file of one member whose trailer gives a smaller size
/// is inflated at once by libdeflate, which cannot stream but takes a quarter to a thirtieth of zlib's time
/// on segmented volumes.
class ByteSource {
 public:
  enum class Packing { none, deflate };

  /// \param bytes must outlive this object
  /// \param name file name for messages
  ByteSource(std::string_view bytes, Packing packing, std::string name);
  ~ByteSource();
  ByteSource(ByteSource&&) noexcept;

  /// Returns the next `n` bytes, or fewer at the end; valid until the next call.
  /// \throws InputError if the compressed data are damaged
  std::string_view take(std::size_t n);
  /// Skips the next `n` bytes, or fewer at the end.
  /// \return the number of bytes skipped
  std::uint64_t skip(std::uint64_t n);
  /// Reads compressed data to their end. Call it after all bytes were taken.
  /// \throws InputError if they end early or their checksum is wrong
  void check_end();

  std::uint64_t taken() const { return taken_; }
  /// Upper bound of the number of remaining bytes.
  std::uint64_t max_left() const;
  bool packed() const { return state_ != nullptr; }
  const std::string& name() const { return name_; }

 private:
  struct State;
  std::string_view inflate_next(std::size_t n);

  std::string_view bytes_;
  std::string name_;
  std::uint64_t taken_ = 0;
  std::unique_ptr<State> state_;  ///< null: the bytes are not compressed
};

}  // namespace tetwright

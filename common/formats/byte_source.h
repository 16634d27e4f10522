#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace tetwright {

/// Part of a file, as it is or inflated (gzip, of one member or more, or zlib) as its bytes are asked for: a
/// few bytes that would inflate to terabytes cost nothing that nobody asked for.
class ByteSource {
 public:
  enum class Packing { none, deflate };

  /// `name`: the file, for messages. The bytes must outlive it.
  ByteSource(std::string_view bytes, Packing packing, std::string name);
  ~ByteSource();
  ByteSource(ByteSource&&) noexcept;

  /// The next `n` bytes, less at the end; valid until the next call. Throws InputError where compressed data
  /// are damaged.
  std::string_view take(std::size_t n);
  /// Drops the next `n` bytes; how many there were.
  std::uint64_t skip(std::uint64_t n);
  /// Throws InputError if the checksum of compressed data that were taken whole is wrong.
  void check_end() { (void)take(1); }

  std::uint64_t taken() const { return taken_; }
  /// No more than this many bytes can follow.
  std::uint64_t most_left() const;
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

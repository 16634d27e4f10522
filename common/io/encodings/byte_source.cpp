// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/byte_source.h"

#include <libdeflate.h>
#include <zlib.h>

#include <algorithm>
#include <memory>
#include <new>

#include "common/io/encodings/byte_order.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Maximum compression ratio of deflate, 1032:1 (zlib, "Technical Details").
constexpr std::uint64_t max_gzip_ratio = 1032;

/// zlib counts bytes with 32 bits.
constexpr std::size_t max_at_once = std::size_t{1} << 30;

/// Size of the buffer into which skipped bytes are inflated.
constexpr std::uint64_t skip_size = std::uint64_t{1} << 16;

/// Maximum size that is inflated at once: less memory than the labels of such a volume need.
constexpr std::size_t max_inflated_at_once = std::size_t{1} << 26;

/// Trailer of a gzip member: checksum and size before compression, modulo 2^32.
constexpr std::size_t gzip_trailer_size = 8;

using Decompressor = std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>;

}  // namespace

struct ByteSource::State {
  z_stream stream{};
  std::size_t packed_size = 0;
  bool member_ended = false;
  std::string buffer;
  /// The whole data if it is inflated at once; null: inflated on demand.
  std::unique_ptr<char[]> inflated;
  std::size_t inflated_size = 0, inflated_taken = 0;

  State() {
    // 15: maximum window; 32: detect gzip or zlib from the header.
    if (inflateInit2(&stream, 15 + 32) != Z_OK) throw std::bad_alloc();
  }
  ~State() { inflateEnd(&stream); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// Inflates a gzip file of one member at once if the size in its trailer is small enough; libdeflate takes
  /// at most a quarter of zlib's time. Leaves all other data, including damaged data, to zlib.
  void inflate_at_once(std::string_view bytes);
};

void ByteSource::State::inflate_at_once(std::string_view bytes) {
  if (!bytes.starts_with("\x1f\x8b") || bytes.size() < gzip_trailer_size) return;
  const std::size_t size = load<std::uint32_t>(bytes.data() + bytes.size() - 4, !little_endian_machine);
  // The trailer of a damaged file may contain any value.
  if (size > max_inflated_at_once || size / max_gzip_ratio > bytes.size()) return;
  const Decompressor decompressor(libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
  if (!decompressor) throw std::bad_alloc();
  auto whole = std::make_unique_for_overwrite<char[]>(size);
  std::size_t used = 0;
  if (libdeflate_gzip_decompress_ex(decompressor.get(), bytes.data(), bytes.size(), whole.get(), size, &used,
                                    nullptr) != LIBDEFLATE_SUCCESS ||
      used != bytes.size())
    return;
  inflated = std::move(whole);
  inflated_size = size;
}

ByteSource::ByteSource(std::string_view bytes, Packing packing, std::string name)
    : bytes_(bytes), name_(std::move(name)) {
  if (packing == Packing::none) return;
  state_ = std::make_unique<State>();
  state_->packed_size = bytes.size();
  state_->inflate_at_once(bytes);
}

ByteSource::~ByteSource() = default;
ByteSource::ByteSource(ByteSource&&) noexcept = default;

std::string_view ByteSource::take(std::size_t n) {
  std::string_view out;
  if (packed()) {
    out = inflate_next(n);
  } else {
    out = bytes_.substr(0, n);
    bytes_.remove_prefix(out.size());
  }
  taken_ += out.size();
  return out;
}

std::string_view ByteSource::inflate_next(std::size_t n) {
  State& s = *state_;
  if (s.inflated) {
    n = std::min(n, s.inflated_size - s.inflated_taken);
    s.inflated_taken += n;
    return {s.inflated.get() + s.inflated_taken - n, n};
  }
  n = std::min(n, max_at_once);
  if (s.buffer.size() < n) s.buffer.resize(n);
  s.stream.next_out = reinterpret_cast<Bytef*>(s.buffer.data());
  s.stream.avail_out = static_cast<uInt>(n);
  while (s.stream.avail_out > 0) {
    if (s.member_ended) {
      // Members follow each other directly; other bytes after the last member are ignored.
      if (!bytes_.starts_with("\x1f\x8b") || inflateReset(&s.stream) != Z_OK) break;
      s.member_ended = false;
    }
    const std::size_t given = std::min(bytes_.size(), max_at_once);
    const uInt room = s.stream.avail_out;
    s.stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes_.data()));  // zlib only reads them
    s.stream.avail_in = static_cast<uInt>(given);
    const int result = inflate(&s.stream, Z_NO_FLUSH);
    bytes_.remove_prefix(given - s.stream.avail_in);
    if (result == Z_MEM_ERROR) throw std::bad_alloc();
    if (result == Z_STREAM_END)
      s.member_ended = true;
    else if (result != Z_OK && result != Z_BUF_ERROR)
      throw InputError(name_ + ": the compressed data are damaged " +
                       std::to_string(s.packed_size - bytes_.size()) + " bytes after their beginning (" +
                       (result == Z_NEED_DICT || !s.stream.msg ? "unknown dictionary" : s.stream.msg) +
                       "); copy or export the file again");
    else if (s.stream.avail_in == given && s.stream.avail_out == room)
      break;  // truncated data
  }
  return {s.buffer.data(), n - s.stream.avail_out};
}

std::uint64_t ByteSource::skip(std::uint64_t n) {
  const std::uint64_t before = taken_;
  while (n > 0) {
    const std::size_t got = take(packed() ? std::min(n, skip_size) : n).size();
    if (got == 0) break;
    n -= got;
  }
  return taken_ - before;
}

void ByteSource::check_end() {
  if (!packed()) return;
  while (!take(skip_size).empty()) {
  }
  if (!state_->inflated && !state_->member_ended)
    throw InputError(name_ +
                     ": the compressed data end early, without their checksum; the file is truncated: " +
                     "copy or export it again");
}

std::uint64_t ByteSource::max_left() const {
  if (!packed()) return bytes_.size();
  // One more, for bytes that were read but not yet returned.
  const std::uint64_t max_size = (state_->packed_size + 1) * max_gzip_ratio;
  return max_size > taken_ ? max_size - taken_ : 0;
}

}  // namespace tetwright

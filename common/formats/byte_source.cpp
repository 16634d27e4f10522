#include "common/formats/byte_source.h"

#include <zlib.h>

#include <algorithm>
#include <new>

#include "common/error.h"

namespace tetwright {

namespace {

/// zlib makes at least one byte of 1032.
constexpr std::uint64_t largest_gzip_ratio = 1032;

/// zlib counts in 32 bits.
constexpr std::size_t most_at_once = std::size_t{1} << 30;

/// What is inflated to be dropped goes through a buffer of this size.
constexpr std::uint64_t skip_size = std::uint64_t{1} << 16;

}  // namespace

struct ByteSource::State {
  z_stream stream{};
  std::size_t packed_size = 0;
  bool member_ended = false;
  std::string buffer;

  State() {
    // 15: the largest window; 32: gzip or zlib, by the header.
    if (inflateInit2(&stream, 15 + 32) != Z_OK) throw std::bad_alloc();
  }
  ~State() { inflateEnd(&stream); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
};

ByteSource::ByteSource(std::string_view bytes, Packing packing, std::string name)
    : bytes_(bytes), name_(std::move(name)) {
  if (packing == Packing::none) return;
  state_ = std::make_unique<State>();
  state_->packed_size = bytes.size();
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
  n = std::min(n, most_at_once);
  if (s.buffer.size() < n) s.buffer.resize(n);
  s.stream.next_out = reinterpret_cast<Bytef*>(s.buffer.data());
  s.stream.avail_out = static_cast<uInt>(n);
  while (s.stream.avail_out > 0) {
    if (s.member_ended) {
      // Files of several members are one after the other; anything else behind the last is not ours.
      if (!bytes_.starts_with("\x1f\x8b") || inflateReset(&s.stream) != Z_OK) break;
      s.member_ended = false;
    }
    const std::size_t given = std::min(bytes_.size(), most_at_once);
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
      break;  // cut short
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

std::uint64_t ByteSource::most_left() const {
  if (!packed()) return bytes_.size();
  // One more: what was read but not yet handed out.
  const std::uint64_t most = (state_->packed_size + 1) * largest_gzip_ratio;
  return most > taken_ ? most - taken_ : 0;
}

}  // namespace tetwright

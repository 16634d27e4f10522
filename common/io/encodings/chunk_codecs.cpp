// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/chunk_codecs.h"

#include <blosc.h>
#include <libdeflate.h>
#include <zstd.h>

#include <array>
#include <memory>
#include <new>

#include "common/io/encodings/byte_order.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr std::size_t checksum_bytes = 4;

[[noreturn]] void fail_damaged(const std::string& name, const std::string& codec) {
  throw InputError(name + ": its " + codec + " data are damaged or truncated; copy or export the file again");
}

[[noreturn]] void fail_longer(const std::string& name, const std::string& codec, std::size_t size) {
  throw InputError(name + ": its " + codec + " data make more than " + std::to_string(size) +
                   " bytes; the chunk or its metadata is wrong");
}

ByteBuffer shortened(ByteBuffer bytes, std::size_t size) {
  bytes.size = size;
  return bytes;
}

ByteBuffer inflate_chunk(std::string_view stored, bool gzip, std::size_t max_size, const std::string& name) {
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)> decompressor(
      libdeflate_alloc_decompressor(), &libdeflate_free_decompressor);
  if (!decompressor) throw std::bad_alloc();
  ByteBuffer out(max_size);
  std::size_t made = 0;
  const auto decompress = gzip ? libdeflate_gzip_decompress : libdeflate_zlib_decompress;
  const libdeflate_result result =
      decompress(decompressor.get(), stored.data(), stored.size(), out.data.get(), max_size, &made);
  if (result == LIBDEFLATE_INSUFFICIENT_SPACE) fail_longer(name, gzip ? "gzip" : "zlib", max_size);
  if (result != LIBDEFLATE_SUCCESS) fail_damaged(name, gzip ? "gzip" : "zlib");
  return shortened(std::move(out), made);
}

ByteBuffer unpack_zstd(std::string_view stored, std::size_t max_size, const std::string& name) {
  ByteBuffer out(max_size);
  const std::size_t made = ZSTD_decompress(out.data.get(), max_size, stored.data(), stored.size());
  if (ZSTD_isError(made)) {
    const unsigned long long size = ZSTD_getFrameContentSize(stored.data(), stored.size());
    if (size != ZSTD_CONTENTSIZE_UNKNOWN && size != ZSTD_CONTENTSIZE_ERROR && size > max_size)
      fail_longer(name, "zstd", max_size);
    fail_damaged(name, "zstd");
  }
  return shortened(std::move(out), made);
}

ByteBuffer unpack_blosc(std::string_view stored, std::size_t max_size, const std::string& name) {
  std::size_t size = 0;
  if (blosc_cbuffer_validate(stored.data(), stored.size(), &size) != 0) fail_damaged(name, "blosc");
  if (size > max_size) fail_longer(name, "blosc", max_size);
  ByteBuffer out(size);
  if (size == 0) return out;
  if (blosc_decompress_ctx(stored.data(), out.data.get(), size, 1) != static_cast<int>(size))
    fail_damaged(name, "blosc");
  return out;
}

ByteBuffer without_checksum(ByteBuffer stored, const std::string& name) {
  if (stored.size < checksum_bytes) fail_damaged(name, "crc32c");
  stored.size -= checksum_bytes;
  if (load<std::uint32_t>(stored.data.get() + stored.size, !little_endian_machine) != crc32c(stored.view()))
    throw InputError(name + ": its checksum (crc32c) is wrong; copy or export the file again");
  return stored;
}

constexpr std::array<std::uint32_t, 256> crc32c_table = [] {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < table.size(); ++i) {
    std::uint32_t rest = i;
    for (int bit = 0; bit < 8; ++bit) rest = rest & 1 ? rest >> 1 ^ 0x82f63b78U : rest >> 1;
    table[i] = rest;
  }
  return table;
}();

}  // namespace

std::optional<ChunkCodec> chunk_codec(std::string_view name) {
  if (name == "zlib") return ChunkCodec::zlib;
  if (name == "gzip") return ChunkCodec::gzip;
  if (name == "zstd") return ChunkCodec::zstd;
  if (name == "blosc") return ChunkCodec::blosc;
  if (name == "crc32c") return ChunkCodec::crc32c;
  return std::nullopt;
}

std::uint32_t crc32c(std::string_view bytes) {
  std::uint32_t rest = ~0U;
  for (const char c : bytes) rest = crc32c_table[(rest ^ static_cast<unsigned char>(c)) & 0xff] ^ rest >> 8;
  return ~rest;
}

std::size_t max_stored_size(std::size_t size) {
  // Compressors store data that do not shrink with headers for each of their blocks.
  constexpr std::size_t headers = std::size_t{1} << 16;
  return size + size / 8 + headers;
}

ByteBuffer decode_chunk(ByteBuffer stored, std::span<const ChunkCodec> codecs, std::size_t size,
                        const std::string& name) {
  for (std::size_t k = codecs.size(); k-- > 0;) {
    const std::size_t max_size = k == 0 ? size : max_stored_size(size);
    switch (codecs[k]) {
      case ChunkCodec::zlib:
      case ChunkCodec::gzip:
        stored = inflate_chunk(stored.view(), codecs[k] == ChunkCodec::gzip, max_size, name);
        break;
      case ChunkCodec::zstd:
        stored = unpack_zstd(stored.view(), max_size, name);
        break;
      case ChunkCodec::blosc:
        stored = unpack_blosc(stored.view(), max_size, name);
        break;
      case ChunkCodec::crc32c:
        stored = without_checksum(std::move(stored), name);
        break;
    }
  }
  if (stored.size != size)
    throw InputError(name + ": it has " + std::to_string(stored.size) + " bytes when decoded, not " +
                     std::to_string(size) + "; the chunk or its metadata is wrong");
  return stored;
}

}  // namespace tetwright

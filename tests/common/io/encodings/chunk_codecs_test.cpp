// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/chunk_codecs.h"

#include <blosc.h>
#include <zstd.h>

#include <cstring>

#include "tests/common/io/volume_bytes.h"

namespace tetwright::chunk_codecs_test {
namespace {

ByteBuffer buffer_of(const std::string& bytes) {
  ByteBuffer out(bytes.size());
  std::memcpy(out.data.get(), bytes.data(), bytes.size());
  return out;
}

std::string decoded(const std::string& stored, const std::vector<ChunkCodec>& codecs, std::size_t size) {
  return std::string(decode_chunk(buffer_of(stored), codecs, size, "f").view());
}

std::string zstd_of(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 3));
  return out;
}

std::string blosc_of(const std::string& bytes, const char* codec, int shuffle = BLOSC_SHUFFLE) {
  std::string out(bytes.size() + BLOSC_MAX_OVERHEAD, '\0');
  const int n =
      blosc_compress_ctx(5, shuffle, 4, bytes.size(), bytes.data(), out.data(), out.size(), codec, 0, 1);
  EXPECT_GT(n, 0) << codec;
  out.resize(static_cast<std::size_t>(std::max(n, 0)));
  return out;
}

std::string with_crc(const std::string& bytes) {
  std::string out = bytes;
  append_bytes(out, crc32c(bytes));
  return out;
}

std::string sample_bytes() {
  std::string bytes;
  for (int i = 0; i < 5000; ++i) bytes += std::to_string(i * 7919 % 1000);
  return bytes;
}

TEST(ChunkCodecs, Crc32cOfRfc3720) {
  EXPECT_EQ(crc32c(std::string(32, '\0')), 0x8a9136aaU);
  EXPECT_EQ(crc32c(std::string(32, '\xff')), 0x62a8ab43U);
  EXPECT_EQ(crc32c("123456789"), 0xe3069283U);
}

TEST(ChunkCodecs, EveryCodecGivesTheBytesBack) {
  const std::string bytes = sample_bytes();
  EXPECT_EQ(decoded(bytes, {}, bytes.size()), bytes);
  EXPECT_EQ(decoded(deflated(bytes, 15), {ChunkCodec::zlib}, bytes.size()), bytes);
  EXPECT_EQ(decoded(deflated(bytes, 31), {ChunkCodec::gzip}, bytes.size()), bytes);
  EXPECT_EQ(decoded(zstd_of(bytes), {ChunkCodec::zstd}, bytes.size()), bytes);
  EXPECT_EQ(decoded(with_crc(bytes), {ChunkCodec::crc32c}, bytes.size()), bytes);
  for (const char* codec : {"blosclz", "lz4", "lz4hc", "zlib", "zstd"})
    for (const int shuffle : {BLOSC_NOSHUFFLE, BLOSC_SHUFFLE, BLOSC_BITSHUFFLE})
      EXPECT_EQ(decoded(blosc_of(bytes, codec, shuffle), {ChunkCodec::blosc}, bytes.size()), bytes) << codec;
}

TEST(ChunkCodecs, SeveralCodecsAreUndoneFromTheLast) {
  const std::string bytes = sample_bytes();
  EXPECT_EQ(decoded(with_crc(zstd_of(bytes)), {ChunkCodec::zstd, ChunkCodec::crc32c}, bytes.size()), bytes);
  EXPECT_EQ(decoded(deflated(with_crc(bytes)), {ChunkCodec::crc32c, ChunkCodec::gzip}, bytes.size()), bytes);
  EXPECT_EQ(decoded(deflated(zstd_of(bytes)), {ChunkCodec::zstd, ChunkCodec::gzip}, bytes.size()), bytes);
}

TEST(ChunkCodecs, AnotherSizeThanThatOfTheChunkIsRefused) {
  const std::string bytes = sample_bytes();
  const std::vector<std::pair<ChunkCodec, std::string>> all{{ChunkCodec::zlib, deflated(bytes, 15)},
                                                            {ChunkCodec::gzip, deflated(bytes, 31)},
                                                            {ChunkCodec::zstd, zstd_of(bytes)},
                                                            {ChunkCodec::blosc, blosc_of(bytes, "lz4")},
                                                            {ChunkCodec::crc32c, with_crc(bytes)}};
  for (const auto& [codec, stored] : all)
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, bytes.size() - 1, bytes.size() + 1}) {
      const std::string message = error_of<InputError>([&, c = codec, s = stored] { decoded(s, {c}, size); });
      EXPECT_EQ(message.find("f: it"), 0u) << message;
    }
}

TEST(ChunkCodecs, DamagedAndTruncatedBytesAreRefused) {
  const std::string bytes = sample_bytes();
  const std::vector<std::pair<ChunkCodec, std::string>> all{{ChunkCodec::zlib, deflated(bytes, 15)},
                                                            {ChunkCodec::gzip, deflated(bytes, 31)},
                                                            {ChunkCodec::zstd, zstd_of(bytes)},
                                                            {ChunkCodec::blosc, blosc_of(bytes, "lz4")},
                                                            {ChunkCodec::blosc, blosc_of(bytes, "blosclz")},
                                                            {ChunkCodec::blosc, blosc_of(bytes, "zstd")},
                                                            {ChunkCodec::crc32c, with_crc(bytes)}};
  for (const auto& [codec, stored] : all) {
    for (const std::size_t left :
         {std::size_t{0}, std::size_t{3}, std::size_t{15}, stored.size() / 2, stored.size() - 1})
      EXPECT_NE(
          error_of<InputError>([&, c = codec, s = stored] { decoded(s.substr(0, left), {c}, bytes.size()); }),
          "");
    // Not every flipped bit is noticed without a checksum; none may do harm.
    for (std::size_t at = 0; at < std::min<std::size_t>(stored.size(), 300); ++at) {
      std::string damaged = stored;
      damaged[at] = static_cast<char>(damaged[at] ^ (1 << at % 8));
      try {
        EXPECT_EQ(decoded(damaged, {codec}, bytes.size()).size(), bytes.size());
      } catch (const InputError& error) {
        EXPECT_EQ(std::string(error.what()).find("f: it"), 0u) << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace tetwright::chunk_codecs_test

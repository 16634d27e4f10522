// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/byte_source.h"

#include "tests/common/io/volume_bytes.h"

namespace tetwright::byte_source_test {
namespace {

using Packing = ByteSource::Packing;

TEST(ByteSource, PlainBytes) {
  const std::string bytes = "0123456789";
  ByteSource source(bytes, Packing::none, "f");
  EXPECT_EQ(source.max_left(), 10u);
  EXPECT_EQ(source.take(3), "012");
  EXPECT_EQ(source.skip(2), 2u);
  EXPECT_EQ(source.take(99), "56789");
  EXPECT_EQ(source.take(1), "");
  EXPECT_EQ(source.skip(1), 0u);
  EXPECT_EQ(source.taken(), 10u);
}

TEST(ByteSource, InflatedBytesInPiecesOfAnySize) {
  std::string bytes;
  for (int i = 0; i < 50000; ++i) bytes += std::to_string(i * 7919 % 1000);
  for (const int wrapper : {31, 15})
    for (const std::size_t piece : {1u, 7u, 1000u, 1000000u}) {
      const std::string packed = deflated(bytes, wrapper);
      ByteSource source(packed, Packing::deflate, "f");
      EXPECT_GE(source.max_left(), bytes.size());
      EXPECT_EQ(source.skip(70000), 70000u);
      std::string out;
      for (std::string_view part; !(part = source.take(piece)).empty();) out += part;
      EXPECT_TRUE(out == bytes.substr(70000)) << wrapper << " " << piece;
      EXPECT_EQ(source.taken(), bytes.size());
    }
}

TEST(ByteSource, MembersOneAfterTheOther) {
  const std::string first(3000, 'a'), second(70000, 'b');
  const std::string packed = deflated(first) + deflated(second);
  for (const std::string& behind : {std::string(), std::string("not gzip")}) {
    const std::string file = packed + behind;
    ByteSource source(file, Packing::deflate, "f");
    EXPECT_EQ(source.skip(2000), 2000u);
    EXPECT_TRUE(source.take(100000) == first.substr(2000) + second);
    EXPECT_EQ(source.take(1), "");
    EXPECT_EQ(source.taken(), first.size() + second.size());
  }
}

TEST(ByteSource, MaxLeftHoldsForTheBestCompression) {
  const std::string bytes(10000000, 'x');
  const std::string packed = deflated(bytes);
  ByteSource source(packed, Packing::deflate, "f");
  EXPECT_GE(source.max_left(), bytes.size());
  EXPECT_LT(source.max_left(), 2 * bytes.size());
  EXPECT_EQ(source.skip(bytes.size()), bytes.size());
}

TEST(ByteSource, WhatEndsBeforeItsChecksumIsRefused) {
  const std::string bytes(3000, 'a');
  for (const int wrapper : {31, 15})
    for (const std::size_t lost : {1u, 4u}) {
      const std::string packed = deflated(bytes, wrapper), cut = packed.substr(0, packed.size() - lost);
      ByteSource source(cut, Packing::deflate, "f");
      EXPECT_TRUE(source.take(bytes.size()) == bytes);
      const std::string message = error_of<InputError>([&] { source.check_end(); });
      EXPECT_EQ(message.find("f: the compressed data end early"), 0u) << message;
    }
  // The bytes after those that were taken are checked, too.
  std::string packed = deflated(bytes + std::string(100000, 'b'));
  packed.pop_back();
  ByteSource source(packed, Packing::deflate, "f");
  (void)source.take(bytes.size());
  EXPECT_NE(error_of<InputError>([&] { source.check_end(); }), "");
}

TEST(ByteSource, DamagedData) {
  for (const std::size_t at : {12u, 22u, 27u}) {  // in the data, the checksum and the size
    std::string packed = deflated("some bytes or other, many of them");
    packed[at < 20 ? at : packed.size() - (30 - at)] ^= 0x7f;
    ByteSource source(packed, Packing::deflate, "f");
    const std::string message = error_of<InputError>([&] {
      (void)source.take(100);
      source.check_end();
    });
    EXPECT_EQ(message.find("f: the compressed data are damaged"), 0u) << message;
  }
}

}  // namespace
}  // namespace tetwright::byte_source_test

// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/base64.h"

#include <gtest/gtest.h>

#include "tetwright/resources.h"

namespace tetwright::base64_test {
namespace {

TEST(Base64, KnownAnswers) {  // RFC 4648, section 10
  const std::pair<const char*, const char*> answers[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, code] : answers) {
    std::string out;
    append_base64(out, plain);
    EXPECT_EQ(out, code);
    char back[8];
    Base64Reader reader(code);
    EXPECT_EQ(std::string(back, reader.read(back, 8)), plain);
  }
}

std::string bytes_of_all_values(std::size_t n) {
  std::string bytes(n, '\0');
  for (std::size_t i = 0; i < n; ++i) bytes[i] = static_cast<char>(i * 37 % 251);
  return bytes;
}

TEST(Base64, TheTextIsTheSameForAnyNumberOfThreads) {
  for (const std::size_t n : {0u, 1u, 12288u, 40000u, 100001u}) {
    const std::string bytes = bytes_of_all_values(n);
    std::string expected;
    append_base64(expected, bytes);
    for (const unsigned threads : {1u, 3u}) {
      const ThreadLimit limit(threads);
      EXPECT_EQ(base64(bytes), expected);
    }
  }
}

TEST(Base64, AnyPartCanBeDecoded) {
  for (std::size_t n = 0; n < 14; ++n) {
    const std::string bytes = bytes_of_all_values(n), text = base64(bytes);
    for (std::size_t begin = 0; begin <= n; ++begin)
      for (std::size_t size = 0; begin + size <= n; ++size) {
        std::string part(size, '?');
        EXPECT_TRUE(decode_base64(text, begin, part));
        EXPECT_EQ(part, bytes.substr(begin, size));
      }
    std::string more(n + 1, '?');
    EXPECT_FALSE(decode_base64(text, 0, more)) << text;
  }
}

TEST(Base64, PartsMustHaveOnlyCharactersOfBase64) {
  const std::string text = base64(bytes_of_all_values(12));
  std::string part(12, '?');
  for (std::size_t i = 0; i < text.size(); ++i)
    for (const char c : {'\n', ' ', '=', '!'}) {
      std::string damaged = text;
      damaged[i] = c;
      EXPECT_FALSE(decode_base64(damaged, 0, part)) << damaged;
    }
  char byte = 0;
  EXPECT_FALSE(decode_base64("Zg=a", 0, {&byte, 1}));
  EXPECT_FALSE(decode_base64("Zg=", 0, {&byte, 1}));
  EXPECT_TRUE(decode_base64("Zm9", 0, {}));
}

TEST(Base64, TheRestBeginsWithAWholeGroup) {
  Base64Reader reader("Zm9vYmFy");
  char out[3];
  EXPECT_EQ(reader.rest(), "Zm9vYmFy");
  EXPECT_EQ(reader.read(out, 1), 1u);
  EXPECT_EQ(reader.rest(), "");
  EXPECT_EQ(reader.read(out, 2), 2u);
  EXPECT_EQ(reader.rest(), "YmFy");
}

TEST(Base64, BlocksOneAfterAnotherInPieces) {
  Base64Reader reader(" Zg==\n Zm8=Zm9v ");
  char out[10];
  EXPECT_EQ(reader.read(out, 2), 2u);
  EXPECT_GE(reader.max_left(), 4u);
  EXPECT_EQ(reader.read(out + 2, 8), 4u);
  EXPECT_EQ(std::string(out, 6), "ffofoo");
}

TEST(Base64, StopsAtWhatIsNone) {
  char out[10];
  for (const char* text : {"Zg=a", "Z===", "Zm9", "Z!9v", "=Zm9"}) {
    Base64Reader reader(text);
    EXPECT_EQ(reader.read(out, 10), 0u) << text;
  }
}

}  // namespace
}  // namespace tetwright::base64_test

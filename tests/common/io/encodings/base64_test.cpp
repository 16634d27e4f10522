// SPDX-License-Identifier: Apache-2.0
#include "common/io/encodings/base64.h"

#include <gtest/gtest.h>

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

// SPDX-License-Identifier: Apache-2.0
#include "tetwright/io.h"

#include <gtest/gtest.h>

#include "tests/common/io/expect_error.h"
#include "tests/common/temporary_folder.h"

namespace tetwright::label_names_test {
namespace {

using Names = std::map<MaterialTag, std::string>;

Names parse(std::string_view text) { return parse_label_names(text, "f"); }

TEST(LabelNames, PlainLines) {
  EXPECT_EQ(
      parse("1 liver\n2\tleft kidney  \n\n-3,spleen\r\n4 , \"portal vein\"\n+5 'a b'\n6 x\n6 x"),
      (Names{{1, "liver"}, {2, "left kidney"}, {-3, "spleen"}, {4, "portal vein"}, {5, "a b"}, {6, "x"}}));
  EXPECT_EQ(parse("\xef\xbb\xbf"
                  "1,vein, portal\n2147483647 B\xc3\xa4r\n-2147483648 lowest"),
            (Names{{1, "vein, portal"}, {2147483647, "B\xc3\xa4r"}, {-2147483648, "lowest"}}));
}

TEST(LabelNames, Comments) {
  EXPECT_EQ(parse("# names\n// names\n  # more\n1 liver # right side\n2 C#4 // \n3 \"a # b\" #c\n4 a//b"),
            (Names{{1, "liver"}, {2, "C#4"}, {3, "a # b"}, {4, "a//b"}}));
}

TEST(LabelNames, ColourTablesOfSlicerAndFreeSurfer) {
  EXPECT_EQ(
      parse("# Color table file x.ctbl\n# 3 values\n0 Background 0 0 0 0\n1 left_kidney 128 174 128 255\n"
            "7 \"a name\" 1 2 3 255\n"),
      (Names{{0, "Background"}, {1, "left_kidney"}, {7, "a name"}}));
  EXPECT_EQ(parse("#No. Label Name:   R   G   B   A\n\n0   Unknown        0   0   0   0\n"
                  "2   Left-Cerebral-White-Matter   245 245 245 0\n"),
            (Names{{0, "Unknown"}, {2, "Left-Cerebral-White-Matter"}}));
}

TEST(LabelNames, NumbersAtTheEndOfSomeNamesAreNoColours) {
  EXPECT_EQ(parse("1 rib 1 2 3 4\n2 liver\n"), (Names{{1, "rib 1 2 3 4"}, {2, "liver"}}));
  EXPECT_EQ(parse("1 rib 1 2 3 256\n"), (Names{{1, "rib 1 2 3 256"}}));
  EXPECT_EQ(parse("1 2 3 4 5 6 7 rib\n"), (Names{{1, "2 3 4 5 6 7 rib"}}));
  EXPECT_EQ(parse("1 2\n2 3 4 5 6\n"), (Names{{1, "2"}, {2, "3 4 5 6"}}));
}

TEST(LabelNames, DescriptionsOfItkSnap) {
  EXPECT_EQ(parse("################\n# IDX   -R-  -G-  -B-  -A--  VIS MSH  LABEL\n"
                  "    0     0    0    0        0  0  0    \"Clear Label\"\n"
                  "    1   255    0    0        1  1  1    \"Label 1\"\n"
                  "    9     0  255    0      0.5  1  1    \"a # b\"\n"),
            (Names{{0, "Clear Label"}, {1, "Label 1"}, {9, "a # b"}}));
}

TEST(LabelNames, AtMost120BytesLong) {
  const std::string longest(120, 'n');
  EXPECT_EQ(parse("1 " + longest), (Names{{1, longest}}));
  const std::string message = error_of<InputError>([&] { parse("1 a\n2 " + longest + "n\n"); });
  EXPECT_NE(message.find("f: line 2: label 2 has a name of 121 bytes"), std::string::npos) << message;
}

TEST(LabelNames, FromAFile) {
  const TemporaryFolder folder;
  put(folder / "names.txt", "5 bone\n");
  EXPECT_EQ(read_label_names(folder / "names.txt"), (Names{{5, "bone"}}));
  EXPECT_NE(error_of<InputError>([&] { read_label_names(folder / "none.txt"); }).find("none.txt"),
            std::string::npos);
}

TEST(LabelNames, Errors) {
  expect_input_error(parse_label_names, "", "lists no labels");
  expect_input_error(parse_label_names, "# 1 liver\n\n", "lists no labels");
  expect_input_error(parse_label_names, "1 liver\nspleen 2\n", "line 2: expected the number of a label",
                     "\"spleen\"");
  expect_input_error(parse_label_names, "1.5 liver\n", "line 1: expected the number", "\"1.5\"");
  expect_input_error(parse_label_names, "\n1\n", "line 2: label 1 has no name");
  expect_input_error(parse_label_names, "1,\n", "line 1: label 1 has no name");
  expect_input_error(parse_label_names, "1 \"\"\n", "line 1: label 1 has no name");
  expect_input_error(parse_label_names, "1 a\n2 b\n\n1 c\n", "line 4: label 1 is called \"c\"", "\"a\"");
  expect_input_error(parse_label_names, "2147483648 a\n", "line 1: ", "2147483648");
  expect_input_error(parse_label_names, "1 \"a\n", "line 1: the name \"a\" lacks its closing quote");
  expect_input_error(parse_label_names, "1 a\x01z\n", "line 1: ", "control character");
  expect_input_error(parse_label_names, std::string_view("1 a\0z\n", 6), "line 1: ", "control character");
  expect_input_error(parse_label_names, "1 0 0 0 255 1 1 \"\"\n", "line 1: label 1 has no name");
  expect_input_error(parse_label_names, "1 a 0 0 0 255\n2 0 0 0 255\n", "line 2: label 2 has no name");
}

TEST(LabelNames, LinesOfTheLabels) {
  std::map<MaterialTag, std::size_t> lines;
  (void)parse_label_names("# names\n7 liver\n\n-3 spleen\n7 liver\n", "f", &lines);
  EXPECT_EQ(lines, (std::map<MaterialTag, std::size_t>{{7, 2}, {-3, 4}}));
}

}  // namespace
}  // namespace tetwright::label_names_test

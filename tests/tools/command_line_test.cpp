#include "tools/command_line.h"

#include <gtest/gtest.h>

#include "tests/common/formats/expect_error.h"

namespace tetwright::command_line_test {
namespace {

using Ranges = std::vector<std::pair<MaterialTag, MaterialTag>>;

CommandLine parse(std::vector<std::string> arguments) {
  for (const char* first : {"scan.nrrd", "mesh", "tetwright"}) arguments.insert(arguments.begin(), first);
  for (const char* last : {"-o", "out.vtu"}) arguments.emplace_back(last);
  std::vector<char*> argv;
  for (std::string& a : arguments) argv.push_back(a.data());
  CommandLine line;
  EXPECT_TRUE(parse_command_line(static_cast<int>(argv.size()), argv.data(), line));
  return line;
}

void expect_refused(const std::vector<std::string>& arguments, const std::string& said) {
  const std::string message = error_of<UsageError>([&] { parse(arguments); });
  EXPECT_NE(message.find(said), std::string::npos) << message;
  EXPECT_NE(message.find(arguments[0].substr(0, arguments[0].find('='))), std::string::npos) << message;
}

TEST(CommandLine, DefaultsForSegmentedVolumes) {
  const CommandLine line = parse({});
  EXPECT_EQ(line.inputs, std::vector<std::string>{"scan.nrrd"});
  EXPECT_TRUE(line.labels.empty());
  EXPECT_EQ(line.label_names, "");
  EXPECT_EQ(line.outside_label, 0);
  EXPECT_FALSE(line.outside_label_given);
  EXPECT_EQ(line.min_voxels, 8u);
  EXPECT_FALSE(line.min_voxels_given);
}

TEST(CommandLine, Labels) {
  EXPECT_EQ(parse({"--labels", "1,5-9"}).labels, (Ranges{{1, 1}, {5, 9}}));
  EXPECT_EQ(parse({"--labels", "-3"}).labels, (Ranges{{-3, -3}}));
  EXPECT_EQ(parse({"--labels", "-3--1,7"}).labels, (Ranges{{-3, -1}, {7, 7}}));
  EXPECT_EQ(parse({"--labels=-3-4"}).labels, (Ranges{{-3, 4}}));
  EXPECT_EQ(parse({"--labels", "2-2", "--labels", "4"}).labels, (Ranges{{2, 2}, {4, 4}}));
  EXPECT_EQ(parse({"--labels", "-2147483648-2147483647"}).labels, (Ranges{{-2147483648, 2147483647}}));
  for (const char* wrong : {"", ",", "1,", "a", "1-", "--1", "1-2-3", "1.5", "1 2", "+1", "1-+2",
                            "2147483648", "1--2147483649", "0x1"})
    expect_refused({std::string("--labels=") + wrong}, "is neither a label nor a range such as 5-9");
  expect_refused({"--labels", "9-5"}, "'9-5' begins with the larger label; did you mean 5-9?");
  expect_refused({"--labels", "-1--3"}, "did you mean -3--1?");
}

TEST(CommandLine, OtherOptionsOfSegmentedVolumes) {
  const CommandLine line =
      parse({"--label-names", "names.ctbl", "--outside-label", "-7", "--min-voxels", "0"});
  EXPECT_EQ(line.label_names, "names.ctbl");
  EXPECT_EQ(line.outside_label, -7);
  EXPECT_TRUE(line.outside_label_given);
  EXPECT_EQ(line.min_voxels, 0u);
  EXPECT_TRUE(line.min_voxels_given);
  EXPECT_TRUE(parse({"--outside-label", "0"}).outside_label_given);
  EXPECT_TRUE(parse({"--min-voxels", "8"}).min_voxels_given);
  for (const char* wrong : {"", "a", "1.5", "2147483648", "-2147483649", "1-2"})
    expect_refused({std::string("--outside-label=") + wrong}, "is not a whole number from -2147483648");
  for (const char* wrong : {"-1", "a", "1.5"})
    expect_refused({std::string("--min-voxels=") + wrong}, "is not a whole number");
}

}  // namespace
}  // namespace tetwright::command_line_test

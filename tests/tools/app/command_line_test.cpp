// SPDX-License-Identifier: Apache-2.0
#include "tools/app/command_line.h"

#include <gtest/gtest.h>

#include "tests/common/io/expect_error.h"

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
  expect_refused({"--labels="}, "has no value");
  for (const char* wrong : {",", "1,", "a", "1-", "--1", "1-2-3", "1.5", "1 2", "+1", "1-+2", "2147483648",
                            "1--2147483649", "0x1"})
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
  for (const char* wrong : {"a", "1.5", "2147483648", "-2147483649", "1-2"})
    expect_refused({std::string("--outside-label=") + wrong}, "is not a whole number from -2147483648");
  for (const char* wrong : {"-1", "a", "1.5"})
    expect_refused({std::string("--min-voxels=") + wrong}, "is not a whole number");
}

TEST(CommandLine, NumbersOutOfRangeNameOptionValueAndRange) {
  const auto refused = [](const std::vector<std::string>& arguments, const std::string& value,
                          const std::string& range) {
    std::vector<std::string> all{"tetwright"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& a : all) argv.push_back(a.data());
    CommandLine line;
    const std::string message =
        error_of<UsageError>([&] { parse_command_line(static_cast<int>(argv.size()), argv.data(), line); });
    const std::string& option = arguments.back();
    EXPECT_NE(message.find(option.substr(0, option.find('='))), std::string::npos) << message;
    EXPECT_NE(message.find("'" + value + "' is not a"), std::string::npos) << message;
    EXPECT_NE(message.find(range), std::string::npos) << message;
  };
  const auto check = [&](const std::vector<std::string>& call, const std::string& option,
                         const std::vector<std::string>& values, const std::string& range) {
    for (const std::string& value : values) {
      std::vector<std::string> arguments = call;
      arguments.push_back(option + "=" + value);
      refused(arguments, value, range);
    }
  };
  const std::vector<std::string> simplify{"simplify", "a.vtu", "-o", "b.vtu"};
  const std::vector<std::string> mesh{"mesh", "a.off", "-o", "b.vtu"};
  const std::vector<std::string> improve{"improve", "a.vtu", "-o", "b.vtu"};
  for (const std::vector<std::string>& call : {simplify, {"prepare", "a.off", "-o", "b.vtu"}})
    check(call, "--target-tets",
          {"0", "-5", "1.5", "many", "1e6", "0x10", "1073741825", "99999999999", "99999999999999999999999",
           "+5"},
          "whole number from 1 to 1073741824");
  check(mesh, "--threads", {"0", "1025", "-1", "two"}, "whole number from 1 to 1024");
  check(mesh, "--seed", {"-1", "1.5", "18446744073709551616"}, "whole number from 0 to 18446744073709551615");
  check(mesh, "--max-refinement", {"9", "-1", "1.5"}, "whole number from 0 to 8");
  check(mesh, "--feature-angle", {"0", "180", "-5", "sharp", "nan"},
        "angle from 1 to 179 degrees, auto or off");
  check(mesh, "--min-gap", {"0", "-1", "nan", "wide"}, "length above 0 in input units");
  check(mesh, "--min-thickness", {"101%", "0%", "-1%"}, "share above 0 % and at most 100 % of the diagonal");
  check(mesh, "--resolution", {"3", "4097", "64.0"}, "whole number from 4 to 4096");
  check(mesh, "--voxel-size", {"0", "-1", "nan", "inf", "1e400", "small", "1mm"}, "number above 0");
  check(mesh, "--adaptivity", {"-0.1", "nan"}, "number of at least 0");
  check(improve, "--max-iterations", {"0", "10001"}, "whole number from 1 to 10000");
  check(improve, "--min-solid-angle", {"-0.1", "0.56", "nan"}, "solid angle from 0 to 0.5513");
  check(improve, "--only-below", {"-0.1", "2", "nan"}, "solid angle from 0 to 0.5513");
  std::vector<std::string> with_target = simplify;
  with_target.push_back("--target-tets=5");
  check(with_target, "--beta", {"0", "nan", "-1"}, "number above 0");
  check(with_target, "--gamma", {"-1", "inf"}, "number of at least 0");
}

TEST(CommandLine, NumbersAreDecimal) {
  EXPECT_EQ(parse({"--resolution", "0100"}).resolution, 100);
  EXPECT_EQ(parse({"--seed", "18446744073709551615"}).seed, 18446744073709551615u);
  EXPECT_EQ(parse({"--voxel-size", "1.5e-3"}).voxel_size, 0.0015);
  EXPECT_EQ(parse({"--adaptivity", "0"}).adaptivity, 0);
  EXPECT_EQ(parse({"--threads", "1024"}).threads, 1024u);
}

}  // namespace
}  // namespace tetwright::command_line_test

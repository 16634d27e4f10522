// SPDX-License-Identifier: Apache-2.0
#include "tools/app/image_options.h"

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/app/command_line.h"
#include "tools/app/option_values.h"

namespace tetwright {

namespace {

constexpr Range probability{0, 1, true, "a probability from 0 to 1"};

IsoValue parse_iso(const std::string& text) {
  IsoValue iso;
  std::string value = text;
  if (text.find('=') != std::string::npos) {
    const NamedValue named = split_named(text, "--iso", "V");
    iso.name = named.name;
    value = named.value;
  }
  constexpr Range threshold{-max_number, max_number, true, "a number, or auto"};
  if (value != "auto") iso.value = parse_number("--iso", value, threshold);
  return iso;
}

}  // namespace

void add_images(CLI::App& app, CommandLine& c) {
  app.add_option_function<std::vector<std::string>>(
         "--iso",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all) c.options.images.isos.push_back(parse_iso(text));
         },
         "The input is an image, and its points with this value or more are the material NAME; repeatable, "
         "for nested materials. auto: Otsu's threshold")
      ->expected(1)
      ->type_name("[NAME=]V|auto")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_parsed<std::optional<double>>(
      app, "--outside-probability", c.options.images.outside_probability, "P",
      [](const std::string& text) { return parse_number("--outside-probability", text, probability); },
      "The inputs are probability maps, one for each material; points where all are below P are outside, "
      "from 0 to 1 (default: what they lack to 1)");
  add_parsed<std::optional<double>>(
      app, "--smooth", c.options.images.smoothing, "VOXELS",
      [](const std::string& text) { return parse_number("--smooth", text, positive); },
      "Smooth images by a Gaussian of this standard deviation; materials keep their volumes");
}

}  // namespace tetwright

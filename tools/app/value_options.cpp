// SPDX-License-Identifier: Apache-2.0
#include "tools/app/value_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tools/app/option_values.h"

namespace tetwright {

namespace {

std::vector<std::string> comma_separated_parts(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text)
    if (c == ',')
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

BinRule parse_bins(const std::string& text) {
  const std::vector<std::string> parts = comma_separated_parts(text);
  BinRule rule;
  if (parts.size() == 1 && text.find_first_not_of("0123456789") == std::string::npos) {
    rule.count = parse_whole_number("--bins", text, 1, max_bins);
    return rule;
  }
  for (const std::string& part : parts) rule.edges.push_back(parse_number("--bins", part, any_number));
  if (rule.edges.size() >= max_bins)
    throw CLI::ValidationError("--bins", "more than " + std::to_string(max_bins) + " bins");
  if (std::adjacent_find(rule.edges.begin(), rule.edges.end(), std::greater_equal<>()) != rule.edges.end())
    throw CLI::ValidationError("--bins", "the values between bins, " + text + ", must ascend");
  return rule;
}

ModulusLaw parse_modulus(const std::string& text) {
  const std::vector<std::string> parts = comma_separated_parts(text);
  if (parts.size() != 2 && parts.size() != 4)
    throw CLI::ValidationError("--modulus",
                               "'" + text + "' is not A,B or A,B,S,T of the law A (S value + T)^B");
  std::vector<double> numbers;
  numbers.reserve(parts.size());
  for (const std::string& part : parts)
    numbers.push_back(parse_number("--modulus", part, numbers.empty() ? positive : any_number));
  ModulusLaw law;
  law.factor = numbers[0];
  law.exponent = numbers[1];
  if (numbers.size() == 4) {
    law.scale = numbers[2];
    law.offset = numbers[3];
  }
  return law;
}

void add_statistics(CLI::App& app, CommandLine& c) {
  app.add_option_function<std::string>(
         "--values-statistics",
         [&c](const std::string& text) {
           for (const std::string& word : comma_separated_parts(text)) {
             ValueOptions& values = c.options.values;
             if (word == "min")
               values.minimum = true;
             else if (word == "max")
               values.maximum = true;
             else if (word == "deviation")
               values.deviation = true;
             else
               throw CLI::ValidationError("--values-statistics",
                                          "'" + word + "' is not one of min, max, deviation");
           }
         },
         "Further fields of the values in each tet, NAME_min, NAME_max, NAME_deviation: any of "
         "min,max,deviation")
      ->type_name("NAMES");
}

}  // namespace

ValueImage parse_value_image(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0 && equals + 1 < text.size())
    return {text.substr(0, equals), text.substr(equals + 1)};
  return {file_stem(text), text};
}

void add_value_rules(CLI::App& app, CommandLine& c) {
  add_statistics(app, c);
  app.add_option_function<std::string>(
         "--values-mask",
         [&c](const std::string& text) {
           c.options.values.own_label = text == "labels";
           if (!c.options.values.own_label) c.options.values.mask_file = text;
         },
         "Volume whose voxels other than 0 say which ones of the images count; labels: in each tet those "
         "with "
         "the label of its material, for segmented volumes (default: all)")
      ->type_name("FILE|labels");
  app.add_option_function<std::vector<std::string>>(
         "--bins",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all) {
             const NamedValue named = split_named(text, "--bins", "N");
             c.options.values.bins.push_back({named.name, parse_bins(named.value)});
           }
         },
         "Divide the tets of each material by the values NAME: into N bins of equal width, or at these "
         "values; sets MATERIAL_001, MATERIAL_002 ... in .inp .bdf .feb .msh, and a table beside the mesh; "
         "repeatable for other NAMEs, with sets MATERIAL_NAME_001 ...")
      ->expected(1)
      ->type_name("NAME=N|A,B,...")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option_function<std::vector<std::string>>(
         "--modulus",
         [&c](const std::vector<std::string>& all) {
           if (all.size() > 1)
             throw CLI::ValidationError("--modulus",
                                        "only one is possible in a call, since an element has "
                                        "one section with one material; leave out the others");
           const NamedValue named = split_named(all.front(), "--modulus", "A,B");
           c.modulus_of = named.name;
           c.modulus = parse_modulus(named.value);
         },
         "Elastic modulus of each bin of NAME, A (S value + T)^B of its mean value; S is 1 and T 0 by "
         "default. Poisson's ratio is 0.3. For .inp .bdf .feb; once, since a tet has one modulus")
      ->expected(1)
      ->type_name("NAME=A,B[,S,T]")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_number(app, "--min-modulus", c.min_modulus, positive,
             "Bins of a smaller modulus get this one, such as those of marrow and air");
}

void add_values_options(CLI::App& app, CommandLine& c) {
  app.add_option_function<std::vector<std::string>>(
         "--values",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all) {
             const NamedValue image = split_named(text, "--values", "IMAGE");
             c.options.values.images.push_back({image.name, image.value});
           }
         },
         "Mean of an image over each tet as the cell field NAME, and its value at each point; repeatable")
      ->expected(1)
      ->type_name("NAME=IMAGE")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_value_rules(app, c);
}

void complete_value_options(CommandLine& out) {
  ValueOptions& values = out.options.values;
  if (out.min_modulus && !out.modulus)
    throw UsageError("--min-modulus is for --modulus; give that too, or leave it out");
  if (!out.modulus) return;
  if (values.images.empty())
    throw UsageError("--modulus is for the values of an image; give --values NAME=IMAGE");
  if (out.min_modulus) out.modulus->minimum = *out.min_modulus;
  const auto bins = std::find_if(values.bins.begin(), values.bins.end(),
                                 [&](const ValueBins& of) { return of.of == out.modulus_of; });
  if (bins == values.bins.end())
    throw UsageError("--modulus " + out.modulus_of + " needs the bins of these values; give --bins " +
                     out.modulus_of + "=N");
  bins->modulus = out.modulus;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tools/app/body_options.h"

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/io/surfaces/declared_space.h"
#include "tools/app/command_line.h"
#include "tools/app/option_values.h"

namespace tetwright {

namespace {

/// Adds an option whose value is one of `rules`, the first of them by default.
template <class Rule>
void add_rule(CLI::App& app, const std::string& name, Rule& to,
              const std::vector<std::pair<std::string, Rule>>& rules, const std::string& description) {
  const auto parse = [name, rules, &to](const std::string& text) {
    std::string names;
    for (const auto& [word, rule] : rules) {
      if (word == text) {
        to = rule;
        return;
      }
      names += (names.empty() ? "" : ", ") + word;
    }
    throw CLI::ValidationError(name, "'" + text + "' is not one of " + names);
  };
  app.add_option_function<std::string>(name, parse, description)
      ->type_name("RULE")
      ->default_str(rules[0].first);
}

/// Adds an option whose value is LPS or RAS.
void add_space(CLI::App& app, const std::string& name, std::string& to, const std::string& description) {
  add_parsed<std::string>(
      app, name, to, "LPS|RAS",
      [name](const std::string& text) {
        std::string space = space_called(text);
        if (space.empty()) throw CLI::ValidationError(name, "'" + text + "' is not LPS or RAS");
        return space;
      },
      description);
}

}  // namespace

void add_surface_space(CLI::App& app, CommandLine& c, const std::string& description) {
  add_space(app, "--surface-space", c.options.bodies.surface_space, description);
}

void add_mesh_space(CLI::App& app, CommandLine& c) {
  add_space(
      app, "--mesh-space", c.options.mesh_space,
      "Coordinate system of MESH if its file names none; surfaces, images and sizes are brought into that of "
      "MESH");
}

void add_bodies(CLI::App& app, CommandLine& c) {
  app.add_option_function<std::vector<std::string>>(
         "--material",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all) c.materials.push_back(split_named(text, "--material", "FILE"));
         },
         "Another surface, as the material NAME; repeatable. Later materials carve earlier ones")
      ->expected(1)
      ->type_name("NAME=FILE")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_flag("--split-solids", c.options.bodies.split_solids,
               "Each solid, group or label of a surface's triangles becomes a material of that name, instead "
               "of a patch of its boundary; later ones carve earlier ones");
  app.add_option_function<std::vector<std::string>>(
         "--layer",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all) {
             const NamedValue layer = split_named(text, "--layer", "THICKNESS");
             c.options.bodies.layers.push_back({layer.name, parse_number("--layer", layer.value, positive)});
           }
         },
         "A layer under the first surface, a material of this thickness in input units; repeatable, "
         "outermost first")
      ->expected(1)
      ->type_name("NAME=THICKNESS")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_rule<NestedRule>(
      app, "--nested", c.options.bodies.nested,
      {{"auto", NestedRule::automatic},
       {"cavity", NestedRule::cavity},
       {"solid", NestedRule::solid},
       {"material", NestedRule::material}},
      "Treat closed parts inside others as: cavity, solid, material (a separate one), or auto "
      "(cavities if wound the opposite way, else solid)");
  add_surface_space(app, c,
                    "Coordinate system of surfaces and size fields whose files name none; all inputs are "
                    "brought into that of the first one (default: that of the first one)");
  add_length(app, "--contact-tolerance", c.options.bodies.contact_tolerance,
             "Join bodies across gaps and overlaps up to this")
      ->default_str("0.001%");
  add_rule<OverlapRule>(app, "--on-overlap", c.options.bodies.overlap,
                        {{"later", OverlapRule::later},
                         {"first", OverlapRule::first},
                         {"material", OverlapRule::material},
                         {"error", OverlapRule::error}},
                        "Give what two crossing bodies, or two masks, claim to: later (the later one), first "
                        "(the earlier one), "
                        "material (one of its own, A+B), or refuse it: error");
  add_rule<RegionRule>(
      app, "--regions", c.options.bodies.regions.rule,
      {{"cells", RegionRule::cells}, {"outer", RegionRule::outer}},
      "Inner walls of a surface divide it into materials NAME_1, NAME_2 ... (by volume), or are sheets where "
      "they end inside: cells; or all are left out: outer");
  const auto add_sheets = [&](const char* option, std::vector<NamedValue>& sheets, const char* help) {
    app.add_option_function<std::vector<std::string>>(
           option,
           [option, &sheets](const std::vector<std::string>& all) {
             for (const std::string& text : all) sheets.push_back(split_named(text, option, "FILE"));
           },
           help)
        ->expected(1)
        ->type_name("NAME=FILE")
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  };
  add_sheets("--sheet", c.sheets,
             "An open surface inside the bodies (baffle, membrane, fracture): its triangles become faces of "
             "the mesh, the patch NAME, with one material on both sides; repeatable");
  add_sheets("--partition", c.partitions,
             "An open surface that cuts a body into materials (horizon, fault), named like those between "
             "inner walls; repeatable");
  add_length(
      app, "--extend", c.options.bodies.extend,
      "Continue the borders of --partition surfaces to the boundary where they end this far before it");
  app.add_option_function<std::vector<std::string>>(
         "--region",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all)
             c.options.bodies.regions.seeds.push_back(parse_seed("--region", text));
         },
         "Name the cell around this point, of inner walls or of files that close together; repeatable")
      ->expected(1)
      ->type_name("NAME@X,Y,Z")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option_function<std::vector<std::string>>(
         "--cap",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all) c.options.bodies.caps.push_back(parse_seed("--cap", text));
         },
         "Call the cap nearest to this point NAME: the patch that closes a hole; repeatable (default: cap_1, "
         "cap_2 ... by size)")
      ->expected(1)
      ->type_name("NAME@X,Y,Z")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_parsed<std::optional<BaseHeight>>(
      app, "--base", c.options.bodies.base, "Z|auto",
      [](const std::string& text) -> std::optional<BaseHeight> {
        if (text == "auto") return BaseHeight();
        constexpr Range height{-max_number, max_number, true, "a height, or auto"};
        return BaseHeight(parse_number("--base", text, height));
      },
      "Open surfaces are height fields: walls and a flat base at z = Z below each make it a block, with "
      "patches top, side, base; auto: a tenth of its width below it");
  add_length(app, "--thicken", c.options.bodies.thickness,
             "Open surfaces are the fronts of shells this thick, which lie behind them, with patches front, "
             "back, rim");
}

}  // namespace tetwright

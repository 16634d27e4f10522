// SPDX-License-Identifier: Apache-2.0
#include "tools/python/option_types.h"

#include <CLI/CLI.hpp>

#include "tools/app/command_line.h"
#include "tools/app/command_options.h"

namespace tetwright::python {

std::map<std::string, std::string> option_types(const std::string& command) {
  const std::map<std::string, void (*)(CLI::App&, CommandLine&)> commands{
      {"prepare", add_prepare}, {"mesh", add_mesh},   {"simplify", add_simplify}, {"improve", add_improve},
      {"values", add_values},   {"embed", add_embed}, {"check", add_check}};
  std::map<std::string, std::string> types;
  const auto add_options = commands.find(command);
  if (add_options == commands.end()) return types;
  CLI::App app;
  CommandLine line;
  line.in_memory = true;
  add_options->second(app, line);
  for (const CLI::Option* option : app.get_options()) {
    if (option == app.get_help_ptr()) continue;
    for (const std::string& name : option->get_lnames())
      types["--" + name] = option->get_items_expected_max() == 0 ? "" : option->get_type_name();
  }
  return types;
}

}  // namespace tetwright::python

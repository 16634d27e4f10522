// SPDX-License-Identifier: Apache-2.0
#include "tools/app/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iostream>

#include "tetwright/error.h"
#include "tools/app/command_options.h"
#include "tools/app/nearest_word.h"
#include "tools/app/option_rules.h"
#include "tools/app/option_values.h"

namespace tetwright {

namespace {

std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  for (char& ch : text)
    if (ch == '\n') ch = ' ';
  return text;
}

/// The commands, in the order of the help.
struct CommandEntry {
  Command command;
  const char* description;
  void (*add_options)(CLI::App& app, CommandLine& c);
};
constexpr std::array<CommandEntry, 9> commands{{
    {Command::prepare, "Turns scans or a segmented volume into a simulation mesh, in one go", add_prepare},
    {Command::mesh, "Turns scans or a segmented volume into a dense mesh", add_mesh},
    {Command::simplify, "Reduces the number of tets of a tet mesh", add_simplify},
    {Command::improve, "Improves the shapes of a tet mesh, keeping the number of tets nearly the same",
     add_improve},
    {Command::values, "Adds the values of images to a tet mesh, which otherwise stays as it is", add_values},
    {Command::embed,
     "Finds the weights by which a tet mesh carries the points of a finer surface: tet and barycentric "
     "coordinates of each",
     add_embed},
    {Command::check,
     "Reports validity, topology and quality of a tet mesh, and its distance from surfaces; status 1 if it "
     "is not valid (a warning, such as an unused point, leaves it valid)",
     add_check},
    {Command::batch, "Runs many jobs concurrently; resumes an earlier call; status 1 unless all ended with 0",
     add_batch},
    {Command::sample, "Writes a built-in sample", add_sample},
}};

/// Rejects a call without a command or with an unknown one.
void check_command(int argc, char** argv) {
  if (argc > 1 && argv[1][0] == '-') return;
  std::vector<std::string> names;
  names.reserve(commands.size());
  for (const CommandEntry& entry : commands) names.emplace_back(name_of(entry.command));
  if (argc < 2)
    throw UsageError("there is no command; give one of " + comma_separated(names) +
                     " (tetwright --help explains them)");
  const std::string typed = argv[1];
  if (std::find(names.begin(), names.end(), typed) != names.end()) return;
  throw UsageError("there is no command '" + typed + "'; the nearest is '" + nearest_word(typed, names) +
                   "' (commands: " + comma_separated(names) + ")");
}

/// Text that suggests the nearest option for the first argument that looks like an option but is unknown;
/// empty if there is no such argument.
std::string unknown_option(const CLI::App& app) {
  const CLI::App* chosen = app.get_subcommands().empty() ? &app : app.get_subcommands().front();
  for (const std::string& argument : app.remaining(true)) {
    if (argument == "--") break;  // all following arguments are names
    if (!argument.starts_with('-') || argument.size() < 2) continue;
    const std::string typed = argument.substr(0, argument.find('='));
    std::vector<std::string> names;
    for (const CLI::Option* option : chosen->get_options())
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return "there is no option " + typed + (chosen == &app ? "" : " of " + chosen->get_name()) +
           "; the nearest is " + nearest_word(typed, names);
  }
  return "";
}

/// Rejects `--option=` without a value, for which the parser would take the next argument.
void check_values(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.starts_with("--") && argument.find('=') == argument.size() - 1)
      throw UsageError(argument + " has no value; give one, or leave the option out");
  }
}

/// Rejects more than one MESH or NAME. The parser's own message gives their number, not their names.
void check_one_positional(const CLI::App& app) {
  for (const CLI::App* chosen : app.get_subcommands())
    for (const CLI::Option* positional : chosen->get_options())
      if (positional->get_positional() && positional->get_items_expected_max() == 1 &&
          positional->count() > 1)
        throw UsageError(chosen->get_name() + " takes one " + positional->get_name() + "; '" +
                         positional->results()[1] + "' is too many");
}

/// Runs the parser, which sets the options.
/// \return false if help or the version was printed
bool parse_arguments(CLI::App& app, int argc, char** argv) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();  // help of the command, if one was given
    return false;
  } catch (const CLI::CallForVersion&) {
    std::cout << "tetwright " << TETWRIGHT_VERSION << "\n";
    return false;
  } catch (const CLI::ParseError& e) {
    // The parser may report a misspelt option as a missing one.
    const std::string unknown = unknown_option(app);
    if (unknown.empty()) check_one_positional(app);
    if (const auto* mismatch = dynamic_cast<const CLI::ArgumentMismatch*>(&e); mismatch && unknown.empty()) {
      const std::string what = e.what();  // "--output: At Most 1 required but received 2"
      if (const std::size_t at = what.find(": At Most 1 "); at != std::string::npos)
        throw UsageError(what.substr(0, at) + " was given more than once; give it once");
    }
    throw UsageError((unknown.empty() ? one_line(e.what()) : unknown) +
                     " (tetwright --help, or --help after a command, lists all options)");
  }
  return true;
}

}  // namespace

bool makes_mesh(Command command) {
  return command == Command::prepare || command == Command::mesh || command == Command::simplify ||
         command == Command::improve || command == Command::values;
}

Task task_of(Command command) {
  TETWRIGHT_CHECK(makes_mesh(command));
  return command == Command::prepare    ? Task::prepare
         : command == Command::mesh     ? Task::mesh
         : command == Command::simplify ? Task::simplify
         : command == Command::values   ? Task::values
                                        : Task::improve;
}

const char* name_of(Command command) {
  switch (command) {
    case Command::prepare:
      return "prepare";
    case Command::mesh:
      return "mesh";
    case Command::simplify:
      return "simplify";
    case Command::improve:
      return "improve";
    case Command::values:
      return "values";
    case Command::embed:
      return "embed";
    case Command::check:
      return "check";
    case Command::batch:
      return "batch";
    case Command::sample:
      return "sample";
  }
  return "";
}

const char* name_of(Schedule schedule) { return schedule == Schedule::tuned ? "tuned" : "paper"; }

const char* name_of(ProgressStyle style) {
  switch (style) {
    case ProgressStyle::automatic:
      return "auto";
    case ProgressStyle::bar:
      return "bar";
    case ProgressStyle::json:
      return "json";
    case ProgressStyle::none:
      return "none";
  }
  return "";
}

const char* name_of(ShapeObjective objective) {
  return objective == ShapeObjective::both          ? "both"
         : objective == ShapeObjective::solid_angle ? "solid-angle"
                                                    : "dihedral";
}

bool parse_command_line(int argc, char** argv, CommandLine& out) {
  check_command(argc, argv);
  check_values(argc, argv);
  CLI::App app("Turns surface scans and segmented volumes into tetrahedral meshes for simulation.",
               "tetwright");
  app.set_version_flag("--version", TETWRIGHT_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done, 1 written but short of the request (check: not valid), 2 invalid call, 3 bad "
      "input,\n4 nothing to mesh, 5 output could not be written, or out of memory or time, 70 a bug in "
      "tetwright, 130 interrupted.");
  for (const CommandEntry& entry : commands)
    entry.add_options(*app.add_subcommand(name_of(entry.command), entry.description), out);
  if (!parse_arguments(app, argc, argv)) return false;
  const CLI::App& chosen = *app.get_subcommands().front();
  for (const CommandEntry& entry : commands)
    if (chosen.get_name() == name_of(entry.command)) out.command = entry.command;
  complete_command_line(out);
  for (int i = 1; i < argc; ++i) out.arguments += " " + std::string(argv[i]);
  out.call = argv[0] + out.arguments;
  return true;
}

}  // namespace tetwright

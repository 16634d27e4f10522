// SPDX-License-Identifier: Apache-2.0
#include "tools/app/brick_options.h"

#include <bit>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>

#include "tools/app/option_values.h"

namespace tetwright {

namespace {

/// Parses the value of --bricks: their use, and their cells or 0.
std::pair<BrickOptions::Use, int> parse_bricks(const std::string& text) {
  if (text == "auto") return {BrickOptions::Use::automatic, 0};
  if (text == "off") return {BrickOptions::Use::never, 0};
  const auto invalid = [&] {
    return CLI::ValidationError("--bricks", "'" + text + "' is not auto, off or a power of two from " +
                                                std::to_string(min_brick_cells) + " to " +
                                                std::to_string(max_brick_cells));
  };
  std::uint64_t cells = 0;
  try {
    cells = parse_whole_number("--bricks", text, min_brick_cells, max_brick_cells);
  } catch (const CLI::ValidationError&) {
    throw invalid();
  }
  if (!std::has_single_bit(cells)) throw invalid();
  return {BrickOptions::Use::always, static_cast<int>(cells)};
}

/// Parses the value of --brick-rounds; 0: auto.
int parse_brick_rounds(const std::string& text) {
  if (text == "auto") return 0;
  try {
    return static_cast<int>(parse_whole_number("--brick-rounds", text, 1, max_brick_rounds));
  } catch (const CLI::ValidationError&) {
    throw CLI::ValidationError("--brick-rounds", "'" + text + "' is not auto or a number from 1 to " +
                                                     std::to_string(max_brick_rounds));
  }
}

}  // namespace

void add_bricks(CLI::App& app, CommandLine& c) {
  app.add_option_function<std::string>(
         "--bricks",
         [&c](const std::string& text) {
           std::tie(c.options.bricks.use, c.options.bricks.cells) = parse_bricks(text);
         },
         "Mesh and coarsen a segmented volume in bricks with this many cells along each edge, a power of two "
         "from 32 to 1024, so that its dense mesh is never in memory at once; auto: if that would not fit. "
         "Equal numbers give equal bytes (with equal --brick-rounds)")
      ->type_name("CELLS|auto|off")
      ->default_str("auto");
  app.add_option_function<std::string>(
         "--brick-rounds",
         [&c](const std::string& text) { c.options.bricks.rounds = parse_brick_rounds(text); },
         "How often bricks are coarsened before all are joined, each time with other cuts; auto: as often as "
         "the memory requires. With given --bricks, equal numbers give equal bytes")
      ->type_name("1|2|3|auto")
      ->default_str("auto");
  app.add_option_function<std::string>(
         "--scratch",
         [&c](const std::string& folder) {
           if (folder.empty()) throw CLI::ValidationError("--scratch", "the name of the folder is empty");
           c.options.bricks.scratch = folder;
         },
         "Folder for finished bricks, which then need no memory: if the run is stopped, the same call "
         "goes on from them. They are removed once the mesh is written")
      ->type_name("DIR");
}

}  // namespace tetwright

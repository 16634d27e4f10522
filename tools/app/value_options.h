// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "tools/app/command_line.h"

namespace tetwright {

/// Adds the options that decide about the values of images: all but the images.
void add_value_rules(CLI::App& app, CommandLine& c);

/// Adds --values and the options for them.
void add_values_options(CLI::App& app, CommandLine& c);

/// Parses NAME=IMAGE, or IMAGE, whose name is that of the file without its extension.
ValueImage parse_value_image(const std::string& text);

/// Combines options of bins and moduli, which may be in any order.
///
/// \throws UsageError if they cannot be combined
void complete_value_options(CommandLine& out);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace tetwright {

struct CommandLine;

/// Adds the options of images that are divided into materials.
void add_images(CLI::App& app, CommandLine& line);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "tetwright/prepare.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"
#include "tools/app/command_line.h"

namespace tetwright {

/// Edge lengths at the points of a tet mesh or surface; finite and above 0 at points that an element uses.
struct SizesObject {
  std::variant<TetMesh, TriangleMesh> elements;
  std::vector<double> lengths;  ///< input units
};

/// Inputs in the memory of a host program, by the names that refer to them in a CommandLine. Messages show a
/// name in full, and it may become a material's name. A name that is not listed is a file.
struct NamedInputs {
  std::map<std::string, Input::Value> values;
  std::map<std::string, SizesObject> sizes;                          ///< sources for --size-field
  std::map<std::string, std::shared_ptr<const ImageVolume>> images;  ///< for --values
  std::map<std::string, std::shared_ptr<const LabelVolume>> masks;   ///< for --values-mask
};

/// Input for a name on the command line: standard input, a file, or a value moved out of `in_memory`.
///
/// \param in_memory may be null
Input input_named(const std::string& name, const CommandLine& line, NamedInputs* in_memory);

/// Positional inputs, followed by those of --material, --sheet and --partition.
std::vector<Input> inputs_of(const CommandLine& line, NamedInputs* in_memory);

/// Makes a size field in memory the source of sizes in `options`.
void take_sizes(NamedInputs& in_memory, SizeOptions& options);

/// Makes images and a mask in memory those of `options`.
void take_images(const NamedInputs& in_memory, ValueOptions& options);

}  // namespace tetwright

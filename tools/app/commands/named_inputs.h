// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <variant>
#include <vector>

#include "tetwright/prepare.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"
#include "tools/app/command_line.h"

namespace tetwright {

/// Edge lengths at the points of a tet mesh or a surface; each is finite and above 0 where an element uses
/// the point.
struct SizesObject {
  std::variant<TetMesh, TriangleMesh> elements;
  std::vector<double> lengths;  ///< input units
};

/// Inputs that a host program has in memory, by what stands for them in a CommandLine where a file's name
/// would: it names them in messages, and materials, whole. What is not among them is a file.
struct NamedInputs {
  std::map<std::string, Input::Value> values;
  std::map<std::string, SizesObject> sizes;  ///< of --size-field
};

/// The input that a name on the command line stands for: standard input, a file, or what `in_memory` (may be
/// null) has, which is moved out of.
Input input_named(const std::string& name, const CommandLine& line, NamedInputs* in_memory);

/// The positional inputs, then those of --material.
std::vector<Input> inputs_of(const CommandLine& line, NamedInputs* in_memory);

/// Makes a size field in memory the source of the sizes in `options`.
void take_sizes(NamedInputs& in_memory, SizeOptions& options);

}  // namespace tetwright

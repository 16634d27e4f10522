// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <vector>

#include "common/mesh/midside_nodes.h"
#include "common/tet_mesh.h"
#include "tools/app/command_line.h"

namespace tetwright::python {

namespace py = pybind11;

/// A mesh that belongs to Python, and what the command that made it said.
struct Mesh {
  TetMesh mesh;
  std::optional<MidsideNodes> midside;
  std::string stats;  ///< JSON; empty if no command made it
  std::vector<std::string> notes, shortfall;
};

/// Throws UsageError where the call would write to standard output, which is the host's.
void check_no_standard_output(const CommandLine& line);

/// Defines Mesh in the module: read-only views of its arrays, which keep it alive, and write().
void bind_mesh(py::module_& module);

}  // namespace tetwright::python

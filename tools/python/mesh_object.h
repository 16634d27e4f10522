// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/pybind11.h>

#include <optional>
#include <string>
#include <vector>

#include "tetwright/parted_interfaces.h"
#include "tetwright/tet_mesh.h"
#include "tools/app/command_line.h"

namespace tetwright::python {

namespace py = pybind11;

/// A mesh owned by Python, with the report of the command that made it.
struct Mesh {
  TetMesh mesh;
  std::optional<MidsideNodes> midside;
  std::vector<TetBins> bins;
  std::vector<PartedInterface> parted;  ///< by the command
  std::string stats;                    ///< JSON; empty if no command made it
  std::vector<std::string> notes, shortfall;
};

/// Rejects calls that would write to standard output, which belongs to the host.
///
/// \throws UsageError if the call would
void check_no_standard_output(const CommandLine& line);

/// Defines Mesh in the module, with write() and read-only views of its arrays; the views keep the mesh alive.
void bind_mesh(py::module_& module);

}  // namespace tetwright::python

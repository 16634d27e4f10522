// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "common/io/names/mesh_parts.h"
#include "tetwright/files.h"
#include "tetwright/io.h"

namespace tetwright {

/// Constraints on names and numbers in write_exodus().
NameRules exodus_names();

/// Converts a name to one that MOOSE and the other readers of Exodus can refer to: no white space, at most 80
/// bytes with the suffix that makes it unique, and not digits alone, which would be the number of a block.
std::string exodus_name(const std::string& name);

/// Sizes of numbers in an Exodus file.
struct ExodusForm {
  bool large_variables = false;  ///< CDF-5 instead of CDF-2
  bool long_numbers = false;     ///< node and element numbers of 64 bits, for which CDF-5 is needed
};

/// The form that most readers take among those that can hold a mesh.
/// \param largest_variable bytes
ExodusForm exodus_form(std::size_t nodes, std::size_t tets, std::size_t largest_variable);

/// Writes an Exodus II file (classic netCDF): an element block of TETRA4 or TETRA10
/// elements for each material; a side set and a node set for each surface of a mesh with interfaces, with the
/// same number and name; and fields as nodal and element variables at time 0, a variable for each component.
///
/// Elements are listed block by block; elem_num_map has their numbers in the mesh, from 1. Side sets hold
/// each face once, on the side of the smaller tag. Equal meshes give equal bytes: the QA record has no date.
/// Needs memory for the whole file. May be called concurrently, one call waiting for the other.
/// \throws
/// OutputError without has_netcdf() or without the memory
void write_exodus(const MeshToWrite& written, const ByteSink& sink);
/// Likewise, in this form.
/// \pre the form can hold the mesh
void write_exodus_as(const ExodusForm& form, const MeshToWrite& written, const ByteSink& sink);

}  // namespace tetwright

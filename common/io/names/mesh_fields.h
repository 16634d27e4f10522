// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/io/contents/read_tet_mesh_result.h"

namespace tetwright {

/// Doubles represent every whole number up to this one. From it on they may stand for another one.
inline constexpr double max_exact_whole = 0x1p53;

/// The name in a form that every format can hold: valid UTF-8 of at most 200 bytes, with underscores for
/// control characters and bytes that are not UTF-8; "field" if it is empty.
std::string field_name(std::string_view name);

/// field_name() of each field, in the form that a format can hold (null: as it is), made unique: a name that
/// is in `taken` or that an earlier field has gets the suffix "_2", "_3" and so on.
std::vector<std::string> field_names_to_write(const std::vector<MeshField>& fields,
                                              std::vector<std::string> taken,
                                              std::string (*form)(const std::string& name) = nullptr);

/// Whether every value is whole and exactly represented (below 2^53 in absolute value).
bool all_whole(const MeshField& field);

/// Marks a field that the file has as integers as such, unless doubles are too short for one of them: then it
/// is none, and `rounded` gets the number of these under its name.
void take_integers(MeshField& field, KindCounts& rounded);

/// Chooses the material of the tets as ReadTetMesh::material_field describes: fills mesh.materials from a
/// cell field, removes that field, and sets material_field. The reader has filled in the tets and, if the
/// format has a place of its own for materials, mesh.materials and the name of that place as material_field;
/// `also` are names that the options may ask for as well, for the message. Throws InputError if the field
/// that is asked for is missing or its values are not material tags. A field named "material" must have whole
/// numbers; a field with another of the known names that has others is not taken.
void take_material(ReadTetMesh& read, const ReadTetMeshOptions& options, const std::string& file,
                   const std::vector<std::string>& also = {});

}  // namespace tetwright

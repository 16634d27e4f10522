// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tetwright/io.h"

namespace tetwright {

/// Doubles represent every whole number below this exactly; from here on a value may stand for a different
/// number.
inline constexpr double max_exact_whole = 0x1p53;

/// Converts a name to a form that every format can hold: valid UTF-8 of at most 200 bytes, with underscores
/// for control characters and bytes that are not UTF-8; "field" if it is empty.
std::string field_name(std::string_view name);

/// Unique names of fields: field_name() in a form that the format can hold.
/// \param taken names that no field may have. If a name is taken or equals an earlier one, it gets the suffix
///   "_2", "_3" and so on
/// \param form converts a name to that form; null: unchanged
std::vector<std::string> field_names_to_write(const std::vector<MeshField>& fields,
                                              std::vector<std::string> taken,
                                              std::string (*form)(const std::string& name) = nullptr);

/// Extends a field of the tets by values for `triangles` more cells: 0 in integer fields, otherwise NaN.
MeshField with_triangles(MeshField field, std::size_t triangles);

/// Whether every value is whole and exactly represented (below 2^53 in absolute value).
bool all_whole(const MeshField& field);

/// Marks a field of integers as an integer field, unless a double cannot represent one of them: then the
/// field stays floating-point, and `rounded` counts such numbers under the field's name.
void take_integers(MeshField& field, KindCounts& rounded);

/// Chooses the material of the tets as ReadTetMesh::material_field describes: fills mesh.materials from a
/// cell field, removes that field, and sets material_field. A field named "material" must have whole numbers;
/// fields with the other known names are skipped if they have other values.
/// \param also further names that the options may request, for the message
/// \pre the reader has filled in the tets and, if the format stores materials itself, mesh.materials and, in
///   material_field, the format's name for them
/// \throws InputError if the requested field is missing or its values are not material tags
void take_material(ReadTetMesh& read, const ReadTetMeshOptions& options, const std::string& file,
                   const std::vector<std::string>& also = {});

}  // namespace tetwright

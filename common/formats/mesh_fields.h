#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/formats/read_tet_mesh_result.h"

namespace tetwright {

/// Numbers beyond it are not all whole as doubles.
inline constexpr double largest_whole = 0x1p53;

/// A field's name as any format can hold it: valid UTF-8 of at most 200 bytes, control characters and bytes
/// that are no UTF-8 replaced by underscores, "field" where it is empty.
std::string field_name(std::string_view name);

/// field_name() of each field, made unique: what is in `taken` or came before gets "_2", "_3" and so on.
std::vector<std::string> field_names_to_write(const std::vector<MeshField>& fields,
                                              std::vector<std::string> taken);

/// Every value is whole and exact as a double (at most 2^53 in size).
bool all_whole(const MeshField& field);

/// Fills mesh.materials from one of mesh.cell_fields, which is then removed, and sets material_field: see
/// ReadTetMesh. The reader has put in the tets and, where the format has a place for materials, these with
/// the name of that place as material_field; `also` names more that could be asked for. Throws InputError if
/// the field asked for is not there or its values are no material tags. What is called "material" must be
/// whole numbers; other known names that are not are no materials.
void take_material(ReadTetMesh& read, const ReadTetMeshOptions& options, const std::string& file,
                   const std::vector<std::string>& also = {});

}  // namespace tetwright

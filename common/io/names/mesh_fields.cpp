// SPDX-License-Identifier: Apache-2.0
#include "common/io/names/mesh_fields.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "common/io/text/text_scanner.h"
#include "common/number_text.h"
#include "common/utf8.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr std::size_t max_name_size = 200;  // bytes

bool is_whole(double value) { return value == std::floor(value) && std::fabs(value) < max_exact_whole; }

/// Converts a field to materials.
/// \param file file name for messages
std::vector<MaterialTag> materials_of(const MeshField& field, const std::string& file) {
  std::vector<MaterialTag> materials(field.values.size());
  for (std::size_t t = 0; t < materials.size(); ++t) {
    const double value = field.values[t];
    if (!is_whole(value)) {
      std::string text;
      append_number(text, value);
      throw InputError(file, 0,
                       "cell field " + in_quotes(field.name) + " was chosen as the material, but tet " +
                           std::to_string(t) + " (counted from 0) has " + text +
                           ", which is not a 32-bit integer");
    }
    materials[t] = checked_material(static_cast<std::int64_t>(value), file, 0);
  }
  return materials;
}

/// Index of the cell field to use as the material, or the number of fields if there is none.
std::size_t field_by_rule(const std::vector<MeshField>& fields) {
  for (const char* name : {"material", "medit:ref", "gmsh:physical", "MaterialID", "attribute"})
    for (std::size_t f = 0; f < fields.size(); ++f)
      if (fields[f].name == name && fields[f].components == 1 &&
          (fields[f].integer || fields[f].name == "material" || all_whole(fields[f])))
        return f;
  std::size_t only = fields.size();
  for (std::size_t f = 0; f < fields.size(); ++f) {
    if (!fields[f].integer || fields[f].components != 1) continue;
    if (only != fields.size()) return fields.size();
    only = f;
  }
  return only;
}

[[noreturn]] void fail_no_such_field(const ReadTetMesh& read, const std::string& wanted,
                                     const std::string& file, const std::vector<std::string>& also) {
  std::vector<std::string> names = also;
  if (!read.material_field.empty()) names.insert(names.begin(), read.material_field);
  for (const MeshField& field : read.mesh.cell_fields)
    if (field.components == 1 && all_whole(field)) names.push_back(field.name);
  constexpr std::size_t max_names = 20;
  std::string list;
  for (std::size_t i = 0; i < std::min(max_names, names.size()); ++i)
    list += (i ? ", " : "; there is ") + in_quotes(names[i]);
  if (names.size() > max_names) list += " and " + std::to_string(names.size() - max_names) + " more";
  throw InputError(file, 0,
                   "no cell field " + in_quotes(wanted) + " with one number for each tet" +
                       (list.empty() ? "; there is no integer cell field in it" : list));
}

}  // namespace

std::string field_name(std::string_view name) {
  name = name.substr(0, max_name_size);
  std::string out;
  while (!name.empty()) {
    const auto [n, valid] = first_utf8_part(name);
    if (!valid || static_cast<unsigned char>(name[0]) < ' ' || name[0] == 127)
      out += '_';
    else
      out += name.substr(0, n);
    name.remove_prefix(valid ? n : 1);
  }
  return out.empty() ? "field" : out;
}

std::vector<std::string> field_names_to_write(const std::vector<MeshField>& fields,
                                              std::vector<std::string> taken,
                                              std::string (*form)(const std::string& name)) {
  std::set<std::string> used(taken.begin(), taken.end());
  std::map<std::string, std::size_t> next;  // next suffix to try, so that many equal names take linear time
  std::vector<std::string> names;
  for (const MeshField& field : fields) {
    const std::string plain = field_name(field.name), name = form ? form(plain) : plain;
    std::string unique = name;
    std::size_t& number = next.try_emplace(name, 2).first->second;
    while (!used.insert(unique).second) unique = name + "_" + std::to_string(number++);
    names.push_back(unique);
  }
  return names;
}

MeshField with_triangles(MeshField field, std::size_t triangles) {
  field.values.resize(field.values.size() + triangles * static_cast<std::size_t>(field.components),
                      field.integer ? 0.0 : std::numeric_limits<double>::quiet_NaN());
  return field;
}

bool all_whole(const MeshField& field) {
  return std::all_of(field.values.begin(), field.values.end(), is_whole);
}

void take_integers(MeshField& field, KindCounts& rounded) {
  const auto exact =
      static_cast<std::size_t>(std::count_if(field.values.begin(), field.values.end(), is_whole));
  field.integer = exact == field.values.size();
  rounded.add("exact values of integers from 2^53 on in the field " + in_quotes(field.name),
              field.values.size() - exact);
}

void take_material(ReadTetMesh& read, const ReadTetMeshOptions& options, const std::string& file,
                   const std::vector<std::string>& also) {
  TetMesh& mesh = read.mesh;
  std::vector<MeshField>& fields = mesh.cell_fields;
  std::size_t taken = fields.size();
  if (options.material_field.empty()) {
    if (!read.material_field.empty()) return;
    taken = field_by_rule(fields);
  } else {
    if (options.material_field == read.material_field) return;
    const std::string wanted = field_name(options.material_field);
    for (std::size_t f = fields.size(); f-- > 0;)
      if (fields[f].name == wanted && fields[f].components == 1) taken = f;
    if (taken == fields.size() && options.material_field_required)
      fail_no_such_field(read, options.material_field, file, also);
    if (taken == fields.size()) {
      take_material(read, {}, file);
      return;
    }
  }
  if (taken == fields.size()) {
    mesh.materials.assign(mesh.tets.size(), 1);
    return;
  }
  std::vector<MaterialTag> materials = materials_of(fields[taken], file);
  const std::string name = fields[taken].name;
  if (read.material_field.empty()) {
    fields.erase(fields.begin() + static_cast<std::ptrdiff_t>(taken));
  } else {
    // The format's own materials become an ordinary field.
    fields[taken] = {read.material_field, 1, true,
                     std::vector<double>(mesh.materials.begin(), mesh.materials.end())};
  }
  // The file's names refer to its default material field.
  if (!options.material_field.empty() && name != "material") mesh.material_names.clear();
  mesh.materials = std::move(materials);
  read.material_field = name;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/io/size_files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include "common/message_text.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/sizes.h"

namespace tetwright {

namespace {

using Fields = std::vector<MeshField>;

[[noreturn]] void fail_without_field(const std::string& file, const Fields& all, bool several) {
  if (all.empty())
    throw InputError(file +
                     ": it has no point fields; write the target edge length at each point as a point field "
                     "named \"size\"");
  std::vector<std::string> names;
  for (const MeshField& field : all)
    if (!several || field.components == 1) names.push_back(field.name);
  throw InputError(file +
                   (several ? ": several of its point fields may be the edge length: "
                            : ": no point field has one number for each point; there are ") +
                   quoted_list(names) + (several ? "; name one \"size\"" : "; add one named \"size\""));
}

/// Selects the field as described for read_mesh_sizes().
MeshField take_field(Fields fields, const std::string& file) {
  std::vector<MeshField*> scalars, floating;
  for (MeshField& field : fields) {
    if (field.components != 1) continue;
    scalars.push_back(&field);
    if (!field.integer) floating.push_back(&field);
  }
  for (const std::string_view name : size_names)
    for (MeshField* field : scalars)
      if (field->name == name) return std::move(*field);
  for (const MeshField& field : fields)
    if (field.components != 1 &&
        std::find(size_names.begin(), size_names.end(), field.name) != size_names.end())
      throw InputError(
          file + ": its point field " + in_quotes(field.name) + " has " + std::to_string(field.components) +
          " numbers for each point, but an edge length is one number; give it one, or rename it");
  if (floating.size() == 1) return std::move(*floating.front());
  if (scalars.size() == 1) return std::move(*scalars.front());
  fail_without_field(file, fields, scalars.size() > 1);
}

/// Checks the field's values at points that an element uses, and returns the field.
template <class Elements>
MeshField checked_lengths(Fields fields, const Elements& elements, const std::string& file) {
  MeshField field = take_field(std::move(fields), file);
  for (const auto& element : elements)
    for (const Index p : element)
      if (const double value = field.values[p]; !(std::isfinite(value) && value > 0))
        throw InputError(file + ": point " + std::to_string(p) + " (counted from 0) has the value " +
                         short_number(value) + " in point field " + in_quotes(field.name) +
                         "; an edge length must be a number above 0: correct it");
  return field;
}

}  // namespace

void check_mesh_sizes_path(const std::string& file, const std::string& others) {
  if (may_hold_point_fields(file)) return;
  const std::string extension = std::filesystem::path(file).extension().string();
  const bool mesh = may_hold_surface(file) || file_kind(file) == FileKind::tet_mesh;
  throw UsageError(file + ": " +
                   (extension.empty() ? "no extension"
                    : mesh            ? "files " + in_quotes(extension) + " have no point fields"
                                      : "unknown extension " + in_quotes(extension)) +
                   "; edge lengths are read from " + point_field_extensions() +
                   (others.empty() ? "" : " " + others));
}

std::unique_ptr<const SizeSource> read_mesh_sizes(const std::string& file) {
  check_mesh_sizes_path(file);
  if (std::optional<SurfaceWithFields> read = read_surface_with_fields(file)) {
    MeshField lengths = checked_lengths(std::move(read->point_fields), read->surface.triangles, file);
    return surface_sizes(std::move(read->surface), std::move(lengths.values), std::move(lengths.name));
  }
  TetMesh mesh = read_tet_mesh(file).mesh;
  MeshField lengths = checked_lengths(std::exchange(mesh.point_fields, {}), mesh.tets, file);
  mesh.cell_fields.clear();
  return tet_mesh_sizes(std::move(mesh), std::move(lengths.values), std::move(lengths.name));
}

}  // namespace tetwright

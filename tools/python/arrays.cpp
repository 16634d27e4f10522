// SPDX-License-Identifier: Apache-2.0
#include "tools/python/arrays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "common/io/names/mesh_fields.h"
#include "common/io/volumes/voxel_data.h"
#include "common/message_text.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/resources.h"

namespace tetwright::python {

namespace {

std::string shape_text(const py::array& array) {
  std::string text;
  for (py::ssize_t k = 0; k < array.ndim(); ++k) text += (k > 0 ? ", " : "") + std::to_string(array.shape(k));
  return "(" + text + ")";
}

void require_columns(const py::array& array, py::ssize_t columns, const std::string& name, const char* what) {
  if (array.ndim() != 2 || array.shape(1) != columns)
    throw InputError(name, 0,
                     std::string(what) + " are an array of shape " + shape_text(array) +
                         "; give one of shape (n, " + std::to_string(columns) + ")");
}

template <std::size_t N>
std::vector<std::array<Index, N>> to_cells(const Cells& array, std::size_t points, const std::string& name,
                                           const char* what) {
  require_columns(array, static_cast<py::ssize_t>(N), name, what);
  const auto rows = array.unchecked<2>();
  std::vector<std::array<Index, N>> cells(static_cast<std::size_t>(rows.shape(0)));
  for (py::ssize_t i = 0; i < rows.shape(0); ++i)
    for (std::size_t k = 0; k < N; ++k) {
      const std::int64_t p = rows(i, static_cast<py::ssize_t>(k));
      if (p < 0 || static_cast<std::uint64_t>(p) >= points)
        throw InputError(name, 0,
                         "row " + std::to_string(i) + " of the " + what + " refers to point " +
                             std::to_string(p) + ", but there are " + std::to_string(points) +
                             ", numbered from 0");
      cells[static_cast<std::size_t>(i)][k] = static_cast<Index>(p);
    }
  return cells;
}

std::vector<MeshField> to_fields(const Fields& fields, std::size_t rows, const std::string& name,
                                 const char* of, std::vector<Dropped>& dropped) {
  std::vector<MeshField> all;
  for (const auto& [field, whole, values] : fields) {
    if (values.ndim() != 2 || static_cast<std::size_t>(values.shape(0)) != rows)
      throw InputError(name, 0,
                       "the field " + in_quotes(field) + " is an array of shape " + shape_text(values) +
                           "; give one row for each of the " + std::to_string(rows) + " " + of);
    all.push_back({field, static_cast<int>(values.shape(1)), whole,
                   std::vector<double>(values.data(), values.data() + values.size())});
  }
  const std::vector<std::string> names = field_names_to_write(all, {});
  std::vector<NameChange> changes;
  add_field_changes(all, names, changes);
  if (!changes.empty())
    dropped.push_back({"original names of fields, the first " + changes.front().own + " (now " +
                           changes.front().written + ")",
                       changes.size()});
  for (std::size_t f = 0; f < all.size(); ++f) all[f].name = names[f];
  return all;
}

}  // namespace

std::vector<Vec3> to_points(const Points& array, const std::string& name) {
  require_columns(array, 3, name, "points");
  const auto rows = array.unchecked<2>();
  std::vector<Vec3> points(static_cast<std::size_t>(rows.shape(0)));
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    const Vec3 p(rows(i, 0), rows(i, 1), rows(i, 2));
    if (!p.allFinite())
      throw InputError(name, 0,
                       "point " + std::to_string(i) + " has a coordinate that is not finite; remove it");
    points[static_cast<std::size_t>(i)] = p;
  }
  return points;
}

FileTriangles to_triangles(const std::string& name, std::size_t points, const GroupedTriangles& triangles) {
  const auto& [cells, groups, names] = triangles;
  FileTriangles listed;
  listed.triangles = to_cells<3>(cells, points, name, "triangles");
  if (groups.ndim() != 1 || static_cast<std::size_t>(groups.shape(0)) != listed.triangles.size())
    throw InputError(name, 0,
                     "groups are an array of shape " + shape_text(groups) + "; give one for each of the " +
                         std::to_string(listed.triangles.size()) + " triangles");
  listed.groups.assign(groups.data(), groups.data() + groups.size());
  listed.names = names;
  return listed;
}

TriangleMesh to_surface(const std::string& name, const Points& points, const GroupedTriangles& triangles) {
  std::vector<Vec3> places = to_points(points, name);
  const FileTriangles listed = to_triangles(name, places.size(), triangles);
  if (listed.triangles.empty()) throw InputError(name, 0, "has no triangles; give a surface");
  return surface_of(listed, std::move(places), name);
}

ReadTetMesh to_mesh(const std::string& name, const Points& points, const Cells& tets,
                    const std::optional<Tags>& materials, const std::map<MaterialTag, std::string>& names,
                    const Fields& point_fields, const Fields& cell_fields, const DroppedItems& dropped) {
  ReadTetMesh read;
  TetMesh& mesh = read.mesh;
  mesh.points = to_points(points, name);
  mesh.tets = to_cells<4>(tets, mesh.points.size(), name, "tets");
  if (mesh.tets.empty()) throw InputError(name, 0, "has no tets; give a tet mesh");
  mesh.materials.assign(mesh.tets.size(), 1);
  if (materials) {
    if (materials->ndim() != 1 || static_cast<std::size_t>(materials->shape(0)) != mesh.tets.size())
      throw InputError(name, 0,
                       "materials are an array of shape " + shape_text(*materials) +
                           "; give one for each of the " + std::to_string(mesh.tets.size()) + " tets");
    mesh.materials.assign(materials->data(), materials->data() + mesh.tets.size());
    read.material_field = "material";
  }
  mesh.material_names = names;
  read.dropped = to_dropped(dropped);
  mesh.point_fields = to_fields(point_fields, mesh.points.size(), name, "points", read.dropped);
  mesh.cell_fields = to_fields(cell_fields, mesh.tets.size(), name, "tets", read.dropped);
  return read;
}

std::vector<Dropped> to_dropped(const DroppedItems& items) {
  std::vector<Dropped> dropped;
  for (const auto& [what, count, restored] : items) dropped.push_back({what, count, restored});
  return dropped;
}

SizesObject to_sizes(const std::string& name, const Points& points, const Cells& cells,
                     const Values& lengths) {
  constexpr py::ssize_t corners = 4;
  SizesObject sizes;
  std::size_t count = 0;
  const auto check = [&](const auto& elements) {
    for (const auto& element : elements)
      for (const Index p : element)
        if (const double value = sizes.lengths[p]; !(std::isfinite(value) && value > 0))
          throw InputError(name, 0,
                           "the length of point " + std::to_string(p) + " is " + short_number(value) +
                               "; an edge length must be a number above 0");
  };
  sizes.lengths.assign(lengths.data(), lengths.data() + lengths.size());
  if (cells.ndim() == 2 && cells.shape(1) == corners) {
    TetMesh mesh = to_mesh(name, points, cells, {}, {}, {}, {}, {}).mesh;
    count = mesh.points.size();
    sizes.elements = std::move(mesh);
  } else {
    Cells groups(static_cast<py::ssize_t>(cells.shape(0)));
    std::fill_n(groups.mutable_data(), groups.size(), 0);
    TriangleMesh surface = to_surface(name, points, {cells, groups, {}});
    count = surface.points.size();
    sizes.elements = std::move(surface);
  }
  if (lengths.ndim() != 1 || sizes.lengths.size() != count)
    throw InputError(name, 0,
                     "lengths are an array of shape " + shape_text(lengths) + "; give one for each of the " +
                         std::to_string(count) + " points");
  if (const auto* mesh = std::get_if<TetMesh>(&sizes.elements))
    check(mesh->tets);
  else
    check(std::get<TriangleMesh>(sizes.elements).triangles);
  return sizes;
}

namespace {

std::string text_of_shape(const std::vector<std::int64_t>& shape) {
  std::string text;
  for (std::size_t k = 0; k < shape.size(); ++k) text += (k > 0 ? ", " : "") + std::to_string(shape[k]);
  return "(" + text + ")";
}

/// Grid of an array with at least three axes.
LabelGrid to_grid(const std::string& name, const PlacedShape& place) {
  LabelGrid grid;
  for (std::size_t a = 0; a < 3; ++a) {
    if (place.shape[a] > std::numeric_limits<int>::max())
      throw InputError(name, 0, "has more than 2147483647 voxels along an axis; give a part of it");
    grid.size[a] = static_cast<int>(place.shape[a]);
  }
  grid.origin = Vec3(place.origin[0], place.origin[1], place.origin[2]);
  for (Eigen::Index row = 0; row < 3; ++row)
    for (Eigen::Index column = 0; column < 3; ++column)
      grid.directions(row, column) =
          place.directions[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
  if (!grid.origin.allFinite() || !grid.directions.allFinite() || grid.directions.determinant() == 0)
    throw InputError(
        name, 0,
        "its origin and steps between voxels are not finite or lie in a plane; give a spacing above 0, "
        "or an affine that can be inverted");
  return grid;
}

bool is_empty(const std::vector<std::int64_t>& shape) {
  return std::any_of(shape.begin(), shape.end(), [](std::int64_t n) { return n < 1; });
}

/// Calls `set(from, to)` with the index of each voxel in a block and its number in the grid.
template <class Set>
void for_each_voxel(const LabelGrid& grid, const std::array<py::ssize_t, 3>& start, const py::array& block,
                    const Set& set) {
  std::array<py::ssize_t, 3> size{};
  for (std::size_t a = 0; a < 3; ++a) {
    size[a] = block.shape(static_cast<py::ssize_t>(a));
    TETWRIGHT_CHECK(start[a] >= 0 && start[a] + size[a] <= grid.size[a]);
  }
  for (py::ssize_t z = 0; z < size[2]; ++z)
    for (py::ssize_t y = 0; y < size[1]; ++y) {
      auto to =
          static_cast<std::size_t>(((start[2] + z) * grid.size[1] + start[1] + y) * grid.size[0] + start[0]);
      for (py::ssize_t x = 0; x < size[0]; ++x) set(x, y, z, to++);
    }
}

}  // namespace

LabelFiller::LabelFiller(std::string name, const PlacedShape& place) : name_(std::move(name)) {
  if (place.shape.size() != 3 || is_empty(place.shape))
    throw InputError(
        name_, 0, "labels are an array of shape " + text_of_shape(place.shape) + "; give one of three axes");
  static_cast<LabelGrid&>(volume_) = to_grid(name_, place);
  const auto voxels = static_cast<std::size_t>(volume_.voxels());
  require_memory(static_cast<double>(voxels) * sizeof(MaterialTag), "the labels of " + name_,
                 "crop the volume or make it coarser");
  volume_.labels.resize(voxels);
}

void LabelFiller::put(const std::array<py::ssize_t, 3>& start, const Labels& block) {
  const auto labels = block.unchecked<3>();
  for_each_voxel(volume_, start, block, [&](py::ssize_t x, py::ssize_t y, py::ssize_t z, std::size_t to) {
    volume_.labels[to] = labels(x, y, z);
  });
}

ImageFiller::ImageFiller(std::string name, const PlacedShape& place) : name_(std::move(name)) {
  if ((place.shape.size() != 3 && place.shape.size() != 4) || is_empty(place.shape))
    throw InputError(name_, 0,
                     "the image is an array of shape " + text_of_shape(place.shape) +
                         "; give one of three axes, or four if the last one is that of channels");
  static_cast<LabelGrid&>(image_) = to_grid(name_, place);
  const std::int64_t channels = place.shape.size() == 4 ? place.shape[3] : 1;
  check_channels(channels, checked_size(std::span(place.shape).first(3), name_, 0), VoxelUse::image, name_,
                 0);
  const auto voxels = static_cast<std::size_t>(image_.voxels());
  require_memory(static_cast<double>(voxels) * static_cast<double>(channels) * sizeof(float),
                 "the values of " + name_, "crop the image or make it coarser");
  image_.channels.assign(static_cast<std::size_t>(channels), std::vector<float>(voxels));
}

void ImageFiller::put(const std::array<py::ssize_t, 3>& start, const Pixels& block) {
  const auto values = block.unchecked<4>();
  TETWRIGHT_CHECK(static_cast<std::size_t>(values.shape(3)) == image_.channels.size());
  for (std::size_t c = 0; c < image_.channels.size(); ++c) {
    std::vector<float>& channel = image_.channels[c];
    for_each_voxel(image_, start, block, [&](py::ssize_t x, py::ssize_t y, py::ssize_t z, std::size_t to) {
      const float value = values(x, y, z, static_cast<py::ssize_t>(c));
      if (!std::isfinite(value)) {
        const std::array<int, 3> at{static_cast<int>(start[0] + x), static_cast<int>(start[1] + y),
                                    static_cast<int>(start[2] + z)};
        throw InputError(
            name_ + ": " +
            bad_voxel<float>(
                {at, static_cast<std::int64_t>(c), static_cast<std::int64_t>(image_.channels.size())},
                reinterpret_cast<const char*>(&value), {.type = VoxelType::float32}));
      }
      channel[to] = value;
    });
  }
}

}  // namespace tetwright::python

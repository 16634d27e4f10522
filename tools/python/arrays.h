// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "tetwright/image_volume.h"
#include "tetwright/io.h"
#include "tetwright/label_volume.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"
#include "tools/app/commands/named_inputs.h"

// Conversions from NumPy arrays. `name` is the name of the input in messages. All functions throw InputError.
namespace tetwright::python {

namespace py = pybind11;

using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Cells = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
using Tags = py::array_t<MaterialTag, py::array::c_style | py::array::forcecast>;
using Values = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Labels = py::array_t<MaterialTag, py::array::forcecast>;
using Pixels = py::array_t<float, py::array::forcecast>;
/// Name, whether the values are integers, and the values.
using Fields = std::vector<std::tuple<std::string, bool, Values>>;
/// Kind of the items (plural), number, and whether they are restored from other data.
using DroppedItems = std::vector<std::tuple<std::string, std::size_t, bool>>;
/// Triangles of shape (m, 3), their group numbers of shape (m,) with 0 for none, and the names of named
/// groups.
using GroupedTriangles = std::tuple<Cells, Cells, std::map<std::int64_t, std::string>>;

/// Points of shape (n, 3); all coordinates must be finite.
std::vector<Vec3> to_points(const Points& array, const std::string& name);
/// A surface with at least one triangle; point indices start at 0.
TriangleMesh to_surface(const std::string& name, const Points& points, const GroupedTriangles& triangles);
/// Triangles listed in addition to the tets of a mesh with `points` points.
FileTriangles to_triangles(const std::string& name, std::size_t points, const GroupedTriangles& triangles);
/// A mesh of tets of shape (m, 4), at least one, and materials of shape (m,). Without materials a cell field
/// may give them, as in files. Point and cell fields have shape (n, components).
ReadTetMesh to_mesh(const std::string& name, const Points& points, const Cells& tets,
                    const std::optional<Tags>& materials, const std::map<MaterialTag, std::string>& names,
                    const Fields& point_fields, const Fields& cell_fields, const DroppedItems& dropped);
/// Contents of the host's object that are not in its arrays.
std::vector<Dropped> to_dropped(const DroppedItems& items);
/// Edge lengths of shape (n,) at the points of tets (m, 4) or triangles (m, 3).
SizesObject to_sizes(const std::string& name, const Points& points, const Cells& cells,
                     const Values& lengths);
/// Where an array of voxels is: its shape, the centre of voxel (0, 0, 0), and one voxel step along each axis
/// as a column of `directions`.
struct PlacedShape {
  std::vector<std::int64_t> shape;
  std::array<double, 3> origin;
  std::array<std::array<double, 3>, 3> directions;
};

/// A volume that is filled block by block, so that no array of all voxels is needed beside it.
class LabelFiller {
 public:
  /// \throws OutputError if the labels exceed available_memory()
  LabelFiller(std::string name, const PlacedShape& place);
  /// Sets the labels of a block of shape (i, j, k) whose lowest voxel is `start`.
  void put(const std::array<py::ssize_t, 3>& start, const Labels& block);
  /// \pre all voxels have a label
  LabelVolume take() { return std::move(volume_); }

 private:
  std::string name_;
  LabelVolume volume_;
};

/// An image that is filled likewise, of shape (i, j, k) or (i, j, k, channels).
class ImageFiller {
 public:
  ImageFiller(std::string name, const PlacedShape& place);
  /// \param block of shape (i, j, k, channels), with all channels
  void put(const std::array<py::ssize_t, 3>& start, const Pixels& block);
  ImageVolume take() { return std::move(image_); }

 private:
  std::string name_;
  ImageVolume image_;
};

}  // namespace tetwright::python

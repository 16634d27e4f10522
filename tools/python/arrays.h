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

#include "common/io/contents/read_tet_mesh_result.h"
#include "common/io/tets/file_triangles.h"
#include "common/label_volume.h"
#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"
#include "common/types.h"
#include "tools/app/commands/input_objects.h"

// What the Python package makes of arrays of numpy. `name` is what messages call the input; all throw
// InputError.
namespace tetwright::python {

namespace py = pybind11;

using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Cells = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
using Tags = py::array_t<MaterialTag, py::array::c_style | py::array::forcecast>;
using Values = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Labels = py::array_t<MaterialTag, py::array::f_style | py::array::forcecast>;
/// Name, whether its numbers are whole ones, and these.
using Fields = std::vector<std::tuple<std::string, bool, Values>>;
/// What it is (plural), how many, and whether it is found again from the rest.
using DroppedItems = std::vector<std::tuple<std::string, std::size_t, bool>>;
/// Triangles of shape (m, 3), the number of each one's group, 0 for none, of shape (m,), and the names of
/// groups that have one.
using GroupedTriangles = std::tuple<Cells, Cells, std::map<std::int64_t, std::string>>;

/// Points of shape (n, 3), all finite.
std::vector<Vec3> to_points(const Points& array, const std::string& name);
/// At least one triangle, of numbers of points from 0 on.
TriangleMesh to_surface(const std::string& name, const Points& points, const GroupedTriangles& triangles);
/// Those of a mesh of so many points.
FileTriangles to_triangles(const std::string& name, std::size_t points, const GroupedTriangles& triangles);
/// Tets of shape (m, 4), at least one, and the material of each, of shape (m,); without them a cell field may
/// give it, as with files. Numbers of points and tets are fields of shape (n, components).
ReadTetMesh to_mesh(const std::string& name, const Points& points, const Cells& tets,
                    const std::optional<Tags>& materials, const std::map<MaterialTag, std::string>& names,
                    const Fields& point_fields, const Fields& cell_fields, const DroppedItems& dropped);
/// What the host's object had and its arrays have not.
std::vector<Dropped> to_dropped(const DroppedItems& items);
/// Edge lengths of shape (n,) at the points of tets (m, 4) or triangles (m, 3).
SizesObject to_sizes(const std::string& name, const Points& points, const Cells& cells,
                     const Values& lengths);
/// Labels of shape (i, j, k); a step along the axis a is the column a of `directions`.
LabelVolume to_volume(const std::string& name, const Labels& labels, const std::array<double, 3>& origin,
                      const std::array<std::array<double, 3>, 3>& directions);

}  // namespace tetwright::python

#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/label_volume.h"
#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"
#include "common/types.h"

// What the Python package makes of arrays of numpy. `name` is what messages call the input; all throw
// InputError.
namespace tetwright::python {

namespace py = pybind11;

using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Cells = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
using Tags = py::array_t<MaterialTag, py::array::c_style | py::array::forcecast>;
using Labels = py::array_t<MaterialTag, py::array::f_style | py::array::forcecast>;

/// Points of shape (n, 3), all finite.
std::vector<Vec3> to_points(const Points& array, const std::string& name);
/// Triangles of shape (m, 3) of numbers of points from 0 on; at least one.
TriangleMesh to_surface(const std::string& name, const Points& points, const Cells& triangles);
/// Tets of shape (m, 4), at least one, and the material of each, of shape (m,); without them all are
/// material 1.
TetMesh to_mesh(const std::string& name, const Points& points, const Cells& tets,
                const std::optional<Tags>& materials, const std::map<MaterialTag, std::string>& names);
/// Labels of shape (i, j, k); a step along the axis a is the column a of `directions`.
LabelVolume to_volume(const std::string& name, const Labels& labels, const std::array<double, 3>& origin,
                      const std::array<std::array<double, 3>, 3>& directions);

}  // namespace tetwright::python

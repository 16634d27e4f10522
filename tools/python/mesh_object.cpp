// SPDX-License-Identifier: Apache-2.0
#include "tools/python/mesh_object.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <utility>

#include "common/io/names/mesh_fields.h"
#include "common/io/names/mesh_parts.h"
#include "common/mesh/boundary_groups.h"
#include "tetwright/compare.h"
#include "tetwright/error.h"
#include "tetwright/files.h"
#include "tetwright/io.h"
#include "tetwright/prepare_steps.h"
#include "tetwright/tet_parts.h"
#include "tools/app/commands/output_paths.h"
#include "tools/app/commands/unwritten.h"
#include "tools/app/option_rules.h"
#include "tools/python/text.h"

namespace tetwright::python {

namespace {

/// A read-only view of the items of `rows`, with `columns` numbers from `first` on in each; `columns` null:
/// one-dimensional.
template <class Number, class Row>
py::array view(const std::vector<Row>& rows, const void* first, py::ssize_t columns,
               const py::object& owner) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(rows.size())}, strides{sizeof(Row)};
  if (columns > 0) {
    shape.push_back(columns);
    strides.push_back(sizeof(Number));
  }
  py::array array(py::dtype::of<Number>(), shape, strides, rows.empty() ? nullptr : first, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::dict fields_of(const std::vector<MeshField>& fields, const py::object& owner) {
  py::dict all;
  const std::vector<std::string> names = field_names_to_write(fields, {});  // unique names
  auto name = names.begin();
  for (const MeshField& f : fields) {
    const auto components = static_cast<py::ssize_t>(f.components);
    const auto count = static_cast<py::ssize_t>(f.values.size()) / components;
    std::vector<py::ssize_t> shape{count};
    if (components > 1) shape.push_back(components);
    py::array_t<double> array(shape, f.values.data(), owner);
    array.attr("setflags")(py::arg("write") = false);
    all[to_text(*name++)] = array;
  }
  return all;
}

/// Material on the other side of each interface triangle, and whether that side is outside.
py::tuple other_sides(const TetMesh& mesh) {
  const auto count = static_cast<py::ssize_t>(mesh.interfaces.size());
  py::array_t<MaterialTag> other(count);
  py::array_t<bool> boundary(count);
  for (py::ssize_t i = 0; i < count; ++i) {
    const std::optional<MaterialTag>& tag = mesh.interfaces[static_cast<std::size_t>(i)].other;
    other.mutable_at(i) = tag.value_or(0);
    boundary.mutable_at(i) = !tag;
  }
  return py::make_tuple(other, boundary);
}

/// Group number of each interface triangle, and the names of the groups as in files: of all groups, and of
/// those that come from the user.
py::tuple groups_of(const TetMesh& mesh) {
  const BoundaryGroups groups(mesh);
  py::array_t<std::int64_t> numbers(static_cast<py::ssize_t>(mesh.interfaces.size()));
  for (std::size_t f = 0; f < mesh.interfaces.size(); ++f)
    numbers.mutable_at(static_cast<py::ssize_t>(f)) = groups.number_of(mesh.interfaces[f]);
  py::dict names, of_patches;
  for (const MeshParts::Surface& s : names_of_parts(mesh, printable_names()).surfaces) {
    names[py::int_(s.number)] = to_text(s.name);
    if (s.group) of_patches[py::int_(s.number)] = to_text(s.name);
  }
  return py::make_tuple(numbers, names, of_patches);
}

/// Name, groups of both sides, pairs of points and whether there are cohesive elements, for each interface
/// that was parted.
py::list parted_of(const Mesh& mesh) {
  py::list all;
  for (const PartedInterface& p : mesh.parted) {
    py::array_t<std::int64_t> pairs({static_cast<py::ssize_t>(p.pairs.size()), py::ssize_t{2}});
    for (std::size_t i = 0; i < p.pairs.size(); ++i)
      for (std::size_t k = 0; k < 2; ++k)
        pairs.mutable_at(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(k)) = p.pairs[i][k];
    all.append(py::make_tuple(to_text(p.name), py::make_tuple(to_text(p.sides[0]), to_text(p.sides[1])),
                              pairs, p.cohesive));
  }
  return all;
}

/// For each interface triangle, the tet on the side of its `material`.
py::array_t<Index> tets_beside(const TetMesh& mesh) {
  py::array_t<Index> tets(static_cast<py::ssize_t>(mesh.interfaces.size()));
  py::ssize_t i = 0;
  for (const TetFace& face : faces_of_tets(mesh)) tets.mutable_at(i++) = face.tet;
  return tets;
}

/// Fields at points and midside nodes.
py::dict fields_of_all_nodes(const Mesh& mesh) {
  const MeshToWrite nodes(mesh.mesh, mesh.midside ? &*mesh.midside : nullptr);
  const auto owned = std::make_unique<std::vector<MeshField>>(nodes.node_fields());
  py::dict all;
  for (const auto& [name, values] : fields_of(*owned, py::none())) all[name] = values.attr("copy")();
  return all;
}

void write_mesh_files(Mesh& mesh, const std::string& path, const std::string& format,
                      const std::string& boundary, bool no_boundary, PartNumber parts) {
  const py::gil_scoped_release release;
  CommandLine line;  // required by the program's checks
  line.command = Command::improve;
  line.outputs.mesh = path;
  line.outputs.format = format;
  line.outputs.boundary = boundary;
  line.outputs.no_boundary = no_boundary;
  line.outputs.parts = parts;
  for (const TetBins& bins : mesh.bins) line.options.values.bins.push_back({bins.field, {}});
  for (const PartedInterface& p : mesh.parted) line.options.parting.push_back({p.name, p.cohesive});
  check_no_standard_output(line);
  check_output_paths(line);
  if (mesh.midside) check_holds_second_order(path, format);
  OutputFiles files;
  const MidsideNodes* midside = mesh.midside ? &*mesh.midside : nullptr;
  const auto write = [&](const TetMesh& tets) {
    if (parts > 0)
      write_tet_mesh({tets, midside}, partition_tets(tets, parts), path, &files, format);
    else
      write_tet_mesh({tets, midside, mesh.bins}, path, &files, format);
  };
  if (no_boundary) {
    TetMesh tets = mesh.mesh;
    tets.interfaces.clear();
    tets.patch_groups.clear();
    write(tets);
  } else {
    write(mesh.mesh);
  }
  if (!boundary.empty()) write_interfaces(mesh.mesh, boundary, &files);
  if (const std::string table = bins_table_of(line); !table.empty())
    files.write(table, table_of_bins(mesh.mesh, mesh.bins));
  if (const std::string table = pairs_table_of(line, !mesh.parted.empty()); !table.empty())
    files.write(table, table_of_pairs(mesh.parted));
  files.commit();
  PrepareReport report;
  report.patches = patches_of_input(mesh.mesh);
  report.bins = mesh.bins;
  report.parted = mesh.parted;
  find_unwritten(line, mesh.mesh, report);
  // The interpreter's lock protects the mesh's own lists from other threads.
  const py::gil_scoped_acquire acquire;
  for (std::string& note : notes_of(report)) mesh.notes.push_back(std::move(note));
  for (std::string& missed : shortfalls_of(report)) mesh.shortfall.push_back(std::move(missed));
}

}  // namespace

void check_no_standard_output(const CommandLine& line) {
  if (line.outputs.mesh == "-" || line.outputs.boundary == "-")
    throw UsageError("standard output belongs to the host program; give file names for output and boundary");
}

void bind_mesh(py::module_& module) {
  py::class_<Mesh, std::shared_ptr<Mesh>>(module, "Mesh")
      .def_property_readonly("points",
                             [](const py::object& self) {
                               const auto& points = self.cast<const Mesh&>().mesh.points;
                               return view<double>(points, points.data(), 3, self);
                             })
      .def_property_readonly("tets",
                             [](const py::object& self) {
                               const auto& tets = self.cast<const Mesh&>().mesh.tets;
                               return view<Index>(tets, tets.data(), 4, self);
                             })
      .def_property_readonly("wedges",
                             [](const py::object& self) {
                               const auto& wedges = self.cast<const Mesh&>().mesh.wedges;
                               return view<Index>(wedges, wedges.data(), 6, self);
                             })
      .def("parted", &parted_of)
      .def_property_readonly("materials",
                             [](const py::object& self) {
                               const auto& materials = self.cast<const Mesh&>().mesh.materials;
                               return view<MaterialTag>(materials, materials.data(), 0, self);
                             })
      .def_property_readonly("material_names",
                             [](const Mesh& m) {
                               py::dict names;
                               for (const auto& [tag, name] : m.mesh.material_names)
                                 names[py::int_(tag)] = to_text(name);
                               return names;
                             })
      .def_property_readonly("space", [](const Mesh& m) { return to_text(m.mesh.space); })
      .def_property_readonly("interface_triangles",
                             [](const py::object& self) {
                               const auto& faces = self.cast<const Mesh&>().mesh.interfaces;
                               return view<Index>(faces, faces.empty() ? nullptr : &faces[0].ids, 3, self);
                             })
      .def_property_readonly("interface_materials",
                             [](const py::object& self) {
                               const auto& faces = self.cast<const Mesh&>().mesh.interfaces;
                               return view<MaterialTag>(faces, faces.empty() ? nullptr : &faces[0].material,
                                                        0, self);
                             })
      .def_property_readonly("interface_patches",
                             [](const py::object& self) {
                               const auto& faces = self.cast<const Mesh&>().mesh.interfaces;
                               return view<std::uint16_t>(faces, faces.empty() ? nullptr : &faces[0].patch, 0,
                                                          self);
                             })
      .def("interface_others", [](const Mesh& m) { return other_sides(m.mesh); })
      .def("interface_tets", [](const Mesh& m) { return tets_beside(m.mesh); })
      .def("interface_groups", [](const Mesh& m) { return groups_of(m.mesh); })
      .def_property_readonly("midside_points",
                             [](const py::object& self) -> py::object {
                               const auto& midside = self.cast<const Mesh&>().midside;
                               if (!midside) return py::none();
                               return view<double>(midside->points, midside->points.data(), 3, self);
                             })
      .def_property_readonly("midside_of_tets",
                             [](const py::object& self) -> py::object {
                               const auto& midside = self.cast<const Mesh&>().midside;
                               if (!midside) return py::none();
                               return view<Index>(midside->of_tets, midside->of_tets.data(), 6, self);
                             })
      .def("point_fields",
           [](const py::object& self) { return fields_of(self.cast<const Mesh&>().mesh.point_fields, self); })
      .def("node_fields", &fields_of_all_nodes)
      .def("cell_fields",
           [](const py::object& self) { return fields_of(self.cast<const Mesh&>().mesh.cell_fields, self); })
      .def_property_readonly("stats", [](const Mesh& m) { return to_text(m.stats); })
      .def_property_readonly("notes", [](const Mesh& m) { return to_texts(m.notes); })
      .def_property_readonly("shortfall", [](const Mesh& m) { return to_texts(m.shortfall); })
      .def("write", &write_mesh_files);
}

}  // namespace tetwright::python

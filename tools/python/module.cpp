// tetwright._core: what the Python package calls. Python turns its objects into arrays, this file arrays into
// meshes and the results' arrays into views.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include "common/error.h"
#include "common/formats/atomic_file.h"
#include "common/formats/formats.h"
#include "common/formats/label_groups.h"
#include "common/formats/mesh_fields.h"
#include "common/formats/mesh_parts.h"
#include "common/formats/mesh_to_write.h"
#include "common/mesh/boundary_groups.h"
#include "common/parallel/parallel.h"
#include "tools/commands/commands.h"
#include "tools/commands/output_paths.h"
#include "tools/commands/result.h"
#include "tools/commands/unwritten.h"
#include "tools/option_rules.h"
#include "tools/patch_fidelity.h"
#include "tools/python/arrays.h"
#include "tools/python/option_types.h"
#include "tools/report.h"
#include "tools/stats_json.h"

namespace tetwright::python {

namespace {

/// How often a running call looks for Ctrl-C and reports its progress.
constexpr std::chrono::milliseconds poll_interval{50};

/// Progress of the thread that works, for the thread that called.
class SharedProgress : public Progress {
 public:
  void begin_stage(std::string_view name) override {
    const std::lock_guard lock(mutex_);
    stage_ = name;
    fraction_ = 0;
  }
  void update(double fraction) override {
    const std::lock_guard lock(mutex_);
    fraction_ = fraction;
  }
  std::string stage() const override { return latest().first; }
  std::pair<std::string, double> latest() const {
    const std::lock_guard lock(mutex_);
    return {stage_, fraction_};
  }

 private:
  mutable std::mutex mutex_;
  std::string stage_;
  double fraction_ = 0;
};

/// Calls `work` in a thread of its own, without the interpreter's lock, while this thread looks for signals
/// and tells `callback(stage, fraction)` what has changed. An exception of either cancels the work and is
/// raised once that has ended.
void run_in_background(const std::function<void()>& work, SharedProgress& progress,
                       const py::object& callback) {
  std::mutex mutex;
  std::condition_variable ended;
  bool done = false;
  std::exception_ptr failure;
  std::thread worker([&] {
    try {
      work();
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    done = true;
    ended.notify_all();
  });
  std::exception_ptr raised;
  std::pair<std::string, double> told{"", -1};
  while (true) {
    bool finished = false;
    {
      const py::gil_scoped_release release;
      std::unique_lock lock(mutex);
      finished = ended.wait_for(lock, poll_interval, [&] { return done; });
    }
    if (finished) break;
    if (raised) continue;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      auto latest = progress.latest();
      if (callback.is_none() || latest.first.empty() || latest == told) continue;
      told = std::move(latest);
      callback(told.first, told.second);
    } catch (...) {
      raised = std::current_exception();
      progress.cancel();
    }
  }
  worker.join();
  if (raised) std::rethrow_exception(raised);
  if (failure) std::rethrow_exception(failure);
}

/// Names of files need not be UTF-8, as Python's text is.
py::str to_text(const std::string& text) {
  PyObject* made = PyUnicode_DecodeUTF8(text.data(), static_cast<py::ssize_t>(text.size()), "replace");
  if (!made) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(made);
}

py::list to_texts(const std::vector<std::string>& all) {
  py::list texts;
  for (const std::string& text : all) texts.append(to_text(text));
  return texts;
}

/// A mesh that belongs to Python, and what the command that made it said.
struct Mesh {
  TetMesh mesh;
  std::optional<MidsideNodes> midside;
  std::string stats;  ///< JSON; empty if no command made it
  std::vector<std::string> notes, shortfall;
};

/// A read-only view of items of `Row`, `columns` numbers each from `first` on; null `columns`: one axis.
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
  const std::vector<std::string> names = field_names_to_write(fields, {});  // no two alike
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

/// The other side of each interface triangle, and whether there is none but outside.
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

/// The number of the group of each interface triangle, and the names of these, as files have them: of all,
/// and of those that are the user's.
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

/// For each interface triangle the tet on the side of its `material`.
py::array_t<Index> tets_beside(const TetMesh& mesh) {
  py::array_t<Index> tets(static_cast<py::ssize_t>(mesh.interfaces.size()));
  py::ssize_t i = 0;
  for (const TetFace& face : faces_of_tets(mesh)) tets.mutable_at(i++) = face.tet;
  return tets;
}

/// The fields of points and midside nodes.
py::dict fields_of_all_nodes(const Mesh& mesh) {
  const MeshToWrite nodes(mesh.mesh, mesh.midside ? &*mesh.midside : nullptr);
  const auto owned = std::make_unique<std::vector<MeshField>>(nodes.node_fields());
  py::dict all;
  for (const auto& [name, values] : fields_of(*owned, py::none())) all[name] = values.attr("copy")();
  return all;
}

void check_no_standard_output(const CommandLine& line) {
  if (line.output == "-" || line.boundary == "-")
    throw UsageError("standard output is the host's; give output and boundary names of files");
}

void write_mesh_files(Mesh& mesh, const std::string& path, const std::string& format,
                      const std::string& boundary, bool no_boundary) {
  const py::gil_scoped_release release;
  CommandLine line;  // for the program's rules
  line.command = Command::improve;
  line.output = path;
  line.output_format = format;
  line.boundary = boundary;
  line.no_boundary = no_boundary;
  check_no_standard_output(line);
  check_output_paths(line);
  if (mesh.midside) check_holds_second_order(path, format);
  OutputFiles files;
  const MidsideNodes* midside = mesh.midside ? &*mesh.midside : nullptr;
  if (no_boundary) {
    TetMesh tets = mesh.mesh;
    tets.interfaces.clear();
    tets.patch_groups.clear();
    write_tet_mesh({tets, midside}, path, &files, format);
  } else {
    write_tet_mesh({mesh.mesh, midside}, path, &files, format);
  }
  if (!boundary.empty()) write_interfaces(mesh.mesh, boundary, &files);
  files.commit();
  RunReport report;
  report.patches = patches_of_input(mesh.mesh);
  find_unwritten(line, mesh.mesh, report);
  for (std::string& note : notes_of(report)) mesh.notes.push_back(std::move(note));
}

CommandLine parse(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "tetwright");
  std::vector<char*> argv;
  argv.reserve(arguments.size());
  for (std::string& a : arguments) argv.push_back(a.data());
  CommandLine line;
  line.in_memory = true;
  if (!parse_command_line(static_cast<int>(argv.size()), argv.data(), line))
    throw UsageError("help and version are not options here; see help(tetwright)");
  if (line.output.empty() &&
      !(line.boundary.empty() && line.write_sdf.empty() && line.report.empty() && line.stats.empty()) &&
      line.command != Command::check)
    throw UsageError(
        "boundary, write_sdf, report and stats are written beside an output; give output too, or call "
        "write()");
  check_no_standard_output(line);
  if (!line.log_file.empty())
    throw UsageError(
        "log_file is the program's; leave it out: notes, shortfall, stats and progress say what it would");
  return line;
}

/// Calls `work`; if that fails, writes the statistics that were asked for all the same.
void with_stats_of_failure(CommandRun& run, const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& e) {
    report_failure(e, run);
    throw;
  }
}

std::shared_ptr<Mesh> run(std::vector<std::string> arguments, InputObjects& inputs,
                          const py::object& callback) {
  const CommandLine line = parse(std::move(arguments));
  auto made = std::make_shared<Mesh>();
  SharedProgress progress;
  run_in_background(
      [&] {
        with_threads(line.threads, [&] {
          if (!line.output.empty()) check_stats_path(line);
          CommandRun run(line, progress, &inputs);
          CommandResult result;
          with_stats_of_failure(run, [&] {
            if (!line.output.empty()) check_output_paths(line);
            result = make_result(run);
            if (!line.output.empty()) write_result(result, run);
          });
          made->stats = stats_json(line, run.report);
          made->notes = notes_of(run.report);
          for (const Shortfall& s : run.report.shortfall) made->shortfall.push_back(s.message);
          made->mesh = std::move(result.mesh);
          made->midside = std::move(run.midside);
        });
      },
      progress, callback);
  return made;
}

py::tuple check(std::vector<std::string> arguments, InputObjects& inputs, const py::object& callback) {
  const CommandLine line = parse(std::move(arguments));
  SharedProgress progress;
  std::string json;
  std::vector<std::string> notes;
  bool passed = false;
  run_in_background(
      [&] {
        with_threads(line.threads, [&] {
          check_stats_path(line);
          CommandRun run(line, progress, &inputs);
          CheckReport found;
          with_stats_of_failure(run, [&] { found = make_check(run); });
          json = check_json(line, run.report, found);
          notes = notes_of(run.report);
          passed = found.valid() && found.topology_kept() && found.within_tolerance();
        });
      },
      progress, callback);
  return py::make_tuple(to_text(json), to_texts(notes), passed);
}

// Exceptions.

/// Python's class for each kind of error; borrowed, the module owns them.
PyObject* error_class(ExitStatus status);

struct ErrorClasses {
  PyObject *base = nullptr, *usage = nullptr, *input = nullptr, *nothing = nullptr, *output = nullptr,
           *internal = nullptr;
} classes;

void set_error(PyObject* of_class, const char* message) { PyErr_SetObject(of_class, to_text(message).ptr()); }

PyObject* error_class(ExitStatus status) {
  switch (status) {
    case ExitStatus::usage:
      return classes.usage;
    case ExitStatus::bad_input:
      return classes.input;
    case ExitStatus::nothing_to_mesh:
      return classes.nothing;
    case ExitStatus::output_failed:
      return classes.output;
    case ExitStatus::internal_error:
      return classes.internal;
    default:
      return classes.base;
  }
}

void make_error_classes(py::module_& module) {
  const auto make = [&](const char* name, const char* doc, PyObject* first, PyObject* second,
                        ExitStatus status) {
    const py::tuple bases =
        second ? py::make_tuple(py::handle(first), py::handle(second)) : py::make_tuple(py::handle(first));
    py::dict members;
    members["status"] = static_cast<int>(status);
    const std::string full = std::string("tetwright.") + name;
    PyObject* made = PyErr_NewExceptionWithDoc(full.c_str(), doc, bases.ptr(), members.ptr());
    if (!made) throw py::error_already_set();
    module.attr(name) = py::reinterpret_steal<py::object>(made);
    return made;
  };
  classes.base =
      make("Error", "What ends a call early: the program's message; `status` is the program's exit status.",
           PyExc_Exception, nullptr, ExitStatus::internal_error);
  classes.usage = make("UsageError", "An option or a combination of them is wrong.", classes.base,
                       PyExc_ValueError, ExitStatus::usage);
  classes.input = make("InputError", "An input cannot be read or makes no sense.", classes.base,
                       PyExc_ValueError, ExitStatus::bad_input);
  classes.nothing = make("NothingToMeshError", "The input leaves nothing to mesh.", classes.base, nullptr,
                         ExitStatus::nothing_to_mesh);
  classes.output = make("OutputError", "A file could not be written, or memory ran out.", classes.base,
                        PyExc_OSError, ExitStatus::output_failed);
  classes.internal = make("InternalError", "A bug in Tetwright: please report it.", classes.base, nullptr,
                          ExitStatus::internal_error);
}

}  // namespace

}  // namespace tetwright::python

PYBIND11_MODULE(_core, module) {
  using namespace tetwright;
  using namespace tetwright::python;
  module.doc() = "The compiled part of tetwright; import tetwright instead.";
  module.attr("version") = TETWRIGHT_VERSION;
  make_error_classes(module);
  // By value, as pybind11 calls it.  NOLINTNEXTLINE(performance-unnecessary-value-param)
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& e) {
      set_error(error_class(exit_status(e)), e.what());
    } catch (const InternalError& e) {
      set_error(classes.internal, e.what());
    }
  });

  py::class_<InputObjects>(module, "Inputs")
      .def(py::init<>())
      .def("add_surface",
           [](InputObjects& to, const std::string& name, const Points& points,
              const GroupedTriangles& triangles, const DroppedItems& dropped) {
             to.surfaces[name] = to_surface(name, points, triangles);
             to.dropped[name] = to_dropped(dropped);
           })
      .def("add_mesh",
           [](InputObjects& to, const std::string& name, const Points& points, const Cells& tets,
              const std::optional<Tags>& materials, const std::map<MaterialTag, std::string>& names,
              const Fields& point_fields, const Fields& cell_fields, const DroppedItems& dropped,
              const GroupedTriangles& triangles) {
             const ReadTetMesh& read = to.meshes[name] =
                 to_mesh(name, points, tets, materials, names, point_fields, cell_fields, dropped);
             to.triangles[name] = to_triangles(name, read.mesh.points.size(), triangles);
           })
      .def("add_own_mesh",
           [](InputObjects& to, const std::string& name, const Mesh& mesh) {
             ReadTetMesh& read = to.meshes[name] = {mesh.mesh, "material", {}};
             if (mesh.midside)
               read.dropped.push_back({"midside nodes; tets of ten nodes are taken by their corners",
                                       mesh.midside->points.size()});
           })
      .def("add_sizes",
           [](InputObjects& to, const std::string& name, const Points& points, const Cells& cells,
              const Values& lengths) { to.sizes[name] = to_sizes(name, points, cells, lengths); })
      .def("add_volume",
           [](InputObjects& to, const std::string& name, const Labels& labels,
              const std::array<double, 3>& origin, const std::array<std::array<double, 3>, 3>& directions) {
             to.volumes[name] = to_volume(name, labels, origin, directions);
           });

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

  module.def("option_types", &option_types);
  module.def("is_face_label", [](const std::string& name) { return is_face_label(name); });
  module.def("run", &run);
  module.def("check", &check);
  module.def("read", [](const std::string& path, const std::string& material_field) {
    auto mesh = std::make_shared<Mesh>();
    const py::gil_scoped_release release;
    ReadTetMesh read = read_tet_mesh(path, {material_field});
    mesh->mesh = std::move(read.mesh);
    for (const Dropped& d : read.dropped)
      if (!d.restored)
        mesh->notes.push_back(path + ": " + std::to_string(d.count) + " " + d.what + ": dropped");
    return mesh;
  });
}

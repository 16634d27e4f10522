// SPDX-License-Identifier: Apache-2.0

// tetwright._core: the functions that the Python package calls. Python converts its objects to arrays,
// arrays.h converts arrays to meshes, and mesh_object.h makes the arrays of results views.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <type_traits>
#include <utility>

#include "common/io/names/label_groups.h"
#include "common/parallel/host_threads.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/prepare_steps.h"
#include "tools/app/commands/commands.h"
#include "tools/app/commands/output_paths.h"
#include "tools/app/commands/result.h"
#include "tools/python/arrays.h"
#include "tools/python/mesh_object.h"
#include "tools/python/option_types.h"
#include "tools/python/text.h"
#include "tools/report/stats_json.h"

namespace tetwright::python {

namespace {

/// Period at which a running call checks for Ctrl-C and reports its progress.
constexpr std::chrono::milliseconds poll_interval{50};

/// Passes progress from the working thread to the calling thread.
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

/// Calls `work` in a separate thread, without the interpreter's lock, while this thread checks for signals
/// and reports changes to `callback(stage, fraction)`. An exception of either cancels the work and is raised
/// once the work has ended.
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

CommandLine parse(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "tetwright");
  std::vector<char*> argv;
  argv.reserve(arguments.size());
  for (std::string& a : arguments) argv.push_back(a.data());
  CommandLine line;
  line.in_memory = true;
  if (!parse_command_line(static_cast<int>(argv.size()), argv.data(), line))
    throw UsageError("help and version are not options here; see help(tetwright)");
  if (line.outputs.mesh.empty() &&
      !(line.outputs.boundary.empty() && line.outputs.distances.empty() && line.outputs.report.empty() &&
        line.outputs.stats.empty()) &&
      line.command != Command::check)
    throw UsageError(
        "boundary, write_sdf, report and stats are written together with an output; give output too, or call "
        "write()");
  check_no_standard_output(line);
  if (!line.console.log_file.empty())
    throw UsageError(
        "log_file is for the program only; leave it out: notes, shortfall, stats and progress have what it "
        "would say");
  return line;
}

/// Calls `work`. If it fails, the requested statistics are written nevertheless.
void with_stats_of_failure(CommandRun& run, const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& e) {
    report_failure(e, run);
    throw;
  }
}

std::shared_ptr<Mesh> run(std::vector<std::string> arguments, NamedInputs& inputs,
                          const py::object& callback) {
  const CommandLine line = parse(std::move(arguments));
  auto made = std::make_shared<Mesh>();
  SharedProgress progress;
  run_in_background(
      [&] {
        with_threads_of_host(line.options.limits.threads, [&] {
          if (!line.outputs.mesh.empty()) check_stats_path(line);
          CommandRun run(line, progress, &inputs);
          Prepared result;
          with_stats_of_failure(run, [&] {
            if (!line.outputs.mesh.empty()) check_output_paths(line);
            result = make_result(run);
            if (!line.outputs.mesh.empty()) write_result(result, run);
            remove_bricks(result);
          });
          made->stats = stats_json(run);
          made->notes = notes_of(run.report);
          made->shortfall = shortfalls_of(run.report);
          made->mesh = std::move(result.mesh);
          made->midside = std::move(result.midside);
          made->bins = std::move(result.bins);
          made->parted = std::move(run.report.parted);
        });
      },
      progress, callback);
  return made;
}

py::tuple check(std::vector<std::string> arguments, NamedInputs& inputs, const py::object& callback) {
  const CommandLine line = parse(std::move(arguments));
  SharedProgress progress;
  std::string json;
  std::vector<std::string> notes;
  bool passed = false;
  run_in_background(
      [&] {
        with_threads_of_host(line.options.limits.threads, [&] {
          check_stats_path(line);
          CommandRun run(line, progress, &inputs);
          CheckReport found;
          with_stats_of_failure(run, [&] { found = make_check(run); });
          json = check_json(run, found);
          notes = notes_of(run.report);
          passed = found.valid() && found.topology_kept() && found.within_tolerance();
        });
      },
      progress, callback);
  return py::make_tuple(to_text(json), to_texts(notes), passed);
}

/// An array of numbers of another type, with a row of four or a number for each point.
template <class To, class Items>
py::array array_of(const Items& items, py::ssize_t columns) {
  const auto count = static_cast<py::ssize_t>(items.size());
  py::array_t<To> array(columns > 1 ? std::vector<py::ssize_t>{count, columns}
                                    : std::vector<py::ssize_t>{count});
  To* to = array.mutable_data();
  for (const auto& item : items)
    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(item)>>)
      *to++ = static_cast<To>(item);
    else
      to = std::copy(item.begin(), item.end(), to);
  return array;
}

py::tuple embed(std::vector<std::string> arguments, NamedInputs& inputs, const py::object& callback) {
  const CommandLine line = parse(std::move(arguments));
  SharedProgress progress;
  Embedding made;
  std::string stats;
  std::vector<std::string> notes;
  run_in_background(
      [&] {
        with_threads_of_host(line.options.limits.threads, [&] {
          const bool written = !line.outputs.mesh.empty();
          if (written) check_stats_path(line);
          CommandRun run(line, progress, &inputs);
          with_stats_of_failure(run, [&] {
            if (written) check_output_paths(line);
            made = make_embedding(run);
            if (written) write_embedding(made, run);
          });
          stats = stats_json(run);
          notes = notes_of(run.report);
        });
      },
      progress, callback);
  return py::make_tuple(
      py::make_tuple(array_of<std::int64_t>(made.tets, 1), array_of<std::int64_t>(made.nodes, 4),
                     array_of<double>(made.weights, 4), array_of<double>(made.distances, 1)),
      to_texts(notes), to_text(stats));
}

// Exceptions.

/// Python class for each kind of error; a borrowed reference, owned by the module.
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
      make("Error", "Base class of errors: the program's message; `status` is the program's exit status.",
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

  py::class_<NamedInputs>(module, "Inputs")
      .def(py::init<>())
      .def("add_surface",
           [](NamedInputs& to, const std::string& name, const Points& points,
              const GroupedTriangles& triangles, const DroppedItems& dropped) {
             to.values[name] = InputSurface{to_surface(name, points, triangles), to_dropped(dropped)};
           })
      .def(
          "add_mesh",
          [](NamedInputs& to, const std::string& name, const Points& points, const Cells& tets,
             const std::optional<Tags>& materials, const std::map<MaterialTag, std::string>& names,
             const Fields& point_fields, const Fields& cell_fields, const DroppedItems& dropped,
             const GroupedTriangles& triangles) {
            InputMesh mesh{to_mesh(name, points, tets, materials, names, point_fields, cell_fields, dropped)};
            mesh.triangles = to_triangles(name, mesh.read.mesh.points.size(), triangles);
            to.values[name] = std::move(mesh);
          })
      .def("add_own_mesh",
           [](NamedInputs& to, const std::string& name, const Mesh& mesh) {
             InputMesh input{{mesh.mesh, "material", {}}};
             if (mesh.midside)
               input.read.dropped.push_back({"midside nodes; tets of ten nodes are reduced to their corners",
                                             mesh.midside->points.size()});
             to.values[name] = std::move(input);
           })
      .def("add_sizes",
           [](NamedInputs& to, const std::string& name, const Points& points, const Cells& cells,
              const Values& lengths) { to.sizes[name] = to_sizes(name, points, cells, lengths); })
      .def("add_volume", [](NamedInputs& to, const std::string& name,
                            LabelFiller& labels) { to.values[name] = labels.take(); })
      .def("add_image", [](NamedInputs& to, const std::string& name,
                           ImageFiller& image) { to.values[name] = image.take(); })
      .def("add_mask",
           [](NamedInputs& to, const std::string& name, LabelFiller& labels) {
             to.masks[name] = std::make_shared<const LabelVolume>(labels.take());
           })
      .def("add_values_image", [](NamedInputs& to, const std::string& name, ImageFiller& image) {
        to.images[name] = std::make_shared<const ImageVolume>(image.take());
      });
  py::class_<LabelFiller>(module, "Labels")
      .def(py::init([](const std::string& name, const std::vector<std::int64_t>& shape,
                       const std::array<double, 3>& origin,
                       const std::array<std::array<double, 3>, 3>& directions) {
        return std::make_unique<LabelFiller>(name, PlacedShape{shape, origin, directions});
      }))
      .def("put", &LabelFiller::put);
  py::class_<ImageFiller>(module, "Image")
      .def(py::init([](const std::string& name, const std::vector<std::int64_t>& shape,
                       const std::array<double, 3>& origin,
                       const std::array<std::array<double, 3>, 3>& directions) {
        return std::make_unique<ImageFiller>(name, PlacedShape{shape, origin, directions});
      }))
      .def("put", &ImageFiller::put);
  module.def("require_memory", [](const std::string& what, double bytes, double held, double limit) {
    const MemoryLimit at_most(limit * gigabyte);
    const HeldMemory others(held);
    require_memory(bytes, what, "crop the image or make it coarser");
  });

  bind_mesh(module);

  module.def("option_types", &option_types);
  module.def("diagnostic_kinds", [] {
    py::list kinds;
    for (const DiagnosticKind& kind : diagnostic_kinds())
      kinds.append(py::make_tuple(kind.name, name_of(kind.severity), kind.yields != Yields::never,
                                  kind.certain, kind.title, kind.message, kind.cause, kind.remedy));
    return kinds;
  });
  module.def("is_face_label", [](const std::string& name) { return is_face_label(name); });
  module.def("run", &run);
  module.def("check", &check);
  module.def("embed", &embed);
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

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "common/files/atomic_file.h"
#include "common/io/contents/dropped.h"
#include "common/io/formats.h"
#include "common/memory.h"
#include "common/mesh/midside_nodes.h"
#include "common/progress.h"
#include "tools/app/command_line.h"
#include "tools/app/commands/input_objects.h"
#include "tools/prepare/run_report.h"
#include "tools/report/page/surface_distances.h"

namespace tetwright {

class Stopwatch {
 public:
  /// Since construction.
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// What all steps of a command share. The meshes themselves are handed from step to step.
struct CommandRun {
  /// What it is given must outlive it. Inputs are moved out of `objects` as they are read. The time and the
  /// memory of --time-limit and --memory-limit are those of its life, on the thread that makes it.
  CommandRun(const CommandLine& line, Progress& progress, InputObjects* objects = nullptr);

  /// Until --time-limit; 0 where it has passed, infinite where there is none.
  double seconds_left() const;
  /// Work on the mesh ends this many seconds before --time-limit, or earlier if it was told so before: what
  /// comparing and writing the mesh are expected to take.
  void reserve_time(double seconds);

  const CommandLine& line;
  MemoryLimit memory_limit;
  Stopwatch since_start;
  Progress& progress;
  InputObjects* objects;
  double seconds_waited = 0;  ///< for standard input
  RunReport report;
  std::optional<MidsideNodes> midside;        ///< of the result, with --order 2
  std::optional<SurfaceDistances> distances;  ///< of the result, with --report where there is a surface
};

/// Adds the statistics to the files, unless there are none or they go to standard output.
void write_stats(const CommandRun& run, OutputFiles& files);

/// The files that a command reads: the positional inputs, then those of --material. Empty for `sample`.
std::vector<std::string> input_files(const CommandLine& line);

/// The name, with the extension of --input-format if it is standard input.
std::string typed_name(const CommandLine& line, const std::string& name);

/// Whether the name is that of an object, whatever it looks like.
bool is_object(const CommandRun& run, const std::string& name);

/// Of a file by its extension, of an object by what it is.
FileKind input_kind(const CommandRun& run, const std::string& name);

/// What a material is called that is the whole input: an object's name, a file's without folders and
/// extension.
std::string material_name_of(const CommandRun& run, const std::string& name);

/// The readers of formats.h, which take what is among `run.objects` from there.
TriangleMesh take_surface(CommandRun& run, const std::string& name, std::vector<Dropped>* dropped);
ReadTetMesh take_tet_mesh(CommandRun& run, const std::string& name, const ReadTetMeshOptions& options);
LabelVolume take_label_volume(CommandRun& run, const std::string& name);

/// Adds to the findings what a reader dropped from `file`. Items that are restored from the mesh are added
/// only if `with_restored`.
void report_dropped(const std::vector<Dropped>& dropped, const std::string& file, RunReport& report,
                    bool with_restored = true);

}  // namespace tetwright

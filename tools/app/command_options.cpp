// SPDX-License-Identifier: Apache-2.0
#include "tools/app/command_options.h"

#include <CLI/CLI.hpp>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "common/samples/foam.h"
#include "common/samples/samples.h"
#include "tetwright/io.h"
#include "tools/app/body_options.h"
#include "tools/app/brick_options.h"
#include "tools/app/command_line.h"
#include "tools/app/image_options.h"
#include "tools/app/interface_options.h"
#include "tools/app/label_ranges.h"
#include "tools/app/option_values.h"
#include "tools/app/value_options.h"
#include "tools/app/volume_options.h"

namespace tetwright {

namespace {

/// The simplifier numbers the four corners of each tet with 32 bits.
constexpr std::uint64_t max_target_tets = std::uint64_t{1} << 30;
constexpr std::uint64_t max_rounds = 10'000;
constexpr std::uint64_t max_threads_option = 1024;
constexpr std::uint64_t max_jobs = 64;
/// Each part may be a file.
constexpr std::uint64_t max_parts = 10'000;
/// More voxels than any volume has.
constexpr std::uint64_t max_min_voxels = 1'000'000'000'000'000'000;

/// Adds an option whose value is one of the names in `values`.
template <class Value>
void add_choice(CLI::App& app, const char* option, Value& to, std::initializer_list<Value> values,
                const char* description) {
  std::map<std::string, Value> words;
  std::string known;
  for (const Value value : values) {
    words[name_of(value)] = value;
    known += (known.empty() ? "" : ", ") + std::string(name_of(value));
  }
  app.add_option_function<std::string>(
         option,
         [option, words, known, &to](const std::string& text) {
           const auto found = words.find(text);
           if (found == words.end())
             throw CLI::ValidationError(option, "'" + text + "' is not one of " + known);
           to = found->second;
         },
         description)
      ->type_name("NAME")
      ->default_str(name_of(to));
}

void add_stats(CLI::App& app, CommandLine& c) {
  app.add_option("--stats", c.outputs.stats,
                 "Write statistics of the run to this .json file, even if it fails; -: to standard output, "
                 "instead of the report")
      ->type_name("FILE");
}

void add_common(CLI::App& app, CommandLine& c) {
  add_whole_number(app, "--threads", c.options.limits.threads, 1, max_threads_option,
                   "Max number of threads, 1 to 1024 (default: all of the machine); at most four for each "
                   "processor, or 16 if that is more, are used");
  add_number(app, "--memory-limit", c.options.limits.memory, positive,
             "Use at most this many GB (2^30 bytes) of memory: cells that would not fit become larger unless "
             "an option sets their size (status 1), and what still does not fit is refused");
  app.add_flag("--quiet", c.console.quiet, "Print only errors and shortfalls");
  add_choice(
      app, "--progress", c.console.progress,
      {ProgressStyle::automatic, ProgressStyle::bar, ProgressStyle::json, ProgressStyle::none},
      "Progress on stderr: a bar, or a line of JSON for each stage and percent; auto: a bar on a terminal");
  app.add_flag("--no-progress", c.console.no_progress, "Same as --progress none");
  app.add_option("--log-file", c.console.log_file,
                 "Append the call, its stages, all messages and the exit status to this file, with times")
      ->type_name("FILE");
}

void add_time_limit(CLI::App& app, CommandLine& c) {
  add_number(app, "--time-limit", c.options.limits.seconds, positive,
             "End after this many seconds with the best mesh so far (status 1), or without a mesh if there "
             "is none yet. Results then depend on the machine");
}

void add_report(CLI::App& app, CommandLine& c) {
  app.add_option("--report", c.outputs.report,
                 "Write a report page, .html: the mesh in 3D with a cut, histograms, statistics, findings "
                 "and shortfalls; needs only a browser")
      ->type_name("FILE");
}

void add_seed(CLI::App& app, CommandLine& c) {
  add_whole_number(app, "--seed", c.options.seed, 0, std::numeric_limits<std::uint64_t>::max(),
                   "Seed of the random numbers; the same seed gives the same bytes")
      ->default_str(std::to_string(c.options.seed));
}

void add_output(CLI::App& app, CommandLine& c, const char* formats) {
  app.add_option("-o,--output", c.outputs.mesh, formats)->required(!c.in_memory)->type_name("FILE");
}

/// Adds the options of commands that write a tet mesh.
/// \param order true: with --order
void add_mesh_output(CLI::App& app, CommandLine& c, bool order = true) {
  add_output(app, c, ("The mesh to write: " + known_extensions(FileKind::tet_mesh, FileUse::write)).c_str());
  std::string formats;
  for (const TetFormatInfo& format : written_tet_formats())
    formats += (formats.empty() ? "" : " ") + format.name;
  app.add_option("--output-format", c.outputs.format,
                 "Format of the mesh instead of its extension's default, or of -o -: " + formats +
                     "; of --boundary -: an extension of a surface without its dot")
      ->type_name("NAME");
  if (order)
    add_whole_number(app, "--order", c.options.order, 1, 2,
                     "2: ten-node tets, with nodes in the middle of the edges; not in .mesh .meshb .node")
        ->default_str(std::to_string(c.options.order));
  std::string of_parts;
  for (const TetFormatInfo& format : written_tet_formats())
    if (format.parts && !of_parts.ends_with(format.extension)) of_parts += " " + format.extension;
  add_whole_number(app, "--parts", c.outputs.parts, 1, max_parts,
                   "Divide the mesh into this many parts of about equal size, 1 to 10000, each with the tets "
                   "around it, for parallel solvers:" +
                       of_parts);
  app.add_option("--boundary", c.outputs.boundary,
                 "Write the boundary and the interfaces between materials as a surface, too (- is standard "
                 "output): " +
                     known_extensions(FileKind::surface, FileUse::write))
      ->type_name("FILE");
  app.add_flag("--no-boundary", c.outputs.no_boundary,
               "Leave the triangles of the boundary and of interfaces out of the mesh, for programs that "
               "treat every element as a tet");
  add_report(app, c);
}

/// Adds the options of segmented volumes.
void add_labels(CLI::App& app, CommandLine& c) {
  app.add_option_function<std::vector<std::string>>(
         "--labels",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all)
             for (const LabelRange& range : parse_label_ranges("--labels", text))
               c.options.labels.meshed.push_back(range);
         },
         "Labels of a segmented volume to mesh, such as 1,5-9; all others become outside (default: all)")
      ->type_name("LIST")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option_function<std::vector<std::string>>(
         "--protect-labels",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all) add_protected_labels(text, c.options.labels);
         },
         "Labels that surfaces in a segmented volume do not carve: numbers, ranges and names, such as "
         "3,5-9,skull")
      ->type_name("LIST")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--label-names", c.options.labels.names_file,
                 "Text file with the names of labels: lines TAG NAME, or a colour table of 3D Slicer, "
                 "FreeSurfer or ITK-SNAP")
      ->type_name("FILE");
  app.add_option_function<std::string>(
         "--outside-label",
         [&c](const std::string& text) { c.options.labels.outside = parse_label("--outside-label", text); },
         "Label of a segmented volume that means the outside")
      ->type_name("LABEL")
      ->default_str("0");
  add_whole_number(app, "--min-voxels", c.options.labels.min_voxels, 0, max_min_voxels,
                   "Min size of an island of a label: smaller ones are merged into the neighbour they touch "
                   "most; 0: keep all")
      ->default_str(std::to_string(default_min_voxels));
}

void add_strict(CLI::App& app, CommandLine& c) {
  app.add_flag("--strict", c.options.acceptance.strict, "Status 1 if there is any note that is certain");
}

void add_meshing(CLI::App& app, CommandLine& c, const char* default_resolution) {
  add_whole_number(app, "--resolution", c.options.cells.resolution, 4, 4096,
                   std::string("Number of finest cells along the longest side, 4 to 4096 (default: ") +
                       default_resolution + ")");
  add_number(app, "--voxel-size", c.options.cells.size, positive,
             "Edge length of the finest cells in input units, instead of --resolution");
  app.add_flag("--uniform", c.options.cells.uniform,
               "Use the finest cells everywhere: a plain grid instead of an octree");
  add_number(app, "--adaptivity", c.options.cells.adaptivity, not_negative,
             "Max displacement of a surface by coarser cells, in finest cells; 0: finest cells along all "
             "surfaces")
      ->default_str(short_text(c.options.cells.adaptivity));
  add_whole_number(app, "--max-refinement", c.options.cells.max_refinement, 0, max_wall_refinement,
                   "How many times cells are halved where walls and gaps of a surface are thin, 0 to 8 "
                   "(default: 3, more where that takes few cells)");
  add_length(app, "--min-gap", c.options.cells.min_gap,
             "Close gaps, tunnels and cavities of a surface that are narrower, input units or percent of the "
             "diagonal");
  add_length(app, "--min-thickness", c.options.cells.min_thickness,
             "Leave out walls and bridges of a surface that are thinner, input units or percent of the "
             "diagonal");
  add_bodies(app, c);
  add_feature_angle(app, c.options.feature_angle);
  app.add_flag("--keep-outside", c.options.cells.keep_outside,
               "Mesh the outside too, up to a box, as the material 'outside' with tag 0");
  app.add_flag("--accept-changes", c.options.acceptance.accept_changes,
               "If the volume, components, handles or cavities differ from those of the surfaces: a note "
               "instead of status 1. Open sheets, which enclose next to nothing, are closed all the same");
  add_strict(app, c);
  app.add_option("--write-sdf", c.outputs.distances,
                 "Write the meshed signed distances to this .vdb file, with thin walls as thick as the cells "
                 "represent them")
      ->type_name("FILE");
}

/// Adds the options of both simplification and improvement.
void add_shaping(CLI::App& app, CommandLine& c, const char* iterations) {
  add_number(app, "--min-solid-angle", c.options.shapes.min_solid_angle, solid_angle,
             "Improve tets with a smaller solid angle (steradians); if given and some are left, status 1")
      ->default_str(short_text(default_min_solid_angle));
  add_choice(app, "--objective", c.options.shapes.objective,
             {ShapeObjective::both, ShapeObjective::solid_angle, ShapeObjective::dihedral},
             "Measure of a tet's shape: its min solid-angle, its min and max dihedral angle, or both");
  add_whole_number(app, "--max-iterations", c.options.shapes.max_iterations, 1, max_rounds, iterations)
      ->default_str(std::to_string(c.options.shapes.max_iterations));
}

void add_tolerance(CLI::App& app, CommandLine& c) {
  add_length(app, "--tolerance", c.options.target.tolerance,
             "Max distance of any point of the mesh's surface from the input's and vice versa, input units "
             "or percent of the diagonal; status 1 unless proven for the result");
}

void add_simplifying(CLI::App& app, CommandLine& c) {
  add_whole_number(app, "--target-tets", c.options.target.tets, 1, max_target_tets,
                   "Target number of tets; without it --tolerance gives as few as it allows. With "
                   "--size-field the sizes decide");
  add_tolerance(app, c);
  app.add_option_function<std::string>(
         "--size-field",
         [&c](const std::string& file) {
           if (!file.empty()) c.options.sizes.field = SizeFieldInput{file};
         },
         "Target edge lengths, input units: the point field of a tet or surface mesh, or a float grid (.vdb)")
      ->type_name("FILE");
  add_length(app, "--max-edge", c.options.sizes.max_edge,
             "Max length of edges, input units or percent of the diagonal; longer ones are split");
  add_length(app, "--min-edge", c.options.sizes.min_edge,
             "Min length of edges, input units or percent of the diagonal; shorter ones are collapsed where "
             "surfaces and shapes allow");
  add_number(app, "--grading", c.options.sizes.grading, positive,
             "Max growth of the edge lengths of --size-field per unit distance; larger growth is reduced")
      ->default_str(short_text(default_grading));
  add_shaping(app, c, "Max number of block iterations, 1 to 10000");
  add_choice(app, "--schedule", c.options.schedule.kind, {Schedule::tuned, Schedule::paper},
             "tuned: fast, ends with improvement; paper: operations in the order of Cutler et al. 2004");
  add_number(app, "--beta", c.options.schedule.beta, positive,
             "Max edge length, in ideal edges, that quality does not penalise")
      ->default_str(short_text(c.options.schedule.beta));
  add_number(app, "--gamma", c.options.schedule.gamma, not_negative,
             "Weight of the surface error; larger values keep more detail")
      ->default_str(short_text(c.options.schedule.gamma));
}

void add_material_field(CLI::App& app, CommandLine& c) {
  app.add_option("--material-field", c.options.material_field,
                 "Integer cell field with the materials, instead of the first of material, medit:ref, "
                 "physical groups, MaterialID, attribute")
      ->type_name("NAME");
}

/// Adds --input-format, for commands that can read standard input.
void add_input_format(CLI::App& app, CommandLine& c) {
  app.add_option("--input-format", c.input_format,
                 "Format of standard input (input -): " + streamed_extensions())
      ->type_name("NAME");
}

std::string scans() {
  return "Surfaces (" + known_extensions(FileKind::surface) +
         ") and level sets (.vdb), each a material; later ones carve earlier ones; or one segmented volume "
         "(" +
         known_extensions(FileKind::volume) +
         ", .vdb of whole numbers), or several or a folder of them that are masks of a material each";
}
std::string meshes() { return "Tet mesh: " + known_extensions(FileKind::tet_mesh); }

/// Adds the spaces of a tet mesh and of surfaces that it is compared with.
void add_spaces(CLI::App& app, CommandLine& c, const std::string& what) {
  add_mesh_space(app, c);
  add_surface_space(app, c,
                    "Coordinate system of " + what + " if its file names none (default: that of MESH)");
}

void add_fix_boundary(CLI::App& app, CommandLine& c) {
  app.add_flag("--fix-boundary", c.options.shapes.fix_boundary,
               "Keep the points and faces of the boundary and of interfaces between materials as they are");
}

}  // namespace

void add_prepare(CLI::App& app, CommandLine& c) {
  app.add_option("INPUT", c.inputs, scans());
  add_input_format(app, c);
  add_mesh_output(app, c);
  add_simplifying(app, c);
  add_meshing(app, c, "what the target needs");
  add_volume_file(app, c.options.volume_file);
  add_labels(app, c);
  add_images(app, c);
  add_values_options(app, c);
  add_selections(app, c);
  add_interface_options(app, c);
  add_bricks(app, c);
  add_stats(app, c);
  add_common(app, c);
  add_time_limit(app, c);
  add_seed(app, c);
}

void add_mesh(CLI::App& app, CommandLine& c) {
  app.add_option("INPUT", c.inputs, scans());
  add_input_format(app, c);
  add_mesh_output(app, c);
  add_meshing(app, c, "128, or with --tolerance what that needs; for segmented volumes one cell per voxel");
  add_tolerance(app, c);
  add_volume_file(app, c.options.volume_file);
  add_labels(app, c);
  add_images(app, c);
  add_values_options(app, c);
  add_selections(app, c);
  add_interface_options(app, c);
  add_stats(app, c);
  add_common(app, c);
  add_time_limit(app, c);
  add_seed(app, c);
}

void add_simplify(CLI::App& app, CommandLine& c) {
  app.add_option("MESH", c.inputs, meshes())->required()->expected(1);
  add_input_format(app, c);
  add_mesh_output(app, c);
  add_simplifying(app, c);
  add_fix_boundary(app, c);
  add_feature_angle(app, c.options.feature_angle);
  add_values_options(app, c);
  add_selections(app, c);
  add_interface_options(app, c);
  add_spaces(app, c, "a --size-field");
  add_strict(app, c);
  add_material_field(app, c);
  add_stats(app, c);
  add_common(app, c);
  add_time_limit(app, c);
  add_seed(app, c);
}

void add_improve(CLI::App& app, CommandLine& c) {
  app.add_option("MESH", c.inputs, meshes())->required()->expected(1);
  add_input_format(app, c);
  add_mesh_output(app, c);
  add_number(
      app, "--only-below", c.options.shapes.only_below, solid_angle,
      "Work only on tets with a smaller solid angle (steradians) and their neighbours; 0: on all. Tets "
      "that stay below it are reported")
      ->default_str("0");
  app.add_flag("--free-count", c.options.shapes.free_count,
               "Let the number of tets change as good shapes need, instead of keeping it within 5 %");
  add_shaping(app, c, "Max number of rounds, 1 to 10000");
  add_fix_boundary(app, c);
  add_feature_angle(app, c.options.feature_angle);
  add_values_options(app, c);
  add_selections(app, c);
  add_interface_options(app, c);
  add_mesh_space(app, c);
  add_strict(app, c);
  add_material_field(app, c);
  add_stats(app, c);
  add_common(app, c);
  add_time_limit(app, c);
  add_seed(app, c);
}

void add_values(CLI::App& app, CommandLine& c) {
  app.add_option("MESH", c.inputs, meshes())->required()->expected(1)->allow_extra_args(false);
  app.add_option_function<std::vector<std::string>>(
         "IMAGE",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all) c.options.values.images.push_back(parse_value_image(text));
         },
         "Images, as NAME=FILE or FILE: the mean over each tet becomes the cell field NAME, by default the "
         "name of the file, and the value at each point the point field NAME")
      ->required(!c.in_memory)
      ->expected(-1);
  add_input_format(app, c);
  add_mesh_output(app, c, false);
  add_value_rules(app, c);
  add_mesh_space(app, c);
  add_strict(app, c);
  add_material_field(app, c);
  add_stats(app, c);
  add_common(app, c);
}

void add_embed(CLI::App& app, CommandLine& c) {
  app.add_option("MESH", c.inputs, meshes())->required()->expected(1)->allow_extra_args(false);
  app.add_option_function<std::string>(
         "SURFACE", [&c](const std::string& file) { c.inputs.push_back(file); },
         "Surface whose points the mesh carries: " + known_extensions(FileKind::surface))
      ->required()
      ->expected(1);
  add_input_format(app, c);
  add_output(app, c,
             "Tet, nodes, weights and distance of each point of SURFACE, counted from 0: .npz (arrays of "
             "numpy), .json");
  app.add_option("--output-format", c.outputs.format,
                 "Format in place of the extension, and of standard output (-o -): npz, json")
      ->type_name("NAME");
  add_spaces(app, c, "SURFACE");
  add_stats(app, c);
  add_common(app, c);
}

void add_check(CLI::App& app, CommandLine& c) {
  app.add_option("MESH", c.inputs, meshes())->required()->expected(1);
  add_input_format(app, c);
  app.add_option("--before", c.check.before, "Another mesh, whose topology MESH must have")
      ->type_name("FILE");
  app.add_option("--surface", c.check.surfaces,
                 "Surfaces (as prepare reads them) to compare MESH with, whatever it was made from: proven "
                 "largest distances both ways, and creases; for one closed surface also volume and topology. "
                 "With several, interfaces between materials count, too")
      ->type_name("FILE");
  add_length(app, "--tolerance", c.options.target.tolerance,
             "Status 1 unless MESH and the surfaces are proven to be within this of each other everywhere, "
             "input units or percent of the surfaces' diagonal");
  add_spaces(app, c, "a --surface");
  app.add_flag("--json", c.check.json, "Print JSON");
  add_report(app, c);
  add_material_field(app, c);
  add_stats(app, c);
  add_common(app, c);
}

void add_batch(CLI::App& app, CommandLine& c) {
  app.add_option("JOBS", c.inputs,
                 "File with a line of JSON for each job, the arguments as they would be given to tetwright: "
                 R"({"id": "a", "args": ["prepare", "a.ply", "-o", "a.vtu", "--target-tets", "10000"]})")
      ->required()
      ->expected(1);
  app.add_option("--results", c.batch.results,
                 "File that receives a line of JSON for each finished job: id, args, status, seconds, "
                 "messages, stats. Jobs in it are not run again, unless they ended with status 5, 70 or 130 "
                 "(default: the name of JOBS with .results.jsonl)")
      ->type_name("FILE");
  add_whole_number(
      app, "--jobs", c.batch.jobs, 1, max_jobs,
      "Max number of jobs at the same time, 1 to 64; they share the threads (default: one for each "
      "thread)");
  app.add_flag("--retry", c.batch.retry, "Run all jobs again that did not end with status 0");
  add_common(app, c);
}

void add_sample(CLI::App& app, CommandLine& c) {
  app.add_option("NAME", c.inputs, "One of: " + comma_separated(sample_names()))->required()->expected(1);
  add_output(app, c,
             ("Surfaces: " + known_extensions(FileKind::surface, FileUse::write) +
              "; tet meshes: " + known_extensions(FileKind::tet_mesh, FileUse::write) +
              "; segmented volumes: " + known_extensions(FileKind::volume, FileUse::write))
                 .c_str());
  app.add_option(
         "--output-format", c.outputs.format,
         "Format in place of the extension, and of standard output (-o -): as for other commands' meshes, "
         "or an extension of a surface or volume without its dot")
      ->type_name("NAME");
  add_whole_number(
      app, "--voxels", c.foam.voxels, min_foam_voxels, max_foam_voxels,
      "foam: number of voxels along each edge of the cube, 4 to 4096; the file is written piece by "
      "piece, not compressed")
      ->default_str(std::to_string(default_foam_voxels));
  add_whole_number(
      app, "--grains", c.foam.grains, 1, max_foam_grains(max_foam_voxels),
      "foam: number of grains, 1 to 1000000, at most a 64th of the voxels (default: 20, or what fits)");
  add_stats(app, c);
  add_common(app, c);
}

}  // namespace tetwright

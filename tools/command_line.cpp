#include "tools/command_line.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>

#include "common/error.h"
#include "common/samples.h"

namespace tetwright {

namespace {

/// Digits only: the parser's own conversion lets a minus wrap round and clamps what is too large.
const CLI::Validator whole_number(
    [](std::string& text) {
      const bool digits = !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
      return digits && text.size() <= 18 ? std::string()
                                         : "'" + text + "' is not a whole number from 0 to 10^18";
    },
    "");

/// A finite number above `low`, or at least `low` where `or_equal`.
CLI::Validator number_from(double low, bool or_equal) {
  return {[low, or_equal](std::string& text) {
            char* end = nullptr;
            const double value = std::strtod(text.c_str(), &end);
            const bool good =
                !text.empty() && *end == 0 && std::isfinite(value) && (or_equal ? value >= low : value > low);
            return good ? std::string()
                        : "'" + text + "' is not a number " + (or_equal ? "of at least " : "above ") +
                              (low == 0 ? "0" : std::to_string(low));
          },
          ""};
}

/// The smallest solid angle of a tet, which is never more than that of the regular one. (The parser's own
/// range lets what is no number pass.)
const CLI::Validator solid_angle(
    [](std::string& text) {
      char* end = nullptr;
      const double value = std::strtod(text.c_str(), &end);
      return !text.empty() && *end == 0 && value >= 0 && value <= 0.5513
                 ? std::string()
                 : "'" + text + "' is not a solid angle from 0 to 0.5513, the regular tet's";
    },
    "");

/// Takes a label off the beginning of the text; false if there is none.
bool take_label(std::string_view& text, MaterialTag& label) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), label);
  if (error != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return true;
}

MaterialTag parse_label(const std::string& text, const char* option) {
  std::string_view left = text;
  MaterialTag label = 0;
  if (!take_label(left, label) || !left.empty())
    throw CLI::ValidationError(option, "'" + text + "' is not a whole number from -2147483648 to 2147483647");
  return label;
}

/// "1,5-9,-3--1": a minus behind a number makes a range, before one it is a sign.
void parse_labels(const std::string& text, std::vector<std::pair<MaterialTag, MaterialTag>>& to) {
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const std::string part = text.substr(begin, end - begin);
    begin = end + 1;
    std::string_view left = part;
    MaterialTag first = 0;
    bool good = take_label(left, first);
    MaterialTag last = first;
    if (good && left.starts_with('-')) {
      left.remove_prefix(1);
      good = take_label(left, last);
    }
    if (!good || !left.empty())
      throw CLI::ValidationError("--labels", "'" + part + "' is neither a label nor a range such as 5-9");
    if (first > last)
      throw CLI::ValidationError("--labels", "'" + part + "' begins with the larger label; did you mean " +
                                                 std::to_string(last) + "-" + std::to_string(first) + "?");
    to.emplace_back(first, last);
  }
}

void add_common(CLI::App& app, CommandLine& c) {
  app.add_option("--threads", c.threads, "Threads to use (default: all of the machine)")
      ->check(whole_number)
      ->check(CLI::Range(1u, 1024u));
  app.add_option("--stats", c.stats, "Write what was done and reached to this .json file");
  app.add_flag("--quiet", c.quiet, "Print nothing but errors");
  app.add_flag("--no-progress", c.no_progress, "No progress bar");
}

void add_seed(CLI::App& app, CommandLine& c) {
  app.add_option("--seed", c.seed,
                 "Start of the random numbers; with one thread the same seed gives the same bytes")
      ->check(whole_number)
      ->capture_default_str();
}

void add_output(CLI::App& app, CommandLine& c, const char* formats) {
  app.add_option("-o,--output", c.output, formats)->required();
}

NamedValue split_named(const std::string& text, const char* option, const char* value) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == text.size())
    throw CLI::ValidationError(option, "'" + text + "' is not NAME=" + value);
  return {text.substr(0, equals), text.substr(equals + 1)};
}

/// What of segmented volumes is meshed.
void add_labels(CLI::App& app, CommandLine& c) {
  app.add_option_function<std::vector<std::string>>(
         "--labels",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all) parse_labels(text, c.labels);
         },
         "Labels of a segmented volume to mesh, such as 1,5-9; the others are outside (default: all)")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option("--label-names", c.label_names,
                 "Text file that names the labels: lines TAG NAME, or a table of 3D Slicer, FreeSurfer or "
                 "ITK-SNAP");
  app.add_option_function<std::string>(
         "--outside-label",
         [&c](const std::string& text) { c.outside_label = parse_label(text, "--outside-label"); },
         "Label of a segmented volume that is outside")
      ->default_str(std::to_string(c.outside_label));
  app.add_option("--min-voxels", c.min_voxels,
                 "Islands of a label with fewer voxels are merged into what they touch most; 0: none")
      ->check(whole_number)
      ->capture_default_str();
}

void add_meshing(CLI::App& app, CommandLine& c, const char* default_resolution) {
  app.add_option("--resolution", c.resolution,
                 std::string("Finest cells along the longest side (default: ") + default_resolution + ")")
      ->check(whole_number)
      ->check(CLI::Range(4, 4096));
  app.add_option("--voxel-size", c.voxel_size,
                 "Edge of the finest cells in input units, instead of --resolution")
      ->check(number_from(0, false));
  app.add_flag("--uniform", c.uniform, "Finest cells everywhere: a plain grid, no octree");
  app.add_option("--adaptivity", c.adaptivity,
                 "Largest misplacement of the surface by a coarser cell, in finest cells; 0: finest cells "
                 "all along it")
      ->check(number_from(0, true))
      ->capture_default_str();
  app.add_option_function<std::vector<std::string>>(
         "--material",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all) c.materials.push_back(split_named(text, "--material", "FILE"));
         },
         "One more surface under a name of its own, NAME=FILE; repeatable. Later materials carve earlier "
         "ones")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app.add_option_function<std::vector<std::string>>(
         "--layer",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all) {
             c.layers.push_back(split_named(text, "--layer", "THICKNESS"));
             std::string value = c.layers.back().value;
             if (const std::string wrong = number_from(0, false)(value); !wrong.empty())
               throw CLI::ValidationError("--layer", wrong);
           }
         },
         "A shell of the first surface, NAME=THICKNESS in input units; repeatable, outermost first")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  static const std::map<std::string, NestedRule> nested_rules{{"auto", NestedRule::automatic},
                                                              {"cavity", NestedRule::cavity},
                                                              {"solid", NestedRule::solid},
                                                              {"material", NestedRule::material}};
  app.add_option_function<std::string>(
      "--nested",
      [&c](const std::string& text) {
        const auto rule = nested_rules.find(text);
        if (rule == nested_rules.end())
          throw CLI::ValidationError("--nested", "'" + text + "' is none of auto, cavity, solid, material");
        c.nested = rule->second;
      },
      "What closed parts inside others are: auto (wound against them: cavities; alike: solid), cavity, "
      "solid, "
      "or material (of their own)");
  app.add_flag("--keep-outside", c.keep_outside,
               "Mesh the outside too, in a box, as the material 'outside' with tag 0");
  app.add_option("--write-sdf", c.write_sdf, "Write the signed distances that were meshed to this .vdb file");
}

/// An option whose value is one of a few words, each naming one of `values`.
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
           if (found == words.end()) throw CLI::ValidationError(option, "'" + text + "' is none of " + known);
           to = found->second;
         },
         description)
      ->default_str(name_of(to));
}

/// What simplification and improvement have in common.
void add_shaping(CLI::App& app, CommandLine& c, const char* iterations) {
  app.add_option(
         "--min-solid-angle", c.min_solid_angle,
         "Tets with a smaller solid angle (steradians) are improved; if given and some are left, status 1")
      ->check(solid_angle)
      ->capture_default_str();
  add_choice(app, "--objective", c.objective,
             {ShapeObjective::both, ShapeObjective::solid_angle, ShapeObjective::dihedral},
             "What a good shape is: large solid-angle, no small or large dihedral, or both");
  app.add_option("--max-iterations", c.max_iterations, iterations)
      ->check(whole_number)
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
}

void add_simplifying(CLI::App& app, CommandLine& c) {
  app.add_option("--target-tets", c.target_tets, "Number of tets wanted")->required()->check(whole_number);
  add_shaping(app, c, "Block iterations at most");
  add_choice(app, "--schedule", c.schedule, {Schedule::tuned, Schedule::paper},
             "tuned: fast, and closes with improvement; paper: operations and order of Cutler et al. 2004");
  app.add_option("--beta", c.beta, "Longest edge, in ideal edges, that quality does not penalise")
      ->check(number_from(0, false))
      ->capture_default_str();
  app.add_option("--gamma", c.gamma, "Weight of the surface's error; larger keeps more of it")
      ->check(number_from(0, true))
      ->capture_default_str();
}

void add_material_field(CLI::App& app, CommandLine& c) {
  app.add_option("--material-field", c.material_field,
                 "Integer cell field that holds the materials, instead of the first of material, medit:ref, "
                 "physical groups, MaterialID, attribute");
}

std::string one_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  for (char& ch : text)
    if (ch == '\n') ch = ' ';
  return text;
}

std::string joined(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& n : names) out += (out.empty() ? "" : ", ") + n;
  return out;
}

}  // namespace

const char* name_of(Schedule schedule) { return schedule == Schedule::tuned ? "tuned" : "paper"; }

const char* name_of(ShapeObjective objective) {
  return objective == ShapeObjective::both          ? "both"
         : objective == ShapeObjective::solid_angle ? "solid-angle"
                                                    : "dihedral";
}

bool parse_command_line(int argc, char** argv, CommandLine& out) {
  CLI::App app("Turns surface scans into tetrahedral meshes that a simulation can run on.", "tetwright");
  app.set_version_flag("--version", TETWRIGHT_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done, 1 written but short of what was asked (check: not valid), 2 wrong call, 3 bad "
      "input,\n"
      "4 nothing to mesh, 5 could not be written or out of memory, 130 interrupted.");
  constexpr const char* surfaces =
      "Surfaces: .ply .obj .stl .off, level sets: .vdb; each a material, later ones carve earlier ones. Or "
      "segmented volumes: .nrrd .nhdr .mhd .mha .nii .nii.gz .inr .inr.gz, and .vdb of whole numbers";
  constexpr const char* meshes = "Tet mesh: .vtu .msh .mesh .vtk .node .ele";
  constexpr const char* mesh_out = "Where the mesh goes: .vtu .msh .mesh";

  CLI::App* prepare = app.add_subcommand("prepare", "Scan to simulation mesh, in one go");
  prepare->add_option("INPUT", out.inputs, surfaces);
  add_output(*prepare, out, mesh_out);
  add_simplifying(*prepare, out);
  add_meshing(*prepare, out, "what the target needs");
  add_labels(*prepare, out);
  add_common(*prepare, out);
  add_seed(*prepare, out);

  CLI::App* mesh = app.add_subcommand("mesh", "Scan to dense mesh");
  mesh->add_option("INPUT", out.inputs, surfaces);
  add_output(*mesh, out, mesh_out);
  add_meshing(*mesh, out, "128");
  add_labels(*mesh, out);
  add_common(*mesh, out);
  add_seed(*mesh, out);

  CLI::App* simplify = app.add_subcommand("simplify", "Tet mesh to simulation mesh");
  simplify->add_option("MESH", out.inputs, meshes)->required()->expected(1);
  add_output(*simplify, out, mesh_out);
  add_simplifying(*simplify, out);
  add_material_field(*simplify, out);
  add_common(*simplify, out);
  add_seed(*simplify, out);

  CLI::App* improve = app.add_subcommand("improve", "Better shapes for a tet mesh, about as many tets");
  improve->add_option("MESH", out.inputs, meshes)->required()->expected(1);
  add_output(*improve, out, mesh_out);
  improve
      ->add_option("--only-below", out.only_below,
                   "Work only on tets with a smaller solid angle (steradians) and what stands around them; "
                   "0: on all")
      ->check(solid_angle)
      ->capture_default_str();
  add_shaping(*improve, out, "Rounds at most");
  add_material_field(*improve, out);
  add_common(*improve, out);
  add_seed(*improve, out);

  CLI::App* check =
      app.add_subcommand("check", "Validity, topology and quality of a tet mesh; status 1 if not valid");
  check->add_option("MESH", out.inputs, meshes)->required()->expected(1);
  check->add_option("--before", out.before, "Mesh whose topology this one must have");
  check->add_flag("--json", out.json, "Print JSON");
  add_material_field(*check, out);
  add_common(*check, out);

  CLI::App* sample = app.add_subcommand("sample", "Writes a built-in sample");
  sample->add_option("NAME", out.inputs, "One of: " + joined(sample_names()))->required()->expected(1);
  add_output(*sample, out,
             "Surfaces: .ply .obj .stl .off; tet meshes: .vtu .msh .mesh; volumes of labels: .nrrd");
  add_common(*sample, out);

  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();  // of the command, where one was named
    return false;
  } catch (const CLI::CallForVersion&) {
    std::cout << "tetwright " << TETWRIGHT_VERSION << "\n";
    return false;
  } catch (const CLI::ParseError& e) {
    throw UsageError(one_line(e.what()) +
                     " (tetwright --help, or --help after a command, lists what there is)");
  }
  const CLI::App* chosen = app.get_subcommands().front();
  out.command = chosen == prepare    ? Command::prepare
                : chosen == mesh     ? Command::mesh
                : chosen == simplify ? Command::simplify
                : chosen == improve  ? Command::improve
                : chosen == check    ? Command::check
                                     : Command::sample;
  const bool simplifies = out.command == Command::prepare || out.command == Command::simplify;
  if (simplifies && out.target_tets == 0) throw UsageError("--target-tets 0 leaves no mesh; give 1 or more");
  if (simplifies || out.command == Command::improve)
    out.min_solid_angle_given = chosen->count("--min-solid-angle") > 0;
  if (out.command == Command::prepare || out.command == Command::mesh) {
    if (out.inputs.empty() && out.materials.empty())
      throw UsageError("there is no input; name a surface, or give --material NAME=FILE");
    out.outside_label_given = chosen->count("--outside-label") > 0;
    out.min_voxels_given = chosen->count("--min-voxels") > 0;
  }
  if (out.resolution && out.voxel_size > 0) throw UsageError("give --resolution or --voxel-size, not both");
  return true;
}

}  // namespace tetwright

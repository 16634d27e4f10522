// SPDX-License-Identifier: Apache-2.0
#include "tools/app/interface_options.h"

#include <algorithm>
#include <string>
#include <vector>

#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tools/app/option_values.h"

namespace tetwright {

namespace {

void add_requests(CLI::App& app, CommandLine& c, const char* option, bool cohesive, const char* help) {
  app.add_option_function<std::vector<std::string>>(
         option,
         [&c, cohesive](const std::vector<std::string>& all) {
           for (const std::string& faces : all) c.options.parting.push_back({faces, cohesive});
         },
         help)
      ->expected(1)
      ->type_name("A,B|NAME|all")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace

void add_selections(CLI::App& app, CommandLine& c) {
  app.add_option_function<std::vector<std::string>>(
         "--select",
         [&c](const std::vector<std::string>& all) {
           for (const std::string& text : all) {
             const NamedValue named = split_named(text, "--select", "RULE");
             c.options.selections.push_back(parse_face_selection(named.name, named.value));
           }
         },
         "A named set of boundary faces, with a set of their nodes in formats of solvers. Rules, joined by "
         "'and': "
         "plane:z=min,0.5% (corners within 0.5 % of the diagonal; or plane:A,B,C=D,T), box:X,Y,Z,X,Y,Z, "
         "sphere:X,Y,Z,R, cylinder:X,Y,Z,X,Y,Z,R, normal:X,Y,Z,DEGREES, patch-at:X,Y,Z (the nearest face, "
         "and all up to creases); repeatable")
      ->expected(1)
      ->type_name("NAME=RULE")
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_interface_options(CLI::App& app, CommandLine& c) {
  add_requests(
      app, c, "--split-interface", false,
      "Double the points between the materials A and B, on a sheet or a group of faces NAME, or with all on "
      "every interface between materials, so that both sides have faces of their own: A|B:A and A|B:B; a "
      "table of the pairs "
      "of points is written beside the mesh; repeatable");
  add_requests(app, c, "--cohesive", true,
               "The same, with wedges without volume between the two sides (COH3D6 in .inp, wedges in .vtu "
               ".vtk .msh .xdmf); repeatable");
}

void check_interface_options(const CommandLine& line) {
  const std::vector<InterfaceRequest>& requests = line.options.parting;
  if (requests.empty()) return;
  if (line.outputs.no_boundary)
    throw UsageError(
        "--no-boundary leaves out the faces of both sides that --split-interface and --cohesive "
        "make; leave out one of them");
  const bool cohesive =
      std::any_of(requests.begin(), requests.end(), [](const InterfaceRequest& r) { return r.cohesive; });
  if (!cohesive || line.outputs.mesh.empty()) return;
  if (line.outputs.parts > 0)
    throw UsageError(
        "--cohesive does not work with --parts, since files of parts hold no wedges; leave out one");
  if (written_tet_format(line.outputs.mesh, line.outputs.format).wedges) return;
  std::string extensions;
  for (const TetFormatInfo& known : written_tet_formats())
    if (known.wedges && !extensions.ends_with(known.extension)) extensions += " " + known.extension;
  throw UsageError("--cohesive: " + line.outputs.mesh + " would be in a format without wedges; write one of" +
                   extensions);
}

}  // namespace tetwright

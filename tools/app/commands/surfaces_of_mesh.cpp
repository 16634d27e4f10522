// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/surfaces_of_mesh.h"

#include <vector>

#include "common/images/grid_box.h"
#include "tetwright/diagnostic.h"

namespace tetwright {

namespace {

Box3 box_of_tets(const TetMesh& mesh) {
  Box3 box;
  for (const Tet& tet : mesh.tets)
    for (const Index p : tet) box.add(mesh.points[p]);
  return box;
}

Box3 box_of_points(const TriangleMesh& surface) {
  Box3 box;
  for (const Vec3& p : surface.points) box.add(p);
  return box;
}

}  // namespace

SpacesOfSurfaces::SpacesOfSurfaces(const TetMesh& mesh, CommandRun& run)
    : run_(run), spaces_(run.line.options.bodies.surface_space), box_(box_of_tets(mesh)) {
  run.report.space = space_of_tets(mesh, run.line.inputs.front(), run.line.options.mesh_space, run.report);
  spaces_.begin_with(run.report.space, run.line.inputs.front(), true);
}

void SpacesOfSurfaces::add(TriangleMesh& surface, const Input& input) {
  const std::string& file = input.name;
  const std::string before = surface.space;
  spaces_.add(surface, input);
  const Box3 box = box_of_points(surface);
  const std::string& mesh = run_.line.inputs.front();
  if (!surface.points.empty() && !box.intersects(box_))
    throw boxes_apart(file, "it does not meet " + mesh, "it", box, mesh, box_,
                      spaces_.both_spaces(before, file));
}

void SpacesOfSurfaces::report() {
  const std::vector<Diagnostic> findings = spaces_.findings();
  run_.report.diagnostics.insert(run_.report.diagnostics.end(), findings.begin(), findings.end());
}

}  // namespace tetwright

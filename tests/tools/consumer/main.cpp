// What the README shows for C++, as a program of another project.
#include <cstdio>
#include <variant>

#include "common/samples.h"
#include "mesher/mesher.h"
#include "simplify/simplify.h"

int main() {
  tetwright::MaterialSurface body{
      "body", 1, std::get<tetwright::TriangleMesh>(tetwright::make_sample("torus")), "torus"};
  tetwright::MesherOptions meshing;
  meshing.resolution = 40;
  const auto dense = tetwright::mesh_surfaces(tetwright::prepare_input({body}), meshing, nullptr);
  tetwright::SimplifyOptions options;
  options.target_tets = 2000;
  const tetwright::TetMesh mesh = tetwright::simplify(dense.mesh, options);
  std::printf("%zu tets\n", mesh.tets.size());
  return mesh.tets.size() > 1950 && mesh.tets.size() < 2050 ? 0 : 1;
}

#include "simplify/operations/block_rules.h"

namespace tetwright {

bool near_reference(const BlockRules& rules, const SurfaceGrid::Added& t, RegionId inside, RegionId across) {
  if (!rules.projection || !(rules.max_distance > 0)) return true;
  const auto& p = t.triangle.points;
  const Vec3 centre = (p[0] + p[1] + p[2]) / 3;
  return rules.projection->onto_surface(centre, inside, across, t.patch, rules.max_distance).has_value();
}

float quality_of(const EditableMesh& mesh, const BlockRules& rules, const Tet& t) {
  return rules.objective(mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2]), mesh.position(t[3]));
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "mesher/cut/complex_patches.h"

#include <algorithm>

#include "tetwright/error.h"

namespace tetwright {

ComplexPatches complex_patches(const MesherInput& input, const std::vector<SurfacePatches>& patches) {
  constexpr std::size_t max_patches = 0xfffe;  // one more is for faces that lie on no surface
  const LabelledComplex& complex = *input.complex;
  ComplexPatches out;
  using BodyPatch = std::pair<std::uint32_t, std::uint16_t>;
  std::map<std::pair<std::size_t, std::vector<BodyPatch>>, std::uint16_t> numbers;
  for (Index f = 0; f < complex.faces.size(); ++f) {
    const LabelledComplex::Face& face = complex.faces[f];
    Triangle ids = face.ids;
    if (face.behind == outside_region) std::swap(ids[1], ids[2]);
    out.triangles.push_back(ids);
    const std::size_t sheet =
        out.sheets.try_emplace(std::minmax(face.behind, face.front), out.sheets.size()).first->second;
    std::vector<BodyPatch> of_bodies;
    SurfaceRegion group;
    for (const LabelledComplex::Source& s : complex.sources(f)) {
      const MesherInput::Body& body = input.bodies[s.body];
      of_bodies.emplace_back(s.body, patches[s.body].patches[s.triangle]);
      if (body.surface.groups.empty()) continue;
      if (const SurfaceRegion& own = body.groups[body.surface.groups[s.triangle]]) group = own;
    }
    std::sort(of_bodies.begin(), of_bodies.end());
    const auto [number, added] =
        numbers.try_emplace({sheet, std::move(of_bodies)}, static_cast<std::uint16_t>(numbers.size()));
    if (numbers.size() > max_patches)
      throw InputError(
          input.bodies[0].file, 0,
          "the surfaces have more than " + std::to_string(max_patches) +
              " patches between sharp edges; use a larger --feature-angle, or --feature-angle off");
    if (added) {
      out.sheet_of_patch.push_back(sheet);
      out.groups.push_back(group);
    }
    out.patches.push_back(number->second);
  }
  return out;
}

}  // namespace tetwright

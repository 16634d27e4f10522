// SPDX-License-Identifier: Apache-2.0
#include "mesher/features/complex_patches.h"

#include <algorithm>

#include "mesher/complex/contact_zone.h"
#include "mesher/complex/sheet_borders.h"
#include "mesher/features/sliver_patches.h"
#include "mesher/input/contact_groups.h"
#include "mesher/tuning/cell_tuning.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

constexpr std::size_t max_patches = 0xfffe;  // one more is for faces that lie on no surface

void require_numbers(std::size_t count, const MesherInput& input) {
  if (count > max_patches)
    throw InputError(
        input.bodies[0].file, 0,
        "the surfaces have more than " + std::to_string(max_patches) +
            " patches between sharp edges; use a larger --feature-angle, or --feature-angle off");
}

/// Adds the inner sheets and their continuations.
void add_sheets(const MesherInput& input, const SheetPatches& of_sheets, ComplexPatches& out) {
  const LabelledComplex& complex = *input.complex;
  std::map<std::array<std::uint32_t, 4>, std::uint16_t> numbers;
  const auto sheet_of = [&](const LabelledComplex::SheetFace& face) {
    return out.inner_sheets
        .try_emplace({face.component, face.region}, out.sheets.size() + out.inner_sheets.size())
        .first->second;
  };
  const auto number = [&](const std::array<std::uint32_t, 4>& key, const LabelledComplex::SheetFace& face,
                          const SurfaceRegion& group) {
    const auto [known, added] =
        numbers.try_emplace(key, static_cast<std::uint16_t>(out.sheet_of_patch.size()));
    if (added) {
      out.sheet_of_patch.push_back(sheet_of(face));
      out.groups.push_back(group);
      out.rough.push_back(0);
      require_numbers(out.groups.size(), input);
    }
    return known->second;
  };
  for (Index f = 0; f < complex.sheets.size(); ++f) {
    const LabelledComplex::SheetFace& face = complex.sheets[f];
    out.triangles.push_back(face.ids);
    out.patches.push_back(number({face.component, face.region, face.sheet, of_sheets.found.patches[f]}, face,
                                 input.sheets[face.sheet].group));
  }
  out.first_continued = static_cast<std::uint16_t>(out.groups.size());
  numbers.clear();
  SheetBorders borders = continue_sheets(complex, of_sheets.continued);
  out.points = std::move(borders.points);
  for (std::size_t t = 0; t < borders.triangles.size(); ++t) {
    const LabelledComplex::SheetFace& face = complex.sheets[borders.faces[t]];
    out.triangles.push_back(borders.triangles[t]);
    out.patches.push_back(number({face.component, face.region, 0, 0}, face, {}));
  }
}

}  // namespace

ComplexPatches complex_patches(const MesherInput& input, const std::vector<SurfacePatches>& patches,
                               const SheetPatches& of_sheets, double cell) {
  const LabelledComplex& complex = *input.complex;
  ComplexPatches out;
  const FaceGroups groups(input);
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
    for (const LabelledComplex::Source& s : complex.sources(f))
      of_bodies.emplace_back(s.body, patches[s.body].patches[s.triangle]);
    std::sort(of_bodies.begin(), of_bodies.end());
    const bool rough = std::any_of(of_bodies.begin(), of_bodies.end(), [&](const BodyPatch& p) {
      return !patches[p.first].rough.empty() && patches[p.first].rough[p.second];
    });
    const auto [number, added] =
        numbers.try_emplace({sheet, std::move(of_bodies)}, static_cast<std::uint16_t>(numbers.size()));
    require_numbers(numbers.size(), input);
    if (added) {
      out.sheet_of_patch.push_back(sheet);
      out.groups.push_back(groups.of(f));
      out.rough.push_back(rough);
    }
    out.patches.push_back(number->second);
  }
  out.points = complex.points;
  for (const TouchingEdge& edge : touching_edges(complex)) out.touching.push_back(edge.ends);
  merge_slivers(out.points, out.triangles, out.sheet_of_patch, CellTuning::Patches::sliver * cell * cell,
                out.patches);
  out.first_continued = static_cast<std::uint16_t>(out.groups.size());
  if (!complex.sheets.empty()) add_sheets(input, of_sheets, out);
  return out;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tools/app/commands/edge_sizes_input.h"

#include <cmath>
#include <memory>
#include <utility>
#include <variant>

#include "common/error.h"
#include "common/message_text.h"
#include "common/sizes/mesh_sizes.h"
#include "tools/app/commands/size_field_file.h"

namespace tetwright {

namespace {

std::unique_ptr<const SizeSource> sizes_of(SizesObject object) {
  const std::string field = "size";
  if (auto* tets = std::get_if<TetMesh>(&object.elements))
    return tet_mesh_sizes(std::move(*tets), std::move(object.lengths), field);
  return surface_sizes(std::move(std::get<TriangleMesh>(object.elements)), std::move(object.lengths), field);
}

/// Of the object of that name, or the file.
std::unique_ptr<const SizeSource> take_size_field(CommandRun& run) {
  const std::string& name = run.line.size_field;
  if (run.objects)
    if (const auto object = run.objects->sizes.find(name); object != run.objects->sizes.end())
      return sizes_of(std::move(object->second));
  return read_size_field(name);
}

}  // namespace

void read_sizes(CommandRun& run, const Box3& box) {
  const CommandLine& line = run.line;
  const double diagonal = (box.high - box.low).norm();
  RequestedSizes& sizes = run.report.sizes;
  sizes.limits.min_edge = line.min_edge.in_input_units(diagonal);
  if (line.max_edge.value > 0) sizes.limits.max_edge = line.max_edge.in_input_units(diagonal);
  sizes.limits.grading = line.grading;
  if (!(sizes.limits.max_edge > sizes.limits.min_edge))
    throw UsageError("--max-edge " + short_number(sizes.limits.max_edge) + " is not above --min-edge " +
                     short_number(sizes.limits.min_edge) + "; give a larger one, or leave one of them out");
  if (line.size_field.empty()) return;
  sizes.source = take_size_field(run);
  if (!(diagonal > 0)) return;  // nothing to mesh, which is said elsewhere
  sizes.target_length =
      std::make_shared<const SizeField>(*sizes.source, box.low, box.high, wanted_within(sizes.limits));
}

void require_sizes_at(const CommandRun& run, const std::vector<Vec3>& places) {
  const RequestedSizes& sizes = run.report.sizes;
  if (!sizes.target_length) return;
  if (const auto place = sizes.target_length->first_beyond(*sizes.source, places))
    throw InputError(run.line.size_field, 0,
                     "the sizes end within the body: there are none at " + place_text(*place) +
                         "; give a field that reaches all of " + run.report.inputs.front());
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/edge_sizes_input.h"

#include <memory>

#include "common/images/grid_box.h"
#include "common/message_text.h"
#include "tetwright/error.h"
#include "tools/prepare/size_field_file.h"
#include "tools/prepare/surface_spaces.h"

namespace tetwright {

namespace {

/// \return what is known of the spaces of both, see SurfaceSpaces::both_spaces(); may be empty
std::string bring_into_space_of_first(const SizeFieldInput& field, PrepareRun& run) {
  PrepareReport& report = run.report;
  const std::string& given = run.options.bodies.surface_space;
  // A value in memory is in the coordinates of the caller's other ones unless it says so.
  if (field.source && field.source->space().empty() && given.empty()) return {};
  SurfaceSpaces spaces(given, "size field");
  spaces.begin_with(report.space_of_result(), report.inputs.front(),
                    run.task == Task::simplify || run.task == Task::improve);
  const std::string before = report.sizes.source->space();
  spaces.add(report.sizes.source, field.name);
  const std::vector<Diagnostic> findings = spaces.findings();
  report.diagnostics.insert(report.diagnostics.end(), findings.begin(), findings.end());
  return spaces.both_spaces(before, field.name);
}

/// Refuses sizes within a volume that the input does not meet. Those of a surface count anywhere.
void require_sizes_meet(const SizeSource& sizes, const std::string& file, const Box3& box,
                        const std::string& input, const std::string& spaces) {
  if (!sizes.fills_space()) return;
  Box3 of_sizes;
  sizes.for_each_value([&](const Vec3& place, double) { of_sizes.add(place); });
  if (!of_sizes.intersects(box))
    throw boxes_apart(file, "it has no sizes in " + input, "it", of_sizes, input, box, spaces);
}

}  // namespace

void read_sizes(PrepareRun& run, const Box3& box) {
  const SizeOptions& asked = run.options.sizes;
  const double diagonal = (box.high - box.low).norm();
  RequestedSizes& sizes = run.report.sizes;
  sizes.limits.min_edge = in_input_units(asked.min_edge, diagonal);
  if (asked.max_edge) sizes.limits.max_edge = asked.max_edge->in_input_units(diagonal);
  sizes.limits.grading = asked.grading.value_or(default_grading);
  if (!(sizes.limits.max_edge > sizes.limits.min_edge))
    throw UsageError("--max-edge " + short_number(sizes.limits.max_edge) + " is not above --min-edge " +
                     short_number(sizes.limits.min_edge) + "; give a larger one, or leave one of them out");
  if (!asked.field) return;
  sizes.source = asked.field->source ? asked.field->source : read_size_field(asked.field->name);
  const std::string spaces = bring_into_space_of_first(*asked.field, run);
  if (!(diagonal > 0)) return;  // nothing to mesh; reported elsewhere
  require_sizes_meet(*sizes.source, asked.field->name, box, run.report.inputs.front(), spaces);
  sizes.target_length =
      std::make_shared<const SizeField>(*sizes.source, box.low, box.high, wanted_within(sizes.limits));
}

void require_sizes_at(const PrepareRun& run, const std::vector<Vec3>& places) {
  const RequestedSizes& sizes = run.report.sizes;
  if (!sizes.target_length) return;
  if (const auto place = sizes.target_length->first_beyond(*sizes.source, places))
    throw InputError(run.options.sizes.field->name, 0,
                     "the sizes end within the body: there are none at " + place_text(*place) +
                         "; give a field that covers all of " + run.report.inputs.front());
}

}  // namespace tetwright

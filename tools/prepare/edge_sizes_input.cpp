// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/edge_sizes_input.h"

#include <memory>

#include "common/message_text.h"
#include "tetwright/error.h"
#include "tools/prepare/size_field_file.h"

namespace tetwright {

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
  if (!(diagonal > 0)) return;  // nothing to mesh; reported elsewhere
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

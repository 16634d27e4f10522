// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tetwright/image_values.h"
#include "tetwright/prepare_steps.h"
#include "tetwright/progress.h"
#include "tetwright/tet_mesh.h"
#include "tetwright/value_options.h"

namespace tetwright {

/// Checks ValueOptions for a task.
///
/// \throws UsageError if options cannot be combined, name an unknown image, or give two fields one name; if
///   bounds of bins do not ascend or the law of a modulus makes no sense
void check_value_options(Task task, const ValueOptions& options);

/// Checks the law of a modulus before there are bins. The mean of a bin is between the values that count, and
/// the modulus rises or falls with the value.
///
/// \param name of the values
/// \param progress announces that some of these values have no modulus
/// \throws UsageError if none of them has a modulus
void check_modulus(const ModulusLaw& law, const std::string& name, const CountedVoxels& counted,
                   Progress& progress);

/// Checks that fields which belong to values, such as NAME_bin, do not replace others of the mesh. Those of a
/// mesh that has the values NAME, too, come from an earlier call.
///
/// \throws UsageError if one would
void check_field_names(const TetMesh& mesh, const PrepareRun& run);

/// \throws InputError saying that no voxel of an image counts
[[noreturn]] void throw_no_voxel_counts(const std::string& image);

}  // namespace tetwright

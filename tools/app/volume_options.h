// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace tetwright {

struct VolumeFileOptions;

/// Adds --spacing, --dimensions and --voxel-type, which say of files of volumes what these do not.
void add_volume_file(CLI::App& app, VolumeFileOptions& options);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace tetwright::fuzz {

/// A target of libFuzzer. `run` returns if the bytes are correctly read or rejected. Otherwise it throws an
/// exception other than InputError, aborts, or is stopped by a sanitizer.
struct Target {
  std::string_view name;  ///< name of the format, as in tests/fuzz/seeds/
  void (*run)(std::string_view bytes);
};

std::span<const Target> surface_targets();
std::span<const Target> tet_mesh_targets();
std::span<const Target> volume_targets();
/// Built only with mesher/.
void run_vdb(std::string_view bytes);
/// Built only with mesher/.
void run_complex(std::string_view bytes);
void run_operations(std::string_view bytes);

}  // namespace tetwright::fuzz

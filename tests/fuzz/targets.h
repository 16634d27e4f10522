// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace tetwright::fuzz {

/// What libFuzzer is let loose on. `run` returns if all is well with what the bytes say, also if they are
/// refused; it throws what is not an InputError, and aborts or is stopped by a sanitizer otherwise.
struct Target {
  std::string_view name;  ///< of the format, as tests/fuzz/seeds/ has it
  void (*run)(std::string_view bytes);
};

std::span<const Target> surface_targets();
std::span<const Target> tet_mesh_targets();
std::span<const Target> volume_targets();
/// Only built with mesher/.
void run_vdb(std::string_view bytes);
void run_operations(std::string_view bytes);

}  // namespace tetwright::fuzz

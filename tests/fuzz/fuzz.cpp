// SPDX-License-Identifier: Apache-2.0

// A single program for all targets, so that common code is compiled once: build/asan/bin/fuzz TARGET,
// followed by the arguments of libFuzzer; `fuzz --list` prints the targets.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include "tests/fuzz/targets.h"

namespace tetwright::fuzz {
namespace {

std::vector<Target> all_targets() {
  std::vector<Target> all;
  for (const std::span<const Target> some : {surface_targets(), tet_mesh_targets(), volume_targets()})
    all.insert(all.end(), some.begin(), some.end());
#ifdef TETWRIGHT_FUZZ_MESHER
  all.push_back({"vdb", run_vdb});
  all.push_back({"complex", run_complex});
#endif
  all.push_back({"operations", run_operations});
  return all;
}

Target chosen;

}  // namespace
}  // namespace tetwright::fuzz

#ifdef TETWRIGHT_FUZZ_MESHER
// If the values of an inner node cannot be decompressed, OpenVDB throws and loses that child of the root
// (RootNode::readTopology()). Only a damaged file does that, and the program ends with it. The function's
// name is not known where no symbolizer is installed, so this names the library.
extern "C" const char* __lsan_default_suppressions();   // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() {  // NOLINT(bugprone-reserved-identifier)
  return "leak:libopenvdb\n";
}
#endif

// Removes the target's name from the arguments before libFuzzer reads them.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  using namespace tetwright::fuzz;
  const std::string_view wanted = *argc > 1 ? (*argv)[1] : "";
  // -merge, -fork and -minimize_crash restart the program without the target's name.
  constexpr const char* variable = "TETWRIGHT_FUZZ_TARGET";
  if (const char* before = std::getenv(variable); before && wanted.starts_with('-'))
    for (const Target& target : all_targets())
      if (before == target.name) return chosen = target, 0;
  for (const Target& target : all_targets()) {
    if (wanted == "--list") std::printf("%.*s\n", static_cast<int>(target.name.size()), target.name.data());
    if (wanted == target.name) chosen = target;
  }
  if (wanted == "--list") std::exit(0);
  if (!chosen.run) {
    std::fprintf(stderr, "fuzz: there is no target '%s'; fuzz --list prints them\n",
                 *argc > 1 ? (*argv)[1] : "");
    std::exit(2);
  }
  ::setenv(variable, (*argv)[1], 1);
  std::memmove(*argv + 1, *argv + 2,
               static_cast<std::size_t>(*argc - 1) * sizeof **argv);  // including the null at the end
  --*argc;
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  tetwright::fuzz::chosen.run({reinterpret_cast<const char*>(data), size});
  return 0;
}

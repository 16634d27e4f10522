// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "benchmarks/table1/paper_table.h"
#include "simplify/simplify.h"

namespace tetwright {

/// Meshes a scan with the uniform mesher to within 3 % of a count, and writes the dense mesh to `path`
/// (.vtu). The voxel size comes from the estimate's, then by secant steps between the logarithms of voxel
/// size and count. Answers {voxel_size, tets, steps, seconds_mesh}; throws what the mesher throws.
nlohmann::json make_dense(const std::string& scan, std::size_t tets, const std::string& path);

struct RowOptions {
  SimplifyOptions simplify;
  unsigned threads = 0;      ///< 0: all
  std::string write_to;      ///< the result's file; empty: not kept
  bool measure_more = true;  ///< else only time, memory and counts: enough for a repetition
};

/// Simplifies the dense mesh of a file and measures the result. Times are of simplify() alone; the peak is
/// that of the process while it runs, with the mesh it is given and what it returns.
nlohmann::json run_row(const std::string& dense, const std::string& scan, const RowOptions& options);

}  // namespace tetwright

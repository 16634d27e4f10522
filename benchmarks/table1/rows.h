// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "benchmarks/table1/paper_table.h"
#include "tetwright/simplify.h"

namespace tetwright {

/// Meshes a scan with the uniform mesher to within 3 % of a number of tets, and writes the dense mesh to
/// `path` (.vtu). The voxel size starts at an estimate and is refined by secant steps between the logarithms
/// of voxel size and number.
///
/// \return {voxel_size, tets, steps, seconds_mesh}.
/// \throws Error in the cases of the mesher.
nlohmann::json make_dense(const std::string& scan, std::size_t tets, const std::string& path);

struct RowOptions {
  SimplifyOptions simplify;
  unsigned threads = 0;      ///< 0: all hardware threads
  std::string write_to;      ///< file for the result; empty: not kept
  bool measure_more = true;  ///< false: only time, memory and counts, for a repetition
};

/// Simplifies the dense mesh in a file and measures the result. Times are of simplify() only; the peak memory
/// is that of the process during simplify(), including the input mesh and the result.
nlohmann::json run_row(const std::string& dense, const std::string& scan, const RowOptions& options);

}  // namespace tetwright

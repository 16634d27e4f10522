// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "benchmarks/table1/paper_table.h"
#include "simplify/simplify.h"

namespace tetwright {

/// Meshes a scan with the uniform mesher to within 3 % of a count, and writes the dense mesh to `path`
/// (.vtu). The voxel size starts at an estimate and is refined by secant steps between the logarithms of
/// voxel size and count.
///
/// \return {voxel_size, tets, steps, seconds_mesh}.
/// \throws as the mesher.
nlohmann::json make_dense(const std::string& scan, std::size_t tets, const std::string& path);

struct RowOptions {
  SimplifyOptions simplify;
  unsigned threads = 0;      ///< 0: all
  std::string write_to;      ///< file of the result; empty: not kept
  bool measure_more = true;  ///< otherwise only time, memory and counts, as for a repetition
};

/// Simplifies the dense mesh in a file and measures the result. Times are of simplify() alone; the peak is
/// the process's during that, with the input mesh and the result.
nlohmann::json run_row(const std::string& dense, const std::string& scan, const RowOptions& options);

}  // namespace tetwright

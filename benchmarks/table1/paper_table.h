// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

namespace tetwright {

/// A row of Table 1 of Cutler, Dorsey & McMillan 2004 (Pentium 4 Xeon at 2.4 GHz), and the scan used for its
/// model.
struct PaperRow {
  const char* model;
  const char* scan;          ///< path in the data folder
  std::size_t initial_tets;  ///< tets of the dense mesh
  std::size_t target_tets;
  int iterations;
  int seconds;
  double below_before, below_after;  ///< percentage of tets below 0.1 sr
  double min_after;                  ///< minimum solid angle, steradians
};

inline constexpr const char* bunny_scan = "scans/bunny_pmp.off";
inline constexpr const char* dragon_scan = "scans/dragon_quartet.obj";
inline constexpr const char* hand_scan = "scans/hand_ntut.ply";
inline constexpr const char* gargoyle_scan = "scans/gargoyle_3dhop.ply";

inline constexpr std::array<PaperRow, 11> paper_table{{
    {"bunny", bunny_scan, 461000, 2000, 18, 7 * 60 + 10, 41.7, 18.5, 0.02},
    {"bunny", bunny_scan, 461000, 10000, 16, 10 * 60 + 44, 41.7, 10.1, 0.02},
    {"bunny", bunny_scan, 461000, 50000, 15, 23 * 60 + 12, 41.7, 5.6, 0.01},
    {"dragon", dragon_scan, 825000, 5000, 18, 14 * 60 + 31, 39.7, 25.9, 0.02},
    {"dragon", dragon_scan, 825000, 100000, 13, 35 * 60 + 32, 39.7, 4.4, 0.01},
    {"hand", hand_scan, 1596000, 10000, 18, 29 * 60 + 1, 40.5, 24.8, 0.02},
    {"hand", hand_scan, 1596000, 100000, 16, 58 * 60 + 32, 40.5, 4.7, 0.02},
    {"gargoyle", gargoyle_scan, 792000, 10000, 17, 15 * 60 + 29, 39.4, 11.4, 0.02},
    {"gargoyle", gargoyle_scan, 792000, 30000, 15, 22 * 60 + 15, 39.4, 6.7, 0.01},
    {"gargoyle", gargoyle_scan, 792000, 50000, 14, 25 * 60 + 19, 39.4, 5.5, 0.01},
    {"gargoyle", gargoyle_scan, 792000, 200000, 12, 29 * 60 + 30, 39.4, 5.4, 0.01},
}};

}  // namespace tetwright

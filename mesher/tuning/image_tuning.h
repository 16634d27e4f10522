// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tetwright {

/// Items that a parallel loop hands out at a time.
struct ImageGrains {
  static constexpr std::size_t voxels = 1 << 16;
  static constexpr std::size_t slices = 4;
  static constexpr std::size_t lines = 64;  ///< of voxels
  static constexpr std::size_t rows = 1;    ///< of bricks, several milliseconds each
};

/// Materials of images; mesher/README.md, Tuned numbers, explains the terms.
struct ImageTuning {
  /// Distances at voxels that island merging gave another region than their values would: as deep as the
  /// voxels of labels are at least, voxels.
  static constexpr double merged_depth = 0.125;
  /// Slope of distances at an interface, as a share of the mean one nearby, from which Newton's method is
  /// trusted: contrast varies that much along blurred edges.
  static constexpr double min_slope = 0.02;
  /// Slopes are averaged around an interface in blocks of a brick; smaller ones than this share of the mean
  /// of the volume are raised to it, so that noise around a threshold does not become steep.
  static constexpr double min_local_slope = 0.05;
  /// Largest ratio of slopes of adjacent blocks: they change by at most an eighth from one voxel to the next,
  /// which moves an interface by at most 0.03 voxels.
  static constexpr double max_slope_ratio = 2;
  /// How much farther the outside counts where two channels are equal, and the difference of theirs from
  /// which on it does not, voxels: far above rounding and far below the size of cells; beyond the voxels
  /// beside an interface.
  static constexpr double tie_bias = 0.05, tie_reach = 1.5;
  /// Largest margin of points in a cube of eight voxels that an interface crosses, voxels: half of its
  /// diagonal, and a little.
  static constexpr double max_mixed_margin = 0.9;
  /// Bins of the histogram for Otsu's threshold: finer than 12-bit detectors need in a part of their range,
  /// coarser than floating-point noise.
  static constexpr std::size_t histogram_bins = 4096;
  /// Reach of the Gaussian kernel, standard deviations, and its largest one, voxels.
  static constexpr double kernel_reach = 3;
  static constexpr double max_smoothing = 20;
  /// Probabilities may exceed 0 and 1 by this: interpolated and rounded ones do.
  static constexpr double probability_tolerance = 0.01;
  /// Samples along each side of a voxel from which volumes are counted; even, so that none is at a centre.
  static constexpr int volume_samples_along = 4;
  /// Rounds in which the volumes of smoothed probability maps are restored one after the other, and the share
  /// of the voxels of a material by which they may differ afterwards.
  static constexpr int volume_rounds = 20;
  static constexpr double volume_tolerance = 1e-3;
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace tetwright {

/// The tuned constants of coarsening parts of a mesh (coarsen()) and of joining them, by the rules of
/// SimplifyTuning.
struct CoarseningTuning {
  /// Number of tets for each final one. With 8 (where the tuned schedule begins to use samples) the parts
  /// of a foam keep 10-35 % more tets; shapes are as good and distances from the original up to 1 % smaller.
  static constexpr double final_tets = 4;
  /// Tets that a frozen boundary face needs: its own, and one between it and its neighbours.
  static constexpr std::size_t tets_for_frozen_face = 2;
  /// Quality^3 below which tets of the joined parts are collapsed first, and the fraction of tets removed
  /// by an iteration below which that ends. Where 59 million tets of a foam were cut into 8 parts of eight
  /// tets for each final one, the result of 200,000 has 4 % more tets near the cuts than without parts;
  /// without this 16-21 %, and 4-6 % with 0.02.
  static constexpr float cut_quality = 0.005f;
  static constexpr double evened_out = 0.01;
};

}  // namespace tetwright

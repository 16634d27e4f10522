// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/brick_estimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mesher/labels/label_faces.h"
#include "mesher/mesh_estimate.h"
#include "mesher/tuning/cell_tuning.h"
#include "tetwright/prepare.h"
#include "tetwright/resources.h"
#include "tools/tuning/brick_rounds_tuning.h"

namespace tetwright {

namespace {

using Rounds = BrickRoundsTuning;

/// Bytes, fitted to foams of 128^3 and 256^3 voxels in 8 and 64 bricks.
struct PerItem {
  static constexpr double program = 60e6;
  /// A tet of a brick while it is coarsened, and a coarse one while it is simplified.
  static constexpr double tet = 110, coarse_tet = 140;
  /// A lattice tet while points are moved. With all threads at one brick each of them keeps freed memory, so
  /// that it is not used for the tets afterwards.
  static constexpr double lattice_tet = 33, lattice_tet_of_all = 50;
  /// A face of the dense surface: with its brick, with its samples and trees in the simplifier, and in a
  /// file.
  static constexpr double kept_face = 60, face = 95, filed_face = 20;
  /// A coarse tet with its brick, and in a file.
  static constexpr double kept_tet = 30, filed_tet = 10;
  /// A point on a cut while bricks are regrouped.
  static constexpr double cut_point = 100;
  /// A face of a cut on one side while boundaries of bricks are compared.
  static constexpr double boundary_face = 100;
};

/// Faces of the dense surface, and of a cut through it: for each dense tet, and for each squared cell and
/// density^(2/3).
constexpr double faces_per_tet = 0.1, cut_faces_per_area = 0.6;
/// Bytes of the borders of bricks for each squared cell of a cut: they are compared once all bricks are made.
constexpr double border_bytes_per_area = 100;
/// Larger bricks gain little: cells around them are 20 % of these.
constexpr int max_chosen_cells = 256;
/// Tets after coarsening for each final one, and for each face of a cut and side (coarsen()).
constexpr double coarse_per_final = 5, coarse_per_cut_face = 2.5;
/// Tets after a later round for each one wanted, as bounds keep some: measured on a foam of 512^3 voxels.
constexpr double coarse_margin = 1.65;
/// Faces of the dense surface that are left of it after thinning.
constexpr double thinned_share = 0.5;

}  // namespace

std::array<double, 3> voxels_of_bricks(const LabelInput& labels, double cell, int cells) {
  std::array<double, 3> voxels;
  for (int a = 0; a < 3; ++a) voxels[a] = std::max(1.0, cells * cell / labels.directions.col(a).norm());
  return voxels;
}

BrickEstimator::BrickEstimator(const LabelInput& labels, const MesherOptions& options, double dense,
                               std::size_t target, bool scratch, bool team)
    : labels_(labels),
      cell_(cell_size(labels, options)),
      dense_(dense),
      target_(static_cast<double>(target)),
      scratch_(scratch),
      team_(team) {
  const MemoryModel memory = label_memory(labels, cell_);
  field_ = PerItem::program + memory.beside;
  before_ = PerItem::program + memory.before;
}

double BrickEstimator::largest_share(int cells, double offset) const {
  const auto [known, is_new] = shares_.try_emplace({cells, offset}, 0);
  if (is_new)
    known->second = faces_of_boxes(labels_, voxels_of_bricks(labels_, cell_, cells), offset).largest_share();
  return known->second;
}

BrickEstimator::Needs BrickEstimator::needs(int side, int rounds) const {
  std::array<double, 3> cells;
  double all_cells = 1;
  for (int a = 0; a < 3; ++a) {
    cells[a] = labels_.size[a] * labels_.directions.col(a).norm() / cell_;
    all_cells *= cells[a];
  }
  // Squared cells of the cuts between bricks.
  const auto cuts = [&](double offset) {
    double sum = 0;
    for (int a = 0; a < 3; ++a)
      sum += (std::ceil(cells[a] / side + offset) - 1) * cells[(a + 1) % 3] * cells[(a + 2) % 3];
    return sum;
  };
  const auto faces_of_cuts = [&](double area, double tets) {
    return 2 * area * cut_faces_per_area * std::pow(tets / all_cells, 2.0 / 3);
  };
  const double first_cuts = cuts(0), cut_faces = faces_of_cuts(first_cuts, dense_);
  double coarse = std::min(dense_, coarse_per_final * target_ + coarse_per_cut_face * cut_faces);
  const double faces = faces_per_tet * dense_ * (rounds > 1 ? thinned_share : 1);
  const double largest = dense_ * largest_share(side, 0);
  const double grown = std::min(dense_, largest * std::pow(1 + 2.0 * CellTuning::Bricks::halo / side, 3));
  double kept = PerItem::kept_tet * coarse + PerItem::kept_face * faces;
  Needs needs{};
  needs.base = field_ + border_bytes_per_area * first_cuts + (scratch_ ? 0 : kept);
  needs.alone = PerItem::lattice_tet_of_all * grown + PerItem::tet * largest;
  needs.each = std::max(PerItem::lattice_tet * grown, PerItem::tet * largest);
  needs.scratch = PerItem::filed_tet * coarse + PerItem::filed_face * faces;
  double largest_later = 0;
  double cut_points = cut_faces / 4;  // each has two faces, and each face is counted on both sides
  for (int round = 2; round <= rounds; ++round) {
    // A brick's piece of a part and the part itself are there together, from a file also its bytes.
    const double share = largest_share(side, Rounds::offset[static_cast<std::size_t>(round - 1)]);
    const double part_of_file = scratch_ ? 2 * PerItem::kept_face * faces : 0;
    largest_later = std::max(largest_later, share * coarse);
    needs.later_each =
        std::max(needs.later_each, share * ((PerItem::tet + 2 * PerItem::kept_tet) * coarse + part_of_file));
    // The pieces of a brick for another member, beside their bytes before and after compression.
    const double message = team_ ? share * (3 * PerItem::kept_tet * coarse + part_of_file) : 0;
    const double area = cuts(Rounds::offset[static_cast<std::size_t>(round - 1)]);
    const double next_faces = faces_of_cuts(area, coarse);
    const double next = std::min(
        coarse, coarse_margin * Rounds::tets_for_final[static_cast<std::size_t>(round - 1)] * target_ +
                    coarse_per_cut_face * next_faces);
    needs.later_base =
        std::max(needs.later_base, field_ + border_bytes_per_area * first_cuts +
                                       PerItem::cut_point * cut_points + PerItem::boundary_face * next_faces +
                                       message + (scratch_ ? 0 : kept + PerItem::kept_tet * next));
    needs.scratch += PerItem::filed_tet * next;
    // The meshes of the round before are dropped.
    kept += PerItem::kept_tet * (next - coarse);
    coarse = next;
    cut_points = next_faces / 4;
  }
  needs.rest = std::max(before_, field_ + PerItem::coarse_tet * coarse + PerItem::face * faces);
  if (largest > max_tets_to_simplify || coarse > max_tets_to_simplify || largest_later > max_tets_to_simplify)
    needs.rest = std::numeric_limits<double>::infinity();
  return needs;
}

double BrickEstimator::memory(const BrickPlan& plan, const Needs& of) const {
  const bool alone = plan.workers == 1 && thread_count() > 1;
  return std::max({of.rest, of.base + (alone ? of.alone : plan.workers * of.each),
                   of.later_base + plan.workers * of.later_each});
}

BrickEstimate BrickEstimator::operator()(const BrickPlan& plan) const {
  const Needs of = needs(plan.cells, plan.rounds);
  return {memory(plan, of), of.scratch};
}

BrickPlan BrickEstimator::with_workers(int cells, int rounds, double available) const {
  const Needs of = needs(cells, rounds);
  double possible = std::floor((available - of.base) / std::max(1.0, of.each));
  if (rounds > 1)
    possible = std::min(possible, std::floor((available - of.later_base) / std::max(1.0, of.later_each)));
  return {cells, static_cast<unsigned>(std::clamp(possible, 1.0, static_cast<double>(thread_count()))),
          rounds};
}

BrickPlan BrickEstimator::choose(const BrickDivision& given, double available) const {
  BrickPlan smallest;
  double min_memory = std::numeric_limits<double>::infinity();
  const int first_round = given.rounds > 0 ? given.rounds : 1;
  const int last_round = given.rounds > 0 ? given.rounds : max_brick_rounds;
  const int first_side = given.cells > 0 ? given.cells : max_chosen_cells;
  const int last_side = given.cells > 0 ? given.cells : min_brick_cells;
  for (int rounds = first_round; rounds <= last_round; ++rounds) {
    BrickPlan best;
    for (int side = first_side; side >= last_side; side /= 2) {
      const BrickPlan plan = with_workers(side, rounds, available);
      const double bytes = (*this)(plan).memory;
      if (bytes <= available && (best.cells == 0 || plan.workers > best.workers)) best = plan;
      if (best.cells > 0 && best.workers == thread_count()) return best;
      if (smallest.cells == 0 || bytes < min_memory) {
        smallest = plan;
        min_memory = bytes;
      }
    }
    if (best.cells > 0) return best;
  }
  return smallest;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "simplify/mesh/editable_mesh.h"

namespace tetwright {

/// The points at which an operation was refused for reasons within their stars. Until a star changes, the
/// same rules refuse the operation again, so that the tets around a point need not each try it.
///
/// Concurrency: add() and holds() may run while operations are decided. Results do not depend on timing: a
/// point counts from the next batch on, and all that add it in one batch store the same value.
class RefusedStars {
 public:
  /// No point is refused.
  ///
  /// \param mesh must outlive this object, and must not be compacted meanwhile.
  explicit RefusedStars(const EditableMesh& mesh) : mesh_(mesh), refused_(mesh.point_slots(), 0) {}

  /// Whether the point was added in an earlier batch and its star has not changed since then.
  bool holds(Index point) const {
    if (point >= refused_.size()) return false;
    // Relaxed: see above.
    const std::uint32_t batch =
        std::atomic_ref<std::uint32_t>(refused_[point]).load(std::memory_order_relaxed);
    return batch != 0 && batch <= mesh_.batch() && mesh_.changed_in(point) < batch;
  }
  /// Points inserted after construction are not recorded.
  /// \pre !holds(point).
  void add(Index point) {
    if (point < refused_.size())
      std::atomic_ref<std::uint32_t>(refused_[point]).store(mesh_.batch() + 1, std::memory_order_relaxed);
  }

 private:
  const EditableMesh& mesh_;
  /// By point: the batch in which it was decided; 0: never. Mutable for atomic loads.
  mutable std::vector<std::uint32_t> refused_;
};

/// Whether a refusal follows from the star and the rules. Volumes of whole materials change too, but hardly
/// within a round.
inline bool lies_within_star(Outcome refusal) {
  return refusal == Outcome::quality || refusal == Outcome::volume || refusal == Outcome::inverts ||
         refusal == Outcome::surface_error || refusal == Outcome::material_rule ||
         refusal == Outcome::no_candidate || refusal == Outcome::too_large;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "simplify/schedule/engine.h"
#include "simplify/schedule/improvement_area.h"
#include "simplify/schedule/selection.h"

namespace tetwright {

/// The whole mesh of an engine.
class WholeMesh final : public ImprovementArea {
 public:
  /// \param engine must outlive this object.
  explicit WholeMesh(Engine& engine) : mesh_(engine.mesh()), rules_(engine.rules) {}
  std::size_t tet_count() const override { return mesh_.live_tets(); }
  double usual_edge() const override { return rules_.objective.quality.ideal_edge; }
  std::vector<TetSnapshot> bad_tets(float limit) override { return tetwright::bad_tets(mesh_, limit); }
  std::vector<Index> bad_points(float limit) override { return tetwright::bad_points(mesh_, limit); }
  std::vector<TetSnapshot> tets_around(const std::vector<TetSnapshot>& tets) override {
    return tetwright::tets_around(mesh_, tets);
  }
  std::vector<Index> points_around(const std::vector<TetSnapshot>& tets) override {
    return tetwright::points_around(mesh_, tets);
  }
  std::vector<Index> points_to_thin(const std::vector<TetSnapshot>&) override { return bad_points(1); }

 private:
  const EditableMesh& mesh_;
  const BlockRules& rules_;
};

}  // namespace tetwright

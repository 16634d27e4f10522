// SPDX-License-Identifier: Apache-2.0
#include "mesher/lattice/redundant_cells.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/lattice_tuning.h"

namespace tetwright {

namespace {

/// A position in quarter cells.
using Quarters = std::array<int, 3>;

constexpr int cell_side = 4;  // quarters

Quarters sum(const Quarters& a, const Quarters& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }

Quarters difference(const Quarters& a, const Quarters& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// An edge of the lattice's tets by its ends, relative to the lower corner of a cell.
struct LatticeEdge {
  Quarters a, b;
  Quarters middle() const { return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2}; }
};

constexpr Quarters cell_centre{cell_side / 2, cell_side / 2, cell_side / 2};

Quarters cell_corner(int k) {
  return {(k & 1) * cell_side, (k >> 1 & 1) * cell_side, (k >> 2 & 1) * cell_side};
}

/// From a corner or centre of a cell to its neighbours in a lattice of cells of one size.
std::vector<Quarters> lattice_steps() {
  std::vector<Quarters> steps;
  steps.reserve(8 + 6);
  for (int k = 0; k < 8; ++k) steps.push_back(difference(cell_corner(k), cell_centre));
  for (int axis = 0; axis < 3; ++axis)
    for (const int length : {-cell_side, cell_side}) {
      steps.emplace_back();
      steps.back()[axis] = length;
    }
  return steps;
}

struct Face {
  Quarters centre;
  std::vector<Quarters> steps;  ///< from there to the cell's centre and the face's corners
  bool contains(const Quarters& p) const {
    for (int axis = 0; axis < 3; ++axis)
      if (centre[axis] != cell_centre[axis] && p[axis] != centre[axis]) return false;
    return true;
  }
};

std::vector<Face> cell_faces() {
  std::vector<Face> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {0, cell_side}) {
      Face face{cell_centre, {}};
      face.centre[axis] = side;
      face.steps.push_back(difference(cell_centre, face.centre));
      for (int k = 0; k < 8; ++k)
        if (face.contains(cell_corner(k))) face.steps.push_back(difference(cell_corner(k), face.centre));
      faces.push_back(std::move(face));
    }
  return faces;
}

/// All edges that the tets of a cell can have. Those of a cell whose neighbours have its size go from its
/// centre to its corners and to its neighbours' centres, and along its own edges; on the box and beside
/// smaller cells they also go to the centres of its faces and to the midpoints of its edges.
std::vector<LatticeEdge> lattice_edges() {
  std::vector<LatticeEdge> edges;
  std::vector<LatticeEdge> own;
  for (int k = 0; k < 8; ++k) {
    edges.push_back({cell_centre, cell_corner(k)});
    for (int axis = 0; axis < 3; ++axis)
      if (!(k >> axis & 1)) own.push_back({cell_corner(k), cell_corner(k | 1 << axis)});
  }
  for (const LatticeEdge& e : own) {
    edges.push_back(e);
    edges.push_back({cell_centre, e.middle()});
  }
  for (const Face& face : cell_faces()) {
    for (const Quarters& step : face.steps) edges.push_back({face.centre, sum(face.centre, step)});
    edges.push_back({cell_centre, sum(face.centre, difference(face.centre, cell_centre))});
    for (const LatticeEdge& e : own)
      if (face.contains(e.middle())) edges.push_back({face.centre, e.middle()});
  }
  return edges;
}

/// The ends and midpoints of edges, each once.
std::vector<Quarters> points_of(const std::vector<LatticeEdge>& edges) {
  std::vector<Quarters> points;
  for (const LatticeEdge& e : edges) points.insert(points.end(), {e.a, e.b, e.middle()});
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  return points;
}

/// The lattice of cells of one size, with the regions at its points and the midpoints of its edges.
class CellTest {
 public:
  /// \param depth cells have an edge of 2^-depth
  /// \param edge_points points_of(edges)
  CellTest(const MaterialField& field, int depth, const std::vector<LatticeEdge>& edges,
           const std::vector<Quarters>& edge_points)
      : sampler_(field.sampler()),
        edges_(edges),
        edge_points_(edge_points),
        unit_(std::ldexp(1.0 / cell_side, -depth)) {
    for (int a = 0; a < 3; ++a) end_[a] = (field.voxels().box[a] << depth) * cell_side;
  }

  /// Evaluates the field around cells, which should be near each other.
  void read(std::span<const MortonKey> cells) {
    points_.clear();
    for (const MortonKey cell : cells) {
      const Quarters low = low_of(cell);
      for (const Quarters& at : edge_points_)
        if (const Quarters p = sum(low, at); in_box(p)) points_.push_back(morton_encode(p));
    }
    std::sort(points_.begin(), points_.end());
    points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
    regions_.resize(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) regions_[i] = evaluate(morton_decode(points_[i]));
  }

  /// Whether splitting a cell, which has been read, would change a region's topology.
  bool shows_more(MortonKey cell) {
    const Quarters low = low_of(cell);
    for (const LatticeEdge& e : edges_) {
      const Quarters a = sum(low, e.a), b = sum(low, e.b);
      if (!in_box(b)) continue;
      const RegionIndex middle = at(sum(low, e.middle()));
      if (middle != at(a) && middle != at(b)) return true;
    }
    if (is_alone(sum(low, cell_centre), steps_)) return true;
    for (int k = 0; k < 8; ++k)
      if (is_alone(sum(low, cell_corner(k)), steps_)) return true;
    for (const Face& face : faces_)
      if (const Quarters p = sum(low, face.centre); on_box(p) && is_alone(p, face.steps)) return true;
    return false;
  }

 private:
  static Quarters low_of(MortonKey cell) {
    Quarters low = morton_decode(cell);
    for (int& c : low) c *= cell_side;
    return low;
  }
  bool in_box(const Quarters& p) const {
    for (int a = 0; a < 3; ++a)
      if (p[a] < 0 || p[a] > end_[a]) return false;
    return true;
  }
  bool on_box(const Quarters& p) const {
    for (int a = 0; a < 3; ++a)
      if (p[a] == 0 || p[a] == end_[a]) return true;
    return false;
  }
  RegionIndex evaluate(const Quarters& p) { return sampler_->nearest(unit_ * Vec3(p[0], p[1], p[2])).region; }
  RegionIndex at(const Quarters& p) {
    const MortonKey key = morton_encode(p);
    const auto found = std::lower_bound(points_.begin(), points_.end(), key);
    return found != points_.end() && *found == key
               ? regions_[static_cast<std::size_t>(found - points_.begin())]
               : evaluate(p);
  }
  /// Whether none of the points at `steps` from a lattice point is in its region.
  bool is_alone(const Quarters& p, std::span<const Quarters> steps) {
    const RegionIndex own = at(p);
    return std::none_of(steps.begin(), steps.end(), [&](const Quarters& step) {
      const Quarters q = sum(p, step);
      return in_box(q) && at(q) == own;
    });
  }

  std::unique_ptr<FieldSampler> sampler_;
  const std::vector<LatticeEdge>& edges_;
  const std::vector<Quarters>& edge_points_;
  std::vector<Face> faces_ = cell_faces();
  std::vector<Quarters> steps_ = lattice_steps();
  double unit_;  ///< a quarter cell, lattice units
  Quarters end_;
  std::vector<MortonKey> points_;  ///< ascending
  std::vector<RegionIndex> regions_;
};

}  // namespace

void drop_redundant_cells(RefinementRegions& finer, const MaterialField& field, int exempt, double largest,
                          const Progress* progress) {
  const std::vector<LatticeEdge> edges = lattice_edges();
  const std::vector<Quarters> edge_points = points_of(edges);
  const auto levels = static_cast<std::size_t>(finer.refinement) + 1;
  for (std::size_t level = static_cast<std::size_t>(exempt) + 1; level < levels; ++level) {
    if (std::ldexp(1.0, static_cast<int>(level) - finer.refinement) > largest) break;
    if (progress) progress->throw_if_stopped();
    const std::vector<MortonKey>& cells = finer.cells[level];
    std::vector<MortonKey> kept = parallel_collect<MortonKey>(
        0, cells.size(), LatticeGrains::tested_cells,
        [&](std::size_t begin, std::size_t end, std::vector<MortonKey>& out) {
          const std::span<const MortonKey> range(cells.data() + begin, end - begin);
          CellTest test(field, finer.refinement - static_cast<int>(level), edges, edge_points);
          test.read(range);
          for (const MortonKey cell : range)
            if (test.shows_more(cell)) out.push_back(cell);
        });
    for (const MortonKey cell : finer.cells[level - 1]) kept.push_back(cell >> 3);
    parallel_sort_unique(kept);
    finer.cells[level] = std::move(kept);
  }
  int empty = 0;
  while (empty < finer.refinement && finer.cells[static_cast<std::size_t>(empty) + 1].empty()) ++empty;
  finer.cells.erase(finer.cells.begin(), finer.cells.begin() + empty);
  finer.refinement -= empty;
}

}  // namespace tetwright

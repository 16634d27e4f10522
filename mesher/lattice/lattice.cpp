// SPDX-License-Identifier: Apache-2.0
#include "mesher/lattice/lattice.h"

#include <algorithm>

#include "common/geometry/predicates.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/tuning/lattice_tuning.h"

namespace tetwright {

namespace {

/// A position on the lattice in half finest cells.
using HalfCells = std::array<int, 3>;

/// A leaf as a box, in half finest cells.
struct LeafBox {
  HalfCells low;
  int side;
  int level;
  HalfCells corner(int k) const {
    return {low[0] + (k & 1 ? side : 0), low[1] + (k >> 1 & 1 ? side : 0), low[2] + (k >> 2 & 1 ? side : 0)};
  }
  HalfCells centre() const { return {low[0] + side / 2, low[1] + side / 2, low[2] + side / 2}; }
};

LeafBox leaf_box(const Octree& octree, std::size_t i) {
  const Octree::Leaf leaf = octree.leaf(i);
  HalfCells low = morton_decode(leaf.key);
  for (int& c : low) c *= 2;
  return {low, 2 << leaf.level, leaf.level};
}

/// Corner numbers (bits x, y, z) of the lower or upper face normal to `axis`, in cyclic order.
std::array<int, 4> face_ring(int axis, bool upper) {
  const int u = 1 << (axis + 1) % 3, v = 1 << (axis + 2) % 3, base = upper ? 1 << axis : 0;
  return {base, base | u, base | u | v, base | v};
}

/// The centre of the lower or upper face normal to `axis`.
HalfCells face_centre(const LeafBox& box, int axis, bool upper) {
  HalfCells p = box.centre();
  p[axis] = box.low[axis] + (upper ? box.side : 0);
  return p;
}

/// True if the lower or upper face normal to `axis` is on the window, or on the border of a volume.
bool has_centre(const Octree& octree, const LeafBox& box, int axis, bool upper) {
  const int at = box.low[axis] + (upper ? box.side : 0);
  if (at == 2 * (upper ? octree.window.high : octree.window.low)[axis]) return true;
  return octree.border != CellBox{} &&
         (at == 2 * octree.border.low[axis] || at == 2 * octree.border.high[axis]);
}

HalfCells middle(const HalfCells& a, const HalfCells& b) {
  return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
}

/// Emits the tets that belong to each leaf.
class TetEmitter {
 public:
  TetEmitter(const Octree& octree, const LatticePoints& points, const std::vector<std::uint8_t>* unwanted,
             int unwanted_level, std::vector<Tet>& out)
      : octree_(octree), points_(points), unwanted_(unwanted), unwanted_level_(unwanted_level), out_(out) {}

  void leaf(std::size_t i) {
    box_ = leaf_box(octree_, i);
    leaf_ = i;
    centre_ = points_.leaf_centres[i];
    for (int k = 0; k < 8; ++k) corners_[k] = find(box_.corner(k));
    for (int axis = 0; axis < 3; ++axis)
      for (bool upper : {false, true}) face(axis, upper);
  }

 private:
  Index find(const HalfCells& p) const { return points_.find(morton_encode(p), centre_); }

  void face(int axis, bool upper) {
    if (has_centre(octree_, box_, axis, upper)) {
      around(axis, upper, find(face_centre(box_, axis, upper)));
      return;
    }
    HalfCells beyond = box_.low;
    beyond[axis] += upper ? box_.side : -box_.side;
    const std::size_t j = octree_.find(morton_encode(beyond[0] / 2, beyond[1] / 2, beyond[2] / 2), leaf_);
    const LeafBox other = leaf_box(octree_, j);
    if (other.level == box_.level) {
      if (upper) around(axis, upper, points_.leaf_centres[j]);
    } else if (other.level > box_.level) {
      against_bigger(axis, upper, other, points_.leaf_centres[j]);
    }  // smaller neighbours emit the tets between
  }

  /// Emits the tets between this leaf's centre, `apex` and each edge of the face.
  void around(int axis, bool upper, Index apex) {
    const std::array<int, 4> ring = face_ring(axis, upper);
    for (std::size_t e = 0; e < 4; ++e) {
      const int a = ring[e], b = ring[(e + 1) % 4];
      // Edges of finest cells have no hanging midpoints.
      const Index m = box_.level > 0 ? find(middle(box_.corner(a), box_.corner(b))) : no_index;
      if (m == no_index) {
        emit(centre_, apex, corners_[a], corners_[b]);
      } else {
        emit(centre_, apex, corners_[a], m);
        emit(centre_, apex, m, corners_[b]);
      }
    }
  }

  void against_bigger(int axis, bool upper, const LeafBox& big, Index big_centre) {
    const HalfCells heart = face_centre(big, axis, !upper);
    const std::array<int, 4> ring = face_ring(axis, upper);
    for (std::size_t e = 0; e < 4; ++e) {
      if (box_.corner(ring[e]) != heart) continue;
      const Index f = corners_[ring[e]], far = corners_[ring[(e + 2) % 4]];
      for (std::size_t side : {e + 1, e + 3}) {
        const Index m = corners_[ring[side % 4]];
        emit(centre_, f, m, far);
        emit(big_centre, f, m, far);
      }
    }
  }

  void emit(Index a, Index b, Index c, Index d) {
    if (unwanted_ && box_.level <= unwanted_level_) {
      const std::vector<std::uint8_t>& u = *unwanted_;
      if (u[a] && u[b] && u[c] && u[d]) return;
    }
    // Coordinates are small multiples of 1/2: the value has no rounding error.
    const auto& p = points_.positions;
    if (orient3d_value(p[a], p[b], p[c], p[d]) < 0) std::swap(c, d);
    out_.push_back({a, b, c, d});
  }

  const Octree& octree_;
  const LatticePoints& points_;
  const std::vector<std::uint8_t>* unwanted_;
  int unwanted_level_;
  std::vector<Tet>& out_;
  LeafBox box_{};
  std::size_t leaf_ = 0;
  Index centre_ = no_index;
  std::array<Index, 8> corners_{};
};

}  // namespace

Index LatticePoints::find(MortonKey key, Index hint) const {
  const std::size_t i = lower_bound_near(keys, key, hint);
  return i < keys.size() && keys[i] == key ? static_cast<Index>(i) : no_index;
}

LatticePoints lattice_points(const Octree& octree) {
  LatticePoints points;
  // The lowest bit, below the key, marks centres. Up to eight leaves emit the same corner.
  std::vector<std::uint64_t> marked = parallel_collect<std::uint64_t>(
      0, octree.size(), LatticeGrains::leaves,
      [&](std::size_t begin, std::size_t end, std::vector<std::uint64_t>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const LeafBox box = leaf_box(octree, i);
          out.push_back(morton_encode(box.centre()) << 1 | 1);
          for (int k = 0; k < 8; ++k) out.push_back(morton_encode(box.corner(k)) << 1);
          for (int axis = 0; axis < 3; ++axis)
            for (bool upper : {false, true})
              if (has_centre(octree, box, axis, upper))
                out.push_back(morton_encode(face_centre(box, axis, upper)) << 1);
        }
        // Most duplicates are within a chunk; a quarter of the keys remains.
        std::sort(out.begin(), out.end());
        out.erase(std::unique(out.begin(), out.end()), out.end());
      });
  parallel_sort_unique(marked);
  points.box = octree.cells;
  points.border = octree.border;
  points.keys = std::move(marked);
  points.positions.resize(points.size());
  points.is_centre.resize(points.size());
  parallel_for(0, points.size(), 8 * LatticeGrains::leaves, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      points.is_centre[i] = points.keys[i] & 1;
      points.keys[i] >>= 1;
      const HalfCells p = morton_decode(points.keys[i]);
      points.positions[i] = 0.5 * Vec3(p[0], p[1], p[2]);
    }
  });
  // Leaves and their centres have the same order.
  points.leaf_centres.reserve(octree.size());
  for (Index i = 0; i < points.size(); ++i)
    if (points.is_centre[i]) points.leaf_centres.push_back(i);
  return points;
}

std::vector<NearestRegion> lattice_regions(const LatticePoints& points, const MaterialField& field) {
  std::vector<NearestRegion> regions(points.size());
  const int voxel = 2 << field.refinement();  // half lattice units
  parallel_for(0, points.size(), 4 * LatticeGrains::leaves, [&](std::size_t begin, std::size_t end) {
    const std::unique_ptr<FieldSampler> owned = field.sampler();
    FieldSampler& sampler = *owned;
    for (std::size_t i = begin; i < end; ++i) {
      const HalfCells p = morton_decode(points.keys[i]);
      const bool at_voxel = !((p[0] | p[1] | p[2]) & (voxel - 1));
      regions[i] = at_voxel ? sampler.nearest_at_voxel(p[0] / voxel, p[1] / voxel, p[2] / voxel)
                            : sampler.nearest(points.positions[i]);
    }
  });
  return regions;
}

std::vector<std::uint8_t> far_outside(const std::vector<NearestRegion>& regions, const MaterialField& field) {
  std::vector<std::uint8_t> far(regions.size());
  for (std::size_t i = 0; i < far.size(); ++i)
    far[i] = regions[i].region == outside_region && regions[i].margin >= static_cast<float>(field.band());
  return far;
}

TetList lattice_tets(const Octree& octree, const LatticePoints& points,
                     const std::vector<std::uint8_t>* unwanted, int unwanted_level, const CellBox* brick,
                     std::vector<std::uint8_t>* owned) {
  std::vector<std::vector<Tet>> parts((octree.size() + LatticeGrains::leaves - 1) / LatticeGrains::leaves);
  std::vector<std::vector<std::uint8_t>> flags(brick ? parts.size() : 0);
  parallel_for(0, parts.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t part = first; part < last; ++part) {
      TetEmitter emitter(octree, points, unwanted, unwanted_level, parts[part]);
      for (std::size_t i = part * LatticeGrains::leaves;
           i < std::min(octree.size(), (part + 1) * LatticeGrains::leaves); ++i) {
        emitter.leaf(i);
        if (brick) flags[part].resize(parts[part].size(), brick->contains(morton_decode(octree.leaf(i).key)));
      }
    }
  });
  if (brick) {
    owned->clear();
    for (const std::vector<std::uint8_t>& f : flags) owned->insert(owned->end(), f.begin(), f.end());
  }
  return TetList(std::move(parts));
}

}  // namespace tetwright

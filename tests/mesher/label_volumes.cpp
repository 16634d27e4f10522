// SPDX-License-Identifier: Apache-2.0
#include "tests/mesher/label_volumes.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <memory>
#include <sstream>

#include "tetwright/mesh_quality.h"
#include "tetwright/resources.h"

namespace tetwright {

LabelInput make_labels(const std::array<int, 3>& size, const VoxelLabels& label,
                       const Eigen::Matrix3d& directions, const Vec3& origin) {
  LabelVolume volume;
  volume.size = size;
  volume.origin = origin;
  volume.directions = directions;
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x) volume.labels.push_back(label(x, y, z));
  LabelChoice choice;
  choice.min_voxels = 0;
  return make_label_input(std::make_unique<MemoryLabelSource>(std::move(volume)), "made.nrrd", choice,
                          nullptr);
}

RegionGrid grid_of(const std::array<int, 3>& size, const std::vector<RegionIndex>& regions) {
  RegionGrid grid(size);
  grid.write_slices(0, regions);
  return grid;
}

std::vector<RegionIndex> voxels_of(const RegionGrid& grid) {
  std::vector<RegionIndex> regions(grid.voxels());
  grid.read_slices(0, grid.size()[2], regions);
  return regions;
}

RegionIndex region_of(const LabelInput& labels, MaterialTag tag) {
  for (std::size_t i = 0; i < labels.materials.size(); ++i)
    if (labels.materials[i].tag == tag) return static_cast<RegionIndex>(i + 1);
  return outside_region;
}

namespace {

/// Regions by index; outside beyond the volume.
class Voxels {
 public:
  explicit Voxels(const LabelInput& labels) : labels_(labels) {}

  bool has(const std::array<int, 3>& v) const {
    for (int a = 0; a < 3; ++a)
      if (v[a] < 0 || v[a] >= labels_.size[a]) return false;
    return true;
  }
  std::size_t number(const std::array<int, 3>& v) const {
    return (static_cast<std::size_t>(v[2]) * labels_.size[1] + v[1]) * labels_.size[0] + v[0];
  }
  RegionIndex at(const std::array<int, 3>& v) const {
    return has(v) ? labels_.regions.at(v[0], v[1], v[2]) : outside_region;
  }
  bool alone(const std::array<int, 3>& v) const {
    for (int a = 0; a < 3; ++a)
      for (int step : {-1, 1}) {
        std::array<int, 3> next = v;
        next[a] += step;
        if (at(next) == at(v)) return false;
      }
    return true;
  }

  /// Distance of a point (index space) from the closest face of the two regions, and of any two.
  std::pair<double, double> to_faces(const Vec3& p, RegionIndex first, RegionIndex second) const {
    constexpr double far = LabelComparison::out_of_sight;
    double of_pair = far, of_any = far;
    const std::array<int, 3> centre{static_cast<int>(std::lround(p.x())),
                                    static_cast<int>(std::lround(p.y())),
                                    static_cast<int>(std::lround(p.z()))};
    // Faces whose nearest corner lies in a ring are no closer than ring - 1.
    for (int ring = 0; ring <= static_cast<int>(far); ++ring) {
      if (of_pair <= ring - 1.0) break;
      for (int dz = -ring - 1; dz <= ring; ++dz)
        for (int dy = -ring - 1; dy <= ring; ++dy)
          for (int dx = -ring - 1; dx <= ring; ++dx) {
            const auto within = [&](int d) { return d >= -ring && d <= ring - 1; };
            if (ring > 0 && within(dx) && within(dy) && within(dz)) continue;
            const std::array<int, 3> v{centre[0] + dx, centre[1] + dy, centre[2] + dz};
            const RegionIndex here = at(v);
            for (int a = 0; a < 3; ++a) {
              std::array<int, 3> next = v;
              ++next[a];
              const RegionIndex there = at(next);
              if (here == there) continue;
              double square = 0;
              for (int b = 0; b < 3; ++b) {
                const double d = b == a ? p[b] - v[b] - 0.5 : std::max(0.0, std::abs(p[b] - v[b]) - 0.5);
                square += d * d;
              }
              const double d = std::sqrt(square);
              of_any = std::min(of_any, d);
              if ((here == first && there == second) || (here == second && there == first))
                of_pair = std::min(of_pair, d);
            }
          }
    }
    return {of_pair, of_any};
  }

 private:
  const LabelInput& labels_;
};

enum Hit : std::uint8_t { own = 1, other = 2 };

/// The tets that contain the centre of each voxel: of its own region, of others (strictly inside).
std::vector<std::uint8_t> hits(const LabelInput& labels, const std::vector<Vec3>& at, const TetMesh& mesh) {
  constexpr double slack = 1e-9;
  const Voxels voxels(labels);
  std::map<MaterialTag, RegionIndex> regions;
  for (MaterialTag tag : mesh.materials)
    if (!regions.count(tag)) regions[tag] = region_of(labels, tag);
  std::vector<std::uint8_t> found(labels.voxel_count(), 0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    std::array<Vec3, 4> p;
    for (int k = 0; k < 4; ++k) p[k] = at[mesh.tets[t][k]];
    const RegionIndex region = regions.at(mesh.materials[t]);
    std::array<int, 3> low, high;
    for (int a = 0; a < 3; ++a) {
      const auto [min, max] = std::minmax({p[0][a], p[1][a], p[2][a], p[3][a]});
      low[a] = std::max(0, static_cast<int>(std::ceil(min - slack)));
      high[a] = std::min(labels.size[a] - 1, static_cast<int>(std::floor(max + slack)));
    }
    const double whole = tet_volume(p[0], p[1], p[2], p[3]);
    std::array<int, 3> v;
    for (v[2] = low[2]; v[2] <= high[2]; ++v[2])
      for (v[1] = low[1]; v[1] <= high[1]; ++v[1])
        for (v[0] = low[0]; v[0] <= high[0]; ++v[0]) {
          const Vec3 c(v[0], v[1], v[2]);
          double min_share = HUGE_VAL;
          for (int k = 0; k < 4; ++k) {
            std::array<Vec3, 4> q = p;
            q[k] = c;
            min_share = std::min(min_share, tet_volume(q[0], q[1], q[2], q[3]) / whole);
          }
          const bool mine = voxels.at(v) == region;
          if (mine && min_share >= -slack) found[voxels.number(v)] |= own;
          if (!mine && min_share > slack) found[voxels.number(v)] |= other;
        }
  }
  return found;
}

}  // namespace

LabelComparison compare_with_voxels(const LabelInput& labels, const TetMesh& mesh) {
  LabelComparison f;
  const Voxels voxels(labels);
  const Eigen::Matrix3d to_index = labels.directions.inverse();
  std::vector<Vec3> at;
  for (const Vec3& p : mesh.points) at.push_back(to_index * (p - labels.origin));

  const std::vector<std::uint8_t> found = hits(labels, at, mesh);
  std::array<int, 3> v;
  for (v[2] = 0; v[2] < labels.size[2]; ++v[2])
    for (v[1] = 0; v[1] < labels.size[1]; ++v[1])
      for (v[0] = 0; v[0] < labels.size[0]; ++v[0]) {
        const std::uint8_t hit = found[voxels.number(v)];
        const bool kept = voxels.at(v) == outside_region ? !(hit & other) : (hit & own) != 0;
        const bool alone = voxels.alone(v);
        if (alone) {
          f.lone_lost += !kept;
          continue;
        }
        ++f.centres;
        if (!kept && f.lost++ == 0) f.first = v;
      }

  f.triangles = mesh.interfaces.size();
  struct Moved {
    double of_pair = 0, of_any = 0;
    Vec3 at_pair = Vec3::Zero(), at_any = Vec3::Zero();
  };
  std::vector<Moved> moved(f.triangles);
  parallel_for(0, f.triangles, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const InterfaceTriangle& t = mesh.interfaces[i];
      const RegionIndex first = region_of(labels, t.material),
                        second = t.other ? region_of(labels, *t.other) : outside_region;
      if (first == second) continue;  // the box around a meshed outside
      for (int k = 0; k < 7; ++k) {
        Vec3 p = Vec3::Zero();
        for (int j = 0; j < 3; ++j) {
          const double share = k < 3 ? (j == k ? 1.0 : 0.0) : k < 6 ? (j == k - 3 ? 0.0 : 0.5) : 1.0 / 3;
          p += share * at[t.ids[j]];
        }
        const auto [of_pair, of_any] = voxels.to_faces(p, first, second);
        if (of_pair > moved[i].of_pair) moved[i].of_pair = of_pair, moved[i].at_pair = p;
        if (of_any > moved[i].of_any) moved[i].of_any = of_any, moved[i].at_any = p;
      }
    }
  });
  for (const Moved& m : moved) {
    f.moved_far += m.of_pair > 0.75;
    f.moved_far_of_any += m.of_any > 0.75;
    if (m.of_pair > f.moved_of_pair) f.moved_of_pair = m.of_pair, f.farthest = m.at_pair;
    if (m.of_any > f.moved) f.moved = m.of_any, f.farthest_of_any = m.at_any;
  }

  std::map<MaterialTag, double> volumes;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const auto& [a, b, c, d] = mesh.tets[t];
    volumes[mesh.materials[t]] += tet_volume(at[a], at[b], at[c], at[d]);
  }
  for (const LabelMaterial& m : labels.materials) {
    const double sign = labels.directions.determinant() < 0 ? -1 : 1;
    const double share = sign * volumes[m.tag] / static_cast<double>(m.voxels);
    f.volumes[m.tag] = share;
    if (m.voxels > LabelComparison::many_voxels && std::abs(share - 1) > f.worst_volume)
      f.worst_volume = std::abs(share - 1), f.worst = m.tag;
  }
  return f;
}

std::string comparison_line(const LabelComparison& f) {
  std::ostringstream out;
  out << "lost " << f.lost << " of " << f.centres << " centres";
  if (f.lost) out << ", the first at " << f.first[0] << " " << f.first[1] << " " << f.first[2];
  out << "; of lone voxels " << f.lone_lost << "; moved " << f.moved << " (" << f.farthest_of_any.transpose()
      << "), of the pair " << f.moved_of_pair << " (" << f.farthest.transpose()
      << "); triangles over 0.75: " << f.moved_far_of_any << " of any, " << f.moved_far << " of the pair, of "
      << f.triangles << "; volume differs by " << 100 * f.worst_volume << " %";
  if (f.worst_volume > 0) out << " (label " << f.worst << ")";
  return out.str();
}

}  // namespace tetwright

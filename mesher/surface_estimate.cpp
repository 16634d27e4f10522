// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <unordered_set>

#include "common/geometry/distance_tree.h"
#include "common/geometry/morton.h"
#include "common/geometry/surface_tree.h"
#include "mesher/domain/grid_frame.h"
#include "mesher/domain/refinement_regions.h"
#include "mesher/mesh_estimate.h"
#include "mesher/tuning/distance_tuning.h"
#include "mesher/tuning/domain_tuning.h"
#include "mesher/tuning/estimate_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Sampling = EstimateTuning::Sampling;

/// A low-discrepancy sequence in the unit interval (Roberts 2018: multiples of the inverses of the plastic
/// number and its square).
double sequence(int i, double step) { return std::fmod(0.5 + i * step, 1.0); }
constexpr double first_step = 0.7548776662466927, second_step = 0.5698402909980532;

struct Sample {
  Vec3 place, normal;  ///< finest cells; outward normal
};

/// Signed distances at the grid points around a sample. Each is computed at most once: the cells around a
/// sample share most of their corners, as do levels and both kinds of flatness.
class NearSample {
 public:
  explicit NearSample(const DistanceTree& tree) : tree_(tree) {}

  void move_to(const Sample& sample) {
    sample_ = sample;
    for (int a = 0; a < 3; ++a) origin_[a] = static_cast<int>(std::floor(sample.place[a])) - radius;
    distances_.assign(width * width * width, -1);
    heights_.assign(width * width * width, 0);
  }

  /// True if a cell of this level around the sample is possible, and so are its neighbours along the surface.
  /// Compares trilinear interpolation between the corners with the distances, as the octree does.
  /// \param plane require that the surface is a plane there
  bool is_flat(int level, double adaptivity, bool plane) {
    const Vec3 first = sample_.normal.unitOrthogonal(), second = sample_.normal.cross(first);
    const double side = 1 << level;
    for (const Vec3& step : {Vec3(Vec3::Zero()), first, Vec3(-first), second, Vec3(-second)})
      if (!interpolates(sample_.place + side * step, level, adaptivity, plane)) return false;
    return true;
  }

 private:
  /// Grid points on either side of a sample: of the cells of level 2 that are one cell away.
  static constexpr int radius = 9, width = 2 * radius + 2;

  std::size_t index(const Vec3& p) const {
    std::size_t at = 0;
    for (int a = 0; a < 3; ++a)
      at = at * width + static_cast<std::size_t>(static_cast<int>(p[a]) - origin_[a]);
    return at;
  }

  /// A number with the sign of the height of a point above the surface along the sample's normal; the surface
  /// near the sample is one sheet.
  double height_over(const Vec3& place) const {
    const double height = (place - sample_.place).dot(sample_.normal);
    // The distance of the surface from the sample's plane here; its sign is that of the closer side.
    const Vec3 in_plane = place - height * sample_.normal;
    const double away = tree_.distance(in_plane, Sampling::reach);
    if (std::abs(height) > away) return height;
    const bool above = tree_.distance(in_plane + Sampling::plane_offset * sample_.normal, Sampling::reach) <
                       tree_.distance(in_plane - Sampling::plane_offset * sample_.normal, Sampling::reach);
    return height - (above ? away : -away);
  }

  /// The distance at a grid point, signed by the surface or by the sample's plane.
  double value(const Vec3& p, bool plane) {
    const std::size_t at = index(p);
    if (distances_[at] < 0) distances_[at] = tree_.distance(p, 2 * Sampling::reach);
    if (plane) return std::copysign(distances_[at], (p - sample_.place).dot(sample_.normal));
    if (heights_[at] == 0) heights_[at] = std::signbit(height_over(p)) ? -1 : 1;
    return heights_[at] < 0 ? -distances_[at] : distances_[at];
  }

  bool interpolates(const Vec3& place, int level, double adaptivity, bool plane) {
    const double side = 1 << level;
    const Vec3 low = side * (place / side).array().floor().matrix();
    const auto value_at = [&](int x, int y, int z) { return value(low + 0.5 * side * Vec3(x, y, z), plane); };
    std::array<double, 8> corners;
    for (int k = 0; k < 8; ++k)
      corners[static_cast<std::size_t>(k)] = value_at(2 * (k & 1), 2 * (k >> 1 & 1), 2 * (k >> 2));
    for (int i = 0; i < 27; ++i) {
      double coarse = 0;
      for (int k = 0; k < 8; ++k) {
        double share = 1;
        for (int a = 0, at = i; a < 3; ++a, at /= 3)
          share *= (k >> a & 1) ? 0.5 * (at % 3) : 1 - 0.5 * (at % 3);
        coarse += share * corners[static_cast<std::size_t>(k)];
      }
      const double exact = value_at(i % 3, i / 3 % 3, i / 9);
      if (std::min(std::abs(exact), std::abs(coarse)) >= 1 && (exact < 0) == (coarse < 0)) continue;
      if (std::abs(coarse - exact) > adaptivity) return false;
    }
    return true;
  }

  const DistanceTree& tree_;
  Sample sample_{};
  std::array<int, 3> origin_{};
  std::vector<double> distances_;     ///< by grid point; negative: not computed
  std::vector<std::int8_t> heights_;  ///< side of the surface; 0: not computed
};

/// A surface in grid coordinates and its estimated properties.
class SampledSurface {
 public:
  SampledSurface(const RepairedSurface& surface, const GridFrame& frame) : surface_(surface), frame_(frame) {
    take_samples();
  }

  const std::vector<Sample>& samples() const { return samples_; }
  double area() const { return surface_.area / (frame_.cell_size * frame_.cell_size); }
  double volume() const { return std::max(0.0, surface_.volume) / std::pow(frame_.cell_size, 3); }

  /// Number of dense tets at the surface, as a fraction of their number with finest cells everywhere; smaller
  /// if the surface is flat.
  double coarse_share(double adaptivity) {
    if (!(adaptivity > 0) || samples_.empty()) return 1;
    const DistanceTree tree = nearby_triangles();
    // Samples that are smooth but curved count half: there, one in twenty of OpenVDB's distances is off by
    // more than 0.05 voxels, which prevents about half of such cells from being coarse.
    std::atomic<int> coarse = 0, coarsest = 0;
    parallel_for(0, samples_.size(), 8, [&](std::size_t begin, std::size_t end) {
      NearSample near(tree);
      for (std::size_t i = begin; i < end; ++i) {
        near.move_to(samples_[i]);
        for (const bool plane : {false, true}) {
          if (!near.is_flat(1, adaptivity, plane)) continue;
          ++coarse;
          coarsest += near.is_flat(2, adaptivity, plane);
        }
      }
    });
    const auto n = 2 * static_cast<double>(samples_.size());
    return share_of_coarse_cells(coarse / n, coarsest / n);
  }

  /// All triangles, finest cells.
  TriangleMesh in_grid() const {
    TriangleMesh mesh;
    mesh.points.reserve(surface_.points.size());
    for (const Vec3& p : surface_.points) mesh.points.push_back(frame_.to_grid(p));
    mesh.triangles = surface_.triangles;
    return mesh;
  }

 private:
  std::array<Vec3, 3> corners(const Triangle& t) const {
    return {frame_.to_grid(surface_.points[t[0]]), frame_.to_grid(surface_.points[t[1]]),
            frame_.to_grid(surface_.points[t[2]])};
  }

  /// Samples points spread evenly over the area.
  void take_samples() {
    double sum = 0;
    int next = 0;
    for (const Triangle& t : surface_.triangles) {
      const auto [a, b, c] = corners(t);
      const Vec3 normal = (b - a).cross(c - a);
      sum += 0.5 * normal.norm();
      for (; next < Sampling::surface_samples && (next + 0.5) / Sampling::surface_samples * area() <= sum;
           ++next) {
        double u = sequence(next, first_step), v = sequence(next, second_step);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        samples_.push_back({a + u * (b - a) + v * (c - a), normal.normalized()});
      }
    }
  }

  /// The triangles around the samples.
  DistanceTree nearby_triangles() const {
    const auto cube = [](const Vec3& p) {
      std::array<int, 3> at;
      for (int a = 0; a < 3; ++a)
        at[a] = std::max(0, static_cast<int>(std::floor(p[a] / Sampling::reach)) + 1);
      return at;
    };
    std::unordered_set<MortonKey> cubes;
    for (const Sample& s : samples_) {
      const auto [x, y, z] = cube(s.place);
      for (int k = 0; k < 27; ++k)
        cubes.insert(morton_encode(std::max(0, x + k % 3 - 1), std::max(0, y + k / 3 % 3 - 1),
                                   std::max(0, z + k / 9 - 1)));
    }
    std::vector<Triangle> near;
    for (const Triangle& t : surface_.triangles) {
      const auto [a, b, c] = corners(t);
      const std::array<int, 3> low = cube(a.cwiseMin(b).cwiseMin(c)), high = cube(a.cwiseMax(b).cwiseMax(c));
      bool found = false;
      for (int z = low[2]; z <= high[2] && !found; ++z)
        for (int y = low[1]; y <= high[1] && !found; ++y)
          for (int x = low[0]; x <= high[0] && !found; ++x) found = cubes.contains(morton_encode(x, y, z));
      if (found) near.push_back(t);
    }
    const std::size_t step = near.size() / Sampling::max_triangles + 1;
    std::vector<Vec3> points;
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < near.size(); i += step) {
      const auto first = static_cast<Index>(points.size());
      for (const Vec3& p : corners(near[i])) points.push_back(p);
      triangles.push_back({first, first + 1, first + 2});
    }
    return {points, triangles};
  }

  const RepairedSurface& surface_;
  const GridFrame& frame_;
  std::vector<Sample> samples_;
};

/// Areas of interfaces, squared finest cells.
struct Interfaces {
  double meshed_sides = 0;  ///< each meshed side counts
  double outside = 0;       ///< interfaces with an outside that is not meshed
};

class SurfaceEstimate {
 public:
  SurfaceEstimate(const MesherInput& input, const MesherOptions& options)
      : input_(input), options_(options), h_(cell_size(input, options)) {
    frame_ = make_grid_frame(input.low, input.high, h_, options.uniform, options.keep_outside);
    for (const MesherInput::Body& b : input.bodies) surfaces_.emplace_back(b.surface, frame_);
    if (input.bodies.size() > 1)
      for (const SampledSurface& s : surfaces_) {
        const TriangleMesh surface = s.in_grid();
        trees_.push_back(std::make_unique<SurfaceTree>(surface.points, surface.triangles));
      }
  }

  MesherEstimate run() {
    double before = 0;
    for (const MesherInput::Body& b : input_.bodies)
      before += EstimateTuning::Memory::per_triangle * static_cast<double>(b.surface.closed) +
                EstimateTuning::Memory::per_open_triangle *
                    static_cast<double>(b.surface.triangles.size() - b.surface.closed);
    before = std::max(before, input_.joined_bytes);
    return options_.uniform ? uniform(before) : adaptive(before);
  }

 private:
  bool is_inside(std::size_t body, const Vec3& place) const {
    const Vec3 p = frame_.to_input(place);
    const RepairedSurface& s = input_.bodies[body].surface;
    if ((p.array() < s.low.array()).any() || (p.array() > s.high.array()).any()) return false;
    return trees_[body]->winding_number(place) > 0.5;
  }

  /// The visible part of a body's surface, as later bodies carve it, by the materials on either side.
  Interfaces interfaces_of(std::size_t body) const {
    Interfaces found;
    const std::vector<Sample>& samples = surfaces_[body].samples();
    if (samples.empty()) return found;
    const double area = surfaces_[body].area() / static_cast<double>(samples.size());
    for (const Sample& s : samples) {
      bool hidden = false, faces_later = false, faces_earlier = false;
      for (std::size_t other = 0; other < trees_.size(); ++other) {
        if (other == body) continue;
        const bool out = is_inside(other, s.place + Sampling::side_offset * s.normal);
        faces_later |= out && other > body;
        faces_earlier |= out && other < body;
        hidden |= other > body && is_inside(other, s.place - Sampling::side_offset * s.normal);
      }
      if (hidden) continue;
      found.meshed_sides += area;
      if (faces_later) continue;  // that side is counted with the later body's surface
      if (faces_earlier || options_.keep_outside)
        found.meshed_sides += area;
      else
        found.outside += area;
    }
    return found;
  }

  /// The volume of all bodies together, finest cells.
  double volume() const {
    if (surfaces_.size() == 1) return surfaces_[0].volume();
    return for_inside([](const Vec3&) {});
  }

  /// Calls `use(point)` for the sample points inside any body; returns the volume that they represent
  /// together.
  template <class Use>
  double for_inside(Use&& use) const {
    const Vec3 low = frame_.to_grid(input_.low), size = frame_.to_grid(input_.high) - low;
    constexpr int n = Sampling::volume_samples;
    int inside = 0;
    for (int i = 0; i < n * n * n; ++i) {
      const int x = i % n, y = i / n % n, z = i / (n * n);
      const Vec3 share((x + sequence(i, first_step)) / n, (y + sequence(i, second_step)) / n, (z + 0.5) / n);
      const Vec3 place = low + size.cwiseProduct(share);
      bool in = false;
      for (std::size_t b = 0; b < trees_.size() && !in; ++b) in = is_inside(b, place);
      if (!in) continue;
      ++inside;
      use(place);
    }
    return size.prod() * inside / (n * n * n);
  }

  MesherEstimate uniform(double before) const {
    double area = 0;
    for (const SampledSurface& s : surfaces_) area += s.area();
    const double box = static_cast<double>(frame_.cells[0]) * frame_.cells[1] * frame_.cells[2];
    double dense = EstimateTuning::Uniform::tets_per_cell * volume() +
                   EstimateTuning::Surfaces::cut_tets_per_area * area;
    double lattice = dense + EstimateTuning::Surfaces::outside_tets_per_area_uniform * area;
    if (options_.keep_outside) {
      lattice = EstimateTuning::Uniform::tets_per_cell * box;
      dense = lattice + EstimateTuning::Surfaces::kept_outside_tets_per_area * area;
    }
    return estimate_of({box, lattice, dense}, {EstimateTuning::Memory::per_surface_lattice_tet, 0, before},
                       options_);
  }

  MesherEstimate adaptive(double before) {
    double dense = 0, lattice = 0;
    for (std::size_t b = 0; b < surfaces_.size(); ++b) {
      Interfaces found = interfaces_of(b);
      const double share = surfaces_[b].coarse_share(options_.adaptivity);
      const double body_volume = surfaces_[b].volume();
      if (b == 0) add_layers(found.meshed_sides);
      // The region around a body, the outside or another body, is usually thick.
      const double own = std::min(found.meshed_sides, surfaces_[b].area()), others = found.meshed_sides - own;
      double tets = share * EstimateTuning::Surfaces::tets_per_area *
                    filling(b == 0 && !input_.layers.empty() ? found.meshed_sides : own, body_volume);
      if (b > 0 || input_.layers.empty()) tets += share * EstimateTuning::Surfaces::tets_per_area * others;
      dense += tets;
      lattice += tets + share * EstimateTuning::Surfaces::outside_tets_per_area * found.outside;
    }
    if (options_.keep_outside) lattice = dense;
    return estimate_of({0, lattice, dense}, {EstimateTuning::Memory::per_surface_lattice_tet, 0, before},
                       options_);
  }

  /// The area of interface sides in a volume, reduced as tets fill it.
  static double filling(double sides, double volume) {
    return volume > 0 ? sides / (1 + EstimateTuning::Surfaces::half_full_thickness * sides / volume) : 0;
  }

  /// Adds the sides of the interfaces between layers; thin layers have smaller cells.
  void add_layers(double& sides) {
    if (input_.layers.empty()) return;
    const TriangleMesh surface = surfaces_[0].in_grid();
    const SurfaceTree winding(surface.points, surface.triangles);
    const DistanceTree distances(surface.points, surface.triangles);
    double depth = 0;
    for (const MaterialLayer& layer : input_.layers) {
      depth += layer.thickness / h_;
      double times = 1;
      for (double side = 1; side > std::ldexp(1, -DomainTuning::Refinement::max_levels) &&
                            layer.thickness / h_ < DistanceTuning::Sheets::min_cells * side;
           side /= 2)
        times *= 4;
      sides += 2 * times * area_at_depth(winding, distances, depth);
    }
  }

  /// The area of the surface at a depth inside the first body, squared finest cells: the volume between two
  /// nearby depths, divided by their difference.
  double area_at_depth(const SurfaceTree& winding, const DistanceTree& distances, double depth) {
    const Vec3 size = (input_.high - input_.low) / h_;
    constexpr int n = Sampling::volume_samples;
    const double half = std::max(0.5, 0.5 * size.maxCoeff() / n);
    const Vec3 low = frame_.to_grid(input_.low);
    int found = 0;
    for (int i = 0; i < n * n * n; ++i) {
      const int x = i % n, y = i / n % n, z = i / (n * n);
      const Vec3 share((x + sequence(i, first_step)) / n, (y + sequence(i, second_step)) / n, (z + 0.5) / n);
      const Vec3 place = low + size.cwiseProduct(share);
      const double distance = distances.distance(place, depth + half);
      found += distance > depth - half && distance < depth + half && winding.winding_number(place) > 0.5;
    }
    return size.prod() * found / (n * n * n) / (2 * half);
  }

  const MesherInput& input_;
  const MesherOptions& options_;
  double h_;
  GridFrame frame_;
  std::vector<SampledSurface> surfaces_;
  std::vector<std::unique_ptr<SurfaceTree>> trees_;  ///< one for each body, if there are several
};

}  // namespace

MesherEstimate estimate_mesh(const MesherInput& input, const MesherOptions& options) {
  return SurfaceEstimate(input, options).run();
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/samples/samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <numbers>

#include "common/message_text.h"
#include "common/random.h"
#include "common/samples/foam.h"
#include "common/samples/random_interior.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

struct SineCosine {
  double sine, cosine;
};

/// Sine and cosine of an angle in full turns (0 to 1), computed with only + - * /, so that samples have the
/// same bits on every machine.
SineCosine sine_cosine(double turns) {
  // Power series for an eighth of the angle, which is then doubled three times.
  const double x = turns * (2 * std::numbers::pi) / 8;
  double s = 0, c = 0, term = 1;
  for (int k = 1; k < 24; ++k) {
    (k % 2 ? c : s) += term;
    term *= (k % 2 ? x : -x) / k;
  }
  for (int k = 0; k < 3; ++k) {
    const double twice = 2 * s * c;
    c = c * c - s * s;
    s = twice;
  }
  return {s, c};
}

/// A grid of u_count x v_count points, closed in both directions like a torus.
template <class At>
TriangleMesh closed_grid(Index u_count, Index v_count, const At& at) {
  TriangleMesh mesh;
  for (Index u = 0; u < u_count; ++u)
    for (Index v = 0; v < v_count; ++v)
      mesh.points.push_back(at(static_cast<double>(u) / u_count, static_cast<double>(v) / v_count));
  const auto id = [&](Index u, Index v) { return u % u_count * v_count + v % v_count; };
  for (Index u = 0; u < u_count; ++u)
    for (Index v = 0; v < v_count; ++v) {
      mesh.triangles.push_back({id(u, v), id(u + 1, v), id(u + 1, v + 1)});
      mesh.triangles.push_back({id(u, v), id(u + 1, v + 1), id(u, v + 1)});
    }
  return mesh;
}

/// A sphere: an octahedron, subdivided `levels` times, with its points projected.
TriangleMesh sphere(const Vec3& centre, double radius, int levels) {
  TriangleMesh mesh;
  for (int k = 0; k < 6; ++k) mesh.points.push_back(k < 3 ? Vec3::Unit(k) : Vec3(-Vec3::Unit(k - 3)));
  mesh.triangles = {{0, 1, 2}, {1, 3, 2}, {3, 4, 2}, {4, 0, 2}, {1, 0, 5}, {3, 1, 5}, {4, 3, 5}, {0, 4, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [at, is_new] =
          middles.try_emplace(std::minmax(a, b), static_cast<Index>(mesh.points.size()));
      if (is_new) {
        const Vec3 sum = mesh.points[a] + mesh.points[b];
        mesh.points.push_back(sum / std::sqrt(sum.x() * sum.x() + sum.y() * sum.y() + sum.z() * sum.z()));
      }
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const Index ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(finer);
  }
  for (Vec3& p : mesh.points) p = centre + radius * p;
  return mesh;
}

TriangleMesh torus() {
  return closed_grid(64, 32, [](double u, double v) {
    const SineCosine a = sine_cosine(u), b = sine_cosine(v);
    const double r = 1 + 0.4 * b.cosine;
    return Vec3(r * a.cosine, r * a.sine, 0.4 * b.sine);
  });
}

/// A tube along the trefoil (sin t + 2 sin 2t, cos t - 2 cos 2t, -sin 3t). Its cross-sections are spanned by
/// the curve's Frenet normal and binormal, which turn smoothly since the curve has no inflection.
TriangleMesh knot() {
  return closed_grid(256, 24, [](double u, double v) {
    const auto times = [&](double k) { return sine_cosine(k * u - std::floor(k * u)); };
    const SineCosine one = times(1), two = times(2), three = times(3), around = sine_cosine(v);
    const Vec3 at(one.sine + 2 * two.sine, one.cosine - 2 * two.cosine, -three.sine);
    const Vec3 first(one.cosine + 4 * two.cosine, -one.sine + 4 * two.sine, -3 * three.cosine);
    const Vec3 second(-one.sine - 8 * two.sine, -one.cosine + 8 * two.cosine, 9 * three.sine);
    const auto unit = [](const Vec3& x) {
      return Vec3(x / std::sqrt(x.x() * x.x() + x.y() * x.y() + x.z() * x.z()));
    };
    const Vec3 binormal = unit(first.cross(second));
    const Vec3 normal = unit(binormal.cross(first));
    return Vec3(at + 0.4 * (around.cosine * normal - around.sine * binormal));
  });
}

/// A box, each side divided into rectangles: `counts` along each axis. Its triangles are in the order of the
/// sides low x, high x, low y, high y, low z, high z.
TriangleMesh box(const Vec3& low, const Vec3& high, const std::array<Index, 3>& counts) {
  TriangleMesh mesh;
  std::map<std::array<Index, 3>, Index> ids;
  const auto id = [&](const std::array<Index, 3>& at) {
    const auto [entry, is_new] = ids.try_emplace(at, static_cast<Index>(mesh.points.size()));
    Vec3 p;
    // The far end exactly, so that boxes with a side in common meet.
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Index step = at[static_cast<std::size_t>(k)], count = counts[static_cast<std::size_t>(k)];
      p[k] = step == count ? high[k] : low[k] + (high[k] - low[k]) * step / count;
    }
    if (is_new) mesh.points.push_back(p);
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const Index side : {Index{0}, counts[axis]})
      for (Index i = 0; i < counts[(axis + 1) % 3]; ++i)
        for (Index j = 0; j < counts[(axis + 2) % 3]; ++j) {
          const auto corner = [&](Index u, Index v) {
            std::array<Index, 3> at;
            at[axis] = side;
            at[(axis + 1) % 3] = u;
            at[(axis + 2) % 3] = v;
            return id(at);
          };
          const Index a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
          // Counter-clockwise seen from outside.
          if (side) {
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
          } else {
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({a, d, c});
          }
        }
  return mesh;
}

/// The cube [-1, 1]^3, each face divided into n x n squares.
TriangleMesh cube(Index n) { return box(Vec3::Constant(-1), Vec3::Constant(1), {n, n, n}); }

/// A part of the heater, with its sides as groups. Parts that touch are divided differently.
TriangleMesh heater_part(const Vec3& low, const Vec3& high, const std::array<Index, 3>& counts) {
  TriangleMesh mesh = box(low, high, counts);
  for (const char* name : {"minX", "maxX", "minY", "maxY", "minZ", "maxZ"}) mesh.groups.push_back({0, name});
  for (std::size_t side = 0; side < 6; ++side) {
    const std::size_t axis = side / 2;
    mesh.triangle_groups.insert(mesh.triangle_groups.end(),
                                std::size_t{2} * counts[(axis + 1) % 3] * counts[(axis + 2) % 3],
                                static_cast<std::uint32_t>(side));
  }
  return mesh;
}

TriangleMesh two_spheres() {
  TriangleMesh mesh = sphere(Vec3(-1.25, 0, 0), 1, 4);
  const TriangleMesh other = sphere(Vec3(1.25, 0, 0), 0.75, 4);
  const auto first = static_cast<Index>(mesh.points.size());
  mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
  for (const auto& [a, b, c] : other.triangles) mesh.triangles.push_back({a + first, b + first, c + first});
  return mesh;
}

TriangleMesh open_sphere() {
  TriangleMesh mesh = sphere(Vec3::Zero(), 1, 5);
  const auto in_hole = [&](const Triangle& t) {
    return mesh.points[t[0]].z() + mesh.points[t[1]].z() + mesh.points[t[2]].z() > 3 * 0.875;
  };
  std::erase_if(mesh.triangles, in_hole);
  // Remove the points that only the removed triangles used, so that every point is on the surface.
  std::vector<Index> numbers(mesh.points.size(), no_index);
  std::vector<Vec3> points;
  for (Triangle& t : mesh.triangles)
    for (Index& v : t) {
      if (numbers[v] == no_index) {
        numbers[v] = static_cast<Index>(points.size());
        points.push_back(mesh.points[v]);
      }
      v = numbers[v];
    }
  mesh.points = std::move(points);
  return mesh;
}

/// A box of cubes with edge length `scale`, each divided into the six tets around its diagonal (Kuhn 1960).
TetMesh box_of_tets(const std::array<Index, 3>& cells, double scale,
                    const std::function<MaterialTag(const Vec3&)>& material) {
  TetMesh mesh;
  const auto id = [&](Index x, Index y, Index z) { return (z * (cells[1] + 1) + y) * (cells[0] + 1) + x; };
  for (Index z = 0; z <= cells[2]; ++z)
    for (Index y = 0; y <= cells[1]; ++y)
      for (Index x = 0; x <= cells[0]; ++x) mesh.points.push_back(Vec3(x, y, z) * scale);
  constexpr std::array<std::array<std::size_t, 3>, 6> orders{
      {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}}};
  for (Index z = 0; z < cells[2]; ++z)
    for (Index y = 0; y < cells[1]; ++y)
      for (Index x = 0; x < cells[0]; ++x)
        for (std::size_t k = 0; k < 6; ++k) {
          std::array<Index, 3> at{x, y, z};
          Tet tet;
          tet[0] = id(x, y, z);
          for (std::size_t i = 0; i < 3; ++i) {
            ++at[orders[k][i]];
            tet[i + 1] = id(at[0], at[1], at[2]);
          }
          // Odd permutations of the axes give negative tets.
          if (k >= 3) std::swap(tet[2], tet[3]);
          mesh.tets.push_back(tet);
          mesh.materials.push_back(material(Vec3(x + 0.5, y + 0.5, z + 0.5)));
        }
  return mesh;
}

TetMesh tet_cube() {
  TetMesh mesh = box_of_tets({4, 4, 4}, 0.25, [](const Vec3&) { return 1; });
  mesh.material_names = {{1, "cube"}};
  return mesh;
}

TetMesh two_materials() {
  TetMesh mesh = box_of_tets({8, 4, 4}, 0.25, [](const Vec3& p) { return p.x() < 4 ? 1 : 2; });
  mesh.material_names = {{1, "left"}, {2, "right"}};
  return mesh;
}

TetMesh layers() {
  TetMesh mesh = box_of_tets({8, 8, 8}, 0.125, [](const Vec3& p) {
    return p.z() < 3 ? 1 : p.z() < 5 ? 2 : p.z() < 7 ? 3 : 4;
  });
  mesh.material_names = {{1, "base"}, {2, "lower"}, {3, "upper"}, {4, "skin"}};
  return mesh;
}

/// Offset of a voxel from the middle of an axis of 48 voxels, doubled so that it is an integer.
constexpr int organs_size = 48;
using Doubled = std::array<std::int64_t, 3>;

bool in_ellipsoid(const Doubled& at, const Doubled& centre, const Doubled& radii) {
  std::int64_t sum = 0, product = 1;
  for (const std::int64_t r : radii) product *= r * r;
  for (std::size_t k = 0; k < 3; ++k)
    sum += (at[k] - centre[k]) * (at[k] - centre[k]) * (product / (radii[k] * radii[k]));
  return sum <= product;
}

MaterialTag organ_at(const Doubled& at) {
  const auto in_body = [](const Doubled& p) { return in_ellipsoid(p, {0, 0, 0}, {44, 36, 46}); };
  if (!in_body(at)) return 0;
  for (std::size_t k = 0; k < 3; ++k)
    for (const int step : {-2, 2}) {
      Doubled next = at;
      next[k] += step;
      if (!in_body(next)) return 4;  // the skin
    }
  // The organs' ellipsoids overlap, so that they touch in a surface.
  if (in_ellipsoid(at, {-15, -6, 4}, {19, 18, 22})) return 2;
  if (in_ellipsoid(at, {13, -6, 0}, {14, 15, 18})) return 3;
  const std::int64_t x = at[0], y = at[1] - 22;
  if (x * x + y * y <= 64 && std::abs(at[2]) < 28) return 5;  // the spine
  return 1;
}

LabelVolume organs() {
  LabelVolume volume;
  volume.size = {organs_size, organs_size, organs_size};
  const Vec3 spacing(0.75, 0.75, 1.25);
  volume.directions = spacing.asDiagonal();
  volume.origin = -0.5 * (organs_size - 1) * spacing;
  volume.space = "left-posterior-superior";
  for (int k = 0; k < organs_size; ++k)
    for (int j = 0; j < organs_size; ++j)
      for (int i = 0; i < organs_size; ++i)
        volume.labels.push_back(
            organ_at({2 * i - (organs_size - 1), 2 * j - (organs_size - 1), 2 * k - (organs_size - 1)}));
  // Noise as in real segmentations: runs of up to three voxels with any label.
  Random random(1);
  constexpr int islands = 60;
  for (int n = 0; n < islands; ++n) {
    const std::uint32_t first = random.below(static_cast<std::uint32_t>(volume.labels.size()) - 2);
    const std::uint32_t length = 1 + random.below(3);
    const auto label = static_cast<MaterialTag>(random.below(6));
    for (std::uint32_t i = 0; i < length; ++i) volume.labels[first + i] = label;
  }
  return volume;
}

/// Share of a voxel inside, for the distance of its centre from a blurred surface, voxels.
double share_inside(double distance) { return std::clamp(0.5 - distance / 2, 0.0, 1.0); }

LabelVolume bone() {
  constexpr int width = 40, length = 60;
  LabelVolume volume;
  volume.size = {width, width, length};
  const Vec3 spacing(2, 2, 2);
  volume.directions = spacing.asDiagonal();
  volume.origin = Vec3(1 - width, 1 - width, 0);
  volume.space = "left-posterior-superior";
  Random random(2);
  for (int k = 0; k < length; ++k)
    for (int j = 0; j < width; ++j)
      for (int i = 0; i < width; ++i) {
        const double x = i - 0.5 * (width - 1), y = j - 0.5 * (width - 1), z = k - 0.5 * (length - 1);
        // The bone lies in front of the axis and has thicker ends.
        const double across = std::sqrt(x * x + (y + 3) * (y + 3)), ends = z * z / 450;
        const double flesh = share_inside(std::sqrt(x * x + y * y) - 17),
                     shaft = share_inside(across - 6 - ends), marrow = share_inside(across - 3.5);
        constexpr double air_value = -1000, flesh_value = 50, marrow_value = -60;
        const double bone_value = 1300 + 8 * z;
        const double value = air_value + flesh * (flesh_value - air_value) +
                             shaft * (bone_value - flesh_value) + marrow * (marrow_value - bone_value);
        volume.labels.push_back(static_cast<MaterialTag>(value) + static_cast<MaterialTag>(random.below(41)) -
                                20);
      }
  return volume;
}

/// An electrode for `organs`: an octagonal prism from inside the organs to beyond the volume.
TriangleMesh lead() {
  constexpr double wide = 1.5, narrow = 0.625;  // coordinates of corners: an octagon but for 0.3 %
  constexpr std::array<std::array<double, 2>, 8> corners{{{wide, -narrow},
                                                          {wide, narrow},
                                                          {narrow, wide},
                                                          {-narrow, wide},
                                                          {-wide, narrow},
                                                          {-wide, -narrow},
                                                          {-narrow, -wide},
                                                          {narrow, -wide}}};
  TriangleMesh mesh;
  for (const double along : {-4.0, 34.0})
    for (const auto& [x, y] : corners)
      mesh.points.emplace_back(4 + x + along / 16, 1 + y - along / 32, along);
  for (Index i = 0; i < 8; ++i) {
    const Index next = (i + 1) % 8;
    mesh.triangles.push_back({i, next, 8 + next});
    mesh.triangles.push_back({i, 8 + next, 8 + i});
    if (i < 1 || i > 6) continue;
    mesh.triangles.push_back({0, next, i});
    mesh.triangles.push_back({8, 8 + i, 8 + next});
  }
  return mesh;
}

LabelVolume usual_foam() {
  return read_all(Foam(default_foam_voxels, default_foam_grains(default_foam_voxels)), foam_name);
}

struct NamedSample {
  const char* name;
  std::variant<TriangleMesh (*)(), TetMesh (*)(), LabelVolume (*)()> make;
};

const std::vector<NamedSample>& samples() {
  static const std::vector<NamedSample> all{
      {"sphere", +[] { return sphere(Vec3::Zero(), 1, 5); }},
      {"torus", torus},
      {"cube", +[] { return cube(8); }},
      {"two_spheres", two_spheres},
      {"knot", knot},
      {"open_sphere", open_sphere},
      {"tet_cube", tet_cube},
      {"two_materials", two_materials},
      {"layers", layers},
      {"random-interior", +[] { return random_interior(8, 5100, 0.07); }},
      {"random-interior-small", +[] { return random_interior(3, 170, 0.25); }},
      {"random-interior-large", +[] { return random_interior(14, 30000, 0.07); }},
      {"organs", organs},
      {"lead", lead},
      {"bone", bone},
      {foam_name, usual_foam},
      {"heater_below",
       +[] {
         return heater_part({0, 0, 0}, {4, 1, 1}, {8, 2, 3});
       }},
      {"heater_left",
       +[] {
         return heater_part({0, 1, 0}, {1.2, 1.5, 1}, {3, 1, 2});
       }},
      {"heater_core",
       +[] {
         return heater_part({1.2, 1, 0}, {2.8, 1.5, 1}, {4, 2, 3});
       }},
      {"heater_right",
       +[] {
         return heater_part({2.8, 1, 0}, {4, 1.5, 1}, {3, 2, 4});
       }},
      {"heater_above",
       +[] {
         return heater_part({0, 1.5, 0}, {4, 2.6, 1}, {7, 3, 2});
       }},
  };
  return all;
}

}  // namespace

std::vector<std::string> sample_names() {
  std::vector<std::string> names;
  for (const NamedSample& sample : samples()) names.emplace_back(sample.name);
  return names;
}

Sample make_sample(const std::string& name) {
  std::string known;
  for (const NamedSample& sample : samples()) {
    if (name == sample.name) return std::visit([](auto make) { return Sample(make()); }, sample.make);
    known += (known.empty() ? "" : " ") + std::string(sample.name);
  }
  throw UsageError("there is no sample " + in_quotes(name) + "; supported: " + known);
}

}  // namespace tetwright

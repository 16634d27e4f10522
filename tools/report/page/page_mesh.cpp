// SPDX-License-Identifier: Apache-2.0
#include "tools/report/page/page_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>

#include "common/geometry/box_tree.h"
#include "common/geometry/predicates.h"
#include "common/geometry/quality.h"
#include "common/parallel/parallel.h"
#include "tools/report/page/little_endian.h"
#include "tools/report/page/skin.h"

namespace tetwright {

namespace {

/// Which tets and triangles the page has.
struct Selection {
  std::vector<Index> tets;
  std::vector<std::uint8_t> layer;  ///< beside `tets`; empty where all tets are there
  std::vector<InterfaceTriangle> skin;
};

std::array<Vec3, 4> corners(const TetMesh& mesh, std::size_t t) {
  const Tet& v = mesh.tets[t];
  return {mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]], mesh.points[v[3]]};
}

/// The tets behind a plane that can be seen from before it once all others are gone: those whose centre is
/// behind it and that touch a tet which it cuts in a face.
std::vector<Index> layer_behind(const TetMesh& mesh, int axis, double plane) {
  std::vector<char> near(mesh.points.size(), 0);
  for (const Tet& t : mesh.tets) {
    int before = 0;
    for (const Index p : t) before += mesh.points[p][axis] > plane;
    if (before > 0 && before < 4)
      for (const Index p : t) near[p] = 1;
  }
  std::vector<Index> out;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    int touching = 0;
    double sum = 0;
    for (const Index p : mesh.tets[t]) touching += near[p], sum += mesh.points[p][axis];
    if (touching >= 3 && sum <= 4 * plane) out.push_back(static_cast<Index>(t));
  }
  return out;
}

/// For a mesh of which the page cannot have all tets.
Selection select_part(const TetMesh& mesh, const PageLimits& limits, PageMesh& page) {
  Selection selected;
  selected.skin = skin_within(mesh, limits.triangles);
  page.whole = false;
  page.coarsened = selected.skin.size() < mesh.interfaces.size();
  Box3 box;
  for (const Vec3& p : mesh.points) box.add(p);
  std::vector<std::uint8_t> axes(mesh.tets.size(), 0);
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<Index> layer = layer_behind(mesh, axis, box.low[axis] / 2 + box.high[axis] / 2);
    page.layers[static_cast<std::size_t>(axis)] = layer.size() <= limits.layer_tets;
    if (layer.size() > limits.layer_tets) continue;
    for (const Index t : layer) axes[t] = static_cast<std::uint8_t>(axes[t] | 1 << axis);
  }
  for (std::size_t t = 0; t < axes.size(); ++t) {
    if (!axes[t]) continue;
    selected.tets.push_back(static_cast<Index>(t));
    selected.layer.push_back(axes[t]);
  }
  return selected;
}

Selection select_all(const TetMesh& mesh) {
  Selection selected;
  selected.tets.resize(mesh.tets.size());
  std::iota(selected.tets.begin(), selected.tets.end(), Index{0});
  return selected;
}

/// New numbers of the points that are used, no_index for the others.
std::vector<Index> number_points(const TetMesh& mesh, const Selection& selected, PageMesh& page) {
  std::vector<Index> number(mesh.points.size(), no_index);
  for (const Index t : selected.tets)
    for (const Index p : mesh.tets[t]) number[p] = 0;
  for (const InterfaceTriangle& t : selected.skin)
    for (const Index p : t.ids) number[p] = 0;
  std::vector<Vec3> points;
  for (std::size_t p = 0; p < number.size(); ++p) {
    if (number[p] == no_index) continue;
    number[p] = static_cast<Index>(points.size());
    points.push_back(mesh.points[p]);
  }
  page.point_count = points.size();
  page.index_bytes = std::max<std::size_t>(2, bytes_for(points.size()));
  page.points = quantise(points);
  return number;
}

std::size_t place_of(MaterialTag tag, const PageMesh& page) {
  return static_cast<std::size_t>(std::lower_bound(page.materials.begin(), page.materials.end(), tag) -
                                  page.materials.begin());
}

void add_tets(const TetMesh& mesh, const Selection& selected, const std::vector<Index>& number,
              PageMesh& page) {
  page.tet_count = selected.tets.size();
  for (const Index t : selected.tets) {
    for (const Index p : mesh.tets[t]) append_little_endian(page.tets, number[p], page.index_bytes);
    append_little_endian(page.tags, static_cast<std::uint32_t>(place_of(mesh.materials[t], page)),
                         page.material_bytes);
  }
  page.layer.assign(selected.layer.begin(), selected.layer.end());
}

/// `value` / `largest` in 8 bits; what is no number, too, is 0.
char share_byte(double value, double largest) {
  constexpr double steps = 255;
  if (!(value > 0)) return 0;
  return static_cast<char>(static_cast<std::uint8_t>(std::lround(steps * std::min(1.0, value / largest))));
}

void add_angles(const TetMesh& mesh, const Selection& selected, PageMesh& page) {
  constexpr std::size_t grain = 1 << 14;
  page.solid.resize(selected.tets.size());
  page.dihedral.resize(selected.tets.size());
  parallel_for(0, selected.tets.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::array<Vec3, 4> x = corners(mesh, selected.tets[i]);
      if (orient3d(x[0], x[1], x[2], x[3]) <= 0) continue;  // as mesh_statistics() counts it
      page.solid[i] = share_byte(min_solid_angle(x[0], x[1], x[2], x[3]), regular_solid_angle);
      const std::array<double, 6> dihedrals = dihedral_angles(x);
      page.dihedral[i] = share_byte(*std::min_element(dihedrals.begin(), dihedrals.end()), regular_dihedral);
    }
  });
}

void add_skin(const Selection& selected, const std::vector<Index>& number, PageMesh& page) {
  page.triangle_count = selected.skin.size();
  for (const InterfaceTriangle& t : selected.skin) {
    for (const Index p : t.ids) append_little_endian(page.triangles, number[p], page.index_bytes);
    for (const std::size_t side :
         {place_of(t.material, page), t.other ? place_of(*t.other, page) : page.materials.size()})
      append_little_endian(page.sides, static_cast<std::uint32_t>(side), page.material_bytes);
  }
}

void add_distances(const SurfaceDistances& distances, const std::vector<Index>& number, PageMesh& page) {
  constexpr double none = 65535, largest = none - 1;
  page.distance_from = distances.from;
  for (std::size_t p = 0; p < number.size(); ++p)
    if (number[p] != no_index && std::isfinite(distances.values[p]) &&
        distances.values[p] > page.max_distance)
      page.max_distance = distances.values[p];
  for (std::size_t p = 0; p < number.size(); ++p) {
    if (number[p] == no_index) continue;
    const double d = distances.values[p];
    const double steps = !std::isfinite(d)       ? none
                         : page.max_distance > 0 ? std::round(largest * (d / page.max_distance))
                                                 : 0;
    append_little_endian(page.distance, static_cast<std::uint32_t>(steps), 2);
  }
}

}  // namespace

PageMesh page_mesh(const TetMesh& mesh, const SurfaceDistances* distances, const PageLimits& limits) {
  PageMesh page;
  page.materials = mesh.materials;
  std::sort(page.materials.begin(), page.materials.end());
  page.materials.erase(std::unique(page.materials.begin(), page.materials.end()), page.materials.end());
  page.material_bytes = bytes_for(page.materials.size() + 1);  // and outside
  const Selection selected =
      mesh.tets.size() <= limits.tets ? select_all(mesh) : select_part(mesh, limits, page);
  const std::vector<Index> number = number_points(mesh, selected, page);
  add_tets(mesh, selected, number, page);
  add_angles(mesh, selected, page);
  add_skin(selected, number, page);
  if (distances) add_distances(*distances, number, page);
  return page;
}

}  // namespace tetwright

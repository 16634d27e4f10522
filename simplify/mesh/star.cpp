// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/star.h"

#include <algorithm>
#include <cmath>

#include "common/portable_math.h"
#include "simplify/tuning/tuning.h"

namespace tetwright {

Outcome Star::gather(const EditableMesh& mesh, Index centre_point) {
  const Index first = mesh.incident_tet(centre_point);
  if (first == no_index) return Outcome::stale;
  begin(centre_point, mesh.position(centre_point));
  tet_numbers_.clear();
  frozen = mesh.frozen(centre);

  bool added;
  const auto number_of = [&](Index p) {
    const std::uint32_t n = point_numbers_.number(p, added);
    if (added) {
      points.push_back(p);
      mesh.prefetch_point(p);
      interface_count.push_back(0);
    }
    return static_cast<std::uint16_t>(n);
  };
  {
    tet_numbers_.number(first, added);
    // (centre, its opposite face as seen from outside) is positive.
    const int slot = mesh.slot_of(first, centre);
    const Triangle face = face_of(mesh.points(first), slot);
    std::array<std::uint16_t, 3> link;
    for (int k = 0; k < 3; ++k) link[k] = number_of(face[k]);
    tets.push_back({first, link, static_cast<std::uint8_t>(slot), mesh.region(first), 0});
  }
  for (std::size_t i = 0; i < tets.size(); ++i) {
    const Index tet = tets[i].tet;
    const RegionId region = tets[i].region;
    const Tet& corners = mesh.points(tet);
    std::array<std::uint16_t, 3> link = tets[i].link;
    // For all tets except the first, the neighbour that queued it has set two link points.
    const int slot = slot_in(corners, centre), first_corner = slot_in(corners, points[link[0]]),
              second_corner = slot_in(corners, points[link[1]]);
    const std::array<int, 3> corner{first_corner, second_corner, 6 - slot - first_corner - second_corner};
    if (i > 0) link[2] = number_of(corners[corner[2]]);
    if (points.size() > SimplifyTuning::Stars::max_points) return Outcome::too_large;
    tets[i].link = link;
    tets[i].slot = static_cast<std::uint8_t>(slot);
    tets[i].quality = mesh.quality(tet);
    worst = std::min(worst, tets[i].quality);
    for (int k = 0; k < 3; ++k) {
      const FaceLink across = mesh.link(tet, corner[k]);
      const std::uint16_t a = link[(k + 1) % 3], b = link[(k + 2) % 3];
      if (across.is_outside()) {
        interface_triangles.push_back({a, b, region, outside_id, across.patch()});
      } else {
        const Index other = across.tet();
        if (k < 2 || i == 0) {  // the third face leads back to the tet that queued it
          tet_numbers_.number(other, added);
          if (added) {
            tets.push_back({other, {b, a, 0}, 0, across.is_interface() ? mesh.region(other) : region, 0});
            mesh.prefetch_tet(other);
          }
        }
        if (!across.is_interface() || other < tet)
          continue;  // an interface between two materials is visited from both sides
        interface_triangles.push_back({a, b, region, mesh.region(other), 0});
        sheets |= interface_triangles.back().is_sheet();
      }
      ++interface_count[a];
      ++interface_count[b];
    }
  }
  for (Index p : points) positions.push_back(mesh.position(p));
  find_creases();
  return Outcome::done;
}

void Star::begin(Index centre_point, const Vec3& position) {
  centre = centre_point;
  centre_position = position;
  tets.clear();
  points.clear();
  positions.clear();
  interface_triangles.clear();
  interface_count.clear();
  normals.clear();
  gradients.clear();
  point_numbers_.clear();
  worst = 1;
  frozen = false;
  creases = false;
  sheets = false;
}

void Star::find_creases() {
  creases = false;
  if (interface_triangles.empty()) return;
  // Without different patches there can be no creases.
  const InterfaceTriangle& first = interface_triangles.front();
  if (std::all_of(interface_triangles.begin(), interface_triangles.end(),
                  [&](const InterfaceTriangle& t) { return t.patch == first.patch; }))
    return;
  crease_.assign(points.size(), 0);
  for (std::size_t i = 0; i < interface_triangles.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const InterfaceTriangle &s = interface_triangles[i], &t = interface_triangles[j];
      if (s.continues(t)) continue;
      for (std::uint16_t p : {s.first, s.second})
        if (p == t.first || p == t.second) {
          crease_[p] = 1;
          creases = true;
        }
    }
}

std::uint16_t Star::add_point(Index p, const Vec3& position) {
  bool added;
  const std::uint32_t n = point_numbers_.number(p, added);
  if (added) {
    points.push_back(p);
    positions.push_back(position);
    interface_count.push_back(0);
  }
  return static_cast<std::uint16_t>(n);
}

void Star::add_interface_triangle(Index first, Index second, RegionId inside, RegionId across,
                                  PatchId patch) {
  const auto a = static_cast<std::uint16_t>(point_numbers_.find(first)),
             b = static_cast<std::uint16_t>(point_numbers_.find(second));
  interface_triangles.push_back({a, b, inside, across, patch});
  sheets |= interface_triangles.back().is_sheet();
  ++interface_count[a];
  ++interface_count[b];
}

int Star::dimension() const {
  return dimension_of([](const InterfaceTriangle&) { return true; },
                      [&](std::size_t p) { return edge_dimension(p) == 1; });
}

int Star::dimension_among_labels(const std::vector<CurveKinds>& kinds) const {
  return dimension_of([](const InterfaceTriangle&) { return true; },
                      [&](std::size_t p) { return kinds[p].between_labels(); });
}

int Star::dimension_on_bodies(PatchId first_body_patch, const std::vector<CurveKinds>& kinds) const {
  return dimension_of([&](const InterfaceTriangle& t) { return t.patch >= first_body_patch; },
                      [&](std::size_t p) { return kinds[p].on_crease(); });
}

template <class Counts, class IsCurve>
int Star::dimension_of(const Counts& counts, const IsCurve& is_curve) const {
  // The interface triangles at the centre are the edges of a graph on the link points. An edge of dimension 2
  // from the centre is a node at which two of them continue. Walk from interface triangle to interface
  // triangle across such nodes.
  visited_.assign(interface_triangles.size(), 0);
  for (std::size_t k = 0; k < interface_triangles.size(); ++k) visited_[k] = !counts(interface_triangles[k]);
  const auto all_visited = [&] {
    return std::all_of(visited_.begin(), visited_.end(), [](std::uint8_t v) { return v != 0; });
  };
  if (all_visited()) return 3;
  std::size_t ends[2] = {0, 0};
  std::size_t end_count = 0;
  for (std::size_t p = 0; p < points.size(); ++p)
    if (is_curve(p)) {
      if (end_count == 2) return 0;
      ends[end_count++] = p;
    }
  if (end_count == 1) return 0;
  const auto walk = [&](std::size_t interface_triangle, std::size_t from) {
    // Follow the interface triangles to the end of their curve, or back to the start.
    std::size_t at = from;
    for (;;) {
      visited_[interface_triangle] = 1;
      at = interface_triangles[interface_triangle].first == at
               ? interface_triangles[interface_triangle].second
               : interface_triangles[interface_triangle].first;
      if (at == from || is_curve(at)) return at;
      std::size_t next = interface_triangles.size();
      for (std::size_t k = 0; k < interface_triangles.size(); ++k)
        if (!visited_[k] && (interface_triangles[k].first == at || interface_triangles[k].second == at))
          next = k;
      if (next == interface_triangles.size()) return at;
      interface_triangle = next;
    }
  };
  if (end_count == 0) {
    const auto first =
        static_cast<std::size_t>(std::find(visited_.begin(), visited_.end(), 0) - visited_.begin());
    walk(first, interface_triangles[first].first);
    return all_visited() ? 2 : 0;
  }
  for (std::size_t k = 0; k < interface_triangles.size(); ++k) {
    if (visited_[k] || (interface_triangles[k].first != ends[0] && interface_triangles[k].second != ends[0]))
      continue;
    if (walk(k, ends[0]) != ends[1]) return 0;
  }
  return all_visited() ? 1 : 0;
}

void Star::find_curves(PatchId first_body_patch, std::vector<CurveKinds>& kinds) const {
  kinds.assign(points.size(), {});
  for (const InterfaceTriangle& t : interface_triangles)
    for (const std::uint16_t p : {t.first, t.second}) kinds[p].add(t.patch, first_body_patch);
}

void Star::compute_normals() {
  normals.clear();
  for (const StarTet& t : tets) {
    const Vec3 &x = positions[t.link[0]], &y = positions[t.link[1]], &z = positions[t.link[2]];
    normals.push_back((y - x).cross(z - x));
  }
}

void Star::compute_gradients() {
  gradients.clear();
  areas_.clear();
  if (interface_triangles.empty()) return;
  if (normals.empty()) compute_normals();
  for (const InterfaceTriangle& s : interface_triangles)
    areas_.push_back((positions[s.first] - centre_position).cross(positions[s.second] - centre_position) *
                     (1.0 / 6));
  if (sheets) sheet_normal_ = oriented_area();
  for (std::size_t k = 0; k < tets.size(); ++k) {
    const StarTet& t = tets[k];
    const Vec3 change = normals[k] * (-1.0 / 6);  // the volume is linear in c
    auto g = std::find_if(gradients.begin(), gradients.end(),
                          [&](const VolumeGradient& v) { return v.region == t.region; });
    if (g == gradients.end()) {
      gradients.push_back({t.region, change});
    } else {
      g->change += change;
    }
  }
}

Vec3 Star::oriented_area() {
  Vec3 sum = areas_.front();
  sides_.assign(interface_triangles.size(), 0);  // 0: not reached
  sides_.front() = 1;
  for (bool reached = true; reached;) {
    reached = false;
    for (std::size_t i = 0; i < interface_triangles.size(); ++i)
      for (std::size_t j = 0; j < interface_triangles.size() && sides_[i] == 0; ++j) {
        const InterfaceTriangle &s = interface_triangles[i], &t = interface_triangles[j];
        if (sides_[j] == 0 ||
            !(s.first == t.first || s.first == t.second || s.second == t.first || s.second == t.second))
          continue;
        // Equally oriented triangles traverse their common edge in opposite directions.
        sides_[i] = s.first == t.first || s.second == t.second ? -sides_[j] : sides_[j];
        sum += sides_[i] * areas_[i];
        reached = true;
      }
  }
  return sum;
}

const std::vector<VolumeChange>& Star::volume_changes(const Vec3& step) {
  changes_.clear();
  for (const VolumeGradient& g : gradients) changes_.push_back({g.region, g.change.dot(step)});
  return changes_;
}

double Star::swept_by_sheets(const Vec3& step) const {
  double swept = 0;
  for (std::size_t k = 0; k < interface_triangles.size(); ++k)
    if (interface_triangles[k].is_sheet()) swept += std::fabs(areas_[k].dot(step));
  return swept;
}

double Star::surface_error(const Vec3& step, double gamma, bool losses_cancel) {
  if (losses_cancel) {
    double sum = 0;
    for (const VolumeGradient& g : gradients) sum += portable_cbrt(std::fabs(g.change.dot(step)));
    if (sheets) sum += portable_cbrt(swept_by_sheets(step));
    return gamma * sum;
  }
  // Moving the centre makes each interface triangle sweep a tet of volume |area vector . step| / 3.
  swept_.assign(gradients.size(), 0);
  for (std::size_t k = 0; k < interface_triangles.size(); ++k) {
    const double swept = std::fabs(areas_[k].dot(step));
    for (std::size_t i = 0; i < gradients.size(); ++i)
      if (gradients[i].region == interface_triangles[k].inside ||
          gradients[i].region == interface_triangles[k].across)
        swept_[i] += swept;
  }
  double sum = 0;
  for (double swept : swept_) sum += portable_cbrt(swept);
  return gamma * sum;
}

}  // namespace tetwright

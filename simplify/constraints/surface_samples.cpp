// SPDX-License-Identifier: Apache-2.0
#include "simplify/constraints/surface_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "common/geometry/low_discrepancy.h"
#include "common/message_text.h"
#include "common/tolerances.h"
#include "simplify/tuning/tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

using Grains = SimplifyTuning::Grains;
using Memory = SimplifyTuning::Memory;
using Samples = SimplifyTuning::Samples;

/// Area of an equilateral triangle over its edge squared: sqrt(3) / 4.
constexpr double equilateral_area = 0.4330127018922193;

double area(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - a).norm() / 2; }

/// A point on an item of the input's surface.
struct Place {
  Vec3 at;
  std::size_t item;
};

/// Samples the surface at the triangles' vertices, and inside large triangles at a low-discrepancy sequence:
/// one sample for each `area_each` times the square of the local scale.
std::vector<Place> spread_places(const ProjectionTree& surface, double area_each,
                                 const std::function<double(const Vec3&)>& scale) {
  std::vector<std::uint8_t> used(surface.points().size(), 0);
  std::vector<Place> places;
  double due = 0;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < surface.items().size(); ++i) {
    const ProjectionTree::Item& item = surface.items()[i];
    const Vec3 &a = surface.corner(item, 0), &b = surface.corner(item, 1), &c = surface.corner(item, 2);
    const double here = scale((a + b + c) / 3);
    due += area(a, b, c) / (area_each * here * here);
    for (const Index p : item.corners)
      if (due > -1 && !std::exchange(used[p], 1)) {
        places.push_back({surface.points()[p], i});
        --due;
      }
    for (; due > 0; --due) {
      const auto [u, v] = low_discrepancy_barycentric(drawn++);
      places.push_back({a + u * (b - a) + v * (c - a), i});
    }
  }
  return places;
}

/// RepresentedSurface::reach().
/// \param total_edge sum of the edge lengths of all triangles.
double mean_reach(double total_edge, std::size_t triangles) {
  return Samples::correspondence_edges * total_edge /
         static_cast<double>(std::max<std::size_t>(1, 3 * triangles));
}

/// The mesh's boundary and interface triangles; kind[0] is the index in mesh.interface_faces().
ProjectionTree faces_of(const EditableMesh& mesh) {
  std::vector<Vec3> points(mesh.point_slots(), Vec3::Zero());
  std::vector<ProjectionTree::Item> items;
  for (const InterfaceFace& f : mesh.interface_faces()) {
    for (const Index p : f.ids) points[p] = mesh.position(p);
    items.push_back({f.ids, {static_cast<std::uint32_t>(items.size()), 0, 0}});
  }
  return {std::move(points), std::move(items)};
}

}  // namespace

RepresentedSurface::Kind RepresentedSurface::kind_of(RegionId inside, RegionId across, PatchId patch) {
  return {std::min(inside, across), std::max(inside, across), patch};
}

RepresentedSurface::Kind RepresentedSurface::kind_of(const ProjectionTree::Item& item) {
  return {item.kind[0], item.kind[1], static_cast<PatchId>(item.kind[2])};
}

RepresentedSurface::RepresentedSurface(const EditableMesh& mesh, const TriangleMesh* given) {
  const std::vector<InterfaceFace> faces = mesh.interface_faces();
  const auto corner = [&](std::size_t face, int k) { return mesh.position(faces[face].ids[k]); };
  double total_edge = 0;
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (int k = 0; k < 3; ++k) total_edge += (corner(i, (k + 1) % 3) - corner(i, k)).norm();
  reach_ = mean_reach(total_edge, faces.size());

  std::vector<Vec3> points;
  std::vector<ProjectionTree::Item> items;
  std::vector<std::uint8_t> alone(faces.size(), 1);
  if (given) {
    for (const Vec3& p : given->points) points.push_back(mesh.space().to_working(p));
    for (const Triangle& t : given->triangles) items.push_back({t, given_kind});
    triangles_ = ProjectionTree(points, items);
    parallel_for(0, faces.size(), Grains::samples, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        alone[i] = faces[i].is_sheet() ||
                   !triangles_.any_within((corner(i, 0) + corner(i, 1) + corner(i, 2)) / 3, reach_);
    });
  }
  std::vector<Index> number(mesh.point_slots(), no_index);
  const std::size_t given_items = items.size();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (!alone[i]) continue;
    Triangle ids;
    for (int k = 0; k < 3; ++k) {
      Index& n = number[faces[i].ids[k]];
      if (n == no_index) {
        n = static_cast<Index>(points.size());
        points.push_back(corner(i, k));
      }
      ids[k] = n;
    }
    const Kind kind = kind_of(faces[i].inside, faces[i].across, faces[i].patch);
    items.push_back({ids, {kind.low, kind.high, kind.patch}});
  }
  if (items.size() > given_items) triangles_ = ProjectionTree(std::move(points), std::move(items));
}

RepresentedSurface::RepresentedSurface(OriginalSurface original) {
  std::vector<ProjectionTree::Item> items;
  items.reserve(original.faces.size());
  double total_edge = 0;
  for (const InterfaceFace& f : original.faces) {
    const Kind kind = kind_of(f.inside, f.across, f.patch);
    items.push_back({f.ids, {kind.low, kind.high, kind.patch}});
    for (int k = 0; k < 3; ++k)
      total_edge += (original.points[f.ids[(k + 1) % 3]] - original.points[f.ids[k]]).norm();
  }
  reach_ = mean_reach(total_edge, items.size());
  std::vector<InterfaceFace>().swap(original.faces);
  triangles_ = ProjectionTree(std::move(original.points), std::move(items));
}

void RepresentedSurface::find_hidden(const EditableMesh& mesh) {
  const ProjectionTree own = faces_of(mesh);
  hidden_.resize(triangles_.items().size());
  parallel_for(0, hidden_.size(), Grains::samples, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const ProjectionTree::Item& item = triangles_.items()[i];
      const Vec3 &a = triangles_.corner(item, 0), &b = triangles_.corner(item, 1),
                 &c = triangles_.corner(item, 2);
      const std::array<Vec3, 4> places{a, b, c, (a + b + c) / 3};
      hidden_[i] = std::none_of(places.begin(), places.end(),
                                [&](const Vec3& p) { return own.any_within(p, reach_); });
    }
  });
}

ProjectionTree RepresentedSurface::shown() const {
  std::vector<ProjectionTree::Item> items;
  for (std::size_t i = 0; i < triangles_.items().size(); ++i)
    if (hidden_.empty() || !hidden_[i]) items.push_back(triangles_.items()[i]);
  return {triangles_.points(), std::move(items)};
}

double RepresentedSurface::accuracy() const {
  Box3 box;
  for (const ProjectionTree::Item& item : triangles_.items())
    for (int k = 0; k < 3; ++k) box.add(triangles_.corner(item, k));
  return tolerance::deviation_share * (box.high - box.low).norm();
}

DeviationReport RepresentedSurface::deviation(const EditableMesh& mesh, const Progress* progress) const {
  DeviationReport report;
  const double scale = mesh.space().scale();
  const bool given = std::any_of(triangles_.items().begin(), triangles_.items().end(), is_given);
  for (std::size_t i = 0; i < triangles_.items().size(); ++i) {
    const ProjectionTree::Item& item = triangles_.items()[i];
    const double size =
        area(triangles_.corner(item, 0), triangles_.corner(item, 1), triangles_.corner(item, 2)) /
        (scale * scale);
    if (!hidden_.empty() && hidden_[i]) report.hidden_area += size;
    // Without a given surface every item is the mesh's own, and none counts as apart.
    if (given && !is_given(item) && !kind_of(item).is_sheet()) report.apart_area += size;
  }
  const auto in_input_units = [&](const SurfaceDeviation& d) {
    return SurfaceDeviation{d.lower / scale, d.upper / scale, mesh.space().to_input(d.place), d.rms / scale};
  };
  const ProjectionTree input = shown(), own = faces_of(mesh);
  report.from_mesh = in_input_units(surface_deviation(own, input, accuracy(), progress));
  report.from_surface = in_input_units(surface_deviation(input, own, accuracy(), progress));
  return report;
}

std::vector<RepresentedSurface::FarFace> RepresentedSurface::far_faces(const EditableMesh& mesh,
                                                                       double limit) const {
  const ProjectionTree input = shown(), own = faces_of(mesh);
  std::vector<FarFace> faces;
  if (input.empty() || own.empty()) return faces;
  for (const FarTriangle& t : triangles_beyond(own, input, limit, accuracy()))
    faces.push_back({own.items()[t.item].kind[0], {}});
  for (const FarTriangle& t : triangles_beyond(input, own, limit, accuracy()))
    faces.push_back({own.items()[t.nearest].kind[0], t.place});
  return faces;
}

SurfaceSamples::SurfaceSamples(const EditableMesh& mesh, std::size_t records,
                               const RepresentedSurface& surface, double edge,
                               const std::function<double(const Vec3&)>& scale)
    : surface_(surface.triangles()) {
  const std::vector<InterfaceFace> faces = mesh.interface_faces();
  resize(records);
  std::vector<ProjectionTree::Item> items;
  std::vector<Vec3> points(mesh.point_slots(), Vec3::Zero());
  items.reserve(faces.size());
  for (std::size_t i = 0; i < faces.size(); ++i) {
    const InterfaceFace& f = faces[i];
    kinds_[i] = RepresentedSurface::kind_of(f.inside, f.across, f.patch);
    for (const Index p : f.ids) points[p] = mesh.position(p);
    items.push_back({f.ids, {static_cast<std::uint32_t>(i), 0, 0}});
  }
  const ProjectionTree mesh_faces(std::move(points), std::move(items));
  const auto normal = [](const ProjectionTree& tree, const ProjectionTree::Item& item) -> Vec3 {
    const Vec3& a = tree.corner(item, 0);
    return (tree.corner(item, 1) - a).cross(tree.corner(item, 2) - a);
  };
  const double area_each = equilateral_area * edge * edge / Samples::per_triangle;
  double expected = 0;
  for (const ProjectionTree::Item& item : surface_.items()) {
    const Vec3 &a = surface_.corner(item, 0), &b = surface_.corner(item, 1), &c = surface_.corner(item, 2);
    const double here = scale((a + b + c) / 3);
    expected += area(a, b, c) / (area_each * here * here);
  }
  require_memory(
      Memory::bytes_per_sample * expected,
      "holding surfaces with " + short_number(expected) + " samples, which a tolerance this small takes,",
      "give a larger one");
  TETWRIGHT_CHECK(expected < none);
  const std::vector<Place> places = spread_places(surface_, area_each, scale);
  struct Owner {
    std::uint32_t record;
    double distance;
  };
  std::vector<Owner> owners(places.size(), {none, 0});
  const std::size_t blocks = (places.size() + Grains::samples - 1) / Grains::samples;
  parallel_for(0, blocks, 1, [&](std::size_t begin_block, std::size_t end_block) {
    for (std::size_t block = begin_block; block < end_block; ++block) {
      constexpr std::size_t nobody = std::numeric_limits<std::size_t>::max();
      std::size_t last = nobody;  // the owner of the previous point: the next one is not far away
      for (std::size_t i = block * Grains::samples;
           i < std::min(places.size(), (block + 1) * Grains::samples); ++i) {
        const Vec3& at = places[i].at;
        const ProjectionTree::Item& from = surface_.items()[places[i].item];
        const bool given = RepresentedSurface::is_given(from);
        const Vec3 outwards = normal(surface_, from);
        // Skip the opposite side of a thin wall, and other interfaces.
        const auto accepts = [&](const ProjectionTree::Item& item) {
          const Kind& kind = kinds_[item.kind[0]];
          if (!given) return kind == RepresentedSurface::kind_of(from);
          return !kind.is_sheet() && (kind.high != outside_id || normal(mesh_faces, item).dot(outwards) > 0);
        };
        double limit = surface.reach();
        if (last != nobody && accepts(mesh_faces.items()[last]))
          limit = std::min(limit, (mesh_faces.closest_on(last, at) - at).norm());
        else
          last = nobody;
        if (const auto hit = mesh_faces.nearest_of(at, limit, accepts))
          last = hit->item;
        else if (last == nobody)
          continue;
        owners[i] = {mesh_faces.items()[last].kind[0], (mesh_faces.closest_on(last, at) - at).norm()};
      }
    }
  });
  for (std::size_t i = 0; i < places.size(); ++i)
    if (owners[i].record != none) add(places[i].at, owners[i].record, owners[i].distance);
}

void SurfaceSamples::add(const Vec3& position, std::uint32_t record, double distance) {
  samples_.push_back({position, static_cast<float>(distance), first_[record]});
  first_[record] = static_cast<std::uint32_t>(samples_.size() - 1);
}

void SurfaceSamples::resize(std::size_t records) {
  first_.resize(records, none);
  kinds_.resize(records);
}

bool SurfaceSamples::reassign_samples(SurfaceGrid::Edit& edit, double max_distance) const {
  return choose_new_owners(edit, max_distance) && stays_near_surface(edit, max_distance);
}

bool SurfaceSamples::choose_new_owners(SurfaceGrid::Edit& edit, double max_distance) const {
  edit.reassigned.clear();
  edit.distances.clear();
  for (const SurfaceGrid::Added& a : edit.added)
    edit.distances.emplace_back(a.triangle.points[0], a.triangle.points[1], a.triangle.points[2]);
  for (const std::uint32_t record : edit.removed_records) {
    if (first_[record] == none) continue;
    const Kind kind = kinds_[record];
    const auto same_kind = [&](const SurfaceGrid::Added& a) {
      return RepresentedSurface::kind_of(a.inside, a.across, a.patch) == kind;
    };
    const bool all = std::none_of(edit.added.begin(), edit.added.end(), same_kind);
    edit.takers.clear();
    for (std::uint32_t k = 0; k < edit.added.size(); ++k)
      if (all || same_kind(edit.added[k])) edit.takers.push_back(k);
    if (edit.takers.empty()) return false;
    for (std::uint32_t s = first_[record]; s != none; s = samples_[s].next) {
      const Sample& sample = samples_[s];
      double best2 = std::numeric_limits<double>::infinity();
      std::uint32_t best = edit.takers.front();
      for (const std::uint32_t k : edit.takers) {
        const double d2 = edit.distances[k].squared(sample.position, best2);
        if (d2 < best2) {
          best2 = d2;
          best = k;
        }
      }
      const double d = std::sqrt(best2);
      // Compare in stored precision, so that a sample whose triangle does not move is no farther than before.
      if (d > max_distance && static_cast<float>(d) > sample.distance) return false;
      edit.reassigned.push_back({s, best, static_cast<float>(d)});
    }
  }
  return true;
}

bool SurfaceSamples::stays_near_surface(SurfaceGrid::Edit& edit, double max_distance) const {
  if (!(max_distance < std::numeric_limits<double>::infinity())) return true;
  double allowed = max_distance;
  bool measured = false;
  // Tests a lattice of points on a large triangle.
  const auto inside_stays = [&](std::uint32_t added) {
    const auto& p = edit.added[added].triangle.points;
    const double longest2 =
        std::max({(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
    if (!(longest2 > spacing_ * spacing_)) return true;
    const int steps = static_cast<int>(std::ceil(std::sqrt(longest2) / spacing_));
    const Vec3 u = (p[1] - p[0]) / steps, v = (p[2] - p[0]) / steps, n = u.cross(v);
    // Most of these points are near a sample of the triangle, which is on the surface.
    const std::size_t row = static_cast<std::size_t>(steps) + 1;
    edit.near_sample.assign(row * row, 0);
    if (n.squaredNorm() > 0) {
      const Vec3 to_i = v.cross(n) / n.squaredNorm(), to_j = n.cross(u) / n.squaredNorm();
      const double reach_i = allowed * to_i.norm(), reach_j = allowed * to_j.norm();
      const auto first = [](double x) { return static_cast<int>(std::ceil(std::max(x, 0.0))); };
      const auto last = [](double x, int end) {
        return static_cast<int>(std::floor(std::min<double>(x, end)));
      };
      for (const SurfaceGrid::ReassignedSample& h : edit.reassigned) {
        if (h.added != added) continue;
        const Vec3 from = samples_[h.sample].position - p[0];
        const double at_i = from.dot(to_i), at_j = from.dot(to_j);
        for (int i = first(at_i - reach_i); i <= last(at_i + reach_i, steps); ++i)
          for (int j = first(at_j - reach_j); j <= last(at_j + reach_j, steps - i); ++j)
            if ((from - i * u - j * v).squaredNorm() <= allowed * allowed)
              edit.near_sample[static_cast<std::size_t>(i) * row + static_cast<std::size_t>(j)] = 1;
      }
    }
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; i + j <= steps; ++j)
        if (!edit.near_sample[static_cast<std::size_t>(i) * row + static_cast<std::size_t>(j)] &&
            !surface_.any_within(p[0] + i * u + j * v, allowed))
          return false;
    return true;
  };
  // Try the samples first: they are on the surface.
  const auto near = [&](const Vec3& p) {
    const double allowed2 = allowed * allowed;
    for (const SurfaceGrid::ReassignedSample& h : edit.reassigned)
      if ((samples_[h.sample].position - p).squaredNorm() <= allowed2) return true;
    return surface_.any_within(p, allowed);
  };
  const auto stays = [&](const Vec3& p) {
    if (near(p)) return true;
    if (measured) return false;
    measured = true;
    for (const SurfaceGrid::ReassignedSample& h : edit.reassigned)
      allowed = std::max(allowed, static_cast<double>(samples_[h.sample].distance));
    return allowed > max_distance && near(p);
  };
  // The position of a vertex in the removed triangles, if it is in one: shows which parts of an added
  // triangle are new.
  const auto place_before = [&](Index id) -> std::optional<Vec3> {
    for (const MeshTriangle& t : edit.removed)
      for (int k = 0; k < 3; ++k)
        if (t.ids[k] == id) return t.points[k];
    return {};
  };
  const auto had_edge = [&](Index p, Index q) {
    const auto has = [](const MeshTriangle& t, Index id) {
      return std::find(t.ids.begin(), t.ids.end(), id) != t.ids.end();
    };
    return std::any_of(edit.removed.begin(), edit.removed.end(),
                       [&](const MeshTriangle& t) { return has(t, p) && has(t, q); });
  };
  std::optional<Index> tested;  // the moved corner: there is at most one
  for (std::uint32_t added = 0; added < edit.added.size(); ++added) {
    const auto& p = edit.added[added].triangle.points;
    const auto& ids = edit.added[added].triangle.ids;
    if (!stays((p[0] + p[1] + p[2]) / 3)) return false;
    std::array<bool, 3> moved{};
    for (int k = 0; k < 3; ++k) {
      moved[k] = place_before(ids[k]) != p[k];
      if (!moved[k] || tested == ids[k]) continue;
      tested = ids[k];
      if (!stays(p[k])) return false;
    }
    for (int k = 0; k < 3; ++k) {
      const int l = (k + 1) % 3;
      if ((moved[k] || moved[l] || !had_edge(ids[k], ids[l])) && !stays((p[k] + p[l]) / 2)) return false;
    }
    if (!inside_stays(added)) return false;
  }
  return true;
}

double SurfaceSamples::largest_distance() const {
  float largest = 0;
  for (const Sample& s : samples_) largest = std::max(largest, s.distance);
  return static_cast<double>(largest);
}

void SurfaceSamples::commit(const SurfaceGrid::Edit& edit) {
  for (std::size_t k = 0; k < edit.added.size(); ++k) {
    const SurfaceGrid::Added& a = edit.added[k];
    first_[edit.added_records[k]] = none;
    kinds_[edit.added_records[k]] = RepresentedSurface::kind_of(a.inside, a.across, a.patch);
  }
  for (const SurfaceGrid::ReassignedSample& h : edit.reassigned) {
    const std::uint32_t record = edit.added_records[h.added];
    samples_[h.sample].distance = h.distance;
    samples_[h.sample].next = std::exchange(first_[record], h.sample);
  }
}

void SurfaceSamples::renumber(const std::vector<std::uint32_t>& new_record, std::size_t records) {
  std::vector<std::uint32_t> first(records, none);
  std::vector<Kind> kinds(records);
  for (std::size_t i = 0; i < new_record.size(); ++i)
    if (new_record[i] != none) {
      first[new_record[i]] = first_[i];
      kinds[new_record[i]] = kinds_[i];
    }
  first_ = std::move(first);
  kinds_ = std::move(kinds);
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/labelled_complex.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/features/edge_uses.h"
#include "common/geometry/box_tree.h"
#include "common/geometry/ray_crossing.h"
#include "common/mesh/disjoint_sets.h"
#include "mesher/complex/surface_cells.h"
#include "mesher/tuning/complex_tuning.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// A triangle of the complex with how often each body's surface runs along it.
struct Welded {
  Triangle ids;
  std::size_t first, count;  ///< uses
};

/// A triangle of a body on a triangle of the complex.
struct Use {
  std::uint32_t body;
  Index source;
  bool turned;
};

}  // namespace

class ComplexBuilder {
 public:
  ComplexBuilder(const ImprintedSurfaces& imprinted, const SurfaceSoup& soup, std::size_t bodies,
                 double tolerance, OverlapRule rule, const SoupSheets& sheets, Progress* progress)
      : imprinted_(imprinted),
        soup_(soup),
        bodies_(bodies),
        tolerance_(tolerance),
        rule_(rule),
        sheets_(sheets),
        progress_(progress) {}

  ComplexResult build() {
    const double bytes =
        ComplexTuning::Cells::bytes_per_triangle * static_cast<double>(imprinted_.triangles.size());
    require_memory(bytes, "finding which body each part of space belongs to",
                   "free some, give a larger --memory-limit, or give surfaces of fewer triangles");
    result_.peak_bytes = std::max(bytes, imprinted_.peak_bytes);
    using Step = void (ComplexBuilder::*)();
    for (const Step step :
         {&ComplexBuilder::weld, &ComplexBuilder::find_windings, &ComplexBuilder::measure_cells,
          &ComplexBuilder::find_overlaps, &ComplexBuilder::label_cells, &ComplexBuilder::dissolve_thin_cells,
          &ComplexBuilder::assemble}) {
      throw_if_stopped();
      (this->*step)();
    }
    return std::move(result_);
  }

 private:
  void throw_if_stopped() const {
    if (progress_) progress_->throw_if_stopped();
  }
  const Vec3& at(Index p) const { return imprinted_.points[p]; }
  std::span<const Use> uses(Index t) const {
    return std::span(uses_).subspan(welded_[t].first, welded_[t].count);
  }
  bool is_sheet(const Use& u) const { return u.body >= bodies_; }
  Vec3 area_vector(const Triangle& t) const { return (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])) / 2; }

  /// Makes triangles with the same points one. A body's triangles that run both ways cancel.
  void weld() {
    struct Entry {
      Triangle sorted;
      Index triangle;
      bool turned;
    };
    std::vector<Entry> entries;
    for (Index t = 0; t < imprinted_.triangles.size(); ++t) {
      Triangle ids = imprinted_.triangles[t];
      std::rotate(ids.begin(), std::min_element(ids.begin(), ids.end()), ids.end());
      const bool turned = ids[1] > ids[2];
      if (turned) std::swap(ids[1], ids[2]);
      entries.push_back({ids, t, turned});
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      return a.sorted != b.sorted ? a.sorted < b.sorted : a.triangle < b.triangle;
    });
    for (std::size_t i = 0, j = 0; i < entries.size(); i = j) {
      std::map<std::uint32_t, std::vector<Use>> of_body;
      for (; j < entries.size() && entries[j].sorted == entries[i].sorted; ++j) {
        const Index source = imprinted_.source[entries[j].triangle];
        const std::uint32_t body = soup_.surface[source];
        std::vector<Use>& own = of_body[body];
        const auto opposite =
            std::find_if(own.begin(), own.end(), [&](const Use& u) { return u.turned != entries[j].turned; });
        if (opposite != own.end() && body < bodies_)
          own.erase(opposite);
        else
          own.push_back({body, source, entries[j].turned});
      }
      const std::size_t first = uses_.size();
      for (const auto& [body, own] : of_body) uses_.insert(uses_.end(), own.begin(), own.end());
      if (uses_.size() > first) welded_.push_back({entries[i].sorted, first, uses_.size() - first});
    }
    std::vector<Triangle> triangles;
    for (const Welded& w : welded_) triangles.push_back(w.ids);
    cells_ = find_cells(imprinted_.points, triangles);
  }

  /// Winding numbers of all bodies in each cell, at the triangle of the cell with the largest projection.
  void find_windings() {
    std::vector<Index> shown(cells_.count, no_index);
    std::vector<double> largest(cells_.count, -1);
    for (Index t = 0; t < welded_.size(); ++t) {
      const double size = std::abs(area_vector(welded_[t].ids).z());
      for (const Index cell : cells_.sides[t])
        if (size > largest[cell]) largest[cell] = size, shown[cell] = t;
    }
    std::vector<Box3> boxes(welded_.size());
    std::vector<Vec3> middles(welded_.size());
    for (Index t = 0; t < welded_.size(); ++t) {
      for (const Index p : welded_[t].ids) boxes[t].add(at(p));
      middles[t] = boxes[t].low + boxes[t].high;
    }
    const std::vector<Index> order = median_order(boxes, middles, ComplexTuning::Cells::leaf_size);
    const BoxTree tree(order.size(), ComplexTuning::Cells::leaf_size,
                       [&](std::size_t i) { return boxes[order[i]]; });
    windings_.assign(cells_.count, std::vector<int>(bodies_, 0));
    parallel_for(0, cells_.count, ComplexGrains::divided, [&](std::size_t begin, std::size_t end) {
      throw_if_stopped();
      for (std::size_t cell = begin; cell < end; ++cell) {
        const Index own = shown[cell];
        const Triangle& ids = welded_[own].ids;
        const Vec3 p = (at(ids[0]) + at(ids[1]) + at(ids[2])) / 3;
        std::vector<int>& winding = windings_[cell];
        const auto cross = [&](Index t, int crossing) {
          for (const Use& u : uses(t))
            if (!is_sheet(u)) winding[u.body] += u.turned ? -crossing : crossing;
        };
        tree.for_each_in(
            [&](const Box3& box) {
              return box.low.x() <= p.x() && p.x() <= box.high.x() && box.low.y() <= p.y() &&
                     p.y() <= box.high.y() && box.low.z() <= p.z();
            },
            [&](std::size_t i) {
              const Index t = order[i];
              if (t == own) return;
              const auto& [a, b, c] = welded_[t].ids;
              if (const int crossing = vertical_crossing(at(a), at(b), at(c), p))
                if (at_or_above(at(a), at(b), at(c), crossing, p)) cross(t, crossing);
            });
        // The side of its own triangle that is above it has crossed it.
        const bool points_up = area_vector(ids).z() > 0;
        const bool is_front = cells_.sides[own][1] == cell && cells_.sides[own][0] != cell;
        if (cells_.sides[own][0] != cells_.sides[own][1] && is_front == points_up)
          cross(own, points_up ? -1 : 1);
      }
    });
    for (Index t = 0; t < welded_.size() && !result_.inconsistent; ++t) {
      std::vector<int> step(bodies_, 0);
      for (const Use& u : uses(t))
        if (!is_sheet(u)) step[u.body] += u.turned ? -1 : 1;
      const auto [behind, front] = cells_.sides[t];
      for (std::size_t b = 0; b < bodies_; ++b)
        if (windings_[behind][b] - windings_[front][b] != step[b])
          result_.inconsistent = at(welded_[t].ids[0]);
    }
  }

  void measure_cells() {
    volumes_.assign(cells_.count, 0);
    areas_.assign(cells_.count, 0);
    places_.assign(cells_.count, Vec3::Zero());
    const Vec3 apex = welded_.empty() ? Vec3(Vec3::Zero()) : at(welded_[0].ids[0]);
    std::vector<double> largest(cells_.count, -1);
    for (Index t = 0; t < welded_.size(); ++t) {
      const auto& [a, b, c] = welded_[t].ids;
      const double volume = (at(a) - apex).dot((at(b) - apex).cross(at(c) - apex)) / 6,
                   area = area_vector(welded_[t].ids).norm();
      volumes_[cells_.sides[t][0]] += volume;
      volumes_[cells_.sides[t][1]] -= volume;
      for (const Index cell : cells_.sides[t]) {
        areas_[cell] += area;
        if (area > largest[cell]) largest[cell] = area, places_[cell] = (at(a) + at(b) + at(c)) / 3;
      }
    }
  }

  void find_overlaps() {
    struct Volumes {
      double both = 0, first_only = 0, second_only = 0, largest = -1, area = 0;
      Vec3 place = Vec3::Zero();
    };
    std::map<std::pair<std::size_t, std::size_t>, Volumes> pairs;
    for (Index c = 0; c < cells_.count; ++c)
      for (std::size_t a = 0; a < bodies_; ++a)
        for (std::size_t b = a + 1; b < bodies_ && volumes_[c] > 0 && windings_[c][a] > 0; ++b) {
          if (windings_[c][b] <= 0) continue;
          Volumes& v = pairs[{a, b}];
          v.both += volumes_[c];
          v.area += areas_[c];
          if (volumes_[c] > v.largest) v.largest = volumes_[c], v.place = places_[c];
        }
    for (auto& [pair, v] : pairs) {
      const auto [a, b] = pair;
      for (Index c = 0; c < cells_.count; ++c) {
        if (!(volumes_[c] > 0)) continue;
        if (windings_[c][a] > 0 && windings_[c][b] <= 0) v.first_only += volumes_[c];
        if (windings_[c][b] > 0 && windings_[c][a] <= 0) v.second_only += volumes_[c];
      }
      const double smallest = tolerance_ * v.area;
      if (v.both > smallest && v.first_only > smallest && v.second_only > smallest)
        result_.overlaps.push_back({a, b, v.both, v.place});
    }
  }

  bool cross(std::size_t a, std::size_t b) const {
    return std::any_of(result_.overlaps.begin(), result_.overlaps.end(),
                       [&](const BodyOverlap& o) { return o.first == a && o.second == b; });
  }

  /// The bodies that have a cell, ascending: more than one only with OverlapRule::material.
  std::vector<std::size_t> owners(Index cell) const {
    std::vector<std::size_t> owners;
    for (std::size_t b = 0; b < bodies_; ++b) {
      if (windings_[cell][b] <= 0) continue;
      const auto crosses = [&](std::size_t a) { return cross(a, b); };
      if (rule_ == OverlapRule::first && std::any_of(owners.begin(), owners.end(), crosses)) continue;
      std::erase_if(owners, [&](std::size_t a) { return rule_ != OverlapRule::material || !crosses(a); });
      owners.push_back(b);
    }
    return owners;
  }

  void label_cells() {
    labels_.assign(cells_.count, outside_region);
    std::map<std::vector<std::size_t>, RegionIndex> common;
    for (Index c = 0; c < cells_.count; ++c) {
      const std::vector<std::size_t> owners = this->owners(c);
      if (owners.size() == 1) labels_[c] = static_cast<RegionIndex>(owners[0] + 1);
      if (owners.size() < 2) continue;
      const auto [known, is_new] =
          common.try_emplace(owners, static_cast<RegionIndex>(bodies_ + 1 + result_.common.size()));
      if (is_new) result_.common.push_back(owners);
      labels_[c] = known->second;
    }
  }

  /// Gives cells that are thinner than the tolerance to the neighbour with the largest common area.
  void dissolve_thin_cells() {
    std::map<Index, std::map<RegionIndex, double>> beside;
    const auto is_thin = [&](Index c) {
      return std::abs(volumes_[c]) < ComplexTuning::Cells::thin_share * tolerance_ * areas_[c];
    };
    for (Index t = 0; t < welded_.size(); ++t) {
      const auto [behind, front] = cells_.sides[t];
      const double area = area_vector(welded_[t].ids).norm();
      if (is_thin(behind)) beside[behind][labels_[front]] += area;
      if (is_thin(front)) beside[front][labels_[behind]] += area;
    }
    for (const auto& [cell, neighbours] : beside) {
      const RegionIndex to =
          std::max_element(neighbours.begin(), neighbours.end(), [](const auto& a, const auto& b) {
            return a.second < b.second;
          })->first;
      labels_[cell] = to;
    }
  }

  /// Whether a body contains a cell that it does not lose to an earlier one (OverlapRule::first).
  bool keeps(std::size_t body, Index cell) const {
    if (windings_[cell][body] <= 0) return false;
    for (std::size_t a = 0; a < body; ++a)
      if (windings_[cell][a] > 0 && cross(a, body)) return false;
    return true;
  }

  void assemble() {
    LabelledComplex& out = result_.complex;
    const std::size_t surfaces = bodies_ + result_.common.size();
    result_.body_triangles.resize(surfaces);
    result_.body_sources.resize(surfaces);
    result_.lost.assign(surfaces, 1);
    const auto add_triangle = [&](std::size_t body, Triangle ids, bool turned, Index source) {
      if (turned) std::swap(ids[1], ids[2]);
      result_.body_triangles[body].push_back(ids);
      result_.body_sources[body].push_back(source);
    };
    out.points = imprinted_.points;
    out.starts_.push_back(0);
    for (Index t = 0; t < welded_.size(); ++t) {
      const std::size_t first = out.sources_.size();
      const auto [back_cell, front_cell] = cells_.sides[t];
      const RegionIndex behind = labels_[back_cell], front = labels_[front_cell];
      for (const Use& u : uses(t)) {
        if (is_sheet(u)) continue;
        if (rule_ == OverlapRule::first && keeps(u.body, back_cell) == keeps(u.body, front_cell)) continue;
        out.sources_.push_back({u.body, static_cast<Index>(result_.body_triangles[u.body].size()), u.turned});
        add_triangle(u.body, welded_[t].ids, u.turned, u.source);
      }
      add_sheet(t, behind, front);
      // The part that an earlier body keeps bounds the later one, too.
      for (std::size_t b = 0; b < bodies_ && rule_ == OverlapRule::first; ++b)
        if (windings_[back_cell][b] > 0 && windings_[front_cell][b] > 0 &&
            keeps(b, back_cell) != keeps(b, front_cell))
          add_triangle(b, welded_[t].ids, keeps(b, front_cell), no_index);
      for (std::size_t b = bodies_; b < surfaces; ++b)
        if (const auto own = static_cast<RegionIndex>(b + 1); (behind == own) != (front == own))
          add_triangle(b, welded_[t].ids, front == own, no_index);
      if (behind == front) {
        out.sources_.resize(first);
        continue;
      }
      out.faces.push_back({welded_[t].ids, behind, front});
      out.starts_.push_back(out.sources_.size());
      for (const RegionIndex r : {behind, front})
        if (r != outside_region) result_.lost[r - 1u] = 0;
    }
    find_contacts();
    std::vector<Triangle> triangles;
    for (const LabelledComplex::Face& f : out.faces) triangles.push_back(f.ids);
    for (const LabelledComplex::SheetFace& f : out.sheets) triangles.push_back(f.ids);
    const std::vector<EdgeUse> edges = edge_uses(triangles, {});
    const auto pair_of = [&](Index f) { return std::minmax(out.faces[f].behind, out.faces[f].front); };
    DisjointSets components(out.sheets.size());
    for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
      while (j < edges.size() && edges[j].key == edges[i].key) ++j;
      // Faces come before sheets.
      std::size_t faces = 0;
      bool plain = true;
      for (; i + faces < j && edges[i + faces].triangle < out.faces.size(); ++faces)
        plain &= pair_of(edges[i + faces].triangle) == pair_of(edges[i].triangle);
      const std::size_t sheets = j - i - faces;
      if (faces > 0 && (faces != 2 || sheets > 0 || !plain)) out.junctions_.push_back(ends_of(edges[i].key));
      const auto sheet_face = [&](std::size_t k) {
        return static_cast<Index>(edges[k].triangle - out.faces.size());
      };
      if (sheets == 2 && part_of_[sheet_face(j - 2)] == part_of_[sheet_face(j - 1)])
        components.unite(sheet_face(j - 2), sheet_face(j - 1));
    }
    std::vector<std::uint32_t> number(out.sheets.size());
    for (Index f = 0; f < out.sheets.size(); ++f) {
      const Index root = components.root(f);  // the smallest
      if (root == f) number[f] = out.sheet_components++;
      out.sheets[f].component = number[root];
    }
  }

  /// Adds a triangle of a sheet unless it is outside or on a face.
  void add_sheet(Index t, RegionIndex behind, RegionIndex front) {
    const auto first =
        std::find_if(uses(t).begin(), uses(t).end(), [&](const Use& u) { return is_sheet(u); });
    if (first == uses(t).end()) return;
    const Triangle& ids = welded_[t].ids;
    const double area = area_vector(ids).norm();
    const Vec3 centre = (at(ids[0]) + at(ids[1]) + at(ids[2])) / 3;
    result_.sheets.resize(sheets_.count);
    for (auto u = first; u != uses(t).end(); ++u) {
      SheetFate& fate = result_.sheets[sheets_.sheet[u->source]];
      if (behind != front)
        fate.on_faces.add(area, centre);
      else if (behind == outside_region)
        fate.outside.add(area, centre);
      else if (u != first)
        fate.repeated.add(area, centre);
      else
        fate.kept += area;
    }
    if (behind != front || behind == outside_region) return;
    LabelledComplex::SheetFace face{ids, behind, sheets_.sheet[first->source], 0};
    if (first->turned) std::swap(face.ids[1], face.ids[2]);
    result_.complex.sheets.push_back(face);
    part_of_.push_back(first->body);
  }

  /// Measures how far a body's surface has moved to a contact: outwards over a gap, inwards over an overlap.
  void measure_gap(const LabelledComplex::Source& source, const Triangle& face, BodyContact& contact) const {
    const Triangle& original = soup_.triangles[result_.body_sources[source.body][source.triangle]];
    const Vec3& corner = soup_.points[original[0]];
    const Vec3 normal = (soup_.points[original[1]] - corner).cross(soup_.points[original[2]] - corner);
    for (const Index p : face) {
      const double moved = normal.dot(at(p) - corner) / normal.norm();
      if (std::abs(moved) < ComplexTuning::Contact::min_gap * tolerance_) continue;
      contact.largest_gap = std::max(contact.largest_gap, moved);
      contact.largest_overlap = std::max(contact.largest_overlap, -moved);
    }
  }

  /// Compares the volumes of the bodies with those before imprinting.
  void find_torn() {
    if (rule_ == OverlapRule::first || soup_.points.empty()) return;
    std::vector<double> change(bodies_, 0), area(bodies_, 0), contact(bodies_, 0);
    const Vec3& apex = soup_.points[0];
    const auto six_volumes = [&](const std::vector<Vec3>& points, const Triangle& t) {
      return (points[t[0]] - apex).dot((points[t[1]] - apex).cross(points[t[2]] - apex));
    };
    for (std::size_t t = 0; t < soup_.triangles.size(); ++t) {
      if (soup_.surface[t] >= bodies_) continue;
      const auto& [a, b, c] = soup_.triangles[t];
      change[soup_.surface[t]] -= six_volumes(soup_.points, soup_.triangles[t]) / 6;
      area[soup_.surface[t]] +=
          (soup_.points[b] - soup_.points[a]).cross(soup_.points[c] - soup_.points[a]).norm() / 2;
    }
    for (std::size_t b = 0; b < bodies_; ++b)
      for (const Triangle& t : result_.body_triangles[b]) change[b] += six_volumes(imprinted_.points, t) / 6;
    for (const BodyContact& c : result_.contacts) {
      if (c.first < bodies_) contact[c.first] += c.area;
      if (c.second < bodies_) contact[c.second] += c.area;
    }
    for (std::size_t b = bodies_; b-- > 0;)
      if (std::abs(change[b]) > tolerance_ * (ComplexTuning::Contact::moved_contact * contact[b] +
                                              ComplexTuning::Contact::moved_area * area[b]))
        result_.torn = b;
  }

  void find_contacts() {
    const LabelledComplex& complex = result_.complex;
    std::map<std::pair<std::size_t, std::size_t>, std::vector<Index>> faces;
    for (Index f = 0; f < complex.faces.size(); ++f)
      if (complex.is_contact(f)) {
        const auto [low, high] = std::minmax(complex.faces[f].behind, complex.faces[f].front);
        faces[{low - 1u, high - 1u}].push_back(f);
      }
    for (const auto& [pair, list] : faces) {
      BodyContact contact{pair.first, pair.second};
      std::vector<Triangle> triangles;
      for (const Index f : list) {
        triangles.push_back(complex.faces[f].ids);
        contact.area += area_vector(triangles.back()).norm();
        for (const LabelledComplex::Source& s : complex.sources(f)) measure_gap(s, triangles.back(), contact);
      }
      DisjointSets sets(list.size());
      const std::vector<EdgeUse> edges = edge_uses(triangles, {});
      for (std::size_t i = 1; i < edges.size(); ++i)
        if (edges[i].key == edges[i - 1].key) sets.unite(edges[i].triangle, edges[i - 1].triangle);
      for (Index i = 0; i < list.size(); ++i) contact.pieces += sets.is_root(i);
      result_.contacts.push_back(contact);
    }
  }

  const ImprintedSurfaces& imprinted_;
  const SurfaceSoup& soup_;
  std::size_t bodies_;
  double tolerance_;
  OverlapRule rule_;
  const SoupSheets& sheets_;
  Progress* progress_;
  ComplexResult result_;
  std::vector<std::uint32_t> part_of_;  ///< surface of the soup of each face of a sheet
  std::vector<Welded> welded_;
  std::vector<Use> uses_;
  SurfaceCells cells_;
  std::vector<std::vector<int>> windings_;  ///< by cell and body
  std::vector<RegionIndex> labels_;         ///< by cell, as are the following
  std::vector<double> volumes_, areas_;
  std::vector<Vec3> places_;  ///< on its largest triangle
};

ComplexResult build_complex(const ImprintedSurfaces& imprinted, const SurfaceSoup& soup, std::size_t bodies,
                            double tolerance, OverlapRule rule, const SoupSheets& sheets,
                            Progress* progress) {
  return ComplexBuilder(imprinted, soup, bodies, tolerance, rule, sheets, progress).build();
}

}  // namespace tetwright

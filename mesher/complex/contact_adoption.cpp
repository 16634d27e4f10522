// SPDX-License-Identifier: Apache-2.0
#include "mesher/complex/contact_adoption.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include "common/features/edge_uses.h"
#include "common/mesh/disjoint_sets.h"
#include "mesher/complex/imprint_state.h"
#include "mesher/complex/laid_curves.h"
#include "mesher/complex/triangle_places.h"
#include "mesher/complex/triangle_subdivision.h"
#include "mesher/tuning/complex_tuning.h"

namespace tetwright {

namespace {

using Adoption = ComplexTuning::Adoption;
using DirectedEdge = std::array<Index, 2>;

DirectedEdge reversed(const DirectedEdge& e) { return {e[1], e[0]}; }

/// Triangles of one surface.
struct Part {
  std::vector<Triangle> triangles;
  std::vector<Index> source;

  void add(const Triangle& t, Index of) {
    triangles.push_back(t);
    source.push_back(of);
  }
};

/// A connected part of the later surface within the tolerance of the earlier one.
struct Contact {
  std::vector<Index> triangles;
  std::vector<std::size_t> border;  ///< segments of the rim
  double area = 0;
  double facing = 0;  ///< above 0: most of it faces as the earlier surface does
};

/// Replaces the contacts of one surface with an earlier one.
class PairAdopter {
 public:
  PairAdopter(std::vector<Vec3>& points, const Part& earlier, const Part& later, double tolerance)
      : points_(points), earlier_(earlier), later_(later), tolerance_(tolerance) {}

  /// \return false if both surfaces stay as they are
  bool run() {
    if (!find_contacts() || !find_rim()) return false;
    const auto laid = lay_curves(rim_, earlier_.triangles, tolerance_, points_);
    if (!laid) return false;
    for (std::size_t t = 0; t < laid->triangles.size(); ++t)
      new_earlier_.add(laid->triangles[t], earlier_.source[laid->source[t]]);
    list_edges();
    for (const Contact& contact : contacts_)
      if (!fill(contact, *laid)) return false;
    return keep_rest(*laid) && is_closed(new_later_);
  }

  Part take_earlier() { return std::move(new_earlier_); }
  Part take_later() { return std::move(new_later_); }

 private:
  const Vec3& at(Index p) const { return points_[p]; }
  Vec3 normal(const Triangle& t) const { return (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0])); }
  Vec3 centre(const Triangle& t) const { return (at(t[0]) + at(t[1]) + at(t[2])) / 3; }

  /// Whether the corners, the middles of edges and the centre are within the tolerance.
  bool is_near(const Triangle& t, const TrianglePlaces& places) const {
    const auto near = [&](const Vec3& p) { return places.nearest(p, tolerance_).has_value(); };
    for (const Index p : t)
      if (!near(at(p))) return false;
    for (std::size_t k = 0; k < 3; ++k)
      if (!near((at(t[k]) + at(t[(k + 1) % 3])) / 2)) return false;
    return near(centre(t));
  }

  bool find_contacts() {
    const TrianglePlaces places(points_, earlier_.triangles);
    contact_of_.assign(later_.triangles.size(), no_contact);
    std::vector<char> near(later_.triangles.size(), 0);
    for (Index t = 0; t < near.size(); ++t) near[t] = is_near(later_.triangles[t], places) ? 1 : 0;
    uses_ = edge_uses(later_.triangles, {});
    DisjointSets sets(near.size());
    for (std::size_t i = 1; i < uses_.size(); ++i)
      if (uses_[i].key == uses_[i - 1].key && near[uses_[i].triangle] && near[uses_[i - 1].triangle])
        sets.unite(uses_[i].triangle, uses_[i - 1].triangle);
    std::map<Index, Contact> found;
    for (Index t = 0; t < near.size(); ++t) {
      if (!near[t]) continue;
      Contact& own = found[sets.root(t)];
      const Vec3 size = normal(later_.triangles[t]);
      const auto place = places.nearest(centre(later_.triangles[t]), tolerance_);
      own.triangles.push_back(t);
      own.area += size.norm() / 2;
      own.facing += size.dot(normal(earlier_.triangles[place->triangle]).normalized());
    }
    for (auto& [root, contact] : found) {
      if (contact.area < Adoption::min_area * tolerance_ * tolerance_) continue;
      for (const Index t : contact.triangles) contact_of_[t] = contacts_.size();
      contacts_.push_back(std::move(contact));
    }
    return !contacts_.empty();
  }

  /// Lists the edges between contacts and the rest, as triangles of the rest run along them.
  bool find_rim() {
    std::map<Index, Index> number;
    const auto numbered = [&](Index p) {
      const auto [known, is_new] = number.insert({p, static_cast<Index>(rim_.points.size())});
      if (is_new) rim_.points.push_back(at(p)), rim_points_.push_back(p);
      return known->second;
    };
    for (std::size_t i = 0, j = 0; i < uses_.size(); i = j) {
      while (j < uses_.size() && uses_[j].key == uses_[i].key) ++j;
      std::set<std::size_t> own;
      for (std::size_t k = i; k < j; ++k) own.insert(contact_of_[uses_[k].triangle]);
      if (own.size() == 1) continue;
      // Contacts are connected across all edges of two triangles.
      if (j - i != 2) return false;
      const EdgeUse& rest = uses_[contact_of_[uses_[i].triangle] == no_contact ? i : i + 1];
      auto [a, b] = ends_of(rest.key);
      if (!rest.ascending) std::swap(a, b);
      contacts_[*own.begin()].border.push_back(rim_.segments.size());
      segment_of_[{a, b}] = rim_.segments.size();
      const Index first = numbered(a);
      rim_.segments.push_back({first, numbered(b)});
    }
    return std::none_of(contacts_.begin(), contacts_.end(),
                        [](const Contact& c) { return c.border.empty(); });
  }

  void list_edges() {
    for (Index t = 0; t < new_earlier_.triangles.size(); ++t) {
      const Triangle& ids = new_earlier_.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [known, is_new] = at_edge_.insert({{ids[k], ids[(k + 1) % 3]}, t});
        if (!is_new) known->second = no_index;
      }
    }
    is_used_.assign(new_earlier_.triangles.size(), 0);
  }

  /// Fills a contact's border with triangles of the earlier surface.
  bool fill(const Contact& contact, const LaidCurves& laid) {
    const bool turned = contact.facing < 0;
    std::set<DirectedEdge> border;  // as the earlier surface's triangles run along it
    for (const std::size_t s : contact.border) {
      const std::vector<Index>& chain = laid.chains[s];
      for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
        DirectedEdge e{chain[i], chain[i + 1]};
        if (!turned) e = reversed(e);
        // Where the border runs back along itself, nothing is enclosed.
        if (border.erase(reversed(e)) == 0 && !border.insert(e).second) return false;
      }
    }
    std::vector<Index> found;
    const auto add = [&](const DirectedEdge& e) {
      const auto known = at_edge_.find(e);
      if (known == at_edge_.end() || known->second == no_index) return false;
      if (is_used_[known->second] == 0) found.push_back(known->second);
      is_used_[known->second] = 1;
      return true;
    };
    for (const DirectedEdge& e : border)
      if (!add(e)) return false;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const Triangle& ids = new_earlier_.triangles[found[i]];
      for (std::size_t k = 0; k < 3; ++k) {
        const DirectedEdge e{ids[k], ids[(k + 1) % 3]};
        if (border.contains(e)) continue;
        if (border.contains(reversed(e)) || !add(reversed(e))) return false;
      }
    }
    return take(found, contact, turned);
  }

  /// Gives the later surface triangles of the earlier one, unless they are not where the contact was.
  bool take(const std::vector<Index>& found, const Contact& contact, bool turned) {
    Part old;
    for (const Index t : contact.triangles) old.add(later_.triangles[t], later_.source[t]);
    const TrianglePlaces places(points_, old.triangles);
    const double reach = Adoption::reach * tolerance_;
    for (const Index t : found) {
      Triangle ids = new_earlier_.triangles[t];
      const auto place = places.nearest(centre(ids), reach);
      if (!place) return false;
      for (const Index p : ids)
        if (!places.nearest(at(p), reach)) return false;
      if (turned) std::swap(ids[1], ids[2]);
      new_later_.add(ids, old.source[place->triangle]);
    }
    return true;
  }

  /// Adds the later surface's other triangles, divided at the points of the rim.
  bool keep_rest(const LaidCurves& laid) {
    std::map<Index, Index> moved;
    for (std::size_t i = 0; i < rim_points_.size(); ++i) moved[rim_points_[i]] = laid.points[i];
    for (Index t = 0; t < later_.triangles.size(); ++t) {
      if (contact_of_[t] != no_contact) continue;
      const Triangle& old = later_.triangles[t];
      Triangle ids = old;
      for (Index& p : ids)
        if (const auto known = moved.find(p); known != moved.end()) p = known->second;
      if (ids[0] == ids[1] || ids[1] == ids[2] || ids[2] == ids[0]) continue;
      TriangleSubdivision division(ids, {at(ids[0]), at(ids[1]), at(ids[2])});
      for (std::size_t k = 0; k < 3; ++k) {
        const auto segment = segment_of_.find({old[k], old[(k + 1) % 3]});
        if (segment == segment_of_.end()) continue;
        const std::vector<Index>& chain = laid.chains[segment->second];
        double last = 0;
        for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
          const double share = foot_on(at(chain[i]), at(chain.front()), at(chain.back())).first;
          if (chain[i] == ids[(k + 2) % 3] || share - last < Adoption::min_share) return false;
          last = share;
          division.add_on_edge(static_cast<int>(k), share, chain[i], at(chain[i]));
        }
      }
      for (const Triangle& part : division.triangles()) new_later_.add(part, later_.source[t]);
    }
    return true;
  }

  static bool is_closed(const Part& part) {
    const std::vector<EdgeUse> uses = edge_uses(part.triangles, {});
    for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
      int sum = 0;
      for (; j < uses.size() && uses[j].key == uses[i].key; ++j) sum += uses[j].ascending ? 1 : -1;
      if (sum != 0) return false;
    }
    return true;
  }

  static constexpr std::size_t no_contact = static_cast<std::size_t>(-1);

  std::vector<Vec3>& points_;
  const Part &earlier_, &later_;
  double tolerance_;
  std::vector<EdgeUse> uses_;  ///< of the later surface
  std::vector<Contact> contacts_;
  std::vector<std::size_t> contact_of_;  ///< by triangle of the later surface
  NearCurves rim_;
  std::vector<Index> rim_points_;  ///< of the rim: the later surface's points
  std::map<DirectedEdge, std::size_t> segment_of_;
  std::map<DirectedEdge, Index> at_edge_;  ///< triangles of the new earlier surface; no_index for several
  std::vector<char> is_used_;              ///< by triangle of the new earlier surface
  Part new_earlier_, new_later_;
};

Box3 box_of(const std::vector<Vec3>& points, const Part& part) {
  Box3 box;
  for (const Triangle& t : part.triangles)
    for (const Index p : t) box.add(points[p]);
  return box;
}

}  // namespace

AdoptedContacts adopt_contacts(const SurfaceSoup& soup, std::size_t bodies, double tolerance,
                               Progress* progress) {
  AdoptedContacts out;
  out.soup.points = soup.points;
  std::map<std::uint32_t, Part> parts;
  for (Index t = 0; t < soup.triangles.size(); ++t) parts[soup.surface[t]].add(soup.triangles[t], t);
  for (auto& [b, later] : parts)
    for (auto& [a, earlier] : parts) {
      if (a >= b || b >= bodies) break;
      if (progress) progress->throw_if_stopped();
      Box3 box = box_of(out.soup.points, earlier);
      box.low -= Vec3::Constant(tolerance);
      box.high += Vec3::Constant(tolerance);
      if (!box.intersects(box_of(out.soup.points, later))) continue;
      PairAdopter adopter(out.soup.points, earlier, later, tolerance);
      if (!adopter.run()) continue;
      earlier = adopter.take_earlier();
      later = adopter.take_later();
      out.any = true;
    }
  for (const auto& [surface, part] : parts) {
    out.soup.triangles.insert(out.soup.triangles.end(), part.triangles.begin(), part.triangles.end());
    out.soup.surface.insert(out.soup.surface.end(), part.triangles.size(), surface);
    out.source.insert(out.source.end(), part.source.begin(), part.source.end());
  }
  return out;
}

std::optional<ImprintedSurfaces> imprint_adopted(const SurfaceSoup& soup, std::size_t bodies,
                                                 double tolerance, Progress* progress) {
  const AdoptedContacts adopted = adopt_contacts(soup, bodies, tolerance, progress);
  if (!adopted.any) return {};
  ImprintedSurfaces imprinted = imprint_surfaces(adopted.soup, tolerance, progress);
  if (imprinted.unresolved) return {};
  for (Index& t : imprinted.source) t = adopted.source[t];
  imprinted.any = true;
  return imprinted;
}

}  // namespace tetwright

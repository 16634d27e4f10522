#include "simplify/link_condition.h"

#include <algorithm>

namespace tetwright {

namespace {

/// What the link of b says about a link point of a.
struct Common {
  bool seen = false;              ///< b and it are joined by an edge
  bool with_ab = false;           ///< a, b and it are in one tet
  std::uint16_t sheets = 0;       ///< interface triangles at the edge from b to it
  std::uint16_t boundary = 0;     ///< of those, the ones with outside on one side
  bool sheet_with_ab = false;     ///< (a, b, it) is an interface triangle
  bool boundary_with_ab = false;  ///< (a, b, it) is a boundary triangle
};

bool junction(std::uint16_t sheets) { return sheets != 0 && sheets != 2; }

}  // namespace

bool link_condition(const EditableMesh& mesh, const Star& star, std::size_t b, LocalNumbers& numbers) {
  const std::size_t n = star.points.size();
  const Index a_id = star.centre, b_id = star.points[b];
  thread_local std::vector<Common> common;
  thread_local std::vector<std::uint16_t> boundary_at_a;
  thread_local std::vector<Index> walk;
  common.assign(n, {});
  boundary_at_a.assign(n, 0);

  bool a_on_boundary = false, a_on_junction = false;
  for (const Star::Sheet& s : star.sheets) {
    const bool outside = s.across == beyond_mesh;
    a_on_boundary |= outside;
    if (outside) {
      ++boundary_at_a[s.first];
      ++boundary_at_a[s.second];
    }
    if (s.first != b && s.second != b) continue;
    Common& c = common[s.first == b ? s.second : s.first];
    c.sheet_with_ab = true;
    c.boundary_with_ab |= outside;
  }
  for (std::size_t p = 0; p < n; ++p) a_on_junction |= junction(star.sheet_count[p]);

  // Tets and triangles of a's link, to be looked for in b's: local numbers by id.
  thread_local LocalNumbers local_of_a;
  local_of_a.clear();
  bool added;
  for (Index p : star.points) local_of_a.number(p, added);

  // Walk the star of b, beginning at a tet of the edge ab.
  numbers.clear();
  walk.clear();
  for (const Star::StarTet& t : star.tets)
    if (t.link[0] == b || t.link[1] == b || t.link[2] == b) {
      numbers.number(t.tet, added);
      walk.push_back(t.tet);
      break;
    }
  bool b_on_boundary = false;
  // Sheets at edges from b to points that a's link does not have: only whether b lies on a junction curve
  // matters.
  thread_local LocalNumbers foreign;
  thread_local std::vector<std::uint16_t> foreign_sheets;
  foreign.clear();
  foreign_sheets.clear();
  const auto count_sheet = [&](Index p, bool outside) {
    if (p == a_id) return;
    if (const std::uint32_t k = local_of_a.find(p); k != no_index) {
      ++common[k].sheets;
      common[k].boundary += outside;
      return;
    }
    bool fresh;
    const std::uint32_t k = foreign.number(p, fresh);
    if (fresh) foreign_sheets.push_back(0);
    ++foreign_sheets[k];
  };
  for (std::size_t i = 0; i < walk.size(); ++i) {
    if (walk.size() > 4 * Star::most_points) return false;  // a star too large to judge
    const Index t = walk[i];
    const TetRecord& r = mesh.tet(t);
    const int slot = mesh.slot_of(t, b_id);
    bool has_a = false;
    for (Index p : r.points) has_a |= p == a_id;
    std::array<std::uint32_t, 3> link;
    int in_a = 0, m = 0;
    for (int k = 0; k < 4; ++k) {
      if (k == slot) continue;
      const Index p = r.points[k];
      link[m] = p == a_id ? no_index : local_of_a.find(p);
      if (link[m] != no_index) {
        common[link[m]].seen = true;
        common[link[m]].with_ab |= has_a;
        ++in_a;
      }
      ++m;
    }
    for (int k = 0; k < 4; ++k) {
      if (k == slot) continue;
      const Index other = r.neighbours[k];
      if (other != no_index) {
        numbers.number(other, added);
        if (added) walk.push_back(other);
        if (mesh.tet(other).region == r.region || other < t) continue;
      }
      const bool outside = other == no_index;
      b_on_boundary |= outside;
      for (int j = 0; j < 4; ++j)
        if (j != slot && j != k) count_sheet(r.points[j], outside);
    }
    // An edge or triangle of b's link that is in a's link too, but not in the link of ab.
    if (has_a || in_a < 2) continue;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t x = link[k], y = link[(k + 1) % 3];
      if (x == no_index || y == no_index) continue;
      bool edge_in_a = false, edge_with_ab = false;
      for (const Star::StarTet& s : star.tets) {
        int hits = 0;
        bool has_b = false;
        for (std::uint16_t p : s.link) {
          hits += p == x || p == y;
          has_b |= p == b;
        }
        edge_in_a |= hits == 2;
        edge_with_ab |= hits == 2 && has_b;
      }
      if (edge_in_a && !edge_with_ab) return false;
    }
    if (in_a == 3)
      for (const Star::StarTet& s : star.tets) {
        int hits = 0;
        for (std::uint16_t p : s.link) hits += p == link[0] || p == link[1] || p == link[2];
        if (hits == 3) return false;
      }
  }

  bool b_on_junction = junction(star.sheet_count[b]);
  for (std::uint16_t sheets : foreign_sheets) b_on_junction |= junction(sheets);
  for (std::size_t p = 0; p < n; ++p) b_on_junction |= p != b && junction(common[p].sheets);

  // omega, and the edges of the links that end in it.
  if (a_on_boundary && b_on_boundary && boundary_at_a[b] == 0) return false;
  const bool ab_on_interface = star.sheet_count[b] != 0;
  const bool ab_on_junction = junction(star.sheet_count[b]);
  if (ab_on_interface && a_on_junction && b_on_junction && !ab_on_junction) return false;
  for (std::size_t p = 0; p < n; ++p) {
    if (p == b || !common[p].seen) continue;
    const Common& c = common[p];
    if (!c.with_ab) return false;
    if (boundary_at_a[p] != 0 && c.boundary != 0 && !c.boundary_with_ab) return false;
    if (ab_on_interface) {
      if (star.sheet_count[p] != 0 && c.sheets != 0 && !c.sheet_with_ab) return false;
      if (junction(star.sheet_count[p]) && junction(c.sheets)) return false;
    }
  }
  // Interface and boundary triangles on the same two points: {x, y} in both links of I, {x, y, omega} in both
  // of K.
  for (const Star::Sheet& s : star.sheets) {
    if (s.first == b || s.second == b) continue;
    const bool outside = s.across == beyond_mesh;
    if (!ab_on_interface && !outside) continue;
    if (common[s.first].sheets == 0 || common[s.second].sheets == 0) continue;
    // Is (b, first, second) an interface triangle?
    for (Index t : walk) {
      const TetRecord& r = mesh.tet(t);
      int slot_k = -1;
      int hits = 0;
      for (int k = 0; k < 4; ++k) {
        const Index p = r.points[k];
        if (p == b_id || p == star.points[s.first] || p == star.points[s.second]) {
          ++hits;
        } else {
          slot_k = k;
        }
      }
      if (hits == 3 && mesh.region_across(t, slot_k) != r.region) return false;
    }
  }
  return true;
}

}  // namespace tetwright

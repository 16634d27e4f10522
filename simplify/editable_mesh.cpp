#include "simplify/editable_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "common/error.h"
#include "common/morton.h"
#include "common/parallel.h"
#include "common/parallel_sort.h"
#include "common/predicates.h"

namespace tetwright {

namespace {

constexpr std::size_t grain = 8192;  ///< tets or points a parallel loop hands out at a time

/// Slots that a task takes from the common reserve at once: few enough to waste little, enough to seldom
/// meet.
constexpr std::size_t slot_lot = 64;

/// Face `f` of a tet, ids ascending.
Triangle sorted_face(const Tet& t, int f) {
  const auto& c = tet_faces[f];
  Triangle s{t[c[0]], t[c[1]], t[c[2]]};
  if (s[0] > s[1]) std::swap(s[0], s[1]);
  if (s[1] > s[2]) std::swap(s[1], s[2]);
  if (s[0] > s[1]) std::swap(s[0], s[1]);
  return s;
}

/// True if the face's outward listing is an even permutation of its ascending one.
bool even_face(const Tet& t, int f) {
  const auto& c = tet_faces[f];
  const Index a = t[c[0]], b = t[c[1]], d = t[c[2]];
  return (a < b) + (b < d) + (d < a) == 2;
}

/// Whether a - b is exact (the error term of Knuth's two-sum).
bool exact_difference(double a, double b) {
  const double x = a - b, b_virtual = a - x, a_virtual = x + b_virtual;
  return (b_virtual - b) + (a - a_virtual) == 0;
}

/// The first place in the file is named, whichever thread finds it.
void lower(std::atomic<Index>& smallest, Index value) {
  Index known = smallest.load();
  while (value < known && !smallest.compare_exchange_weak(known, value)) {
  }
}

std::string place(const Vec3& p) {
  return "(" + std::to_string(p.x()) + ", " + std::to_string(p.y()) + ", " + std::to_string(p.z()) + ")";
}

}  // namespace

EditableMesh::EditableMesh(TetMesh&& mesh, const std::string& name) {
  const std::size_t tets = mesh.tets.size();
  // Faces are numbered 4 * tet + face in 32 bits.
  if (tets >= no_index / 4)
    throw InputError(name, 0, std::to_string(tets) + " tets are more than the 2^30 possible");
  names_ = std::move(mesh.material_names);
  positions_ = std::move(mesh.points);

  for (const Vec3& p : positions_)
    if (!p.allFinite()) throw InputError(name, 0, "a coordinate is not finite");
  // Shifted to the lowest corner along each axis where no point loses a bit by it: a body far away then has
  // as many bits to move in as one at the origin, and one that was moved exactly gets the same working
  // coordinates.
  for (int axis = 0; axis < 3; ++axis) {
    double low = std::numeric_limits<double>::infinity();
    for (const Vec3& p : positions_) low = std::min(low, p[axis]);
    if (std::isfinite(low) && std::all_of(positions_.begin(), positions_.end(),
                                          [&](const Vec3& p) { return exact_difference(p[axis], low); }))
      shift_[axis] = low;
  }
  double largest = 0;
  for (const Vec3& p : positions_) largest = std::max(largest, (p - shift_).cwiseAbs().maxCoeff());
  if (!std::isfinite(largest)) throw InputError(name, 0, "coordinates are too far apart");
  if (largest > 0) scale_ = std::ldexp(1.0, -std::clamp(std::ilogb(largest), -1000, 1000));
  for (Vec3& p : positions_) p = (p - shift_) * scale_;

  tags_ = mesh.materials;
  std::sort(tags_.begin(), tags_.end());
  tags_.erase(std::unique(tags_.begin(), tags_.end()), tags_.end());

  tets_.resize(tets);
  std::atomic<Index> first_bad{no_index};
  parallel_for(0, tets, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Tet& t = mesh.tets[i];
      const auto region = std::lower_bound(tags_.begin(), tags_.end(), mesh.materials[i]) - tags_.begin();
      tets_[i] = {t, {no_index, no_index, no_index, no_index}, static_cast<Region>(region), 0};
      for (int k = 0; k < 4; ++k)
        for (int l = 0; l < k; ++l)
          if (t[k] == t[l]) lower(first_bad, static_cast<Index>(i));
    }
  });
  if (const Index bad = first_bad.load(); bad != no_index)
    throw InputError(name, 0,
                     "tet " + std::to_string(bad) + " has a point twice, at " +
                         place(to_input(positions_[mesh.tets[bad][0]])) +
                         "; `tetwright check` lists all of them");
  mesh = TetMesh();
  live_ = static_cast<std::int64_t>(tets);
  next_spare_ = tets;
  locks_.reset(positions_.size());
  next_spare_point_ = positions_.size();
  touched_.assign(positions_.size(), 0);
  link_faces(name);
  set_hints();
  split_stars();
}

/// Faces are put into buckets by their smallest point and paired within each: 16 bytes a tet at peak, where a
/// sort of all faces would take eight times as much.
void EditableMesh::link_faces(const std::string& name) {
  std::vector<Index> start(positions_.size() + 1, 0);
  for (const TetRecord& t : tets_)
    for (int f = 0; f < 4; ++f) ++start[sorted_face(t.points, f)[0] + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<Index> faces(tets_.size() * 4);
  {
    std::vector<Index> next(start.begin(), start.end() - 1);
    for (std::size_t t = 0; t < tets_.size(); ++t)
      for (int f = 0; f < 4; ++f)
        faces[next[sorted_face(tets_[t].points, f)[0]]++] = static_cast<Index>(4 * t + f);
  }
  std::atomic<Index> bad{no_index};
  parallel_for(0, positions_.size(), grain, [&](std::size_t begin, std::size_t end) {
    struct Entry {
      Index middle, largest, face;
    };
    std::vector<Entry> bucket;
    for (std::size_t p = begin; p < end; ++p) {
      bucket.clear();
      for (Index i = start[p]; i < start[p + 1]; ++i) {
        const Triangle s = sorted_face(tets_[faces[i] / 4].points, faces[i] % 4);
        bucket.push_back({s[1], s[2], faces[i]});
      }
      std::sort(bucket.begin(), bucket.end(), [](const Entry& a, const Entry& b) {
        return std::array{a.middle, a.largest, a.face} < std::array{b.middle, b.largest, b.face};
      });
      for (std::size_t i = 0; i < bucket.size();) {
        std::size_t j = i + 1;
        while (j < bucket.size() && bucket[j].middle == bucket[i].middle &&
               bucket[j].largest == bucket[i].largest)
          ++j;
        if (j - i == 2) {
          const Index s = bucket[i].face, u = bucket[i + 1].face;
          // Two positive tets on opposite sides of a face list it in opposite senses.
          if (even_face(tets_[s / 4].points, s % 4) == even_face(tets_[u / 4].points, u % 4)) lower(bad, s);
          tets_[s / 4].neighbours[s % 4] = u / 4;
          tets_[u / 4].neighbours[u % 4] = s / 4;
        } else if (j - i > 2) {
          lower(bad, bucket[i].face);
        }
        i = j;
      }
    }
  });
  if (const Index face = bad.load(); face != no_index) {
    const Triangle s = sorted_face(tets_[face / 4].points, face % 4);
    throw InputError(name, 0,
                     "the face of points " + std::to_string(s[0]) + ", " + std::to_string(s[1]) + ", " +
                         std::to_string(s[2]) + " at " + place(to_input(positions_[s[0]])) +
                         " has more than two tets, or two on one side; `tetwright check` lists all of them");
  }
}

void EditableMesh::set_hints() {
  hints_.assign(positions_.size(), no_index);
  for (std::size_t t = tets_.size(); t-- > 0;)
    if (tets_[t].points[0] != no_index)
      for (Index p : tets_[t].points) hints_[p] = static_cast<Index>(t);
}

void EditableMesh::split_stars() {
  std::vector<Index> split;  // points whose hint's part is not the whole star
  {
    std::vector<Index> tets_at(positions_.size(), 0);
    for (const TetRecord& t : tets_)
      for (Index p : t.points) ++tets_at[p];
    split = parallel_collect<Index>(0, positions_.size(), grain,
                                    [&](std::size_t begin, std::size_t end, std::vector<Index>& out) {
                                      LocalNumbers seen;
                                      std::vector<Index> part;
                                      for (std::size_t p = begin; p < end; ++p) {
                                        if (hints_[p] == no_index) continue;
                                        part_of_star(static_cast<Index>(p), hints_[p], seen, part);
                                        if (part.size() != tets_at[p]) out.push_back(static_cast<Index>(p));
                                      }
                                    });
  }
  // Tets that share more than one face (flawed files have such) are no complex to operate on: all their
  // points stay.
  std::vector<Index> glued;
  for (std::size_t t = 0; t < tets_.size(); ++t) {
    const auto& n = tets_[t].neighbours;
    for (int k = 0; k < 4; ++k)
      for (int l = 0; l < k; ++l)
        if (n[k] != no_index && n[k] == n[l]) glued.push_back(static_cast<Index>(t));
  }
  if (split.empty() && glued.empty()) return;
  std::vector<Index> pins = split;
  std::vector<std::vector<Index>> stars(split.size());
  for (std::size_t t = 0; t < tets_.size(); ++t)
    for (Index p : tets_[t].points) {
      const auto at = std::lower_bound(split.begin(), split.end(), p);
      if (at != split.end() && *at == p) stars[at - split.begin()].push_back(static_cast<Index>(t));
    }
  LocalNumbers seen;
  std::vector<Index> part;
  std::vector<std::array<Index, 2>> copies;  // and what they were split off from
  for (std::size_t i = 0; i < split.size(); ++i) {
    std::vector<Index>& left = stars[i];
    Index name = split[i];
    while (!left.empty()) {
      part_of_star(split[i], left.front(), seen, part);
      std::sort(part.begin(), part.end());
      std::vector<Index> others;
      std::set_difference(left.begin(), left.end(), part.begin(), part.end(), std::back_inserter(others));
      if (name != split[i]) {
        copies.push_back({name, split[i]});
        pins.push_back(name);
        positions_.push_back(positions_[split[i]]);
        hints_.push_back(no_index);
        for (Index t : part) tets_[t].points[slot_of(t, split[i])] = name;
      }
      hints_[name] = part.front();
      left = std::move(others);
      name = static_cast<Index>(positions_.size());
    }
  }
  touched_.assign(positions_.size(), 0);
  pinned_.assign(positions_.size(), 0);
  for (Index p : pins) pinned_[p] = 1;
  for (Index t : glued)
    for (Index p : tets_[t].points) pinned_[p] = 1;
  originals_.resize(positions_.size());
  std::iota(originals_.begin(), originals_.end(), Index{0});
  for (const auto& [copy, original] : copies) originals_[copy] = original;
  locks_.reset(positions_.size());
  next_spare_point_ = positions_.size();
}

std::size_t EditableMesh::pinned_points() const {
  std::size_t count = 0;
  for (Index p = 0; p < pinned_.size(); ++p) count += pinned_[p] && originals_[p] == p;
  return count;
}

void EditableMesh::part_of_star(Index point, Index first, LocalNumbers& seen,
                                std::vector<Index>& part) const {
  seen.clear();
  part.assign(1, first);
  bool added;
  seen.number(first, added);
  for (std::size_t i = 0; i < part.size(); ++i)
    for (int k = 0; k < 4; ++k) {
      const TetRecord& t = tets_[part[i]];
      if (t.points[k] == point || t.neighbours[k] == no_index) continue;
      seen.number(t.neighbours[k], added);
      if (added) part.push_back(t.neighbours[k]);
    }
}

bool EditableMesh::SlotStock::reserve(std::size_t count) {
  while (free_.size() < count) {
    const std::size_t total = mesh_->tets_.size();
    const std::size_t first = mesh_->next_spare_.fetch_add(slot_lot, std::memory_order_relaxed);
    if (first >= total) {
      mesh_->next_spare_.store(total, std::memory_order_relaxed);
      return false;
    }
    // Backwards, so that slots are taken in ascending order.
    for (std::size_t i = std::min(total, first + slot_lot); i-- > first;)
      free_.push_back(static_cast<Index>(i));
  }
  return true;
}

Index EditableMesh::SlotStock::take() {
  const Index slot = free_.back();
  free_.pop_back();
  return slot;
}

Index EditableMesh::PointStock::take() {
  if (free_.empty()) {
    const std::size_t total = mesh_->positions_.size();
    const std::size_t first = mesh_->next_spare_point_.fetch_add(slot_lot, std::memory_order_relaxed);
    if (first >= total) {
      mesh_->next_spare_point_.store(total, std::memory_order_relaxed);
      return no_index;
    }
    for (std::size_t i = std::min(total, first + slot_lot); i-- > first;)
      free_.push_back(static_cast<Index>(i));
  }
  const Index slot = free_.back();
  free_.pop_back();
  return slot;
}

void EditableMesh::compact(std::size_t spare, std::size_t spare_points) {
  // Points in Morton order of their place in the bounding box; those without a tet go.
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (std::size_t p = 0; p < positions_.size(); ++p)
    if (hints_[p] != no_index) {
      low = low.cwiseMin(positions_[p]);
      high = high.cwiseMax(positions_[p]);
    }
  const MortonGrid grid(low, high);
  struct Key {
    std::uint64_t morton;
    Index point;
  };
  std::vector<Key> keys;
  keys.reserve(positions_.size());
  for (std::size_t p = 0; p < positions_.size(); ++p)
    if (hints_[p] != no_index) keys.push_back({grid.key(positions_[p]), static_cast<Index>(p)});
  parallel_sort(keys, [](const Key& a, const Key& b) {
    return a.morton != b.morton ? a.morton < b.morton : a.point < b.point;
  });
  std::vector<Index> new_point(positions_.size(), no_index);
  {
    std::vector<Vec3> positions(keys.size() + spare_points, Vec3::Zero());
    for (std::size_t i = 0; i < keys.size(); ++i) {
      new_point[keys[i].point] = static_cast<Index>(i);
      positions[i] = positions_[keys[i].point];
    }
    positions_ = std::move(positions);
  }
  const std::size_t points = keys.size();
  keys = {};
  if (any_pinned()) {
    std::vector<std::uint8_t> pinned(positions_.size(), 0);
    for (std::size_t p = 0; p < new_point.size(); ++p)
      if (new_point[p] != no_index) pinned[new_point[p]] = pinned_[p];
    pinned_ = std::move(pinned);
    std::vector<Index> originals(positions_.size());
    std::iota(originals.begin(), originals.end(), Index{0});
    for (std::size_t p = 0; p < new_point.size(); ++p)
      if (new_point[p] != no_index)
        originals[new_point[p]] = new_point[originals_[p]];  // pinned points never go
    originals_ = std::move(originals);
  }

  // Tets by their first point in the new order: a counting sort.
  std::vector<Index> next(positions_.size() + 1, 0);
  const auto first_point = [&](const TetRecord& t) {
    return std::min(std::min(new_point[t.points[0]], new_point[t.points[1]]),
                    std::min(new_point[t.points[2]], new_point[t.points[3]]));
  };
  std::size_t live = 0;
  for (const TetRecord& t : tets_)
    if (t.points[0] != no_index) {
      ++next[first_point(t) + 1];
      ++live;
    }
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<Index> new_tet(tets_.size(), no_index);
  for (std::size_t t = 0; t < tets_.size(); ++t)
    if (tets_[t].points[0] != no_index) new_tet[t] = next[first_point(tets_[t])]++;

  std::vector<TetRecord> tets(live + spare);
  parallel_for(0, tets_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (new_tet[t] == no_index) continue;
      TetRecord r = tets_[t];
      for (Index& p : r.points) p = new_point[p];
      for (Index& n : r.neighbours)
        if (n != no_index) n = new_tet[n];
      tets[new_tet[t]] = r;
    }
  });
  for (std::size_t t = live; t < tets.size(); ++t)
    tets[t] = {{no_index, no_index, no_index, no_index}, {no_index, no_index, no_index, no_index}, 0, 0};
  tets_ = std::move(tets);
  live_ = static_cast<std::int64_t>(live);
  next_spare_ = live;
  next_spare_point_ = points;
  locks_.reset(positions_.size());
  touched_.assign(positions_.size(), 0);
  set_hints();
}

std::vector<EditableMesh::InterfaceFace> EditableMesh::interface_faces() const {
  return parallel_collect<InterfaceFace>(
      0, tets_.size(), grain, [&](std::size_t begin, std::size_t end, std::vector<InterfaceFace>& out) {
        for (std::size_t i = begin; i < end; ++i) {
          const auto t = static_cast<Index>(i);
          const TetRecord& r = tets_[t];
          if (r.points[0] == no_index) continue;
          for (int f = 0; f < 4; ++f) {
            const Index other = r.neighbours[f];
            if (other != no_index && (other < t || tets_[other].region == r.region)) continue;
            const auto& c = tet_faces[f];
            out.push_back({{r.points[c[0]], r.points[c[1]], r.points[c[2]]}, r.region, region_across(t, f)});
          }
        }
      });
}

double EditableMesh::signed_volume(Index t) const {
  const Tet& p = tets_[t].points;
  return orient3d_value(positions_[p[0]], positions_[p[1]], positions_[p[2]], positions_[p[3]]) / 6;
}

double EditableMesh::total_volume() const {
  return parallel_sum(0, tets_.size(), grain, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      const Tet& t = tets_[i].points;
      if (t[0] != no_index)
        sum += orient3d_value(positions_[t[0]], positions_[t[1]], positions_[t[2]], positions_[t[3]]) / 6;
    }
    return sum;
  });
}

TetMesh EditableMesh::to_mesh() && {
  compact(0, 0);
  std::vector<Index> number(positions_.size());
  Index next = 0;
  for (std::size_t p = 0; p < number.size(); ++p)
    if (original(static_cast<Index>(p)) == p) number[p] = next++;
  for (std::size_t p = 0; p < number.size(); ++p) number[p] = number[original(static_cast<Index>(p))];
  TetMesh mesh;
  mesh.points = std::move(positions_);
  for (std::size_t p = 0; p < number.size(); ++p)
    if (original(static_cast<Index>(p)) == p) mesh.points[number[p]] = to_input(mesh.points[p]);
  mesh.points.resize(next);
  mesh.tets.reserve(tets_.size());
  mesh.materials.reserve(tets_.size());
  for (const TetRecord& t : tets_) {
    mesh.tets.push_back({number[t.points[0]], number[t.points[1]], number[t.points[2]], number[t.points[3]]});
    mesh.materials.push_back(tags_[t.region]);
  }
  mesh.material_names = std::move(names_);
  tets_ = {};
  hints_ = {};
  return mesh;
}

bool EditableMesh::links_consistent() const {
  std::size_t live = 0;
  for (std::size_t t = 0; t < tets_.size(); ++t) {
    const TetRecord& r = tets_[t];
    if (r.points[0] == no_index) {
      if (r.points != Tet{no_index, no_index, no_index, no_index}) return false;
      continue;
    }
    ++live;
    for (int f = 0; f < 4; ++f) {
      if (hints_[r.points[f]] == no_index) return false;
      const Index n = r.neighbours[f];
      if (n == no_index) continue;
      const TetRecord& o = tets_[n];
      if (o.points[0] == no_index) return false;
      const int back = face_towards(n, static_cast<Index>(t));
      if (o.neighbours[back] != t || sorted_face(o.points, back) != sorted_face(r.points, f)) return false;
      if (even_face(o.points, back) == even_face(r.points, f)) return false;
    }
  }
  for (std::size_t p = 0; p < hints_.size(); ++p) {
    if (hints_[p] == no_index) continue;
    const Tet& t = tets_[hints_[p]].points;
    if (std::find(t.begin(), t.end(), static_cast<Index>(p)) == t.end()) return false;
  }
  return live == live_tets();
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "mesher/lattice/labelled_lattice.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "common/parallel/parallel_sort.h"
#include "common/tolerances.h"
#include "mesher/tuning/lattice_tuning.h"

namespace tetwright {

namespace {

bool mixed(const std::vector<RegionIndex>& regions, const Tet& t) {
  const RegionIndex r = regions[t[0]];
  return regions[t[1]] != r || regions[t[2]] != r || regions[t[3]] != r;
}

/// Relaxed, since all writers write 1 and flags are read only after the loop.
void mark(std::uint8_t& flag) { std::atomic_ref<std::uint8_t>(flag).store(1, std::memory_order_relaxed); }

/// A flag for each point: 1 for points of tets with more than one region.
std::vector<std::uint8_t> points_near_interfaces(const std::vector<RegionIndex>& regions,
                                                 const TetList& tets) {
  std::vector<std::uint8_t> near(regions.size(), 0);
  parallel_for(0, tets.size(), LatticeGrains::tets, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      if (mixed(regions, tets[i]))
        for (Index v : tets[i]) mark(near[v]);
  });
  return near;
}

/// Changes the regions of isolated vertices, see label_lattice(); returns their number.
std::size_t relabel_isolated_vertices(std::vector<RegionIndex>& regions, const TetList& tets,
                                      const StarMap& stars) {
  std::vector<std::uint8_t> has_company(regions.size(), 0);
  parallel_for(0, tets.size(), LatticeGrains::tets, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Tet& t = tets[i];
      if (!mixed(regions, t)) continue;  // mixed tets suffice for nearly all points; alone() checks the rest
      for (int a = 0; a < 4; ++a)
        for (int b = 0; b < 4; ++b)
          if (a != b && regions[t[a]] == regions[t[b]]) mark(has_company[t[a]]);
    }
  });
  const auto alone = [&](Index p) {
    for (Index t : stars.tets(p))
      for (Index q : tets[t])
        if (q != p && regions[q] == regions[p]) return false;
    return true;
  };
  std::vector<Index> isolated_vertices;
  for (Index p : stars.points())
    if (!has_company[p] && alone(p)) isolated_vertices.push_back(p);
  // Run sequentially, so that two adjacent isolated vertices do not just exchange their regions.
  std::stable_partition(isolated_vertices.begin(), isolated_vertices.end(),
                        [&](Index p) { return regions[p] == outside_region; });
  std::size_t count = 0;
  std::vector<RegionIndex> around;
  for (Index p : isolated_vertices) {
    if (!alone(p)) continue;
    around.clear();
    for (Index t : stars.tets(p))
      for (Index q : tets[t])
        if (q != p) around.push_back(regions[q]);
    std::sort(around.begin(), around.end());
    std::size_t max_count = 0;
    for (std::size_t i = 0, j; i < around.size(); i = j) {
      for (j = i; j < around.size() && around[j] == around[i];) ++j;
      if (j - i > max_count) max_count = j - i, regions[p] = around[i];
    }
    ++count;
  }
  return count;
}

}  // namespace

float LabelledLattice::gap(Index p, RegionIndex a, RegionIndex b) const {
  const std::span<const RegionIndex> regions = star_regions(p);
  const std::span<const float> values = star_values(p);
  float at_a = 0, at_b = 0;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (regions[i] == a) at_a = values[i];
    if (regions[i] == b) at_b = values[i];
  }
  return at_b - at_a;
}

float LabelledLattice::margin(Index p) const {
  const std::span<const RegionIndex> regions = star_regions(p);
  const std::span<const float> values = star_values(p);
  float own = 0, next = HUGE_VALF;
  for (std::size_t i = 0; i < regions.size(); ++i)
    if (regions[i] == first_region[p])
      own = values[i];
    else
      next = std::min(next, values[i]);
  return next - own;
}

void LabelledLattice::list_star_regions(std::size_t region_count) {
  const std::vector<Index>& points = stars.points();
  starts_.assign(points.size() + 1, 0);
  if (region_count == 2) {  // each star near an interface has both regions
    regions_.resize(2 * points.size());
    values_.assign(regions_.size(), 0);
    for (std::size_t s = 0; s < points.size(); ++s) {
      starts_[s + 1] = 2 * s + 2;
      regions_[2 * s + 1] = 1;
    }
    return;
  }
  // Make two passes over the stars: sizes, then regions.
  const auto regions_of = [&](Index p, std::vector<RegionIndex>& out) {
    out.clear();
    for (Index t : stars.tets(p))
      for (Index q : tets[t])
        if (std::find(out.begin(), out.end(), first_region[q]) == out.end()) out.push_back(first_region[q]);
  };
  parallel_for(0, points.size(), LatticeGrains::sampled_points, [&](std::size_t begin, std::size_t end) {
    std::vector<RegionIndex> found;
    for (std::size_t s = begin; s < end; ++s) {
      regions_of(points[s], found);
      starts_[s + 1] = found.size();
    }
  });
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  regions_.resize(starts_.back());
  parallel_for(0, points.size(), LatticeGrains::sampled_points, [&](std::size_t begin, std::size_t end) {
    std::vector<RegionIndex> found;
    for (std::size_t s = begin; s < end; ++s) {
      regions_of(points[s], found);
      std::sort(found.begin(), found.end());
      std::copy(found.begin(), found.end(), regions_.begin() + static_cast<std::ptrdiff_t>(starts_[s]));
    }
  });
  values_.assign(regions_.size(), 0);
}

void LabelledLattice::free_stars() {
  stars = {};
  std::vector<std::size_t>().swap(starts_);
  std::vector<RegionIndex>().swap(regions_);
  std::vector<float>().swap(values_);
}

LabelledLattice label_lattice(LatticePoints points, std::vector<NearestRegion> nearest, TetList tets,
                              std::size_t region_count, bool keep_outside, std::size_t* isolated_vertices,
                              std::vector<std::uint8_t> owned) {
  LabelledLattice lattice;
  lattice.owned = std::move(owned);
  lattice.keep_outside = keep_outside;
  lattice.positions = std::move(points.positions);
  lattice.is_centre = std::move(points.is_centre);
  lattice.box = points.box;
  lattice.border = points.border;
  points = {};
  const std::size_t count = lattice.positions.size();
  std::vector<RegionIndex>& regions = lattice.first_region;
  regions.resize(count);
  for (std::size_t i = 0; i < count; ++i) regions[i] = nearest[i].region;
  std::vector<NearestRegion>().swap(nearest);
  lattice.is_on.assign(count, 0);

  const std::vector<std::uint8_t> near = points_near_interfaces(regions, tets);
  lattice.tets = std::move(tets);
  const auto contributes = [&](const Tet& t) {
    return std::any_of(t.begin(), t.end(), [&](Index v) { return near[v] || regions[v] != outside_region; });
  };
  if (!keep_outside) {
    if (lattice.owned.empty())
      lattice.tets.keep_if(contributes);
    else
      lattice.tets.keep_if(contributes, lattice.owned);
  }
  std::vector<Index> near_points;
  for (Index i = 0; i < count; ++i)
    if (near[i]) near_points.push_back(i);
  lattice.stars = StarMap(std::move(near_points), count, lattice.tets);
  const std::size_t found = relabel_isolated_vertices(regions, lattice.tets, lattice.stars);
  if (isolated_vertices) *isolated_vertices = found;
  lattice.list_star_regions(region_count);
  return lattice;
}

void mark_rims(LabelledLattice& lattice, const SheetedField& field) {
  lattice.has_rims = true;
  const std::vector<Index>& points = lattice.stars.points();
  const auto separated = [&](RegionIndex a, RegionIndex b) {
    return field.part(a).region != field.part(b).region || field.component_between(a, b) != no_index;
  };
  // The part with sides of fewer sheets is the outer one.
  const auto is_outer = [&](RegionIndex a, RegionIndex b) {
    const std::size_t of_a = field.part(a).sides.size(), of_b = field.part(b).sides.size();
    return of_a != of_b ? of_a < of_b : a < b;
  };
  parallel_for(0, points.size(), LatticeGrains::sampled_points, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const RegionIndex own = lattice.first_region[points[s]];
      bool at_rim = false, free = true;
      for (const Index t : lattice.stars.tets(points[s]))
        for (const Index q : lattice.tets[t]) {
          const RegionIndex other = lattice.first_region[q];
          if (other == own) continue;
          if (separated(own, other))
            free = false;
          else
            at_rim |= is_outer(own, other);
        }
      if (at_rim && free) lattice.is_on[points[s]] = 1;
    }
  });
}

void read_star_values(LabelledLattice& lattice, const MaterialField& field) {
  const std::vector<Index>& points = lattice.stars.points();
  parallel_for(0, points.size(), LatticeGrains::sampled_points, [&](std::size_t begin, std::size_t end) {
    const std::unique_ptr<FieldSampler> owned = field.sampler();
    FieldSampler& sampler = *owned;
    for (std::size_t s = begin; s < end; ++s) {
      const Index p = points[s];
      const std::span<const RegionIndex> regions = lattice.star_regions(p);
      const std::span<float> values = lattice.star_values(p);
      sampler.values(lattice.positions[p], regions, values.data());
      float others = HUGE_VALF;
      float* own = nullptr;
      for (std::size_t i = 0; i < values.size(); ++i)
        if (regions[i] == lattice.first_region[p])
          own = &values[i];
        else
          others = std::min(others, values[i]);
      if (own && !(*own <= others - tolerance::min_region_gap)) *own = others - tolerance::min_region_gap;
    }
  });
}

}  // namespace tetwright

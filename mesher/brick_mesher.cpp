// SPDX-License-Identifier: Apache-2.0
#include "mesher/brick_mesher.h"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <utility>

#include "common/mesh/point_joining.h"
#include "common/parallel/parallel_sort.h"
#include "mesher/cut/cutting.h"
#include "mesher/cut/vertex_snapping.h"
#include "mesher/field_mesher.h"
#include "mesher/lattice/labelled_lattice.h"
#include "mesher/lattice/lattice.h"
#include "mesher/lattice/octree.h"
#include "mesher/sizing/sized_cells.h"
#include "mesher/thin/local_thickness.h"
#include "mesher/tuning/cell_tuning.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Appends the keys of cells in a box.
/// \param begin, end ascending keys, all in the cube of 2^level cells that `cube` is the first cell of
/// \param box cells of the keys' level
void append_within(const MortonKey* begin, const MortonKey* end, MortonKey cube, int level,
                   const CellBox& box, std::vector<MortonKey>& out) {
  if (begin == end) return;
  const std::array<int, 3> low = morton_decode(cube);
  bool inside = true;
  for (int a = 0; a < 3; ++a) {
    const int high = low[a] + (1 << level);
    if (high <= box.low[a] || low[a] >= box.high[a]) return;
    inside &= low[a] >= box.low[a] && high <= box.high[a];
  }
  if (inside) {
    out.insert(out.end(), begin, end);
    return;
  }
  // A single cell is either inside the box or outside.
  const MortonKey part = MortonKey{1} << 3 * (level - 1);
  for (MortonKey k = 0; k < 8; ++k) {
    const MortonKey first = cube + k * part;
    const MortonKey* const next = std::lower_bound(begin, end, first + part);
    append_within(begin, next, first, level - 1, box, out);
    begin = next;
  }
}

/// The keys of cells in a box, ascending.
std::vector<MortonKey> within(const std::vector<MortonKey>& keys, const CellBox& box) {
  std::vector<MortonKey> found;
  int level = 0;
  while (level < 20 && MortonKey{1} << 3 * level <= (keys.empty() ? 0 : keys.back())) ++level;
  append_within(keys.data(), keys.data() + keys.size(), 0, level, box, found);
  return found;
}

/// Enlarges a box of root cells on all sides, as far as the frame permits.
CellBox enlarged(const CellBox& box, int by, const GridFrame& frame) {
  const int root = 1 << frame.root_level;
  const int whole = (by + root - 1) / root * root;
  CellBox larger;
  for (int a = 0; a < 3; ++a) {
    larger.low[a] = std::max(0, box.low[a] - whole);
    larger.high[a] = std::min(frame.cells[a], box.high[a] + whole);
  }
  return larger;
}

/// Whether a lattice point is in a box or on its sides.
bool touches(const CellBox& box, MortonKey point) {
  const std::array<int, 3> half_cells = morton_decode(point);
  for (int a = 0; a < 3; ++a)
    if (half_cells[a] < 2 * box.low[a] || half_cells[a] > 2 * box.high[a]) return false;
  return true;
}

/// Drops the tets that share no point with one of the brick.
void drop_distant_tets(LabelledLattice& lattice) {
  std::vector<std::uint8_t> used(lattice.positions.size(), 0);
  for (std::size_t i = 0; i < lattice.tets.size(); ++i)
    if (lattice.owns(i))
      for (const Index v : lattice.tets[i]) used[v] = 1;
  lattice.tets.keep_if(
      [&](const Tet& t) { return std::any_of(t.begin(), t.end(), [&](Index v) { return used[v] != 0; }); },
      lattice.owned);
}

/// The brick's own tets, with points in the order of their first use.
/// \param shared receives a flag for each point
CutMesh own_part(const CutMesh& cut, std::vector<std::uint8_t>& shared) {
  CutMesh own;
  std::vector<std::uint8_t> elsewhere(cut.points.size(), 0);
  for (std::size_t t = 0; t < cut.tets.size(); ++t)
    if (!cut.owned[t])
      for (const Index v : cut.tets[t]) elsewhere[v] = 1;
  std::vector<Index> number(cut.points.size(), no_index);
  for (std::size_t t = 0; t < cut.tets.size(); ++t) {
    if (!cut.owned[t]) continue;
    Tet tet = cut.tets[t];
    for (Index& v : tet) {
      if (number[v] == no_index) {
        number[v] = static_cast<Index>(own.points.size());
        own.points.push_back(cut.points[v]);
        own.on_interface.push_back(cut.on_interface[v]);
        shared.push_back(elsewhere[v]);
      }
      v = number[v];
    }
    own.tets.push_back(tet);
    own.regions.push_back(cut.regions[t]);
  }
  return own;
}

/// Joins the bricks' meshes at their shared points, which have equal coordinates, and frees them.
CutMesh joined(std::vector<BrickMesh> bricks) {
  std::vector<PiecePoints> pieces;
  std::size_t tets = 0;
  for (const BrickMesh& brick : bricks) {
    pieces.push_back({brick.mesh.points, brick.shared});
    tets += brick.mesh.tets.size();
  }
  JoinedPoints points = join_points(pieces);
  CutMesh all;
  all.points.resize(points.count);
  all.on_interface.resize(points.count);
  all.tets.reserve(tets);
  all.regions.reserve(tets);
  for (std::size_t b = 0; b < bricks.size(); ++b) {
    const CutMesh brick = std::move(bricks[b].mesh);
    const std::vector<Index> numbers = std::move(points.numbers[b]);
    for (std::size_t p = 0; p < numbers.size(); ++p) {
      all.points[numbers[p]] = brick.points[p];
      all.on_interface[numbers[p]] = brick.on_interface[p];
    }
    for (Tet tet : brick.tets) {
      for (Index& v : tet) v = numbers[v];
      all.tets.push_back(tet);
    }
    all.regions.insert(all.regions.end(), brick.regions.begin(), brick.regions.end());
  }
  return all;
}

}  // namespace

BrickMesher::BrickMesher(VolumeField volume, const MesherOptions& options, MesherReport& report,
                         Progress* progress)
    : options_(options) {
  interface_voxels_ = volume.field->interface_voxels();
  finer_ = std::move(volume.finer);
  if (options.max_cell)
    finer_ = combine(std::move(finer_),
                     find_sized_cells(*volume.field, options.max_cell, options.keep_outside, progress));
  report.refinement = finer_.refinement;
  field_ = finer_.refinement > 0 ? volume.field->refined(finer_.refinement) : volume.field;
}

int BrickMesher::usual_halo() const {
  const int cells = CellTuning::Bricks::halo << field_->refinement();
  return (cells + root() - 1) / root() * root();
}

std::vector<CellBox> BrickMesher::bricks(int side) const {
  TETWRIGHT_CHECK(side >= root() && std::has_single_bit(static_cast<unsigned>(side)));
  std::array<int, 3> counts;
  for (int a = 0; a < 3; ++a) counts[a] = (frame().cells[a] + side - 1) / side;
  std::vector<MortonKey> keys;
  for (int z = 0; z < counts[2]; ++z)
    for (int y = 0; y < counts[1]; ++y)
      for (int x = 0; x < counts[0]; ++x) keys.push_back(morton_encode(x, y, z));
  std::sort(keys.begin(), keys.end());
  std::vector<CellBox> bricks;
  for (const MortonKey key : keys) {
    const std::array<int, 3> at = morton_decode(key);
    CellBox& brick = bricks.emplace_back();
    for (int a = 0; a < 3; ++a) {
      brick.low[a] = at[a] * side;
      brick.high[a] = std::min(brick.low[a] + side, frame().cells[a]);
    }
  }
  return bricks;
}

BrickMesh BrickMesher::mesh(const CellBox& brick, int halo, Progress* progress) const {
  TETWRIGHT_CHECK(halo >= root());
  const MaterialField& field = *field_;
  const CellBox window = enlarged(brick, halo, frame());
  std::optional<Octree> octree;
  // The octree is that of the whole volume at some distance from where it ends.
  for (int beyond = root(); !octree; beyond *= 2) {
    const CellBox wider = enlarged(window, beyond, frame());
    std::vector<std::vector<MortonKey>> thin(finer_.cells.size());
    for (std::size_t level = 0; level < thin.size(); ++level)
      thin[level] = within(finer_.cells[level], at_level(wider, static_cast<int>(level)));
    octree =
        build_octree(field, {false, options_.adaptivity, finer_.coarsest_interface_level},
                     within(interface_voxels_, at_level(wider, field.refinement())), thin, nullptr, &wider)
            .part(window);
  }
  LatticePoints points = lattice_points(*octree);
  if (progress) progress->throw_if_stopped();
  std::vector<NearestRegion> regions = lattice_regions(points, field);
  const std::vector<std::uint8_t> far =
      options_.keep_outside ? std::vector<std::uint8_t>() : far_outside(regions, field);
  std::vector<std::uint8_t> owned;
  TetList tets =
      lattice_tets(*octree, points, far.empty() ? nullptr : &far, field.refinement(), &brick, &owned);
  if (progress) progress->throw_if_stopped();
  BrickMesh made;
  made.border = {brick, halo, {}};
  for (std::size_t i = 0; i < octree->size(); ++i)
    made.leaves += brick.contains(morton_decode(octree->leaf(i).key));
  octree.reset();
  const std::vector<NearestRegion> nearest = regions;
  LabelledLattice lattice =
      label_lattice(std::move(points), std::move(regions), std::move(tets), field.regions().size(),
                    options_.keep_outside, nullptr, std::move(owned));
  made.lattice_tets = static_cast<std::size_t>(std::count(lattice.owned.begin(), lattice.owned.end(), 1));
  SeamRecorder recorder(lattice, brick);
  for (const Index p : lattice.stars.points())
    made.isolated_vertices += lattice.first_region[p] != nearest[p].region && recorder.is_inside(p);
  read_star_values(lattice, field);
  // Its own progress would hide that of the bricks.
  snap_vertices(lattice, field, nullptr);
  if (progress) progress->throw_if_stopped();
  made.border.seam = recorder.finish();
  lattice.stars.forget_tets();
  drop_distant_tets(lattice);
  made.mesh = own_part(cut_lattice(std::move(lattice)), made.shared);
  return made;
}

std::vector<std::size_t> unconfirmed_bricks(const std::vector<const BrickBorder*>& bricks) {
  struct Offer {
    SeamPoint point;
    std::size_t brick;
  };
  std::vector<Offer> offers;
  for (std::size_t b = 0; b < bricks.size(); ++b)
    for (const SeamPoint& p : bricks[b]->seam.offered) offers.push_back({p, b});
  parallel_sort(offers, [](const Offer& a, const Offer& b) { return a.point.key < b.point.key; });
  std::vector<std::uint8_t> doubtful(bricks.size(), 0);
  for (std::size_t b = 0; b < bricks.size(); ++b)
    for (const SeamPoint& p : bricks[b]->seam.needed) {
      const auto offer = std::lower_bound(offers.begin(), offers.end(), p.key,
                                          [](const Offer& o, MortonKey key) { return o.point.key < key; });
      const bool offered = offer != offers.end() && offer->point.key == p.key;
      if (offered ? offer->point == p : p.history == SeamPoint::not_near) continue;
      doubtful[b] = 1;
      // The brick of the point may not even know that others read it.
      for (std::size_t other = 0; other < bricks.size(); ++other)
        if (touches(bricks[other]->brick, p.key)) doubtful[other] = 1;
    }
  std::vector<std::size_t> unconfirmed;
  for (std::size_t b = 0; b < bricks.size(); ++b)
    if (doubtful[b]) unconfirmed.push_back(b);
  return unconfirmed;
}

std::size_t make_bricks(const BrickMesher& mesher, const std::vector<CellBox>& boxes,
                        std::vector<BrickBorder>& borders,
                        const std::function<void(const std::vector<BrickOrder>&)>& make) {
  borders.resize(boxes.size());
  std::vector<BrickOrder> orders;
  std::vector<const BrickBorder*> all;
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    orders.push_back({b, mesher.usual_halo()});
    all.push_back(&borders[b]);
  }
  make(orders);
  const std::array<int, 3>& cells = mesher.frame().cells;
  const int whole = *std::max_element(cells.begin(), cells.end());
  std::size_t repeated = 0;
  for (std::vector<std::size_t> doubtful; !(doubtful = unconfirmed_bricks(all)).empty();) {
    orders.clear();
    for (const std::size_t b : doubtful)
      // If it knew the whole volume, only its neighbours can be wrong.
      if (borders[b].halo < whole) orders.push_back({b, std::min(2 * borders[b].halo, whole)});
    TETWRIGHT_CHECK(!orders.empty());
    make(orders);
    repeated += orders.size();
  }
  return repeated;
}

BrickedMesh BrickMesher::mesh_all(int side, MesherReport& report, Progress* progress) const {
  const std::vector<CellBox> boxes = bricks(side);
  std::vector<BrickMesh> made(boxes.size());
  BrickedMesh all;
  all.bricks = made.size();
  std::vector<BrickBorder> borders;
  all.repeated = make_bricks(*this, boxes, borders, [&](const std::vector<BrickOrder>& orders) {
    for (const BrickOrder& order : orders) {
      made[order.brick] = mesh(boxes[order.brick], order.halo, progress);
      borders[order.brick] = std::move(made[order.brick].border);
      if (progress) progress->update(static_cast<double>(order.brick + 1) / static_cast<double>(made.size()));
    }
  });
  borders = {};
  for (const BrickMesh& brick : made) brick.add_to(report);
  all.mesh = joined(std::move(made));
  return all;
}

}  // namespace tetwright

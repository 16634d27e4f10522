// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <vector>

#include "mesher/features/feature_surface.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The patches that a boundary vertex belongs to, ascending. A corner of more than `capacity` patches keeps
/// the first ones inserted.
class PatchSet {
 public:
  static constexpr std::size_t capacity = 15;

  PatchSet() = default;
  PatchSet(std::initializer_list<FeatureSurface::Patch> patches) {
    for (const FeatureSurface::Patch p : patches) insert(p);
  }
  void insert(FeatureSurface::Patch p) {
    if (size_ == capacity || contains(p)) return;
    items_[size_++] = p;
    std::sort(items_.begin(), items_.begin() + size_);
  }
  std::size_t size() const { return size_; }
  const FeatureSurface::Patch* begin() const { return items_.data(); }
  const FeatureSurface::Patch* end() const { return items_.data() + size_; }
  bool contains(FeatureSurface::Patch p) const { return std::find(begin(), end(), p) != end(); }
  bool meets(const PatchSet& o) const {
    return std::any_of(begin(), end(), [&](FeatureSurface::Patch p) { return o.contains(p); });
  }
  PatchSet common(const PatchSet& o) const {
    PatchSet both;
    for (const FeatureSurface::Patch p : *this)
      if (o.contains(p)) both.insert(p);
    return both;
  }

 private:
  std::uint8_t size_ = 0;
  std::array<FeatureSurface::Patch, capacity> items_{};
};

/// The feature that a boundary vertex represents.
struct FeatureLabel {
  enum class Kind : std::uint8_t {
    none,    ///< the surface is not near, creases are given up, or more than two regions meet in a curve that
             ///< it does not have
    patch,   ///< one patch
    crease,  ///< two patches, or those of a junction: one for each pair of regions
    corner
  };
  Kind kind = Kind::none;
  PatchSet patches;
  Index corner = no_index;  ///< index into FeatureSurface::corners()
  /// Set for a crease. If the point represents two creases close to each other, the nearer one.
  FeatureSurface::PatchPair crease{};
};

/// Labels the boundary vertices of a dense mesh such that, as far as possible, the three vertices of each
/// face have a patch in common. Edges between faces of different patches then follow creases.
class CreaseLabels {
 public:
  /// Labels the vertices of `mesh.interfaces`. An edge that crosses a crease far from both ends is split,
  /// which adds tets, vertices and interface triangles.
  /// \param cell as for fit_creases()
  CreaseLabels(TetMesh& mesh, const FeatureSurface& surface, double cell);

  /// Kind::none for points that are not on the boundary.
  const FeatureLabel& of(Index point) const {
    static const FeatureLabel none;
    return number_[point] == no_index ? none : labels_[number_[point]];
  }
  /// The patches of a boundary point on a sheet, also those that continue it beyond its border.
  PatchSet patches_on(Index point, std::size_t sheet) const { return on_sheet(number_[point], sheet); }
  bool on_boundary(Index point) const { return number_[point] != no_index; }
  /// True for points between two labels around the bodies, off these and off the border of the volume: they
  /// may make room for points of bodies.
  bool is_loose(Index point) const {
    return number_[point] != no_index && !loose_.empty() && loose_[number_[point]] != 0;
  }
  /// The sheet that a face of the mesh lies on: FeatureSurface::sheet_of(), or sheet_across_gap().
  std::optional<std::size_t> sheet_of(const InterfaceTriangle& face) const {
    if (const auto sheet = surface_.sheet_of(face)) return sheet;
    return sheet_across_gap(face);
  }
  /// The boundary points, by number.
  const std::vector<Index>& points() const { return points_; }
  /// The neighbours of points on creases and corners along the junctions of the mesh: edges of faces on
  /// several sheets.
  std::map<Index, std::vector<Index>> junction_neighbours() const;
  /// A flag for each point of the mesh: it is one of a face across a closed gap.
  std::vector<std::uint8_t> points_at_gaps() const;

 private:
  using Kind = FeatureLabel::Kind;
  struct Crossing;

  /// Size of the cells at a sheet, and at a corner of patches, input units.
  double cell_of(std::size_t sheet) const { return surface_.cell_of(sheet).value_or(cell_); }
  double cell_of(const PatchSet& patches) const;
  void number_boundary();
  void label_points();
  void find_loose_points();
  void free_rims_of_gaps();
  void smooth_labels();
  void take_corners();
  void order_corners();
  std::vector<Index> beyond_corner(const std::map<Index, std::vector<Index>>& neighbours, Index corner,
                                   Index beside) const;
  void divide_at_corner(const std::vector<Index>& run, bool corner_may_move);
  void take_kinks();
  void snap_points();
  void resolve_rest();
  void dissolve_islands();
  /// The sheet of an edge inside a region.
  static constexpr std::size_t no_sheet = std::numeric_limits<std::size_t>::max();
  /// An edge of faces on one sheet.
  struct SheetEdge {
    Index u, v;
    std::size_t sheet;
    auto operator<=>(const SheetEdge&) const = default;
    bool same_ends(const SheetEdge& o) const { return u == o.u && v == o.v; }
  };
  std::optional<std::size_t> sheet_across_gap(const InterfaceTriangle& face) const;
  std::set<std::size_t> sheets_of(const std::vector<Index>& faces, bool or_none) const;
  /// The sheets of the faces at a boundary point; empty if a face lies on none.
  std::set<std::size_t> sheets_at(Index number) const { return sheets_of(triangles_at_[number], true); }
  PatchSet leave_out_continuations(const Vec3& p, std::set<std::size_t>& sheets) const;
  FeatureLabel label_at(Index number);
  FeatureLabel junction_label(const Vec3& p, const std::set<std::size_t>& sheets) const;
  PatchSet on_sheet(Index number, std::size_t sheet) const;
  bool crosses(const SheetEdge& edge) const;
  std::vector<SheetEdge> crossing_edges() const;
  std::optional<Crossing> find_crossing(const SheetEdge& edge) const;
  bool may_snap(Index point, const PatchSet& patches) const;
  std::vector<SheetEdge> find_chords() const;
  std::vector<SheetEdge> find_chords_over_gaps() const;
  void split_chords(const std::vector<SheetEdge>& chords);
  void split_chords_of_creases();
  FeatureLabel patch_label(const Vec3& p, std::size_t sheet, const Vec3* normal) const;
  void split(Index u, Index v, double share, const FeatureLabel& label);
  void track(const std::vector<SheetEdge>& edges);
  template <class Visit>
  void for_neighbours(Index number, const Visit& visit) const;
  FeatureLabel& label(Index point) { return labels_[number_[point]]; }

  TetMesh& mesh_;
  const FeatureSurface& surface_;
  double cell_;
  std::vector<Index> number_;         ///< index of each point in points_; no_index: interior
  std::vector<Index> points_;         ///< boundary points
  std::vector<FeatureLabel> labels_;  ///< by number
  /// By number: patches of inner sheets that end before the point, and whose faces there are left out later.
  std::vector<PatchSet> continued_;
  std::vector<std::uint8_t> loose_;               ///< by number; empty without labels around the bodies
  std::vector<std::vector<Index>> triangles_at_;  ///< by number: indices into mesh_.interfaces
  std::vector<std::vector<Index>> tets_at_;       ///< by number: incident tets, for tracked points only
};

template <class Visit>
void CreaseLabels::for_neighbours(Index number, const Visit& visit) const {
  for (const Index t : triangles_at_[number])
    for (const Index p : mesh_.interfaces[t].ids)
      if (p != points_[number]) visit(p);
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "mesher/tuning/label_tuning.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// Smooth signed distances for the labels of a segmented volume, computed tile by tile.
///
/// Requirements: interfaces have no staircases and are shared exactly by their two labels; the centre of each
/// voxel stays in its label; each label keeps its volume, also locally, so that thin sheets neither vanish
/// nor swell; interfaces stay within the voxels that contain them.
///
/// Distances are computed at the centres of voxels ("nodes") in index space, where a voxel is 1 along each
/// axis:
///  1. The indicator function of each label is smoothed with a binomial kernel of variance 1. A point belongs
///     to the label of the largest value, so labels share their interfaces by construction.
///  2. Smoothing moves curved interfaces inwards and removes thin parts. Back projection restores them, as in
///     superresolution (Irani & Peleg 1991, section 3): the fraction of each voxel that a label occupies (by
///     eight sample points) is compared with the fraction it should occupy, and the difference is smoothed
///     likewise and added. Done twice.
///  3. After each back projection, and after step 4, the value of each node's own label is raised above the
///     others by a margin (a constraint as in Whitaker 2000, "Reducing aliasing artifacts in iso-surfaces of
///     binary volumes"). Labels that still lack most of one of their voxels (rods and single voxels) get a
///     fixed depth there.
///  4. The remaining error of each label's total volume is removed by growing or shrinking the label
///     uniformly. The caller, which sees all tiles, determines the amount from shares() and contacts().
///  5. Values u become distances -probit(u), which are correct for a flat interface.
///  6. If labels alternate in the four voxels around an edge, the two voxels of one label are connected; if
///     both labels form such a pair, the label that is rarer nearby is chosen. Slanted sheets one voxel thick
///     are connected by such edges only, and labels that touch only along an edge are kept apart. Likewise if
///     two opposite ones of the eight voxels around a corner are the only ones of their label there: of the
///     labels with two opposite voxels, the rarest nearby is connected.
///  7. Labels that share a voxel face get a contact of a minimum size, as far as step 6 and the band permit.
///
/// Nodes that neighbouring tiles have in common get identical bits in both.
class LabelSmoother {
 public:
  /// Cells of a tile along each side. Nodes around the tile are computed with it and discarded: only cells^3
  /// of side^3 nodes, a quarter, are kept. Larger tiles would hold more labels at a time than fit in the
  /// cache.
  static constexpr int cells = 32;
  /// Volumes are summed in parts of a tile with this many cells along each side.
  static constexpr int part_cells = 16, parts = cells / part_cells;
  static constexpr int nodes = cells + 1;  ///< of a tile
  static constexpr int reach = 9;          ///< width of the layer of nodes around the tile that affect it
  static constexpr int side = nodes + 2 * reach;
  /// Distances are clamped to this, voxels.
  static constexpr float band = 2.125F;

  LabelSmoother();

  /// The labels of side^3 voxels centred on the tile, x fastest. The caller fills them with two or more
  /// labels.
  std::span<RegionIndex> voxels() { return raw_; }
  /// Restricts volumes and contacts to the volume: nodes `low` to `high` (exclusive) of the tile, and half a
  /// voxel beyond the outermost centres. Initially unrestricted.
  void set_volume(const std::array<int, 3>& low, const std::array<int, 3>& high) {
    low_ = low;
    high_ = high;
  }
  /// The number of voxels of the volume in a part of the tile.
  double volume_of(const std::array<int, 3>& part) const;
  /// Finds the labels and returns their number, which must not exceed
  /// LabelTuning::Smoothing::max_labels.
  std::size_t number_labels();
  /// Computes the distances.
  /// \param growth by region: how far each label is grown (or, if negative, shrunk) in all directions,
  ///   voxels; at most LabelTuning::Growth::max_growth in absolute value
  /// \pre number_labels() was called
  void smooth(std::span<const float> growth);

  /// The labels of the voxels, ascending.
  std::span<const RegionIndex> labels() const { return labels_; }
  /// The signed distance of a label at a node of the tile, voxels, negative inside.
  /// \param label index into labels()
  float distance(std::size_t label, int x, int y, int z) const {
    return fields_[label][place(x + reach, y + reach, z + reach)];
  }
  /// The volume of each of labels() in a part of the tile, voxels: within 2 %, except for rods much narrower
  /// than a voxel.
  /// \param part indices along x, y, z, each below `parts`
  std::vector<double> shares(const std::array<int, 3>& part) const;
  /// Labels of two regions and the number of voxel faces between them in the tile.
  struct Contact {
    RegionIndex first, second;  ///< first < second
    std::uint32_t faces;
  };
  /// Each pair once, ascending.
  std::vector<Contact> contacts() const;

 private:
  using Field = std::vector<float>;
  /// The part of a field that may differ from 0: from `low` to `high` (exclusive) along each axis.
  struct Box {
    std::array<int, 3> low, high;
  };
  /// A node with a different label among its 26 neighbours, and the labels of these 27 nodes.
  struct MixedNode {
    int place;
    std::uint16_t own, label_count;
    std::uint32_t first_label;
    float lack;  ///< the fraction of its voxel that its own label did not occupy at the last back projection
  };

  static constexpr int place(int x, int y, int z) { return (z * side + y) * side + x; }
  static constexpr std::array<int, 3> position(int place) {
    return {place % side, place / side % side, place / (side * side)};
  }
  /// True if nodes with this coordinate along an axis have distances that are final except for steps 6 and 7.
  static constexpr bool settled(int i) { return i >= reach - 1 && i <= side - reach; }
  static constexpr int volume = side * side * side;
  static constexpr std::array<int, 3> steps{1, side, side* side};

  void find_mixed_nodes();
  /// Adds `factor` times the smoothed `from` to `to`, except at nodes less than `margin` from the border.
  void add_smoothed(const Field& from, const Box& box, int margin, float factor, Field& to);
  static void clear(Field& field, const Box& box);
  void add_missing_shares(int margin);
  /// Step 3: raises own values above all others by the margin.
  void enforce_own_labels();
  void grow(std::span<const float> growth);
  void distances_from_shares(int margin, std::span<const float> growth);
  /// The amount by which the distance of a label is to be decreased at a node.
  struct Lift {
    int place;
    std::uint16_t label;
    float by;
  };
  /// Steps 6 and 7.
  void enforce_contacts();
  void connect_edge(const MixedNode& n, int normal, std::vector<Lift>& lifts) const;
  void connect_corner(const MixedNode& n, std::vector<Lift>& lifts) const;
  void widen_contact(const MixedNode& n, int normal, std::vector<Lift>& lifts) const;
  std::span<const std::uint16_t> labels_near(const MixedNode& n) const {
    return {near_.data() + n.first_label, n.label_count};
  }

  /// The range of samples within the volume in the cell above node i (of the tile) along an axis.
  std::pair<int, int> samples_within(int axis, int i) const {
    return {i >= low_[axis]       ? 0
            : i == low_[axis] - 1 ? LabelTuning::Smoothing::samples_along / 2
                                  : LabelTuning::Smoothing::samples_along,
            i < high_[axis] - 1    ? LabelTuning::Smoothing::samples_along
            : i == high_[axis] - 1 ? LabelTuning::Smoothing::samples_along / 2
                                   : 0};
  }

  static constexpr int far = std::numeric_limits<int>::max() / 2;
  std::array<int, 3> low_{-far, -far, -far}, high_{far, far, far};  ///< see set_volume()
  std::vector<RegionIndex> raw_;
  std::vector<std::uint16_t> own_;      ///< index in labels_ of each node's label
  std::vector<std::uint16_t> numbers_;  ///< by region: index in labels_ plus 1 while labels are numbered
  std::vector<RegionIndex> labels_;
  std::vector<Box> boxes_;               ///< of each label's voxels
  std::vector<Field> fields_, missing_;  ///< missing_ is 0 between uses
  std::vector<Box> missing_boxes_;
  std::vector<MixedNode> mixed_;
  std::vector<std::int32_t> mixed_at_;  ///< by place: index in mixed_, or -1
  std::vector<std::uint16_t> near_;
  Field rows_, slices_;
};

}  // namespace tetwright

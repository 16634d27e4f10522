#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesher/regions.h"

namespace tetwright {

/// Smooth signed distances for the labels of a segmented volume, made tile by tile.
///
/// What is wanted of them: interfaces without staircases that neighbours share exactly; the centre of every
/// voxel stays in its label; the volume of each label stays, also locally, so that thin sheets neither
/// vanish nor swell; nothing moves farther than the voxels say.
///
/// How they are made, at the centres of voxels ("nodes"), distances in index space (a voxel is 1 along each
/// axis):
///  1. each label's indicator is smoothed with a binomial kernel of variance 1; the label of the largest
///     value has a place, so all interfaces are shared by construction;
///  2. smoothing moves curved interfaces inwards and eats what is thin. How much of each voxel every label
///     has got (in eight sample points) is compared with what it should have, and the difference, smoothed
///     alike, is added: back projection, as in superresolution (Irani & Peleg 1991, section 3). Twice;
///  3. after each back projection, and after step 4, a node's own label is made the largest by a margin
///     (Whitaker 2000, "Reducing aliasing artifacts in iso-surfaces of binary volumes", constrains smoothing
///     likewise); what still lacks most of its voxel then, rods and single voxels, is put inside by hand;
///  4. what a label has too much or too little of all the same, taken over the whole volume, is evened out by
///     growing it a little all around; who makes the tiles finds out how much, from shares() and contacts();
///  5. shares u become distances -probit(u), which are right for a flat interface;
///  6. where labels alternate in the four voxels around an edge, the two voxels of one label are connected,
///     of two such pairs those of the label that is rarer around there: a sheet one voxel thick that runs at
///     a slant hangs together by such edges, and labels that only touch in an edge are kept apart;
///  7. labels that share a face of voxels have a contact of some size, as far as 6 and the band leave room.
///
/// Nodes of neighbouring tiles that are the same come out bit by bit the same.
class LabelSmoother {
 public:
  static constexpr int cells = 16;         ///< of a tile, along each side
  static constexpr int nodes = cells + 1;  ///< of a tile
  static constexpr int reach = 9;          ///< nodes around the tile that it depends on
  static constexpr int side = nodes + 2 * reach;
  /// Distances are cut off here, voxels.
  static constexpr float band = 2.125F;

  LabelSmoother();

  /// The labels of side^3 voxels, x fastest; the tile is in their middle. Two or more labels.
  std::span<RegionIndex> voxels() { return raw_; }
  /// Lists and counts the labels, of which there may be most_labels: each takes a third of a megabyte.
  std::size_t number_labels();
  static constexpr std::size_t most_labels = 1024;
  /// To be called after that. `growth`, by region: by how much each is to be larger all around, voxels; at
  /// most most_growth in size.
  void smooth(std::span<const float> growth);
  static constexpr float most_growth = 0.7F;

  /// The labels there were, ascending.
  std::span<const RegionIndex> labels() const { return labels_; }
  /// The distance of a label (its place in labels()) at a node of the tile, voxels, negative inside.
  float distance(std::size_t label, int x, int y, int z) const {
    return fields_[label][place(x + reach, y + reach, z + reach)];
  }
  /// What each of labels() has of the tile's cells^3 cells between nodes, voxels: within 2 %, save for rods
  /// much narrower than a voxel.
  std::vector<double> shares() const;
  /// Faces between voxels of two labels of the tile, each pair once, ascending.
  struct Contact {
    RegionIndex first, second;  ///< first < second
    std::uint32_t faces;
  };
  std::vector<Contact> contacts() const;

 private:
  using Field = std::vector<float>;
  /// What differs from 0 of a field, from and to (exclusive) along x, y, z.
  struct Box {
    std::array<int, 3> low, high;
  };
  /// A node with another label next to it, and the labels of the 27 nodes there.
  struct MixedNode {
    int place;
    std::uint16_t own, label_count;
    std::uint32_t first_label;
    float lack;  ///< the share of its voxel that its own label had not got when it was last looked
  };

  static constexpr int place(int x, int y, int z) { return (z * side + y) * side + x; }
  static constexpr std::array<int, 3> position(int place) {
    return {place % side, place / side % side, place / (side * side)};
  }
  /// True for nodes, along one axis, whose distances are final but for steps 6 and 7.
  static constexpr bool settled(int i) { return i >= reach - 1 && i <= side - reach; }
  static constexpr int volume = side * side * side;
  static constexpr std::array<int, 3> steps{1, side, side* side};

  void find_mixed_nodes();
  /// Adds the smoothed `from` to `to`, as far as it reaches within `margin` nodes of the border.
  void add_smoothed(const Field& from, const Box& box, int margin, float factor, Field& to);
  void add_missing_shares(int margin);
  void hold_own_labels();
  void grow(std::span<const float> growth);
  void distances_from_shares(int margin, std::span<const float> growth);
  /// What a node's own distance is to be less by.
  struct Lift {
    int place;
    float by;
  };
  void hold_contacts();
  void hold_edge(const MixedNode& n, int normal, std::vector<Lift>& lifts) const;
  void hold_face(const MixedNode& n, int normal, std::vector<Lift>& lifts) const;
  std::span<const std::uint16_t> labels_near(const MixedNode& n) const {
    return {near_.data() + n.first_label, n.label_count};
  }

  std::vector<RegionIndex> raw_;
  std::vector<std::uint16_t> own_;      ///< place in labels_ of each node's label
  std::vector<std::uint16_t> numbers_;  ///< by region: place in labels_ plus 1 while labels are numbered
  std::vector<RegionIndex> labels_;
  std::vector<Box> boxes_;  ///< of each label's voxels
  std::vector<Field> fields_, missing_;
  std::vector<Box> missing_boxes_;
  std::vector<MixedNode> mixed_;
  std::vector<std::int32_t> mixed_at_;  ///< by place: number in mixed_, or -1
  std::vector<std::uint16_t> near_;
  Field rows_, slices_;
};

}  // namespace tetwright

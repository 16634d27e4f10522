// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "mesher/domain/material_field.h"
#include "mesher/lattice/octree.h"
#include "mesher/lattice/tet_list.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// The points of the body-centred lattice over an octree: the corners and the centre of every leaf, and the
/// centre of every leaf face on the octree's window or on the border of a volume. Sorted by Morton key, so
/// that neighbouring points have close numbers.
struct LatticePoints {
  /// Morton keys of the points in half finest cells (centres of finest cells have odd coordinates),
  /// ascending.
  std::vector<MortonKey> keys;
  std::vector<Vec3> positions;          ///< lattice units
  std::vector<std::uint8_t> is_centre;  ///< 1 for centres of leaves

  std::size_t size() const { return keys.size(); }
  std::vector<Index> leaf_centres;  ///< by leaf: index of its centre
  std::array<int, 3> box{};         ///< of the octree, lattice units
  CellBox border{};                 ///< likewise

  /// The index of the point with this key, or no_index. Fast if it is close to `hint`.
  Index find(MortonKey key, Index hint = 0) const;
};

LatticePoints lattice_points(const Octree& octree);

/// The region of each lattice point.
std::vector<NearestRegion> lattice_regions(const LatticePoints& points, const MaterialField& field);

/// 1 for each lattice point that is outside with no interface within the field's band.
std::vector<std::uint8_t> far_outside(const std::vector<NearestRegion>& regions, const MaterialField& field);

/// The tets of the body-centred lattice: positive, conforming without T-junctions, filling the window.
///
/// Two leaves of equal size that share a face give four tets around the segment between their centres, one
/// for each edge of the face. If a leaf is next to four smaller ones, each of the four small faces is cut
/// along the diagonal through the centre of the large face, and its triangles are joined to both centres. On
/// the window and on the border of a volume, the centre of the face replaces the neighbour's centre. An edge
/// with a hanging node at its midpoint is split there. Every face between two pyramids is spanned by a centre
/// and an edge, and every diagonal depends only on its quadrilateral, so neighbouring tets conform. Dihedral
/// angles are 60 and 90 degrees between equal leaves and 45 to 120 elsewhere.
///
/// \param unwanted by point, may be null: tets of leaves up to `unwanted_level` are omitted if all their
///   points are unwanted
/// \param brick a box of whole leaves; may be null
/// \param owned receives a flag for each tet: 1 if it belongs to the brick. Each tet belongs to one leaf: the
///   smaller one of two that share the face across which it reaches, or the lower one of equal size
TetList lattice_tets(const Octree& octree, const LatticePoints& points,
                     const std::vector<std::uint8_t>* unwanted = nullptr, int unwanted_level = 0,
                     const CellBox* brick = nullptr, std::vector<std::uint8_t>* owned = nullptr);

}  // namespace tetwright

#pragma once

#include <cstdint>
#include <vector>

#include "common/types.h"
#include "mesher/material_field.h"
#include "mesher/octree.h"
#include "mesher/tet_list.h"

namespace tetwright {

/// The points of the body-centred lattice over an octree: the corners and the centre of every leaf, and the
/// middle of every leaf face on the box. Sorted by Morton key, so that near points have near numbers.
struct LatticePoints {
  /// Morton keys of the points in half finest cells (centres of finest cells are at odd numbers), ascending.
  std::vector<MortonKey> keys;
  std::vector<Vec3> positions;          ///< lattice units
  std::vector<std::uint8_t> is_centre;  ///< 1 for centres of leaves

  std::size_t size() const { return keys.size(); }
  std::vector<Index> leaf_centres;  ///< of each leaf the number of its centre

  /// The number of the point with this key, or no_index. Fast where it is not far from the number `hint`.
  Index find(MortonKey key, Index hint = 0) const;
};

LatticePoints lattice_points(const Octree& octree);

/// The region that has each lattice point.
std::vector<NearestRegion> lattice_regions(const LatticePoints& points, const MaterialField& field);

/// Of each lattice point: 1 if it is outside and no interface is within the field's band.
std::vector<std::uint8_t> far_outside(const std::vector<NearestRegion>& regions, const MaterialField& field);

/// The tets of the body-centred lattice: positive, conforming without T-junctions, filling the box.
///
/// Two equal leaves that share a face: four tets around the segment between the centres, one for each edge of
/// the face. A leaf against four smaller ones: each of the four small faces is cut along the diagonal through
/// the big face's centre, and its triangles are coned to both centres. On the box: the face's middle in the
/// place of the neighbour's centre. An edge with a hanging midpoint is split there. Every face between two
/// pyramids is a triangle of a centre and an edge and every quadrilateral's diagonal depends on it alone, so
/// neighbours agree. Equal leaves give dihedral angles of 60 and 90 degrees, all transitions 45 to 120.
///
/// With `unwanted` points given, tets of leaves up to the level `unwanted_level` whose points are all
/// unwanted are left out.
TetList lattice_tets(const Octree& octree, const LatticePoints& points,
                     const std::vector<std::uint8_t>* unwanted = nullptr, int unwanted_level = 0);

}  // namespace tetwright

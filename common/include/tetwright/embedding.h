// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Points in terms of a tet mesh: a point is the sum of four points of the mesh, times their weights. If the
/// mesh moves, the same sum of its new points moves the point along. The arrays have an entry for each point,
/// in order.
struct Embedding {
  std::vector<Index> tets;                     ///< tet that contains the point or is nearest to it
  std::vector<Tet> nodes;                      ///< points of this tet, in its order
  std::vector<std::array<double, 4>> weights;  ///< of these points: from 0 to 1, with sum 1 up to rounding
  /// Distance of the point from the tet, input units; 0 for a point inside or on a tet. The weights of a
  /// point outside are those of the nearest point of the tet.
  std::vector<double> distances;
};

/// Embeds points in a mesh.
///
/// Exact predicates decide which tet contains a point; a point on a face, an edge or a point of the mesh
/// belongs to the tet with the smallest index. The weights of a point inside reproduce its position, and with
/// it every linear field, up to rounding: about 1e-16 of the largest coordinate. Other points get the nearest
/// tet, the one with the smallest index among equal distances. Tets that are flat or inverted are skipped.
///
/// Takes O(log n) for each point in a mesh of good shapes, and about 70 bytes for each tet beside the mesh
/// and 60 for each point. Points are embedded in parallel, and the result does not depend on the number of
/// threads. May be called concurrently.
/// \param mesh_name for messages
/// \pre indices in range, coordinates finite
/// \throws InputError if no tet is positive
Embedding embed_points(const TetMesh& mesh, std::span<const Vec3> points,
                       const std::string& mesh_name = "the mesh");

/// Distances of an embedding in a few numbers.
struct EmbeddingSummary {
  std::size_t points = 0;
  /// Points outside the mesh, farther away than a millionth of the diagonal of its bounding box: surfaces of
  /// the same body differ by so much if their files are rounded to floats.
  std::size_t outside = 0;
  double largest_distance = 0;  ///< of all points, input units
  Vec3 place = Vec3::Zero();    ///< first point at this distance
};

/// \param points those that were embedded
EmbeddingSummary summary_of(const Embedding& embedding, const TetMesh& mesh, std::span<const Vec3> points);

}  // namespace tetwright

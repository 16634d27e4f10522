// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/mesh/mesh_faces.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// Faults of a mesh, in the order of the checks. After one of the first three no further check is made.
/// Unused points are a warning, since no computation on the tets notices them; all other faults are errors.
enum class MeshFault : int {
  materials_missing = 1,              ///< no tets, or not one material for each tet
  index_out_of_range = 2,             ///< tets that refer to a point that does not exist
  coordinates_not_finite = 3,         ///< points
  degenerate_tets = 4,                ///< tets with a vertex twice
  duplicate_tets = 5,                 ///< tets beyond the first with the same vertices
  unused_points = 6,                  ///< points that no tet uses; a warning
  inverted = 7,                       ///< tets whose exact orientation is negative or zero
  face_over_shared = 8,               ///< faces with more than two tets
  boundary_edges_not_two = 9,         ///< boundary edges without exactly two boundary triangles
  boundary_points_non_manifold = 10,  ///< fans of boundary triangles at a point beyond the first
  point_star_split = 11,              ///< parts of a point's star, chained by faces, beyond the first
  self_intersections = 12             ///< pairs of boundary or interface triangles
};

/// Name in machine-readable reports, such as "degenerate_tets".
const char* mesh_fault_name(MeshFault fault);

/// Description of the counted items, such as "tets with a repeated vertex".
const char* mesh_fault_text(MeshFault fault);

/// Whether the fault leaves the mesh valid.
bool is_warning(MeshFault fault);

struct MeshPlace {
  std::string text;           ///< such as "tet 7 (1 2 2 5)" or "point 3 at 0 0.5 1"
  std::vector<Index> points;  ///< indices of the points concerned, in the order of the text
  std::optional<Vec3> at;     ///< mean position of the points, if all exist and are finite
};

struct MeshFinding {
  MeshFault fault;
  std::size_t count;
  std::vector<MeshPlace> places;  ///< the first few
};

struct MeshCheckOptions {
  bool self_intersections = true;  ///< takes as long as all other checks together
  std::size_t places = 3;          ///< maximum number of examples in each finding
};

/// True unless a finding is an error.
bool is_valid(const std::vector<MeshFinding>& findings);

/// Checks any mesh, even one with indices out of range. Parallel; the result does not depend on the number of
/// threads. Takes well under a second for a million tets, and about 120 bytes of memory for each tet.
/// \return the faults found; numbers in their texts count from 0
std::vector<MeshFinding> check_mesh(const TetMesh& mesh, const MeshCheckOptions& options = {});
/// Checks a mesh with the faces that mesh_faces() found in it.
/// \pre indices in range
std::vector<MeshFinding> check_mesh(const TetMesh& mesh, const MeshCheckOptions& options,
                                    const std::vector<MeshFace>& faces);

/// One line for messages: "tets with a repeated vertex (degenerate_tets): 3, the first at tet 7 (1 2 2 5)".
std::string mesh_finding_line(const MeshFinding& finding);

}  // namespace tetwright

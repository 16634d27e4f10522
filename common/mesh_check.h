#pragma once

#include <string>
#include <vector>

#include "common/mesh_faces.h"
#include "common/tet_mesh.h"

namespace tetwright {

/// What can be wrong with a mesh, in the order in which it is looked for. What comes first makes what follows
/// meaningless: after 1 to 3 the check ends.
enum class MeshFault : int {
  materials_missing = 1,              ///< not one material for each tet, or no tets
  index_out_of_range = 2,             ///< tets that name a point that isn't there
  coordinates_not_finite = 3,         ///< points
  degenerate_tets = 4,                ///< tets with a vertex twice
  duplicate_tets = 5,                 ///< tets beyond the first with the same vertices
  unused_points = 6,                  ///< points of no tet
  inverted = 7,                       ///< tets whose exact orientation is negative or flat
  face_over_shared = 8,               ///< faces with more than two tets
  boundary_edges_not_two = 9,         ///< edges of the boundary with other than two boundary triangles
  boundary_points_non_manifold = 10,  ///< fans of boundary triangles at a point beyond the first
  point_star_split = 11,              ///< parts of a point's star, chained by faces, beyond the first
  self_intersections = 12             ///< pairs of boundary or interface triangles
};

/// "degenerate_tets": the name in reports.
const char* mesh_fault_name(MeshFault fault);

struct MeshFinding {
  MeshFault fault;
  std::size_t count;
  std::vector<std::string> places;  ///< the first few, such as "tet 7 (1 2 2 5)" or "point 3 at 0 0.5 1"
};

struct MeshCheckOptions {
  bool self_intersections = true;  ///< takes as long as all the rest together
  std::size_t places = 3;          ///< how many are named in each finding
};

/// What is wrong with a mesh; empty: it is valid. Changes nothing and is safe on any mesh, also one with
/// indices out of range. Numbers in places count from 0. Parallel; the result does not depend on the threads.
/// A million tets take well under a second and about 120 bytes of memory each.
std::vector<MeshFinding> check_mesh(const TetMesh& mesh, const MeshCheckOptions& options = {});
/// The same, with faces that mesh_faces() made of this mesh, whose indices must be in range.
std::vector<MeshFinding> check_mesh(const TetMesh& mesh, const MeshCheckOptions& options,
                                    const std::vector<MeshFace>& faces);

/// "inverted: 3, the first at tet 7 (1 2 2 5)"
std::string mesh_finding_line(const MeshFinding& finding);

}  // namespace tetwright

#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/formats/read_tet_mesh_result.h"

namespace tetwright {

/// The triangles that a file lists beside its tets, and the group that it puts each into.
struct FileTriangles {
  std::vector<Triangle> triangles;   ///< indices of points; no_index where the file names none of its points
  std::vector<std::int64_t> groups;  ///< one for each triangle; 0: none
  std::map<std::int64_t, std::string> names;  ///< of groups that have one
};

/// Adds to `read.dropped` what of the triangles is lost. A group is restored if it is what find_interfaces()
/// and the writers make of the mesh: its triangles lie between the same two materials, or between one and
/// outside, no other group has that pair, and its name is pair_name()'s, or, where it has none, its number is
/// interface_groups()'. Triangles without a group are restored if all of them are interface triangles.
///
/// `group_word` is what the format calls a group, in the plural, for example "physical groups". To be called
/// when the materials and their names are known. Time and memory grow with the number of triangles, beside
/// one look at every tet.
void note_dropped_triangles(const FileTriangles& listed, const std::string& group_word, ReadTetMesh& read);

}  // namespace tetwright

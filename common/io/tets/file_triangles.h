// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/io/contents/read_tet_mesh_result.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// Triangles that a file lists, beside its tets or as a surface, and the group of each.
struct FileTriangles {
  void add(const Triangle& ids, std::int64_t group) {
    triangles.push_back(ids);
    groups.push_back(group);
  }
  /// Splits a quad as SurfaceBuilder::add_polygon() does.
  void add_quad(const std::array<Index, 4>& ids, std::int64_t group) {
    add({ids[0], ids[1], ids[2]}, group);
    add({ids[0], ids[2], ids[3]}, group);
  }

  std::vector<Triangle> triangles;            ///< indices of points; no_index for a point that the file lacks
  std::vector<std::int64_t> groups;           ///< one for each triangle; 0: none
  std::map<std::int64_t, std::string> names;  ///< of the groups that have a name
  /// Form of a name in the format's writer; null: msh_name().
  std::string (*name_form)(const std::string& name) = nullptr;
  std::map<std::int64_t, std::string> comments;  ///< comments of write_medit() on groups
};

/// Turns the groups of the triangles, except derived ones, into patches of `read.mesh`, with their names and
/// numbers: fills `interfaces` and `patch_groups`, which stay empty if all groups are derived ones. A derived
/// group is one that writers make of a pair of materials: all its triangles lie between two materials, or
/// between one and outside; it contains each face there that is in no other group; and it is identified by
/// - its name: pair_name()'s, or with the suffix that write_msh() adds if the input has groups of this name;
/// - or, if the group has one, the comment of write_medit();
/// - or, if it has neither, its number, if that is the one that BoundaryGroups gives the pair and all groups
///   of the file are derived.
///
/// Adds to `read.dropped` the derived groups as restored, and the losses: triangles within a material, those
/// of no tet and no group, and those that are in a group already. A triangle that is listed without a group,
/// too, is no loss. Time and memory are those of find_interfaces().
/// \param group_word the format's term for a group, for example "physical group"
/// \param file named in messages
/// \pre the materials and their names are known
/// \throws InputError for a triangle of a group that is no face of a tet, and for more than 65,535 groups
void take_triangles(const FileTriangles& listed, const std::string& group_word, const std::string& file,
                    ReadTetMesh& read);

/// Message for a file with tets where a surface is needed; to be appended to its name.
std::string surface_expected(std::size_t tets);

/// Returns the triangles as a surface with the groups of the file, unless there is only one and it has no
/// name.
/// \throws InputError if there are none, or for one with a point that does not exist
TriangleMesh surface_of(const FileTriangles& listed, std::vector<Vec3> points, const std::string& file);

}  // namespace tetwright

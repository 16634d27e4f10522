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

/// The triangles that a file lists, beside its tets or as a surface, and the group that it puts each into.
struct FileTriangles {
  void add(const Triangle& ids, std::int64_t group) {
    triangles.push_back(ids);
    groups.push_back(group);
  }
  /// Cuts a quad as SurfaceBuilder::add_polygon() does.
  void add_quad(const std::array<Index, 4>& ids, std::int64_t group) {
    add({ids[0], ids[1], ids[2]}, group);
    add({ids[0], ids[2], ids[3]}, group);
  }

  std::vector<Triangle> triangles;   ///< indices of points; no_index where the file names none of its points
  std::vector<std::int64_t> groups;  ///< one for each triangle; 0: none
  std::map<std::int64_t, std::string> names;  ///< of groups that have one
  /// What the format's writer makes of a name; null: msh_name().
  std::string (*name_form)(const std::string& name) = nullptr;
  std::map<std::int64_t, std::string> comments;  ///< what write_medit() says of a group in a comment
};

/// Takes the groups of the triangles as patches of `read.mesh`, with their names and numbers: fills
/// `interfaces` and `patch_groups`. A group that writers make of a pair of materials is none: all its
/// triangles lie between two materials, or between one and outside; each face there that is in no other group
/// is in it; and it is known by
/// - its name: pair_name()'s, or with the suffix that write_msh() gives it where the user has groups of this
///   name;
/// - or, if the group has one, the comment of write_medit();
/// - or, where it has neither, its number, if that is the one that BoundaryGroups gives the pair and no group
///   of the file is the user's.
/// Where there is no other, both stay empty.
///
/// Adds to `read.dropped` what is restored in this way, and what is lost: triangles within a material, those
/// of no tet and no group, and those that are in a group already. To be listed without a group, too, loses
/// none. Throws InputError for a triangle of a
/// group that is no face of a tet, and for more than 65,535 groups.
///
/// `group_word` is what the format calls a group, for example "physical group"; `file` is named in messages.
/// To be called when the materials and their names are known. Time and memory are those of find_interfaces().
void take_triangles(const FileTriangles& listed, const std::string& group_word, const std::string& file,
                    ReadTetMesh& read);

/// What to say of a file with tets where a surface is needed; to be appended to its name.
std::string surface_expected(std::size_t tets);

/// The triangles as a surface by themselves; groups are those of the file, unless there is only one and it
/// has no name. Throws InputError if there are none, or for one that names a point that is not there.
TriangleMesh surface_of(const FileTriangles& listed, std::vector<Vec3> points, const std::string& file);

}  // namespace tetwright

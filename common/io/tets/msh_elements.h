// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/io/elements/element_types.h"
#include "tetwright/io.h"

namespace tetwright {

/// Gmsh's order of the midside nodes of a tet: positions in tet_midside_edges.
inline constexpr std::array<std::size_t, 6> msh_midside_order{0, 1, 2, 3, 5, 4};

/// Beginning of a line of $Comments in this program's files of version 4.1; the number of a physical group of
/// tets and the tag of the material follow. Gmsh would not keep such a tag as a number, since it is not above
/// 0.
inline constexpr const char* msh_material_comment = "tetwright material: ";

/// Elements of an MSH file that are not linear tets, counted by type and group, and the names of the groups
/// of every dimension.
class OtherMshElements {
 public:
  /// Whether the type is a volume element other than a linear tet.
  static bool is_volume(std::int64_t type);

  /// Adds a name of section $PhysicalNames; `dimension` is 0 to 3.
  void add_name(std::int64_t dimension, std::int64_t group, const std::string& name);
  /// Adds a physical group of an entity after its first one, which is used.
  void add_further_group(std::size_t dimension, std::int64_t group);
  /// Adds a volume element other than a linear tet, also one of a type that is_volume() does not know.
  void add_volume(std::int64_t type, std::int64_t element, std::size_t line);
  /// Adds a point, line or face other than a linear triangle; `group` is its physical group, 0 for none.
  void add_flat(std::int64_t type, std::int64_t group);
  /// Adds a linear triangle; its nodes as indices of points, no_index for a node that the file does not have.
  void add_triangle(const Triangle& ids, std::int64_t group) { triangles_.add(ids, group); }
  /// Adds a quad of a surface as two triangles.
  void add_quad(const std::array<Index, 4>& ids, std::int64_t group) { triangles_.add_quad(ids, group); }

  /// Triangles added so far.
  std::vector<Triangle>& triangles() { return triangles_.triangles; }

  /// \throws InputError if there were volume elements
  void refuse_volumes(const std::string& file) const;
  /// Adds the triangles to the mesh, see take_triangles(), and everything else to `read.dropped`.
  /// \pre the materials are known
  void finish(const std::string& file, ReadTetMesh& read) const;
  /// Returns the triangles as a surface, see surface_of().
  /// \param dropped receives everything else; may be null
  TriangleMesh surface(std::vector<Vec3> points, const std::string& file,
                       std::vector<Dropped>* dropped) const;

 private:
  struct OfType {
    std::size_t elements = 0;
    std::set<std::int64_t> groups;  ///< without 0
  };

  void note_dropped(std::vector<Dropped>& dropped) const;
  const std::map<std::int64_t, std::string>& names_of(std::size_t dimension) const {
    return dimension == 2 ? triangles_.names : names_[dimension];
  }

  std::array<std::map<std::int64_t, std::string>, 4> names_;  ///< by dimension, except faces
  FileTriangles triangles_;                                   ///< with the names of groups of faces
  std::array<std::set<std::int64_t>, 4> further_groups_;      ///< by dimension
  std::map<std::int64_t, OfType> flat_;                       ///< by type
  std::map<std::int64_t, std::size_t> volumes_;               ///< numbers by type
  std::int64_t first_volume_ = 0, first_volume_type_ = 0;
  std::size_t first_volume_line_ = 0;
};

}  // namespace tetwright

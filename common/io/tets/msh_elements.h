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

#include "common/io/contents/read_tet_mesh_result.h"
#include "common/io/tets/file_triangles.h"

namespace tetwright {

/// Gmsh's numbers of element types.
inline constexpr std::int64_t msh_triangle_type = 2;
inline constexpr std::int64_t msh_quad_type = 3;
inline constexpr std::int64_t msh_tet_type = 4;
inline constexpr std::int64_t msh_quadratic_triangle_type = 9;
inline constexpr std::int64_t msh_quadratic_tet_type = 11;

/// Where Gmsh lists the midside nodes of a tet: places in the order of tet_midside_edges.
inline constexpr std::array<std::size_t, 6> msh_midside_order{0, 1, 2, 3, 5, 4};

/// Begins a line of $Comments in our own files of version 4.1, followed by the number of a physical group of
/// tets and the tag of the material, which is no number that Gmsh would keep: it is not above 0.
inline constexpr const char* msh_material_comment = "tetwright material: ";

/// The number of nodes of an element of this type; 0: unknown.
std::size_t msh_nodes_of(std::int64_t type);

/// The elements of an MSH file that are not linear tets, counted by kind and group, and the names of the
/// groups of every dimension.
class OtherMshElements {
 public:
  /// True for the types of volume elements other than linear tets.
  static bool is_volume(std::int64_t type);

  /// A name of section $PhysicalNames; `dimension` is 0 to 3.
  void add_name(std::int64_t dimension, std::int64_t group, const std::string& name);
  /// A physical group of an entity that has another one before it, which counts.
  void add_further_group(std::size_t dimension, std::int64_t group);
  /// A volume element other than a linear tet, also one of a type that is_volume() does not know.
  void add_volume(std::int64_t type, std::int64_t element, std::size_t line);
  /// A point, line or face other than a linear triangle; `group` is its physical group, 0 for none.
  void add_flat(std::int64_t type, std::int64_t group);
  /// A linear triangle; its nodes as indices of points, no_index for a node that the file does not have.
  void add_triangle(const Triangle& ids, std::int64_t group) { triangles_.add(ids, group); }
  /// A quad of a surface, as two triangles.
  void add_quad(const std::array<Index, 4>& ids, std::int64_t group) { triangles_.add_quad(ids, group); }

  /// The triangles so far.
  std::vector<Triangle>& triangles() { return triangles_.triangles; }

  /// Throws InputError if there were volume elements.
  void refuse_volumes(const std::string& file) const;
  /// Takes the triangles, see take_triangles(), and adds all the rest to `read.dropped`. To be called when
  /// the materials are known.
  void finish(const std::string& file, ReadTetMesh& read) const;
  /// The triangles as a surface, see surface_of(); all the rest is added to `dropped`, unless that is null.
  TriangleMesh surface(std::vector<Vec3> points, const std::string& file,
                       std::vector<Dropped>* dropped) const;

 private:
  struct OfKind {
    std::size_t elements = 0;
    std::set<std::int64_t> groups;  ///< without 0
  };

  void note_dropped(std::vector<Dropped>& dropped) const;
  const std::map<std::int64_t, std::string>& names_of(std::size_t dimension) const {
    return dimension == 2 ? triangles_.names : names_[dimension];
  }

  std::array<std::map<std::int64_t, std::string>, 4> names_;  ///< by dimension, but for faces
  FileTriangles triangles_;                                   ///< with the names of groups of faces
  std::array<std::set<std::int64_t>, 4> further_groups_;      ///< by dimension
  std::map<std::int64_t, OfKind> flat_;                       ///< by type
  std::map<std::int64_t, std::size_t> volumes_;               ///< numbers by type
  std::int64_t first_volume_ = 0, first_volume_type_ = 0;
  std::size_t first_volume_line_ = 0;
};

}  // namespace tetwright

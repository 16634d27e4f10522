// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Faces inside a mesh at which its two sides are to part: contact, cohesive zones, cracks.
struct InterfaceToPart {
  /// All faces between these two materials, the smaller tag first; std::nullopt: the faces of `group`.
  std::optional<std::pair<MaterialTag, MaterialTag>> materials = {};
  std::string group = {};  ///< name of a sheet, or of a part of an interface
  bool cohesive = false;   ///< wedges join the two sides
};

/// An interface that was parted.
struct PartedInterface {
  /// Name of the pair of materials, "bone|implant"; or of the faces' group, if that was to part.
  std::string name;
  /// Groups of the two sides, NAME:SIDE: "bone|implant:bone" and "bone|implant:implant". The sides of a sheet
  /// are "back", from which its normals point away, and "front".
  std::array<std::string, 2> sides;
  /// Groups with faces between the materials, whose names those of the sides replace.
  std::vector<std::string> renamed_groups = {};
  bool cohesive = false;
  std::size_t faces = 0;  ///< on each side
  /// Faces that stay as they are, since the tets around each of their corners are connected elsewhere: all
  /// corners lie on the border of what is parted.
  std::size_t joined_faces = 0;
  std::vector<Vec3> joined_places = {};  ///< centres of the first few of these, input units
  /// Wedges with one or two edges of a single point, at the border of what is parted.
  std::size_t degenerate_wedges = 0;
  /// Points with equal coordinates on the first and the second side, in ascending order of the first. With
  /// midside nodes also these, numbered after the points.
  std::vector<std::array<Index, 2>> pairs = {};
};

/// Doubles the points of interfaces, so that both sides have faces and points of their own.
///
/// A point gets a copy for each group of tets at it that are connected across faces which are not parted,
/// less one: three where three parted bodies meet, none at the border of a crack inside a body. The first of
/// these groups (by tets) keeps the point, copies are appended. The interface triangles of both sides become
/// faces of the boundary, in groups named after their interface and side. With InterfaceToPart::cohesive each
/// pair of faces becomes a wedge (TetMesh::wedges). Fields are copied.
///
/// \param mesh a mesh with its interfaces; changed
/// \param midside the mesh's midside nodes, changed accordingly; may be null
/// \param interfaces the first one with a face decides on it
/// \return what was parted: for each group and each pair of materials with faces, by name
/// \pre indices in range; each face has at most two tets
/// \throws OutputError if a material would have more than 65,536 patches
std::vector<PartedInterface> part_interfaces(TetMesh& mesh, MidsideNodes* midside,
                                             std::span<const InterfaceToPart> interfaces);

/// Result of join_parted_interfaces().
struct JoinedInterfaces {
  std::vector<InterfaceToPart> parts;  ///< for part_interfaces(), which parts them again
  std::vector<std::string> names;      ///< of the parts
  std::size_t points = 0;              ///< number of points that were joined with another
  /// Wedges between faces that are not both in named groups of a parted interface; they are removed.
  std::size_t other_wedges = 0;
  /// Wedges that are there twice, and faces of interfaces with wedges that have none. part_interfaces() makes
  /// one for each face.
  std::size_t repeated_wedges = 0, missing_wedges = 0;
  /// Names of point fields, and in how many joined points their values differed from that of the first copy.
  std::vector<std::pair<std::string, std::size_t>> lost_values;
  /// Interfaces whose groups have the names of sides, but do not coincide, and their faces without a
  /// counterpart. They stay apart.
  std::vector<std::pair<std::string, std::size_t>> apart;
};

/// Undoes part_interfaces(): finds pairs of groups of boundary faces with the names NAME:A and NAME:B of
/// sides whose faces coincide one by one, with exactly equal coordinates, and joins their points. Their faces
/// become the interface again, in the group NAME unless that is the name of its materials. Other faces that
/// coincide stay apart. Wedges are removed. A joined point has the field values of its first copy. O(n log
/// n).
///
/// \param mesh changed if there is such a pair, or a wedge; then its interfaces are recomputed
/// \pre indices in range; mesh.interfaces are faces of tets
JoinedInterfaces join_parted_interfaces(TetMesh& mesh);

/// Table of the pairs of points as CSV, for constraints between them: name of the interface, number of the
/// point on the first side and on the second. Numbers count from 1, as in the files of solvers.
std::string table_of_pairs(std::span<const PartedInterface> parted);

/// The faces of both sides of all parted interfaces that join_parted_interfaces() would find, as indices into
/// TetMesh::interfaces, ascending.
std::vector<std::size_t> parted_faces(const TetMesh& mesh);

/// Whether the corners k and k + 3 of a wedge have equal coordinates, but are not the same points everywhere:
/// a cohesive element.
///
/// \pre indices in range
bool is_cohesive(const Wedge& wedge, std::span<const Vec3> points);

/// The wedges of each parted interface (indices into TetMesh::wedges, ascending), by its name.
///
/// \pre the mesh is a result of part_interfaces(), or a file of it
std::map<std::string, std::vector<std::size_t>> wedges_by_interface(const TetMesh& mesh);

}  // namespace tetwright

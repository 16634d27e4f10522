// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tetwright/sizes.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Faces whose corners are all within a distance of a plane.
struct InPlane {
  enum class At { value, min, max };
  Vec3 normal;            ///< of any length above 0
  At at = At::value;      ///< min, max: the smallest or largest coordinate along `normal` on the boundary
  double coordinate = 0;  ///< with At::value: coordinate along `normal`, input units if that has length 1
  Length tolerance = {0.1, true};  ///< may be 0; percent of the diagonal of the mesh's bounding box
};

/// Faces whose corners are all in a box.
struct InBox {
  Vec3 low, high;
};

/// Faces whose corners are all in a ball.
struct InSphere {
  Vec3 centre;
  double radius;
};

/// Faces whose corners are all in a cylinder.
struct InCylinder {
  Vec3 from, to;  ///< centres of its ends
  double radius;
};

/// Faces whose normals, out of the mesh, deviate from a direction by at most an angle.
struct WithNormal {
  Vec3 direction;  ///< of any length above 0
  double degrees;  ///< 0 to 180
};

/// The face nearest to a point (of equally near ones the first in the mesh), and all that are connected with
/// it by edges inside its patch: up to creases and the borders of groups.
struct PatchAt {
  Vec3 point;
};

/// A rule for faces.
struct SelectionTerm {
  std::variant<InPlane, InBox, InSphere, InCylinder, WithNormal, PatchAt> rule;
  std::string text;  ///< as given, for messages
};

/// A named set of boundary faces: those that fulfil all rules.
struct FaceSelection {
  std::string name;
  std::vector<SelectionTerm> terms;  ///< at least one
};

/// Parses rules that are joined by "and":
///
/// - `plane:z=min,0.5%`: corners within 0.5 % of the diagonal of the smallest z. The axis is x, y, z or a
///   normal A,B,C; the coordinate a number, min or max; the tolerance a length or percentage, by default 0.1
///   %
/// - `box:X,Y,Z,X,Y,Z`: corners in the box between these two points
/// - `sphere:X,Y,Z,R`, `cylinder:X,Y,Z,X,Y,Z,R`: corners in the ball, or in the cylinder between two points
/// - `normal:X,Y,Z,D`: normals out of the mesh within D degrees of this direction
/// - `patch-at:X,Y,Z`: the nearest face, and those connected with it up to creases and other groups
///
/// \throws UsageError that quotes the rule and shows a correct one
FaceSelection parse_face_selection(const std::string& name, const std::string& rules);

/// Outcome of a selection.
struct SelectedFaces {
  std::string name;
  std::size_t faces = 0;
  double area = 0;  ///< input units squared
  /// Names of groups that lost faces to this selection, with their numbers.
  std::vector<std::pair<std::string, std::size_t>> taken = {};
  std::size_t in_earlier = 0;              ///< faces that an earlier selection has
  std::string nearest = {};                ///< without faces: what was nearest, for messages
  std::optional<Vec3> nearest_place = {};  ///< centre of that face
  /// PatchAt rules whose point is more than 1 % of the diagonal of the mesh's bounding box from the nearest
  /// face, as given, with that distance in input units.
  std::vector<std::pair<std::string, double>> far_points = {};
};

/// Selects boundary faces of a mesh and makes each selection a group of its faces. A face that several rules
/// select belongs to the first of them; one that belonged to a group leaves it.
///
/// \param mesh with its interfaces, whose patches change
/// \return one for each selection
/// \throws OutputError if a material would have more than 65,536 patches
std::vector<SelectedFaces> select_faces(TetMesh& mesh, const std::vector<FaceSelection>& selections);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "mesher/complex/surface_imprint.h"
#include "tetwright/mesher_input.h"

namespace tetwright {

/// All surfaces of an input as one complex of triangles, each with the region on either side. Two triangles
/// share points or an edge, or are apart; a contact is one sheet that both bodies share.
///
/// Regions are numbered by body: 0 is the outside, b + 1 is body b. With OverlapRule::material those of
/// volumes that several bodies claim follow. Immutable; input units.
class LabelledComplex {
 public:
  /// The part of a body's surface that a triangle is.
  struct Source {
    std::uint32_t body;
    Index triangle;  ///< index into the body's ComplexResult::body_triangles
    bool turned;     ///< the body's triangle runs the other way
  };
  struct Face {
    Triangle ids;
    RegionIndex behind, front;  ///< regions; the normal points to the front
  };
  /// A triangle of an open sheet inside a region.
  struct SheetFace {
    Triangle ids;  ///< as the sheet is oriented
    RegionIndex region;
    std::uint32_t sheet;  ///< index into MesherInput::sheets
    /// Faces of one component are connected across edges of exactly two triangles of sheets.
    std::uint32_t component;
  };

  std::vector<Vec3> points;
  std::vector<Face> faces;  ///< with different regions on both sides
  std::vector<SheetFace> sheets;
  std::uint32_t sheet_components = 0;
  std::span<const Source> sources(Index face) const {
    return std::span(sources_).subspan(starts_[face], starts_[face + 1] - starts_[face]);
  }
  /// True for faces of contacts: both sides belong to materials, and both bodies have the surface.
  bool is_contact(Index face) const {
    return faces[face].behind != outside_region && faces[face].front != outside_region &&
           sources(face).size() > 1;
  }
  /// Edges, ascending, with other than two faces, or with faces of different pairs of regions; also those at
  /// which a sheet meets a face.
  const std::vector<std::array<Index, 2>>& junctions() const { return junctions_; }

 private:
  friend class ComplexBuilder;
  std::vector<Source> sources_;
  std::vector<std::size_t> starts_;
  std::vector<std::array<Index, 2>> junctions_;
};

/// Two bodies that cross: neither contains the other.
struct BodyOverlap {
  std::size_t first, second;  ///< bodies, ascending
  double volume = 0;          ///< that both claim, input units cubed
  Vec3 place = Vec3::Zero();  ///< on the boundary of its largest cell
};

/// The faces that two bodies share.
struct BodyContact {
  std::size_t first, second;   ///< bodies, ascending
  double area = 0;             ///< input units squared
  std::size_t pieces = 0;      ///< connected by edges
  double largest_gap = 0;      ///< closed by imprinting, input units
  double largest_overlap = 0;  ///< likewise
};

/// Triangles of sheets that are in no sheet of the complex.
struct SheetLoss {
  double area = 0;            ///< input units squared
  Vec3 place = Vec3::Zero();  ///< the centre of the largest triangle
  double largest = 0;         ///< area of that triangle

  void add(double own, const Vec3& centre) {
    area += own;
    if (own > largest) largest = own, place = centre;
  }
};

/// The areas of a sheet, by fate.
struct SheetFate {
  double kept = 0;     ///< area in the complex, input units squared
  SheetLoss outside;   ///< in no body
  SheetLoss on_faces;  ///< on a face between two regions
  SheetLoss repeated;  ///< on another sheet
};

struct ComplexResult {
  LabelledComplex complex;
  /// Each body's own surface as it is in the complex, before later bodies carve it, but without what earlier
  /// ones keep (OverlapRule::first); triangles as counted by LabelledComplex::Source. Common volumes follow.
  std::vector<std::vector<Triangle>> body_triangles;
  /// For each of them, the triangle of the soup that it is a part of, or no_index if the body's own surface
  /// does not run there.
  std::vector<std::vector<Index>> body_sources;
  /// The bodies, ascending, that claim each common volume; with OverlapRule::material.
  std::vector<std::vector<std::size_t>> common;
  std::vector<BodyOverlap> overlaps;  ///< by pair
  std::vector<BodyContact> contacts;  ///< by pair
  std::vector<char> lost;             ///< by body: nothing of it is left after carving
  std::optional<Vec3> inconsistent;   ///< a point where the cells contradict the bodies' orientation
  /// A body whose volume differs by more than moves within the tolerance explain: merging has torn it, as
  /// the tolerance is larger than parts of it. Not looked for with OverlapRule::first.
  std::optional<std::size_t> torn;
  std::vector<SheetFate> sheets;  ///< by sheet
  double peak_bytes = 0;          ///< estimated peak memory of imprinting and labelling
};

/// The sheets among imprinted surfaces: those after the bodies.
struct SoupSheets {
  std::vector<std::uint32_t> sheet;  ///< by triangle of the soup; unused for bodies
  std::size_t count = 0;
};

/// Builds the complex of closed bodies from their imprinted surfaces. A point belongs to the last body that
/// contains it (positive winding number); among bodies that cross, the rule decides.
/// \param soup what was imprinted; surfaces are bodies
/// \param bodies number of bodies; surfaces of the soup from there on are open sheets
/// \param sheets of the soup
/// \param progress may be null
/// \throws OutputError if it needs more memory than is available, see require_memory()
/// \throws Interrupted
ComplexResult build_complex(const ImprintedSurfaces& imprinted, const SurfaceSoup& soup, std::size_t bodies,
                            double tolerance, OverlapRule rule = OverlapRule::later,
                            const SoupSheets& sheets = {}, Progress* progress = nullptr);

}  // namespace tetwright

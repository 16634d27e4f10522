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

  std::vector<Vec3> points;
  std::vector<Face> faces;  ///< with different regions on both sides
  std::span<const Source> sources(Index face) const {
    return std::span(sources_).subspan(starts_[face], starts_[face + 1] - starts_[face]);
  }
  /// True for faces of contacts: both sides belong to materials, and both bodies have the surface.
  bool is_contact(Index face) const {
    return faces[face].behind != outside_region && faces[face].front != outside_region &&
           sources(face).size() > 1;
  }
  /// Edges, ascending, with other than two faces, or with faces of different pairs of regions.
  const std::vector<std::array<Index, 2>>& junctions() const { return junctions_; }
  /// True if there is a contact or a junction.
  bool any() const { return !junctions_.empty() || has_contacts_; }

 private:
  friend class ComplexBuilder;
  std::vector<Source> sources_;
  std::vector<std::size_t> starts_;
  std::vector<std::array<Index, 2>> junctions_;
  bool has_contacts_ = false;
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
};

/// Builds the complex of closed bodies from their imprinted surfaces. A point belongs to the last body that
/// contains it (positive winding number); among bodies that cross, the rule decides.
/// \param soup what was imprinted; surfaces are bodies
/// \param bodies number of bodies
ComplexResult build_complex(const ImprintedSurfaces& imprinted, const SurfaceSoup& soup, std::size_t bodies,
                            double tolerance, OverlapRule rule = OverlapRule::later);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "tetwright/mesher_input.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A part of a surface that is reoriented as a whole or not at all.
struct SurfaceComponent {
  std::vector<Index> triangles;  ///< ascending
  bool closed = false;           ///< every edge is used equally often in both directions
};

/// Appends a finding unless `count` is 0.
void add_finding(std::vector<Diagnostic>& findings, DiagnosticCode code, const std::string& what,
                 std::size_t count, const std::optional<Vec3>& place, const std::string& done);

/// Orients neighbouring triangles consistently, by the majority of each patch, and returns the components in
/// the order of their first triangles. Inner walls and fins belong to no component.
///
/// A *patch* is connected across edges of exactly two triangles. Edges of one, three or more triangles are
/// *seams*:
/// - a patch that balances at each of its seams on its own (like each of two cubes that share an edge) is a
///   closed component;
/// - so is a group of patches that balance together after patches with free edges are set aside. Patches are
///   reversed, small ones first, as long as that makes more edges balance;
/// - a patch whose whole boundary lies on seams that are closed without it is an inner wall. Among three
///   patches with common seams, the smallest one is;
/// - a patch that the file lists from both sides and that has free edges and seams is a fin;
/// - all others are open components, merged with those that continue them.
///
/// \param two_sided by triangle
/// \pre triangles have three different corners, and none is repeated
/// \throws InputError if a patch is one-sided
std::vector<SurfaceComponent> split_into_components(const std::vector<Vec3>& points,
                                                    std::vector<Triangle>& triangles,
                                                    const std::vector<char>& two_sided,
                                                    const std::string& file,
                                                    std::vector<Diagnostic>& findings);

}  // namespace tetwright

#pragma once

#include <string>
#include <vector>

#include "common/types.h"
#include "mesher/surface_input.h"

namespace tetwright {

/// A part of a surface that is turned over as a whole or not at all.
struct SurfaceComponent {
  std::vector<Index> triangles;  ///< ascending
  bool closed = false;           ///< each edge is run through as often one way as the other
};

/// Appends a finding, unless there is nothing to report.
void add_finding(std::vector<SurfaceFinding>& findings, const std::string& what, std::size_t count,
                 const std::optional<Vec3>& place, const std::string& done);

/// "(x, y, z)" for messages.
std::string place_text(const Vec3& p);

/// Winds neighbours alike, by the majority of each patch, and finds the components, in the order of their
/// first triangles. Inner walls and fins are in none of them. Triangles have three different corners, none
/// repeats.
///
/// A *patch* hangs together across edges of exactly two triangles. Where patches meet, at *seams* of one,
/// three or more triangles:
/// - a patch that balances at each of its seams by itself (each of two cubes that share an edge) is a closed
///   component;
/// - so is a group of patches that balance together, after what hangs on free edges is set aside; patches are
///   turned over, small ones first, as long as that makes more edges balance;
/// - a patch that ends nowhere but at seams of other triangles that need no closing is an inner wall; where
///   three patches share their seams the smallest one is;
/// - a patch that the file lists from both sides (`two_sided`, of each triangle) and that has free edges and
///   seams is a fin;
/// - all others are open components, together with those that continue them.
///
/// Throws InputError if a patch is one-sided.
std::vector<SurfaceComponent> split_into_components(const std::vector<Vec3>& points,
                                                    std::vector<Triangle>& triangles,
                                                    const std::vector<char>& two_sided,
                                                    const std::string& file,
                                                    std::vector<SurfaceFinding>& findings);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tetwright/diagnostic.h"
#include "tetwright/surface_mesh.h"

namespace tetwright {

/// Brings the surfaces of a call into the coordinate system of its first input, and reports which ones
/// changed and of which ones the system is unknown. Use: begin_with() if there is a volume, add() for each
/// surface.
class SurfaceSpaces {
 public:
  /// \param space that of surfaces whose files name none, see BodyOptions::surface_space; empty: unknown
  explicit SurfaceSpaces(std::string space) : of_others_(std::move(space)) {}

  /// Makes a volume the first input.
  /// \param space its system; empty: unknown
  /// \param file name of the volume for messages
  /// \throws UsageError if there is a space for surfaces whose files name none, and that of the volume is not
  ///   anatomical or unknown, so that they cannot be compared
  void begin_with(const std::string& space, const std::string& file);
  /// Brings a surface into the system of the first input, which it becomes if there is none. A surface whose
  /// system is unknown stays as it is.
  /// \param file name of the surface for messages
  void add(TriangleMesh& surface, const std::string& file);

  /// System of the surfaces that were added; empty: unknown.
  const std::string& space() const { return first_space_; }
  std::vector<Diagnostic> findings() const;

 private:
  using Files = std::vector<std::string>;

  std::string of_others_, first_space_, first_file_;
  std::map<std::string, Files> converted_, not_comparable_;  ///< by the system of the surface
  Files without_space_;
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tetwright/diagnostic.h"
#include "tetwright/prepare.h"
#include "tetwright/sizes.h"
#include "tetwright/surface_mesh.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Ends a message about a tet mesh whose space is unknown.
inline constexpr const char* mesh_space_hint = "; --mesh-space LPS or RAS names it";

/// The coordinate system of a tet mesh: its own, else that of PrepareOptions::mesh_space. If both are known
/// and differ, a note in the report names them. \param file name of the mesh for messages
std::string space_of_tets(const TetMesh& mesh, const std::string& file, const std::string& mesh_space,
                          PrepareReport& report);

/// Brings the surfaces of a call into the coordinate system of its first input, and reports which ones
/// changed and of which ones the system is unknown. Use: begin_with() if the first input is a volume or a tet
/// mesh, add() for each surface.
class SurfaceSpaces {
 public:
  /// \param space that of surfaces whose files name none, see BodyOptions::surface_space; empty: unknown
  /// \param what singular of what is added, for messages
  explicit SurfaceSpaces(std::string space, std::string what = "surface")
      : of_others_(std::move(space)), what_(std::move(what)) {}

  /// Makes a volume or a tet mesh the first input.
  /// \param space its system; empty: unknown
  /// \param file name of the input for messages
  /// \throws UsageError if there is a space for surfaces whose files name none, but that of the first input
  /// is
  ///   unknown or not anatomical, so that the two cannot be compared
  void begin_with(const std::string& space, const std::string& file, bool tet_mesh = false);
  /// Brings a surface into the system of the first input, which it becomes if there is none. A surface whose
  /// system is unknown stays as it is; nothing is reported of one that is a value in memory, which has the
  /// coordinates of the caller's other ones unless it says so.
  /// \param input of the surface, which may have been moved out of it; only named in messages
  void add(TriangleMesh& surface, const Input& input);
  /// Brings sizes into the system of the first input.
  /// \pre begin_with() was called
  void add(std::shared_ptr<const SizeSource>& sizes, const std::string& file);

  /// System of the surfaces that were added; empty: unknown.
  const std::string& space() const { return first_space_; }
  std::vector<Diagnostic> findings() const;
  /// Describes the systems of an input and of the first one, with the options that name unknown ones.
  /// \param space system of the input before it was added; empty: unknown
  std::string both_spaces(const std::string& space, const std::string& file) const;

 private:
  using Files = std::vector<std::string>;

  /// Notes what becomes of an input.
  /// \param converted whether it was brought from `before` into the system of the first input
  void note(const std::string& before, bool converted, const std::string& file);

  std::string of_others_, what_, first_space_, first_file_;
  bool first_is_tet_mesh_ = false;
  std::map<std::string, Files> converted_, not_comparable_;  ///< by the system of the surface
  Files without_space_;
};

}  // namespace tetwright

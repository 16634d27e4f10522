// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <string>

#include "common/io/encodings/byte_order.h"
#include "common/io/names/mesh_parts.h"
#include "common/io/tets/msh_elements.h"
#include "common/io/tets/msh_groups.h"
#include "common/io/text/text_writer.h"

namespace tetwright {

inline constexpr int surface_dimension = 2, volume_dimension = 3;

/// Writes the numbers of a section as text or little-endian.
class Msh4Numbers {
 public:
  Msh4Numbers(TextWriter& out, bool binary) : out_(out), binary_(binary) {}

  /// Writes the section that describes the file.
  void begin_file() {
    out_ << "$MeshFormat\n4.1 " << (binary_ ? 1 : 0) << " 8\n";
    if (binary_) {
      integer(1);
      out_ << '\n';
    }
    out_ << "$EndMeshFormat\n";
  }
  Msh4Numbers& integer(std::int64_t value) { return put(static_cast<std::int32_t>(value)); }
  Msh4Numbers& size(std::size_t value) { return put(std::uint64_t{value}); }
  Msh4Numbers& real(double value) { return put(value); }
  /// Ends a line in a text file.
  void end_line() {
    if (!binary_) out_ << '\n';
    begins_line_ = true;
  }
  /// Ends the section with "$End" and its name.
  void end(const char* section) { out_ << (binary_ ? "\n$End" : "$End") << section << '\n'; }

 private:
  template <class Number>
  Msh4Numbers& put(Number value) {
    if (binary_) {
      bytes_.clear();
      append_bytes(bytes_, value);
      out_ << bytes_;
    } else {
      if (!begins_line_) out_ << ' ';
      out_ << value;
    }
    begins_line_ = false;
    return *this;
  }

  TextWriter& out_;
  bool binary_;
  bool begins_line_ = true;
  std::string bytes_;
};

/// Numbers of the volumes and their physical groups, by material.
inline std::map<std::int64_t, std::int64_t> msh4_volumes(const TetMesh& mesh) {
  return positive_numbers(tags_of(mesh.materials), std::numeric_limits<std::int32_t>::max());
}

/// Writes the names of physical groups, and comments with those tags that cannot be their numbers.
/// \param further names of further groups of volumes, by number
inline void write_msh4_groups(TextWriter& out, const MshGroups& groups,
                              const std::map<std::int64_t, std::int64_t>& physical,
                              const std::map<std::int64_t, std::string>& further = {}) {
  bool any = false;
  for (const auto& [tag, number] : physical) {
    if (tag == number) continue;
    if (!any) out << "$Comments\n";
    any = true;
    out << msh_material_comment << number << ' ' << tag << '\n';
  }
  if (any) out << "$EndComments\n";
  std::map<std::int64_t, std::string> volumes = further;
  for (const auto& [tag, name] : groups.material_names)
    if (const auto number = physical.find(tag); number != physical.end()) volumes[number->second] = name;
  if (volumes.empty() && groups.face_names.empty()) return;
  out << "$PhysicalNames\n" << groups.face_names.size() + volumes.size() << '\n';
  for (const auto& [number, name] : groups.face_names)
    out << surface_dimension << ' ' << number << " \"" << name << "\"\n";
  for (const auto& [number, name] : volumes)
    out << volume_dimension << ' ' << number << " \"" << name << "\"\n";
  out << "$EndPhysicalNames\n";
}

}  // namespace tetwright

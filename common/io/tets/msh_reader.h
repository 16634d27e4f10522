// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/io/elements/file_numbers.h"
#include "common/io/elements/midside_nodes_read.h"
#include "common/io/encodings/msh_numbers.h"
#include "common/io/tets/msh_elements.h"
#include "common/io/text/text_scanner.h"
#include "tetwright/io.h"

namespace tetwright {

/// Number of a group of faces or of lower dimension, without the sign by which Gmsh marks the opposite
/// orientation.
inline std::int64_t without_sign(std::int64_t number) {
  return number < 0 && number != std::numeric_limits<std::int64_t>::min() ? -number : number;
}

/// Implements the reading functions of msh.h; an object reads one file once. The sections of the file and the
/// assembly of the result are in msh_reader.cpp; nodes, entities and elements of each version are in
/// msh_reader_mesh.cpp.
class MshReader {
 public:
  MshReader(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options)
      : in_(bytes, name), options_(options), bytes_(bytes) {}

  ReadTetMesh read();
  TriangleMesh read_surface(std::vector<Dropped>* dropped);
  /// \return std::nullopt for a file with tets
  std::optional<SurfaceWithFields> read_surface_with_fields();

 private:
  struct EntityName {
    std::int64_t dimension, number;
  };

  void read_sections();
  void read_format();
  void expect(std::string_view end);
  /// Keeps a copy of the scanner at a section of data, or skips the section. Data are read once all nodes and
  /// elements are known.
  void keep_or_skip(std::string_view section);
  /// Reads the comments of write_msh41() that give material tags which cannot be group numbers.
  void read_comments(const std::string& end);
  /// Material of a physical group of tets.
  std::int64_t tag_of(std::int64_t group) const;
  void read_names();
  /// \param room as for read_msh_data()
  void read_node_data(std::size_t& room);
  void read_data();
  void set_materials();
  void note_dropped();

  // Defined in msh_reader_mesh.cpp.
  Vec3 read_point();
  std::size_t begin_nodes(std::size_t n);
  void end_nodes();
  void read_nodes_2();
  void read_nodes_4();
  /// Reads the minimum and maximum number of a node or element.
  void read_range_of_numbers();
  EntityName read_entity();
  void read_entities();
  void begin_elements();
  /// Reads the number of a node or element, which is stored as a size in binary files of version 4.1.
  std::int64_t read_node(const char* what) {
    return version_4_ && !version_40_ ? numbers_.size(what) : numbers_.integer(what);
  }

  /// \param needed true: a missing node is an error
  template <class Ids>
  Ids read_ids(std::int64_t element, bool needed, const char* what) {
    Ids ids;
    for (Index& vertex : ids) {
      const std::int64_t node = read_node(what);
      vertex = nodes_.find(node);
      if (needed && vertex == no_index)
        in_.fail("element " + std::to_string(element) + " refers to node " + std::to_string(node) +
                 ", which is not in $Nodes; export the file again");
    }
    return ids;
  }

  /// Reads a face. Quads are read only for a surface, not in a file with tets.
  /// \return false if faces of this type are not read
  bool read_face(std::int64_t type, std::int64_t element, std::int64_t group);
  /// Reads a tet of four nodes, or of ten nodes with the corners first.
  void read_tet(std::int64_t type, std::int64_t element);
  /// Reads a wedge: a cohesive element, or a volume that is refused.
  void read_wedge(std::int64_t element);
  static bool is_tet(std::int64_t type) {
    return type == element::tet.msh || type == element::quadratic_tet.msh;
  }

  /// Skips the nodes of an element: in a text file the rest of its line.
  void skip_nodes(std::int64_t type);
  /// Version 2: each element has its own line: number, type, tags, nodes. Binary files give the type and the
  /// number of tags once for several elements.
  void read_elements_2();
  void read_elements_4();
  void end_elements();
  void add_groups(std::int64_t physical, std::int64_t geometrical);

  static constexpr const char* geometrical_name = "gmsh:geometrical";

  TextScanner in_;
  MshNumbers numbers_{in_};
  const ReadTetMeshOptions& options_;
  std::string_view bytes_;
  ReadTetMesh result_;
  FileNumbers nodes_, elements_;
  /// First physical group of the entities of each dimension.
  std::array<std::unordered_map<std::int64_t, std::int64_t>, 4> entity_to_group_;
  std::vector<MaterialTag> geometrical_;
  std::vector<std::int64_t> tet_numbers_;
  MidsideNodesRead midside_;
  std::map<std::int64_t, MaterialTag> group_to_tag_;  ///< from comments of write_msh41()
  std::vector<TextScanner> node_data_, element_data_;
  OtherMshElements others_;
  std::map<std::string, std::int64_t> surface_names_;        ///< physical groups of faces by name
  std::set<std::pair<std::int64_t, std::int64_t>> volumes_;  ///< physical and geometrical groups of the tets
  std::pair<std::int64_t, std::int64_t> last_volume_;
  std::size_t partitioned_ = 0;
  std::vector<std::string> empty_fields_, fields_of_others_, other_sections_;  ///< names of ignored contents
  bool surface_ = false;  ///< true: a surface is read, not tets
  bool version_4_ = false, version_40_ = false;
  bool has_elements_ = false;
  bool any_physical_ = false, any_geometrical_ = false;
  bool keep_numbers_ = false;  ///< keep the numbers of tets: fields refer to them, or they are out of order
};

}  // namespace tetwright

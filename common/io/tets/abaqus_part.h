// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/io/elements/file_numbers.h"
#include "common/io/tets/abaqus_lines.h"
#include "tetwright/tet_mesh.h"

namespace tetwright {

/// Contents of a *PART, of an *INSTANCE, or of the file outside of both, which includes the assembly. Numbers
/// and names are its own.
class AbaqusPart {
 public:
  /// Element numbers in a set, and the names, in upper case, of sets that it includes.
  struct Members {
    std::string instance;  ///< to which they belong, in upper case; empty: this part
    std::size_t line;      ///< of the keyword
    std::vector<std::int64_t> numbers;
    std::vector<std::string> sets;
  };
  struct Side {
    std::string what;  ///< an element number, or the name of a set in upper case
    int side;          ///< 1 to 4
    std::size_t line;
  };

  /// Reads the data lines of *NODE, *ELEMENT, *ELSET, *NSET, *SURFACE or *SOLID SECTION.
  /// \param instance mesh of the instance that INSTANCE= names; null: there is none
  /// \return false for other keywords, whose data lines are left
  /// \throws InputError with the line
  bool read(const AbaqusKeyword& keyword, AbaqusLines& in, const AbaqusPart* instance);

  /// Sorts the numbers of the elements, once all are read.
  /// \throws InputError if one appears twice
  void sort_elements(const AbaqusLines& in);

  /// Number of elements of all kinds.
  std::size_t element_count() const;

  bool has_set(const std::string& name) const { return block_sets.contains(name) || sets.contains(name); }

  // Nodes and elements, in the order of the file; indices are into `points`.
  std::vector<Vec3> points;
  std::vector<Tet> tets;
  std::vector<std::array<Index, 6>> midside;  ///< of the tets of ten nodes
  std::vector<Wedge> wedges;                  ///< cohesive elements
  FileNumbers nodes, elements;
  std::size_t first_tets_line = 0;  ///< line of the *ELEMENT keyword of the first tets; 0: none

  // Names are keys in upper case.
  std::vector<std::uint32_t> block_set;             ///< of each tet, as an index into block_names
  std::map<std::string, std::uint32_t> block_sets;  ///< indices into block_names
  std::vector<std::string> block_names;             ///< empty for *ELEMENT without ELSET
  std::map<std::string, std::vector<Members>> sets;
  std::map<std::string, std::string> set_names;               ///< as spelled in the file
  std::vector<std::pair<std::string, std::size_t>> sections;  ///< sets, with lines
  std::map<std::string, std::vector<Side>> surfaces;          ///< by name as spelled in the file

  // Contents that are not read, by kind.
  std::vector<std::pair<std::string, std::size_t>> volumes, others;
  std::size_t volumes_line = 0;
  std::vector<std::string> node_sets, other_surfaces;

 private:
  void read_nodes(AbaqusLines& in);
  void read_elements(const AbaqusKeyword& keyword, AbaqusLines& in);
  void read_set(const AbaqusKeyword& keyword, AbaqusLines& in, std::size_t max_numbers);
  void note_node_set(const AbaqusKeyword& keyword, AbaqusLines& in);
  void read_surface(const AbaqusKeyword& keyword, AbaqusLines& in);
  void note_section(const AbaqusKeyword& keyword, AbaqusLines& in);
  void sort_nodes(const AbaqusLines& in);
  Index node(std::int64_t element, std::int64_t number, const AbaqusLines& in) const;
  void add_tet(const std::vector<std::int64_t>& numbers, const std::string& set, const AbaqusLines& in);
  void add_wedge(const std::vector<std::int64_t>& numbers, const std::string& type, std::size_t line,
                 const AbaqusLines& in);
  std::uint32_t index_of_set(const std::string& set);

  bool sorted_ = false;
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/exodus.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "common/io/encodings/netcdf_image.h"
#include "common/io/names/group_text.h"
#include "common/io/names/mesh_fields.h"
#include "common/unique_names.h"
#include "common/utf8.h"

namespace tetwright {

namespace {

/// Number of the face opposite each vertex: side 1 has the nodes 1-2-4, side 2 2-3-4, side 3 1-3-4, side 4
/// 1-2-3.
constexpr std::array<std::int64_t, 4> side_numbers{2, 3, 1, 4};

/// libMesh, and so MOOSE, reads no more bytes of a name; older programs only the smaller number, which the
/// library of Exodus takes unless it is told otherwise.
constexpr std::size_t longest_name = 80, usual_name = 32;
/// "_" and ten digits, which make a name unique, and the component of a field.
constexpr std::size_t longest_suffix = 12;

/// Width of title and information records, and of QA records.
constexpr std::size_t line_width = 81, record_width = 33;

/// Version of the layout: that of the library which first had names longer than 32 bytes and integers of 64
/// bits.
constexpr float layout_version = 5.22F;
/// Flags of the library for files whose maps and whose other integers have 64 bits; numbers of blocks and
/// sets have 32.
constexpr std::int32_t int64_maps = 0x2000, int64_bulk = 0x8000;

/// Names of the components of a field: letters, by which programs recognize vectors, or numbers.
std::string component_name(const std::string& field, int components, int component) {
  constexpr std::array<char, 3> axes{'x', 'y', 'z'};
  if (components == 1) return field;
  if (components == 3) return field + "_" + axes[static_cast<std::size_t>(component)];
  return field + "_" + std::to_string(component + 1);
}

/// A variable of one component of a field.
struct ExodusVariable {
  const MeshField* field;
  int component;

  double value(std::size_t i) const {
    return field
        ->values[i * static_cast<std::size_t>(field->components) + static_cast<std::size_t>(component)];
  }
};

/// Variables of nodes or of elements.
struct ExodusVariables {
  std::vector<std::string> names;  ///< unique
  std::vector<ExodusVariable> variables;

  explicit ExodusVariables(const std::vector<MeshField>& fields) {
    UniqueNames unique([](const std::string& name) { return name; });
    const std::vector<std::string> of_fields = field_names_to_write(fields, {}, exodus_name);
    for (std::size_t f = 0; f < fields.size(); ++f)
      for (int c = 0; c < fields[f].components; ++c) {
        names.push_back(unique.add(component_name(of_fields[f], fields[f].components, c)));
        variables.push_back({&fields[f], c});
      }
  }
};

std::vector<std::int64_t> numbers_from_one(std::size_t count) {
  std::vector<std::int64_t> numbers(count);
  for (std::size_t i = 0; i < count; ++i) numbers[i] = static_cast<std::int64_t>(i) + 1;
  return numbers;
}

template <class Part>
std::vector<std::string> names_of(const std::vector<Part>& parts) {
  std::vector<std::string> names;
  names.reserve(parts.size());
  for (const Part& part : parts) names.push_back(part.name);
  return names;
}

template <class Part>
std::vector<std::int64_t> numbers_of_parts(const std::vector<Part>& parts) {
  std::vector<std::int64_t> numbers;
  numbers.reserve(parts.size());
  for (const Part& part : parts) numbers.push_back(part.number);
  return numbers;
}

class ExodusWriter {
 public:
  explicit ExodusWriter(const MeshToWrite& written)
      : written_(written),
        node_fields_(written.node_fields()),
        nodal_(node_fields_),
        elemental_(written.mesh.cell_fields),
        parts_(mesh_parts(written.mesh, exodus_names())) {
    for (const MeshParts::Surface& surface : parts_.surfaces)
      nodes_of_surfaces_.push_back(nodes_of_faces(written.mesh, surface.faces,
                                                  written.midside ? &written.midside->of_faces : nullptr));
  }

  /// Bytes of the largest variable, and of all variables that grow with the mesh.
  /// \param number bytes of an integer
  std::pair<std::size_t, std::size_t> bytes(std::size_t number) const {
    const std::size_t nodes = written_.nodes(), tets = written_.mesh.tets.size();
    std::size_t largest = std::max(sizeof(double) * nodes, number * tets);
    std::size_t all = sizeof(double) * (nodes * (3 + nodal_.names.size()) + tets * elemental_.names.size()) +
                      number * (nodes + tets * (1 + nodes_of_tet()));
    for (const MeshParts::Material& m : parts_.materials)
      largest = std::max(largest, number * nodes_of_tet() * m.tets.size());
    for (std::size_t s = 0; s < parts_.surfaces.size(); ++s)
      all += number * (2 * parts_.surfaces[s].faces.size() + nodes_of_surfaces_[s].size());
    return {largest, all};
  }

  void write(const ExodusForm& form, const ByteSink& sink) {
    NetcdfWriter file(form.large_variables || form.long_numbers ? NetcdfForm::data64 : NetcdfForm::offset64,
                      bytes(form.long_numbers ? sizeof(std::int64_t) : sizeof(std::int32_t)).second);
    define(file, form);
    file.end_definitions();
    put_records(file);
    put_nodes(file);
    put_blocks(file);
    put_sets(file);
    put_fields(file);
    file.write_to(sink);
  }

 private:
  /// Variables of a set of sides and nodes.
  struct SetVariables {
    int elements, sides, nodes;
  };

  std::size_t nodes_of_tet() const { return written_.midside ? 10 : 4; }

  std::size_t longest_used_name() const {
    std::size_t longest = usual_name;
    for (const auto& names :
         {names_of(parts_.materials), names_of(parts_.surfaces), nodal_.names, elemental_.names})
      for (const std::string& name : names) longest = std::max(longest, name.size());
    return longest;
  }

  void define(NetcdfWriter& file, const ExodusForm& form) {
    constexpr int whole = NetcdfWriter::whole_file;
    const std::size_t name_length = longest_used_name();
    file.attribute(whole, "api_version", layout_version);
    file.attribute(whole, "version", layout_version);
    file.attribute(whole, "floating_point_word_size", std::int32_t{sizeof(double)});
    file.attribute(whole, "file_size", std::int32_t{1});
    file.attribute(whole, "maximum_name_length", static_cast<std::int32_t>(name_length));
    file.attribute(whole, "int64_status", form.long_numbers ? int64_maps | int64_bulk : std::int32_t{0});
    file.attribute(whole, "title", "Tetrahedral mesh written by tetwright");

    const NetcdfType number = form.long_numbers ? NetcdfType::int64 : NetcdfType::int32;
    name_ = file.dimension("len_name", name_length + 1);
    const int record = file.dimension("len_string", record_width),
              line = file.dimension("len_line", line_width), four = file.dimension("four", 4),
              axes = file.dimension("num_dim", 3);
    time_ = file.record_dimension("time_step");
    nodes_ = file.dimension("num_nodes", written_.nodes());
    const int elements = file.dimension("num_elem", written_.mesh.tets.size());
    qa_ = file.variable("qa_records", NetcdfType::text, {file.dimension("num_qa_rec", 1), four, record});
    info_ = file.variable("info_records", NetcdfType::text, {file.dimension("num_info", 1), line});
    times_ = file.variable("time_whole", NetcdfType::real, {time_});
    for (std::size_t k = 0; k < 3; ++k)
      coordinates_[k] = file.variable(std::string("coord") + "xyz" [k], NetcdfType::real, { nodes_ });
    axis_names_ = file.variable("coor_names", NetcdfType::text, {axes, name_});
    node_numbers_ = file.variable("node_num_map", number, {nodes_});
    element_numbers_ = file.variable("elem_num_map", number, {elements});
    define_blocks(file, number);
    define_sets(file, number);
    define_fields(file);
  }

  /// Defines names, numbers and status of blocks or sets.
  std::array<int, 3> define_names(NetcdfWriter& file, const std::string& prefix, int dimension) const {
    const std::array<int, 3> variables{file.variable(prefix + "_names", NetcdfType::text, {dimension, name_}),
                                       file.variable(prefix + "_status", NetcdfType::int32, {dimension}),
                                       file.variable(prefix + "_prop1", NetcdfType::int32, {dimension})};
    file.attribute(variables[2], "name", "ID");
    return variables;
  }

  template <class Part>
  void put_names(NetcdfWriter& file, const std::array<int, 3>& variables,
                 const std::vector<Part>& parts) const {
    file.put(variables[0], names_of(parts));
    file.put(variables[1], std::vector<std::int64_t>(parts.size(), 1));
    file.put(variables[2], numbers_of_parts(parts));
  }

  void define_blocks(NetcdfWriter& file, NetcdfType number) {
    blocks_ = file.dimension("num_el_blk", parts_.materials.size());
    block_names_ = define_names(file, "eb", blocks_);
    for (std::size_t b = 0; b < parts_.materials.size(); ++b) {
      const std::string suffix = std::to_string(b + 1);
      tets_of_blocks_.push_back(file.dimension("num_el_in_blk" + suffix, parts_.materials[b].tets.size()));
      connectivity_.push_back(
          file.variable("connect" + suffix, number,
                        {tets_of_blocks_[b], file.dimension("num_nod_per_el" + suffix, nodes_of_tet())}));
      file.attribute(connectivity_[b], "elem_type", written_.midside ? "TETRA10" : "TETRA4");
    }
  }

  void define_sets(NetcdfWriter& file, NetcdfType number) {
    const std::size_t count = parts_.surfaces.size();
    if (count == 0) return;
    side_set_names_ = define_names(file, "ss", file.dimension("num_side_sets", count));
    node_set_names_ = define_names(file, "ns", file.dimension("num_node_sets", count));
    for (std::size_t s = 0; s < count; ++s) {
      const std::string suffix = std::to_string(s + 1);
      const int sides = file.dimension("num_side_ss" + suffix, parts_.surfaces[s].faces.size()),
                nodes = file.dimension("num_nod_ns" + suffix, nodes_of_surfaces_[s].size());
      sets_.push_back({file.variable("elem_ss" + suffix, number, {sides}),
                       file.variable("side_ss" + suffix, number, {sides}),
                       file.variable("node_ns" + suffix, number, {nodes})});
    }
  }

  void define_fields(NetcdfWriter& file) {
    if (!nodal_.names.empty()) {
      const int count = file.dimension("num_nod_var", nodal_.names.size());
      nodal_names_ = file.variable("name_nod_var", NetcdfType::text, {count, name_});
      for (std::size_t v = 0; v < nodal_.names.size(); ++v)
        nodal_values_.push_back(
            file.variable("vals_nod_var" + std::to_string(v + 1), NetcdfType::real, {time_, nodes_}));
    }
    if (elemental_.names.empty()) return;
    const int count = file.dimension("num_elem_var", elemental_.names.size());
    elemental_names_ = file.variable("name_elem_var", NetcdfType::text, {count, name_});
    table_ = file.variable("elem_var_tab", NetcdfType::int32, {blocks_, count});
    for (std::size_t v = 0; v < elemental_.names.size(); ++v)
      for (std::size_t b = 0; b < parts_.materials.size(); ++b)
        elemental_values_.push_back(
            file.variable("vals_elem_var" + std::to_string(v + 1) + "eb" + std::to_string(b + 1),
                          NetcdfType::real, {time_, tets_of_blocks_[b]}));
  }

  void put_records(NetcdfWriter& file) const {
    // Program, version, date and time; the latter would make every file another one.
    file.put(qa_, std::vector<std::string>{"tetwright", TETWRIGHT_VERSION, "", ""});
    file.put(info_, std::vector<std::string>{"Written by tetwright " TETWRIGHT_VERSION});
  }

  void put_nodes(NetcdfWriter& file) const {
    std::vector<double> values(written_.nodes());
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = written_.node(i)[static_cast<Eigen::Index>(k)];
      file.put(coordinates_[k], values);
    }
    file.put(axis_names_, std::vector<std::string>{"x", "y", "z"});
    file.put(node_numbers_, numbers_from_one(written_.nodes()));
  }

  void put_blocks(NetcdfWriter& file) const {
    put_names(file, block_names_, parts_.materials);
    std::vector<std::int64_t> numbers;
    for (std::size_t b = 0; b < parts_.materials.size(); ++b) {
      std::vector<std::int64_t> ids;
      ids.reserve(nodes_of_tet() * parts_.materials[b].tets.size());
      for (const Index t : parts_.materials[b].tets) {
        numbers.push_back(std::int64_t{t} + 1);
        for (const Index v : written_.mesh.tets[t]) ids.push_back(std::int64_t{v} + 1);
        if (written_.midside)
          for (const Index m : written_.midside->of_tets[t])
            ids.push_back(static_cast<std::int64_t>(written_.mesh.points.size() + m) + 1);
      }
      file.put(connectivity_[b], ids);
    }
    file.put(element_numbers_, numbers);
  }

  void put_sets(NetcdfWriter& file) const {
    if (sets_.empty()) return;
    put_names(file, side_set_names_, parts_.surfaces);
    put_names(file, node_set_names_, parts_.surfaces);
    // Sets refer to elements by their positions in the file.
    std::vector<std::int64_t> positions(written_.mesh.tets.size());
    std::int64_t position = 0;
    for (const MeshParts::Material& m : parts_.materials)
      for (const Index t : m.tets) positions[t] = ++position;
    const std::vector<TetFace> faces = faces_of_tets(written_.mesh);
    for (std::size_t s = 0; s < sets_.size(); ++s) {
      std::vector<std::int64_t> elements, sides, nodes;
      for (const std::size_t f : parts_.surfaces[s].faces) {
        elements.push_back(positions[faces[f].tet]);
        sides.push_back(side_numbers[faces[f].face]);
      }
      for (const Index node : nodes_of_surfaces_[s]) nodes.push_back(std::int64_t{node} + 1);
      file.put(sets_[s].elements, elements);
      file.put(sets_[s].sides, sides);
      file.put(sets_[s].nodes, nodes);
    }
  }

  void put_fields(NetcdfWriter& file) const {
    if (nodal_.names.empty() && elemental_.names.empty()) return;
    file.put(times_, std::vector<double>{0});
    std::vector<double> values;
    if (!nodal_.names.empty()) file.put(nodal_names_, nodal_.names);
    for (std::size_t v = 0; v < nodal_.names.size(); ++v) {
      values.clear();
      for (std::size_t i = 0; i < written_.nodes(); ++i) values.push_back(nodal_.variables[v].value(i));
      file.put(nodal_values_[v], values);
    }
    if (elemental_.names.empty()) return;
    file.put(elemental_names_, elemental_.names);
    file.put(table_, std::vector<std::int64_t>(parts_.materials.size() * elemental_.names.size(), 1));
    for (std::size_t v = 0; v < elemental_.names.size(); ++v)
      for (std::size_t b = 0; b < parts_.materials.size(); ++b) {
        values.clear();
        for (const Index t : parts_.materials[b].tets) values.push_back(elemental_.variables[v].value(t));
        file.put(elemental_values_[v * parts_.materials.size() + b], values);
      }
  }

  const MeshToWrite& written_;
  std::vector<MeshField> node_fields_;
  ExodusVariables nodal_, elemental_;
  MeshParts parts_;
  std::vector<std::vector<Index>> nodes_of_surfaces_;

  // Dimensions and variables of the file.
  int name_ = 0, time_ = 0, nodes_ = 0, blocks_ = 0;
  int qa_ = 0, info_ = 0, times_ = 0, axis_names_ = 0, node_numbers_ = 0, element_numbers_ = 0;
  int nodal_names_ = 0, elemental_names_ = 0, table_ = 0;
  std::array<int, 3> coordinates_{}, block_names_{}, side_set_names_{}, node_set_names_{};
  std::vector<int> tets_of_blocks_, connectivity_, nodal_values_, elemental_values_;
  std::vector<SetVariables> sets_;
};

}  // namespace

NameRules exodus_names() {
  // libMesh is usually built with sets numbered in 16 bits; it does not say when a number does not fit.
  return {.form = exodus_name, .max_number = std::numeric_limits<std::int16_t>::max()};
}

std::string exodus_name(const std::string& name) {
  std::string word = printable_word(name);
  if (std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; })) word = "n" + word;
  std::size_t size = 0;
  while (size < word.size()) {
    const std::size_t next = size + first_utf8_part(std::string_view(word).substr(size)).size;
    if (next > longest_name - longest_suffix) break;
    size = next;
  }
  return word.substr(0, size);
}

ExodusForm exodus_form(std::size_t nodes, std::size_t tets, std::size_t largest_variable) {
  // Limits of CDF-2 on a variable and on a dimension.
  constexpr std::size_t max_bytes = std::numeric_limits<std::uint32_t>::max() - 3U,
                        max_count = std::numeric_limits<std::int32_t>::max() - 3U;
  return {.large_variables = largest_variable > max_bytes, .long_numbers = std::max(nodes, tets) > max_count};
}

void write_exodus_as(const ExodusForm& form, const MeshToWrite& written, const ByteSink& sink) {
  ExodusWriter(written).write(form, sink);
}

void write_exodus(const MeshToWrite& written, const ByteSink& sink) {
  ExodusWriter writer(written);
  writer.write(
      exodus_form(written.nodes(), written.mesh.tets.size(), writer.bytes(sizeof(std::int32_t)).first), sink);
}

}  // namespace tetwright

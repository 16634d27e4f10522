// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/msh_reader.h"

#include "common/io/encodings/byte_order.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/tets/msh.h"
#include "common/io/tets/msh_data.h"
#include "tetwright/error.h"

namespace tetwright {

ReadTetMesh MshReader::read() {
  read_sections();
  if (result_.mesh.tets.empty())
    in_.fail("there are no tets (type 4 or 11) in it; a volume mesh is needed, not a surface");
  read_data();
  midside_.remove_from(result_, others_.triangles());
  set_materials();
  note_dropped();
  return std::move(result_);
}

TriangleMesh MshReader::read_surface(std::vector<Dropped>* dropped) {
  surface_ = true;
  read_sections();
  if (!result_.mesh.tets.empty()) throw InputError(in_.name() + surface_expected(result_.mesh.tets.size()));
  TriangleMesh surface = others_.surface(std::move(result_.mesh.points), in_.name(), dropped);
  if (!dropped) return surface;
  for (const auto& [section, places] :
       {std::pair("fields of nodes", &node_data_), std::pair("fields of elements", &element_data_)})
    if (!places->empty()) dropped->push_back({section, places->size()});
  append_dropped_names(*dropped, "sections", other_sections_);
  return surface;
}

std::optional<SurfaceWithFields> MshReader::read_surface_with_fields() {
  surface_ = true;
  read_sections();
  if (!result_.mesh.tets.empty()) return {};
  std::size_t room = bytes_.size();
  read_node_data(room);
  return SurfaceWithFields{others_.surface(std::move(result_.mesh.points), in_.name(), nullptr),
                           std::move(result_.mesh.point_fields)};
}

void MshReader::read_sections() {
  if (in_.at_end()) in_.fail("the file is empty");
  read_format();
  for (std::string_view section; !(section = in_.word()).empty();) {
    if (section[0] != '$') in_.fail("expected a section such as $Nodes, found " + in_quotes(section));
    if (section == "$PhysicalNames")
      read_names();
    else if (section == "$Nodes")
      version_4_ ? read_nodes_4() : read_nodes_2();
    else if (section == "$Elements")
      version_4_ ? read_elements_4() : read_elements_2();
    else if (section == "$Entities" && version_4_)
      read_entities();
    else if (section == "$PartitionedEntities")
      in_.fail("the mesh is partitioned; save it as one (gmsh -part 0, or Mesh > Unpartition)");
    else if (section == "$ParametricNodes")
      in_.fail("parametric nodes are not supported; save the file without them");
    else
      keep_or_skip(section);
  }
  if (!has_elements_) in_.fail("there is no section $Elements in it; the file is truncated");
  others_.refuse_volumes(in_.name());
}

void MshReader::read_format() {
  if (const std::string_view word = in_.word(); word != "$MeshFormat")
    in_.fail("expected $MeshFormat at the beginning, found " + in_quotes(word) + "; is this a Gmsh file?");
  const std::string_view version = in_.word();
  version_4_ = version == "4.1" || version == "4" || version == "4.0";
  version_40_ = version_4_ && version != "4.1";
  if (!version.starts_with("2") && !version_4_)
    in_.fail("version " + in_quotes(version) +
             " of the format is not supported; save it as version 2.2, 4.0 or 4.1 (gmsh -format msh41)");
  const std::int64_t type = in_.integer("type of the file");
  if (type != 0 && type != 1)
    in_.fail("the type of the file is " + std::to_string(type) + "; 0 (ASCII) and 1 (binary) are supported");
  const std::int64_t size = in_.integer("size of a number");
  if (type == 1) {
    if (size != 8 && !(size == 4 && version_4_))
      in_.fail("numbers of " + std::to_string(size) + " bytes; 8 are supported");
    in_.skip_line();
    const std::string_view one = in_.take_bytes(sizeof(std::int32_t));
    if (one.size() < sizeof(std::int32_t)) in_.fail_cut_short("number 1, which gives the byte order");
    const bool as_is = load<std::int32_t>(one.data(), false) == 1;
    if (!as_is && load<std::int32_t>(one.data(), true) != 1)
      in_.fail("expected the four-byte number 1, which gives the byte order; the file is damaged");
    numbers_.set_binary(!as_is, static_cast<std::size_t>(size));
  }
  expect("$EndMeshFormat");
}

void MshReader::expect(std::string_view end) {
  const std::string_view word = in_.word();
  if (word.empty()) in_.fail_cut_short(end);
  if (word != end) in_.fail("expected " + std::string(end) + ", found " + in_quotes(word));
}

void MshReader::keep_or_skip(std::string_view section) {
  if (section == "$NodeData") node_data_.push_back(in_);
  if (section == "$ElementData") element_data_.push_back(in_);
  if (section != "$NodeData" && section != "$ElementData" && section != "$Comments")
    other_sections_.emplace_back(section);
  const std::string end = "$End" + std::string(section.substr(1));
  in_.skip_line();
  if (section == "$Comments") {
    read_comments(end);
    return;
  }
  if (numbers_.binary()) {
    // A byte of a binary number that equals a line feed does not start a line.
    const std::size_t at = bytes_.find(end, in_.offset());
    if (at == std::string_view::npos) in_.fail_cut_short("line " + in_quotes(end));
    (void)in_.take_bytes(at - in_.offset());
    expect(end);
    return;
  }
  for (;;) {
    if (in_.at_end()) in_.fail_cut_short("line " + in_quotes(end));
    if (in_.word_on_line() == end) return;
    in_.skip_line();
  }
}

void MshReader::read_comments(const std::string& end) {
  for (;;) {
    if (in_.left() == 0) in_.fail_cut_short("line " + in_quotes(end));
    const std::size_t line = in_.line();
    const std::string_view text = in_.rest_of_line();
    if (text.starts_with(end)) return;
    if (!text.starts_with(msh_material_comment)) continue;
    TextScanner numbers(text.substr(std::string_view(msh_material_comment).size()), in_.name());
    std::int64_t group = 0, tag = 0;
    if (parse_number(numbers.word(), group) && parse_number(numbers.word(), tag))
      group_to_tag_[group] = checked_material(tag, in_.name(), line);
  }
}

std::int64_t MshReader::tag_of(std::int64_t group) const {
  const auto known = group_to_tag_.find(group);
  return known == group_to_tag_.end() ? group : known->second;
}

void MshReader::read_names() {
  const std::size_t n = in_.count("number of physical names", 6);
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t dimension = in_.integer("dimension of a physical group");
    std::int64_t tag = in_.integer("physical group");
    if (dimension != 3) tag = without_sign(tag);
    const std::size_t line = in_.line();
    std::string_view name = in_.rest_of_line();
    const std::size_t open = name.find('"'), close = name.rfind('"');
    if (open == close)
      throw InputError(in_.name(), line,
                       "expected the name of a physical group in quotes, found " + in_quotes(name));
    name = name.substr(open + 1, close - open - 1);
    if (dimension == 2) {
      const auto [known, added] = surface_names_.emplace(std::string(name), tag);
      if (!added && known->second != tag)
        throw InputError(in_.name(), line,
                         "the physical surfaces " + std::to_string(known->second) + " and " +
                             std::to_string(tag) + " are both called " + in_quotes(name) +
                             "; give one of them another name, or both the same number");
    }
    others_.add_name(dimension, tag, std::string(name));
    if (dimension == 3)
      result_.mesh.material_names[checked_material(tag_of(tag), in_.name(), line)] = std::string(name);
  }
  expect("$EndPhysicalNames");
}

void MshReader::read_node_data(std::size_t& room) {
  for (TextScanner& in : node_data_) {
    MeshField field = read_msh_data(in, numbers_, "node", nodes_, result_.mesh.points.size(), false, room);
    if (field.values.empty())
      empty_fields_.push_back(field.name);
    else
      result_.mesh.point_fields.push_back(std::move(field));
  }
}

void MshReader::read_data() {
  const TetMesh& mesh = result_.mesh;
  std::size_t room = bytes_.size();
  read_node_data(room);
  if (element_data_.empty()) return;
  if (const std::optional<std::int64_t> twice = elements_.sort())
    in_.fail("element " + std::to_string(*twice) + " appears twice");
  for (TextScanner& in : element_data_) {
    MeshField field = read_msh_data(in, numbers_, "element", elements_, mesh.tets.size(), true, room);
    if (field.values.empty())
      fields_of_others_.push_back(field.name);
    else
      result_.mesh.cell_fields.push_back(std::move(field));
  }
}

void MshReader::set_materials() {
  TetMesh& mesh = result_.mesh;
  std::vector<std::string> also;
  const bool asked = options_.material_field == geometrical_name;
  if (any_geometrical_ && (asked || (version_4_ && !any_physical_))) {
    mesh.materials = std::move(geometrical_);
    result_.material_field = geometrical_name;
    // The names refer to physical groups.
    mesh.material_names.clear();
  } else if (any_physical_) {
    result_.material_field = "gmsh:physical";
    if (any_geometrical_) also.emplace_back(geometrical_name);
  }
  take_material(result_, options_, in_.name(), also);
}

void MshReader::note_dropped() {
  others_.finish(in_.name(), result_);
  std::vector<Dropped>& dropped = result_.dropped;
  // Nothing is lost if each physical group has only one volume.
  std::set<std::int64_t> physical;
  for (const auto& volume : volumes_) physical.insert(volume.first);
  if (result_.material_field == "gmsh:physical" && volumes_.size() > physical.size())
    dropped.push_back(
        {"numbers of volumes within the physical groups; --material-field gmsh:geometrical uses them as "
         "materials",
         volumes_.size()});
  if (partitioned_ > 0) dropped.push_back({"tets with partition numbers", partitioned_});
  append_dropped_names(dropped, "fields without a value", empty_fields_);
  append_dropped_names(dropped, "fields of elements other than tets", fields_of_others_);
  append_dropped_names(dropped, "sections", other_sections_);
}

ReadTetMesh read_msh(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options) {
  return MshReader(bytes, name, options).read();
}

TriangleMesh read_msh_surface(std::string_view bytes, const std::string& name,
                              std::vector<Dropped>* dropped) {
  const ReadTetMeshOptions options;
  return MshReader(bytes, name, options).read_surface(dropped);
}

std::optional<SurfaceWithFields> read_msh_surface_with_fields(std::string_view bytes,
                                                              const std::string& name) {
  const ReadTetMeshOptions options;
  return MshReader(bytes, name, options).read_surface_with_fields();
}

}  // namespace tetwright

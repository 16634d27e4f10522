// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/pvtu.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <utility>

#include "common/io/elements/element_types.h"
#include "common/io/elements/midside_nodes_read.h"
#include "common/io/elements/vtk_cells.h"
#include "common/io/elements/vtk_pieces.h"
#include "common/io/encodings/vtu_data.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/surfaces/vtu_space.h"
#include "common/io/tets/piece_joining.h"
#include "common/io/tets/vtu.h"
#include "common/io/text/text_scanner.h"
#include "common/utf8.h"
#include "tetwright/error.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

/// Whether a path leads out of the folder that it is relative to.
bool leaves_folder(const std::filesystem::path& path) {
  return path.has_root_path() || std::find(path.begin(), path.end(), "..") != path.end();
}

/// Paths of the pieces that a .pvtu file names.
std::vector<std::string> piece_files(std::string_view bytes, const std::string& path) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(bytes.data(), bytes.size());
  if (!parsed)
    throw InputError(path + ": byte " + std::to_string(parsed.offset) + ": not XML: " + parsed.description() +
                     "; the file is damaged or truncated");
  const pugi::xml_node root = document.child("VTKFile");
  if (!root) throw InputError(path + ": there is no element VTKFile in it; is this a VTK XML file?");
  const std::string_view type = root.attribute("type").as_string();
  if (type != "PUnstructuredGrid")
    throw InputError(path + ": a file of type PUnstructuredGrid is needed, this one is " + in_quotes(type));
  std::vector<std::string> files;
  std::map<std::filesystem::path, std::size_t> numbers;  // of the pieces
  for (const pugi::xml_node piece : root.child("PUnstructuredGrid").children("Piece")) {
    const std::string source = piece.attribute("Source").as_string();
    if (source.empty())
      throw InputError(path + ": piece " + std::to_string(files.size()) + " has no Source; export it again");
    if (leaves_folder(source))
      throw InputError(path + ": piece " + std::to_string(files.size()) + ": " + in_quotes(source) +
                       " is not a file in its folder; move the pieces there and export the file again");
    const auto [known, added] =
        numbers.emplace(std::filesystem::path(source).lexically_normal(), files.size());
    if (!added)
      throw InputError(path + ": pieces " + std::to_string(known->second) + " and " +
                       std::to_string(files.size()) + " are the same file, " + in_quotes(source) +
                       "; export it again");
    files.push_back((std::filesystem::path(path).parent_path() / source).string());
  }
  if (files.empty()) throw InputError(path + ": there is no Piece in it");
  return files;
}

std::vector<std::uint8_t> marks_of(const std::vector<std::int64_t>& numbers) {
  std::vector<std::uint8_t> marks;
  marks.reserve(numbers.size());
  for (const std::int64_t n : numbers) marks.push_back((n & vtk_duplicate) != 0);
  return marks;
}

/// Memory of the fields' values, bytes.
double memory_of(const std::vector<MeshField>& fields) {
  double values = 0;
  for (const MeshField& field : fields) values += static_cast<double>(field.values.size());
  return sizeof(double) * values;
}

/// Memory of a piece until the mesh is joined, bytes.
double memory_of(const ReadPiece& piece) {
  return static_cast<double>(piece.points.size() * (sizeof(Vec3) + sizeof(std::int64_t) + 1) +
                             piece.tets.size() * (sizeof(Tet) + sizeof(std::int64_t) + 1) +
                             piece.midside.size() * sizeof(piece.midside[0]) +
                             piece.face_groups.size() * sizeof(std::int64_t)) +
         memory_of(piece.point_fields) + memory_of(piece.cell_fields);
}

/// Reads pieces that number their tets and points.
class NumberedPieces {
 public:
  NumberedPieces(std::vector<std::string> files, const std::string& path, const FileReader& read_file)
      : files_(std::move(files)), path_(path), read_file_(read_file) {}

  /// \return false if a piece has no numbers, or other cells than tets: then read_vtu_files() can read them
  bool read() {
    for (std::size_t i = 0; i < files_.size(); ++i)
      if (!read_piece(i)) return false;
    return true;
  }

  ReadTetMesh join(const ReadTetMeshOptions& options) {
    if (std::all_of(pieces_.begin(), pieces_.end(), [](const ReadPiece& p) { return p.tets.empty(); }))
      throw InputError(path_ + ": there are no tets in its pieces; a tet mesh is needed");
    ReadTetMesh result;
    JoinedPieces joined = join_pieces(std::move(pieces_), whole_, path_);
    result.mesh = std::move(joined.mesh);
    result.mesh.space = space_;
    MidsideNodesRead midside;
    for (std::size_t t = 0; t < joined.midside.size(); t += 6)
      midside.add_tet(std::span<const Index>(joined.midside).subspan(t, 6));
    midside.remove_from(result, joined.faces.triangles);
    for (const auto& [tag, name] : parse_vtk_names(material_names_, vtk_material_names, path_))
      result.mesh.material_names[checked_material(tag, path_, 0)] = name;
    for (const auto& [number, name] : parse_vtk_names(face_group_names_, vtk_face_group_names, path_))
      joined.faces.names[number] = name;
    joined.faces.name_form = printable_name;
    take_material(result, options, path_);
    take_triangles(joined.faces, "face group", path_, result);
    append_dropped_names(result.dropped, "arrays of the whole dataset", dataset_arrays_);
    append_dropped_names(result.dropped, "fields missing from some pieces", joined.some_pieces);
    rounded_.append_to(result.dropped);
    return result;
  }

 private:
  bool read_piece(std::size_t number) {
    const std::string& file = files_[number];
    std::string bytes;
    try {
      bytes = read_file_(file);
    } catch (const InputError& e) {
      throw InputError(path_ + ": piece " + std::to_string(number) + ": " + e.what());
    }
    require(static_cast<double>(bytes.size()));
    const VtuData data(bytes, file);
    const std::vector<pugi::xml_node> nodes = data.pieces("UnstructuredGrid");
    if (nodes.size() > 1) return false;
    const pugi::xml_node node = nodes[0];
    ReadPiece piece;
    piece.file = file;
    const std::size_t points = data.count(node, "NumberOfPoints"), cells = data.count(node, "NumberOfCells");
    piece.points = data.points(node, points);
    piece.point_fields = data.fields(node.child("PointData"), points, nullptr, &rounded_);
    piece.cell_fields = data.fields(node.child("CellData"), cells, nullptr, &rounded_);
    auto node_numbers = take_numbers(piece.point_fields, vtk_node_numbers, number),
         tet_numbers = take_numbers(piece.cell_fields, vtk_cell_numbers, number);
    const auto node_ghosts = take_numbers(piece.point_fields, vtk_ghosts, number),
               tet_ghosts = take_numbers(piece.cell_fields, vtk_ghosts, number);
    if (!node_numbers || !tet_numbers) {
      if (points > 0 || cells > 0) return false;
      pieces_.push_back(std::move(piece));  // parallel programs write empty pieces
      return true;
    }
    piece.node_numbers = std::move(*node_numbers);
    piece.tet_numbers = std::move(*tet_numbers);
    if (node_ghosts) piece.node_ghosts = marks_of(*node_ghosts);
    piece.tet_ghosts = tet_ghosts ? marks_of(*tet_ghosts) : std::vector<std::uint8_t>(cells, 0);
    if (!read_tets(data, node, piece)) return false;
    if (auto groups = take_numbers(piece.cell_fields, vtk_face_groups, number, 4))
      piece.face_groups = std::move(*groups);
    read_field_data(data, node.parent(), bytes.size(), number);
    check_own_tets(piece, number);
    held_ += memory_of(piece);
    require(0);
    pieces_.push_back(std::move(piece));
    return true;
  }

  /// Removes a field of whole numbers from a list.
  /// \return its values; nothing if there is none with this name and number of components
  std::optional<std::vector<std::int64_t>> take_numbers(std::vector<MeshField>& fields, const char* name,
                                                        std::size_t piece, int components = 1) const {
    constexpr double too_large = 9007199254740992;  // 2^53: from here on, fields hold rounded numbers
    const auto field = std::find_if(fields.begin(), fields.end(), [&](const MeshField& f) {
      return f.name == name && f.components == components;
    });
    if (field == fields.end()) return {};
    const auto bad = std::find_if(field->values.begin(), field->values.end(),
                                  [&](double value) { return std::abs(value) >= too_large; });
    if (bad != field->values.end())
      throw InputError(path_ + ": piece " + std::to_string(piece) + " (" + files_[piece] + "): item " +
                       std::to_string((bad - field->values.begin()) / components) + " of " + in_quotes(name) +
                       " is not between -2^53 and 2^53; number the mesh anew");
    if (!field->integer) return {};
    std::vector<std::int64_t> numbers;
    numbers.reserve(field->values.size());
    for (const double value : field->values) numbers.push_back(static_cast<std::int64_t>(value));
    fields.erase(field);
    return numbers;
  }

  /// Refuses copies of a piece before more of them fill the memory; join_pieces() compares all tets.
  void check_own_tets(const ReadPiece& piece, std::size_t number) {
    std::optional<std::int64_t> first;
    for (std::size_t t = 0; t < piece.tets.size(); ++t)
      if (!piece.tet_ghosts[t]) first = std::min(first.value_or(piece.tet_numbers[t]), piece.tet_numbers[t]);
    if (!first) return;
    const auto [known, added] = first_tets_.emplace(*first, number);
    if (!added)
      throw InputError(path_ + ": piece " + std::to_string(number) + " (" + files_[number] +
                       "): tet number " + std::to_string(*first) + " is its own, and also that of piece " +
                       std::to_string(known->second) + " (" + files_[known->second] +
                       "); write the pieces again");
  }

  /// \throws OutputError if there is no memory for this many bytes more
  void require(double bytes) const {
    require_memory(held_ + bytes, "the pieces of " + path_, "read them on a larger machine");
  }

  static bool read_tets(const VtuData& data, pugi::xml_node node, ReadPiece& piece) {
    const std::size_t cells = piece.tet_numbers.size();
    const pugi::xml_node parent = node.child("Cells");
    if (!parent) data.fail(node, "there are no Cells in it");
    const pugi::xml_node types_node = data.array(parent, "types"),
                         offsets_node = data.array(parent, "offsets"),
                         connectivity_node = data.array(parent, "connectivity");
    const std::vector<std::uint32_t> types = data.counts(types_node, cells);
    data.expect_size(types_node, types.size(), cells);
    const bool second_order = !types.empty() && types[0] == element::quadratic_tet.vtk;
    const auto type = static_cast<std::uint32_t>((second_order ? element::quadratic_tet : element::tet).vtk);
    if (std::any_of(types.begin(), types.end(), [&](std::uint32_t t) { return t != type; })) return false;
    const std::size_t nodes = second_order ? 10 : 4;
    const std::vector<std::uint32_t> offsets = data.counts(offsets_node, cells);
    data.expect_size(offsets_node, offsets.size(), cells);
    for (std::size_t t = 0; t < cells; ++t)
      if (offsets[t] != nodes * (t + 1))
        data.fail(offsets_node, "cell " + std::to_string(t) + " ends at index " + std::to_string(offsets[t]) +
                                    ", not after its " + std::to_string(nodes) +
                                    " points; the file is damaged");
    const std::vector<std::uint32_t> ids = data.counts(connectivity_node, nodes * cells);
    data.expect_size(connectivity_node, ids.size(), nodes * cells);
    for (std::size_t i = 0; i < ids.size(); ++i)
      if (ids[i] >= piece.points.size())
        data.fail(connectivity_node, "cell " + std::to_string(i / nodes) + " refers to point " +
                                         std::to_string(ids[i]) + " of " +
                                         std::to_string(piece.points.size()) + "; export the file again");
    for (std::size_t t = 0; t < cells; ++t) {
      const std::uint32_t* of_tet = ids.data() + nodes * t;
      piece.tets.push_back({of_tet[0], of_tet[1], of_tet[2], of_tet[3]});
      if (second_order) std::copy_n(of_tet + 4, 6, piece.midside.emplace_back().begin());
    }
    return true;
  }

  /// Reads names and counts, which are the same in all pieces of a mesh.
  void read_field_data(const VtuData& data, pugi::xml_node grid, std::size_t file_size, std::size_t number) {
    const auto array = [&](const char* name) {
      return grid.child("FieldData").find_child_by_attribute("DataArray", "Name", name);
    };
    const auto text = [&](const char* name) {
      std::string out;
      if (const pugi::xml_node node = array(name))
        for (const std::int64_t c : data.integers(node, file_size)) out += static_cast<char>(c);
      return out;
    };
    const std::string materials = text(vtk_material_names), groups = text(vtk_face_group_names),
                      space = read_vtu_space(data, grid);
    std::optional<WholeCounts> whole;
    if (const pugi::xml_node node = array(vtk_whole_mesh)) {
      const std::vector<std::int64_t> counts = data.integers(node, 3);
      data.expect_size(node, counts.size(), 3);
      whole = WholeCounts{counts[0], counts[1], counts[2]};
      if (counts[0] != static_cast<std::int64_t>(files_.size()))
        throw InputError(path_ + ": it names " + std::to_string(files_.size()) + " pieces, but piece " +
                         std::to_string(number) + " (" + files_[number] + ") is one of " +
                         std::to_string(counts[0]) + "; write the set again");
    }
    for (const pugi::xml_node node : grid.child("FieldData").children("DataArray")) {
      const std::string name = field_name(node.attribute("Name").as_string());
      if (name != vtk_material_names && name != vtk_face_group_names && name != vtk_whole_mesh &&
          space_of_vtu_array(data, node).empty() &&
          std::find(dataset_arrays_.begin(), dataset_arrays_.end(), name) == dataset_arrays_.end())
        dataset_arrays_.push_back(name);
    }
    if (!std::exchange(described_, true)) {
      material_names_ = materials;
      face_group_names_ = groups;
      space_ = space;
      whole_ = whole;
    } else if (materials != material_names_ || groups != face_group_names_ || space != space_ ||
               whole != whole_) {
      throw InputError(path_ + ": piece " + std::to_string(number) + " (" + files_[number] +
                       ") is of another mesh than " + pieces_.front().file + "; write the set again");
    }
  }

  std::vector<std::string> files_;
  const std::string& path_;
  const FileReader& read_file_;
  std::vector<ReadPiece> pieces_;
  double held_ = 0;                                 ///< memory of these, bytes
  std::map<std::int64_t, std::size_t> first_tets_;  ///< smallest own tet of each piece that has one
  bool described_ = false;                          ///< the next four are those of a piece
  std::string material_names_, face_group_names_, space_;
  std::optional<WholeCounts> whole_;
  std::vector<std::string> dataset_arrays_;
  KindCounts rounded_;
};

}  // namespace

ReadTetMesh read_pvtu(const std::string& path, const ReadTetMeshOptions& options,
                      const FileReader& read_file) {
  const std::vector<std::string> files = piece_files(read_file(path), path);
  {
    NumberedPieces numbered(files, path, read_file);
    if (numbered.read()) return numbered.join(options);
  }  // frees its pieces
  return read_vtu_files(files, path, options, read_file);
}

std::vector<std::string> pieces_of_pvtu(const std::string& path) {
  try {
    return piece_files(read_whole_file(path), path);
  } catch (const InputError&) {
    return {};
  }
}

}  // namespace tetwright

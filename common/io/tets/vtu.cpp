// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/vtu.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/io/elements/midside_nodes_read.h"
#include "common/io/elements/vtk_cells.h"
#include "common/io/elements/vtk_pieces.h"
#include "common/io/encodings/vtu_data.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/names/mesh_parts.h"
#include "common/io/surfaces/vtu_space.h"
#include "common/io/text/text_scanner.h"
#include "common/parallel/touched_memory.h"
#include "tetwright/error.h"
#include "tetwright/parted_interfaces.h"
#include "tetwright/resources.h"

namespace tetwright {

namespace {

class VtuReader {
 public:
  VtuReader(const std::string& name, const ReadTetMeshOptions& options) : name_(name), options_(options) {}

  /// Adds the pieces of a file. The bytes must outlive the next call.
  void add_file(std::string_view bytes, const std::string& name) {
    data_.emplace(bytes, name);
    file_size_ = bytes.size();
    const std::vector<pugi::xml_node> pieces = data_->pieces("UnstructuredGrid");
    grid_ = pieces[0].parent();
    for (const pugi::xml_node piece : pieces) read_piece(piece);
    read_names(grid_);
    if (std::string space = read_vtu_space(*data_, grid_); !space.empty())
      result_.mesh.space = std::move(space);
    note_dropped_arrays(grid_, pieces);
  }

  ReadTetMesh finish() {
    if (result_.mesh.tets.empty())
      data_->fail(grid_, "there are no tets (type 10 or 24) among its " + std::to_string(cells_) +
                             " cells; a tet mesh is needed");
    other_cells_.append_flat_to(result_.dropped);
    if (first_points_.size() > 1) join_pieces();
    for (std::size_t t = 0; t < midside_of_tets_.size(); t += midside_per_tet)
      midside_.add_tet(std::span(midside_of_tets_).subspan(t, midside_per_tet));
    for (std::size_t t = 0; t < midside_of_triangles_.size(); t += midside_per_triangle)
      midside_.add_triangle(std::span(midside_of_triangles_).subspan(t, midside_per_triangle));
    midside_.remove_from(result_, triangles_.triangles);
    take_material(result_, options_, name_);
    take_triangles(triangles_, "surface", name_, result_);
    append_dropped_arrays();
    rounded_.append_to(result_.dropped);
    return std::move(result_);
  }

 private:
  static constexpr std::size_t midside_per_tet = 6, midside_per_triangle = 3;
  static constexpr std::size_t cell_grain = 1 << 14;  ///< cells for each task: some nanoseconds each

  /// Adds the points, tets and fields of a piece.
  void read_piece(pugi::xml_node piece) {
    TetMesh& mesh = result_.mesh;
    const std::size_t points = data_->count(piece, "NumberOfPoints"),
                      cells = data_->count(piece, "NumberOfCells"), first_tet = mesh.tets.size();
    if (mesh.points.size() + points >= no_index)
      data_->fail(piece, "more than " + std::to_string(no_index - 1) + " points; split the mesh");
    first_points_.push_back(static_cast<Index>(mesh.points.size()));
    std::vector<Vec3> of_piece = data_->points(piece, points);
    if (mesh.points.empty())
      mesh.points = std::move(of_piece);
    else
      mesh.points.insert(mesh.points.end(), of_piece.begin(), of_piece.end());
    const std::optional<std::vector<std::size_t>> tet_to_cell = read_cells(piece, points, cells);
    cells_ += cells;
    const bool has_surfaces = take_surfaces(piece, cells);
    add_fields(mesh.point_fields, data_->fields(piece.child("PointData"), points, nullptr, &rounded_),
               first_points_.back(), points);
    std::vector<MeshField> cell_fields =
        data_->fields(piece.child("CellData"), cells, tet_to_cell ? &*tet_to_cell : nullptr, &rounded_);
    if (has_surfaces)
      std::erase_if(cell_fields, [](const MeshField& field) { return field.name == vtk_surface_field; });
    add_fields(mesh.cell_fields, std::move(cell_fields), first_tet, mesh.tets.size() - first_tet);
  }

  /// Takes the triangles of a piece of a file that this program wrote, by the field that gives the numbers of
  /// their surfaces. False if there is no such field, or no triangle.
  bool take_surfaces(pugi::xml_node piece, std::size_t cells) {
    const std::vector<FileTriangle> triangles = std::move(triangles_of_piece_);
    triangles_of_piece_.clear();
    const pugi::xml_node node =
        piece.child("CellData").find_child_by_attribute("DataArray", "Name", vtk_surface_field);
    const std::string_view type = node.attribute("type").as_string();
    if (triangles.empty() || !node || type.find("Int") == type.npos) return false;
    if (node.attribute("NumberOfComponents").as_int(1) != 1) return false;
    const std::vector<std::int64_t> numbers = data_->integers(node, cells);
    data_->expect_size(node, numbers.size(), cells);
    for (const FileTriangle& t : triangles) {
      triangles_.add(t.corners, numbers[t.cell]);
      if (t.quadratic)
        midside_of_triangles_.insert(midside_of_triangles_.end(), t.midside.begin(), t.midside.end());
      other_cells_.remove(t.quadratic ? element::quadratic_triangle.vtk : element::triangle.vtk);
    }
    return true;
  }

  /// Adds the fields of a piece. Fields that are missing in some piece are left out. A piece without items,
  /// as written by parallel programs, is ignored.
  /// \param before number of points or tets in the previous pieces
  /// \param items number of points or tets of this piece
  void add_fields(std::vector<MeshField>& all, std::vector<MeshField> added, std::size_t before,
                  std::size_t items) {
    // The marked items are removed already.
    std::erase_if(added, [](const MeshField& field) { return field.name == vtk_ghosts; });
    if (items == 0) return;
    if (before == 0) {
      all = std::move(added);
      return;
    }
    for (MeshField& field : all) {
      const auto same = std::find_if(added.begin(), added.end(), [&](const MeshField& f) {
        return f.name == field.name && f.components == field.components;
      });
      if (same == added.end()) {
        field_names_of_some_pieces_.push_back(field.name);
        field.components = 0;
        continue;
      }
      field.integer &= same->integer;
      field.values.insert(field.values.end(), same->values.begin(), same->values.end());
      added.erase(same);
    }
    std::erase_if(all, [](const MeshField& field) { return field.components == 0; });
    for (const MeshField& field : added) field_names_of_some_pieces_.push_back(field.name);
  }

  /// Marks in vtkGhostType: cells that a neighbouring piece also has.
  std::vector<std::int64_t> ghosts(pugi::xml_node piece, std::size_t cells) const {
    const pugi::xml_node node =
        piece.child("CellData").find_child_by_attribute("DataArray", "Name", vtk_ghosts);
    return node ? data_->integers(node, cells) : std::vector<std::int64_t>();
  }

  /// Takes the cells if all are tets of four points within the piece, each listed once.
  /// \return false if they are not: nothing was taken
  bool take_plain_tets(const std::vector<std::uint32_t>& types, const std::vector<std::uint32_t>& offsets,
                       const std::vector<std::uint32_t>& connectivity, std::size_t points) {
    if (connectivity.size() != 4 * types.size()) return false;
    std::vector<Tet>& tets = result_.mesh.tets;
    const std::size_t before = tets.size();
    const Index first_point = first_points_.back();
    if (before == 0) reserve_touched(tets, types.size());
    tets.resize(before + types.size());
    std::atomic<bool> plain{true};  // relaxed: it only has to become visible eventually
    parallel_for(0, types.size(), cell_grain, [&](std::size_t begin, std::size_t end) {
      bool all = true;
      for (std::size_t c = begin; c < end; ++c) {
        all &= types[c] == element::tet.vtk && offsets[c] == 4 * (c + 1);
        for (std::size_t k = 0; k < 4; ++k) {
          all &= connectivity[4 * c + k] < points;
          tets[before + c][k] = first_point + connectivity[4 * c + k];
        }
      }
      if (!all) plain.store(false, std::memory_order_relaxed);
    });
    if (!plain.load()) tets.resize(before);
    return plain.load();
  }

  /// Reads the cells.
  /// \return the cell indices of the tets; nothing if all cells are tets
  std::optional<std::vector<std::size_t>> read_cells(pugi::xml_node piece, std::size_t points,
                                                     std::size_t cell_count) {
    const pugi::xml_node cells = piece.child("Cells");
    if (!cells) data_->fail(piece, "there are no Cells in it");
    const pugi::xml_node types_node = data_->array(cells, "types"),
                         offsets_node = data_->array(cells, "offsets"),
                         connectivity_node = data_->array(cells, "connectivity");
    const std::vector<std::uint32_t> types = data_->counts(types_node, cell_count);
    data_->expect_size(types_node, types.size(), cell_count);
    const std::vector<std::uint32_t> offsets = data_->counts(offsets_node, cell_count);
    data_->expect_size(offsets_node, offsets.size(), cell_count);
    const std::vector<std::uint32_t> connectivity =
        data_->counts(connectivity_node, offsets.empty() ? 0 : offsets.back());
    const std::vector<std::int64_t> ghost = ghosts(piece, cell_count);
    if (ghost.empty() && take_plain_tets(types, offsets, connectivity, points)) return std::nullopt;
    const Index first_point = first_points_.back();
    std::vector<std::size_t> tet_to_cell;
    const bool has_surfaces = static_cast<bool>(
        piece.child("CellData").find_child_by_attribute("DataArray", "Name", vtk_surface_field));
    std::size_t begin = 0;
    const auto node_of = [&](std::size_t c, std::size_t k) {
      const std::uint32_t id = connectivity[begin + k];
      if (id >= points)
        data_->fail(connectivity_node, "cell " + std::to_string(c) + " refers to point " +
                                           std::to_string(id) + " of " + std::to_string(points) +
                                           "; export the file again");
      return first_point + id;
    };
    for (std::size_t c = 0; c < cell_count; ++c) {
      const std::size_t end = offsets[c];
      if (end < begin || end > connectivity.size())
        data_->fail(offsets_node, "cell " + std::to_string(c) + " ends at index " + std::to_string(end) +
                                      " of " + std::to_string(connectivity.size()) + "; the file is damaged");
      if (c < ghost.size() && (ghost[c] & vtk_duplicate)) {
        ++ghost_cells_;
      } else if (is_vtk_tet(types[c])) {
        const std::size_t nodes = vtk_element_type(types[c])->nodes;
        if (end - begin != nodes)
          data_->fail(offsets_node, "cell " + std::to_string(c) + " is a tet of " +
                                        std::to_string(end - begin) + " points; the file is damaged");
        std::array<Index, 4 + midside_per_tet> ids;
        for (std::size_t k = 0; k < nodes; ++k) ids[k] = node_of(c, k);
        result_.mesh.tets.push_back({ids[0], ids[1], ids[2], ids[3]});
        if (nodes > 4) midside_of_tets_.insert(midside_of_tets_.end(), ids.begin() + 4, ids.end());
        tet_to_cell.push_back(c);
      } else if (types[c] == element::wedge.vtk && end - begin == 6 &&
                 take_wedge([&](std::size_t k) { return node_of(c, k); })) {
        // It has no fields.
      } else {
        other_cells_.add(types[c], c);
        // A triangle that is not one of this program's surfaces is only counted, whatever its points are.
        if (is_vtk_triangle(types[c]) && has_surfaces && end - begin == vtk_element_type(types[c])->nodes) {
          const bool quadratic = types[c] == element::quadratic_triangle.vtk;
          FileTriangle t{c, quadratic, {node_of(c, 0), node_of(c, 1), node_of(c, 2)}, {}};
          for (std::size_t k = 0; quadratic && k < midside_per_triangle; ++k)
            t.midside[k] = node_of(c, 3 + k);
          triangles_of_piece_.push_back(t);
        }
      }
      begin = end;
    }
    if (other_cells_.has_volumes()) data_->fail(types_node, other_cells_.refusal());
    if (tet_to_cell.size() == cell_count) return std::nullopt;
    return tet_to_cell;
  }

  /// Takes a wedge if it is a cohesive element.
  template <class NodeOf>
  bool take_wedge(const NodeOf& node_of) {
    Wedge wedge;
    for (std::size_t k = 0; k < wedge.size(); ++k) wedge[k] = node_of(vtk_wedge_order[k]);
    if (!is_cohesive(wedge, result_.mesh.points)) return false;
    result_.mesh.wedges.push_back(wedge);
    return true;
  }

  /// Merges the points at which pieces meet: points with equal coordinates become the point of the first
  /// piece, with its values. Duplicates within a piece are intended: the k-th of them is merged with the k-th
  /// of another piece.
  void join_pieces() {
    TetMesh& mesh = result_.mesh;
    const auto coordinates = [&](Index p) {
      const Vec3& x = mesh.points[p];
      return std::array{x[0], x[1], x[2]};
    };
    std::vector<Index> order(mesh.points.size());
    std::iota(order.begin(), order.end(), Index{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](Index a, Index b) { return coordinates(a) < coordinates(b); });
    std::vector<Index> to(mesh.points.size());
    std::vector<Index> slots;
    for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
      while (end < order.size() && coordinates(order[end]) == coordinates(order[begin])) ++end;
      slots.clear();
      std::size_t piece = 0, used = 0;  // here pieces are numbered from 1
      for (std::size_t i = begin; i < end; ++i) {
        const Index p = order[i];
        const auto own = static_cast<std::size_t>(
            std::upper_bound(first_points_.begin(), first_points_.end(), p) - first_points_.begin());
        used = own == piece ? used + 1 : 0;
        piece = own;
        if (used == slots.size()) slots.push_back(p);
        to[p] = slots[used];
      }
    }
    renumber(to);
  }

  /// \param to for each point the point that it becomes: itself or one with a smaller index
  void renumber(std::vector<Index>& to) {
    TetMesh& mesh = result_.mesh;
    Index kept = 0;
    for (Index p = 0; p < to.size(); ++p) {
      if (to[p] != p) {
        to[p] = to[to[p]];
        continue;
      }
      mesh.points[kept] = mesh.points[p];
      for (MeshField& field : mesh.point_fields) {
        const auto n = static_cast<std::size_t>(field.components);
        std::copy_n(field.values.begin() + static_cast<std::ptrdiff_t>(p * n), n,
                    field.values.begin() + static_cast<std::ptrdiff_t>(kept * n));
      }
      to[p] = kept++;
    }
    joined_points_ = to.size() - kept;
    mesh.points.resize(kept);
    for (MeshField& field : mesh.point_fields)
      field.values.resize(static_cast<std::size_t>(field.components) * kept);
    for (Tet& tet : mesh.tets)
      for (Index& p : tet) p = to[p];
    for (Index& p : midside_of_tets_) p = to[p];
    for (Index& p : midside_of_triangles_) p = to[p];
    for (Triangle& t : triangles_.triangles)
      for (Index& p : t) p = to[p];
    for (Wedge& wedge : mesh.wedges)
      for (Index& p : wedge) p = to[p];
  }

  /// Names in an array of the dataset, with their numbers.
  std::vector<std::pair<std::int64_t, std::string>> names_in(pugi::xml_node grid, const char* array) const {
    const pugi::xml_node node = grid.child("FieldData").find_child_by_attribute("DataArray", "Name", array);
    if (!node) return {};
    std::string text;
    // Compressed data may be larger than the file, but names hardly are.
    for (std::int64_t c : data_->integers(node, file_size_)) text += static_cast<char>(c);
    return parse_vtk_names(text, array, name_);
  }

  void read_names(pugi::xml_node grid) {
    for (auto& [tag, name] : names_in(grid, vtk_material_names))
      result_.mesh.material_names[checked_material(tag, name_, 0)] = name;
    if (triangles_.triangles.empty()) return;
    for (auto& [number, name] : names_in(grid, vtk_surface_names)) triangles_.names[number] = name;
  }

  /// Counts arrays of the whole dataset and text arrays as dropped.
  void note_dropped_arrays(pugi::xml_node grid, const std::vector<pugi::xml_node>& pieces) {
    const auto is_array = [](pugi::xml_node node) {
      return std::string_view(node.name()) == "DataArray" || std::string_view(node.name()) == "Array";
    };
    const auto is_of_names = [&](const std::string& array) {
      return array == vtk_material_names || (array == vtk_surface_names && !triangles_.triangles.empty());
    };
    const auto name_of = [](pugi::xml_node node) { return field_name(node.attribute("Name").as_string()); };
    std::vector<std::string> of_dataset, text;
    // Some programs put FieldData next to the grid or into a piece.
    std::vector<pugi::xml_node> parents{data_->root(), grid};
    parents.insert(parents.end(), pieces.begin(), pieces.end());
    for (const pugi::xml_node parent : parents)
      for (const pugi::xml_node node : parent.child("FieldData").children())
        if (is_array(node) &&
            !(parent == grid && (is_of_names(name_of(node)) || !space_of_vtu_array(*data_, node).empty())))
          of_dataset.push_back(name_of(node));
    for (const char* part : {"PointData", "CellData"})
      for (const pugi::xml_node node : pieces[0].child(part).children())
        if (is_array(node) && !holds_numbers(node)) text.push_back(name_of(node));
    for (const auto& [from, to] : {std::pair(&of_dataset, &dataset_arrays_), {&text, &text_arrays_}})
      for (const std::string& name : *from)
        if (std::find(to->begin(), to->end(), name) == to->end()) to->push_back(name);
  }

  void append_dropped_arrays() {
    append_dropped_names(result_.dropped, "arrays of the whole dataset", dataset_arrays_);
    append_dropped_names(result_.dropped, "arrays of text", text_arrays_);
    append_dropped_names(result_.dropped, "fields missing from some pieces", field_names_of_some_pieces_);
    if (ghost_cells_ > 0)
      result_.dropped.push_back({"cells that also belong to other pieces (vtkGhostType)", ghost_cells_});
    if (joined_points_ > 0)
      result_.dropped.push_back({"duplicate points shared between pieces", joined_points_});
  }

  /// A triangle of the piece that is being read.
  struct FileTriangle {
    std::size_t cell;
    bool quadratic;
    Triangle corners;
    std::array<Index, midside_per_triangle> midside;
  };

  std::optional<VtuData> data_;  ///< the file that is being read
  pugi::xml_node grid_;          ///< of this file
  std::size_t file_size_ = 0;    ///< of this file
  std::string name_;
  const ReadTetMeshOptions& options_;
  std::size_t cells_ = 0, ghost_cells_ = 0, joined_points_ = 0;
  std::vector<Index> first_points_;     ///< of each piece
  std::vector<Index> midside_of_tets_;  ///< for tets of ten nodes
  std::vector<Index> midside_of_triangles_;
  std::vector<FileTriangle> triangles_of_piece_;
  FileTriangles triangles_;
  std::vector<std::string> field_names_of_some_pieces_, dataset_arrays_, text_arrays_;
  OtherVtkCells other_cells_;
  KindCounts rounded_;  ///< rounded integers of fields
  MidsideNodesRead midside_;
  ReadTetMesh result_;
};

}  // namespace

ReadTetMesh read_vtu(std::string_view bytes, const std::string& name, const ReadTetMeshOptions& options) {
  VtuReader reader(name, options);
  reader.add_file(bytes, name);
  return reader.finish();
}

ReadTetMesh read_vtu_files(const std::vector<std::string>& files, const std::string& name,
                           const ReadTetMeshOptions& options, const FileReader& read_file) {
  VtuReader reader(name, options);
  std::string bytes;
  for (const std::string& file : files) {
    bytes = read_file(file);
    reader.add_file(bytes, file);
  }
  return reader.finish();
}

}  // namespace tetwright

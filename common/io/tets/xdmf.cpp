// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/xdmf.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <span>
#include <vector>

#include "common/io/elements/element_types.h"
#include "common/io/elements/midside_nodes_read.h"
#include "common/io/encodings/hdf5_image.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/names/mesh_parts.h"
#include "common/io/text/text_scanner.h"
#include "common/io/text/text_writer.h"
#include "common/io/text/xml_text.h"
#include "common/lower_case.h"
#include "common/message_text.h"
#include "tetwright/error.h"
#include "tetwright/io.h"
#include "tetwright/parted_interfaces.h"

namespace tetwright {

namespace {

constexpr const char* xdmf_material = "material";
constexpr const char* facet_attribute = "facet_tags";

constexpr const char* cohesive_grid = "cohesive";

constexpr std::size_t tet_nodes = 4, quadratic_tet_nodes = 10, wedge_nodes = 6;

/// Cohesive elements, with numbers that no material has.
std::vector<CohesivePart> xdmf_cohesive(const TetMesh& mesh) {
  return cohesive_parts(mesh, names_of_parts(mesh, printable_names()).materials, printable_names());
}

class XdmfReader {
 public:
  XdmfReader(std::string_view bytes, const std::string& name, const FileReader& read_file)
      : name_(name), read_file_(read_file) {
    const pugi::xml_parse_result parsed = document_.load_buffer(bytes.data(), bytes.size());
    if (!parsed)
      throw InputError(name + ": byte " + std::to_string(parsed.offset) + ": " + parsed.description());
    if (!document_.child("Xdmf")) throw InputError(name + ": there is no element Xdmf in it");
  }

  ReadTetMesh read(const ReadTetMeshOptions& options, const std::optional<NamedBytes>& facets) {
    const pugi::xml_node grid = choose_grid();
    read_points(grid);
    read_tets(grid);
    if (cohesive_) read_wedges();
    for (const pugi::xml_node attribute : grid.children("Attribute")) read_attribute(attribute);
    for (const auto& [tag, name] : names_of(grid, "3"))
      result_.mesh.material_names[checked_material(tag, name_, 0)] = name;
    FileTriangles listed;
    if (facets) read_facets(*facets, listed);
    midside_.remove_from(result_, listed.triangles);
    take_material(result_, options, name_);
    if (facets) take_triangles(listed, "facet tag", facets->name, result_);
    rounded_.append_to(result_.dropped);
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const {
    throw InputError(name_ + ": byte " + std::to_string(std::max<std::ptrdiff_t>(node.offset_debug(), 0)) +
                     ": " + node.name() + ": " + message);
  }

  static std::string topology_of(pugi::xml_node grid) {
    const pugi::xml_node topology = grid.child("Topology");
    const char* type = topology.attribute("TopologyType").as_string();
    return lower_case(*type ? type : topology.attribute("Type").as_string());
  }
  static std::size_t nodes_of(const std::string& topology) {
    if (topology == "tetrahedron" || topology == "tetra") return tet_nodes;
    return topology == "tetrahedron_10" || topology == "tet_10" ? quadratic_tet_nodes : 0;
  }

  pugi::xml_node choose_grid() {
    pugi::xml_node chosen;
    std::string others;
    std::size_t other_grids = 0;
    for (const pugi::xpath_node& found : document_.select_nodes("//Grid[Topology]")) {
      const pugi::xml_node grid = found.node();
      const std::string topology = topology_of(grid);
      if (!chosen && nodes_of(topology) > 0)
        chosen = grid;
      else if (!cohesive_ && topology == "wedge" &&
               grid.attribute("Name").as_string() == std::string(cohesive_grid))
        cohesive_ = grid;
      else
        ++other_grids;
      if (nodes_of(topology) == 0 && others.empty()) others = topology;
    }
    if (!chosen)
      throw InputError(name_ + ": there is no grid of tets (TopologyType Tetrahedron or Tetrahedron_10)" +
                       (others.empty() ? "" : ", but one of type " + in_quotes(others)) +
                       "; a mesh of tets alone is needed");
    if (other_grids > 0) result_.dropped.push_back({"other grids", other_grids});
    return chosen;
  }

  /// Reads the numbers of a DataItem; fails if there are more than `max_count`.
  std::vector<double> numbers(pugi::xml_node parent, std::size_t max_count) {
    const pugi::xml_node item = parent.child("DataItem");
    if (!item) fail(parent, "there is no DataItem in it");
    const std::string format = item.attribute("Format").as_string("XML");
    const std::string text = item.child_value();
    if (item.attribute("Reference")) fail(item, "references are not supported; write the numbers out");
    if (format == "XML") {
      std::vector<double> values;
      TextScanner words(text, name_);
      for (std::string_view word; !(word = words.word()).empty();) {
        double value = 0;
        if (!parse_number(word, value)) fail(item, "expected a number, found " + in_quotes(word));
        if (values.size() == max_count)
          fail(item, "more than the " + std::to_string(max_count) + " numbers expected");
        values.push_back(value);
      }
      return values;
    }
    if (format != "HDF") fail(item, "format " + in_quotes(format) + "; XML and HDF are supported");
    const std::size_t begin = text.find_first_not_of(" \t\r\n"), end = text.find_last_not_of(" \t\r\n");
    const std::size_t colon = text.rfind(':');
    if (begin == std::string::npos || colon == std::string::npos || colon <= begin)
      fail(item,
           "expected the name of an HDF5 file, a colon and that of a dataset, found " + in_quotes(text));
    return hdf5(text.substr(begin, colon - begin)).numbers(text.substr(colon + 1, end - colon), max_count);
  }

  const Hdf5Reader& hdf5(const std::string& file) {
    std::unique_ptr<Hdf5Reader>& reader = hdf5_[file];
    if (!reader) {
      const std::string path = (std::filesystem::path(name_).parent_path() / file).string();
      reader = std::make_unique<Hdf5Reader>(read_file_(path), path);
    }
    return *reader;
  }

  /// Number of rows in an attribute ("Dimensions" is "17 3"), or 0.
  static std::size_t rows_of(pugi::xml_node parent) {
    const std::string dimensions = parent.child("DataItem").attribute("Dimensions").as_string();
    TextScanner words(dimensions, "");
    std::int64_t rows = 0;
    return parse_number(words.word(), rows) && rows > 0 ? static_cast<std::size_t>(rows) : 0;
  }

  /// Checks a number of rows against the size of the file, which may be compressed HDF5.
  std::size_t checked_rows(pugi::xml_node parent, const char* what) const {
    const std::size_t rows = rows_of(parent);
    if (rows == 0) fail(parent, std::string("there are no ") + what + ", or no Dimensions of them");
    if (rows >= no_index) fail(parent, std::to_string(rows) + " " + what + " are too many; split the mesh");
    return rows;
  }

  void read_points(pugi::xml_node grid) {
    const pugi::xml_node geometry = grid.child("Geometry");
    if (!geometry) fail(grid, "there is no Geometry in it");
    const char* type = geometry.attribute("GeometryType").as_string();
    const std::string kind = *type ? type : geometry.attribute("Type").as_string("XYZ");
    if (kind != "XYZ") fail(geometry, "the geometry is " + in_quotes(kind) + "; XYZ is needed");
    const std::size_t rows = checked_rows(geometry, "points");
    const std::vector<double> values = numbers(geometry, 3 * rows);
    if (values.size() != 3 * rows) fail(geometry, "there are fewer coordinates than its Dimensions say");
    for (std::size_t i = 0; i < rows; ++i) {
      const Vec3 p(values[3 * i], values[3 * i + 1], values[3 * i + 2]);
      if (!p.allFinite()) fail(geometry, "a coordinate of point " + std::to_string(i) + " is not finite");
      result_.mesh.points.push_back(p);
    }
  }

  Index index_of(pugi::xml_node topology, const char* what, std::size_t number, double value,
                 std::size_t points) const {
    if (!(value >= 0 && value < static_cast<double>(points)) || value != std::floor(value))
      fail(topology, std::string(what) + " " + std::to_string(number) + " refers to point " +
                         short_number(value) + " of " + std::to_string(points) + "; export the file again");
    return static_cast<Index>(value);
  }

  void read_tets(pugi::xml_node grid) {
    const pugi::xml_node topology = grid.child("Topology");
    const std::size_t nodes = nodes_of(topology_of(grid));
    const std::size_t rows = checked_rows(topology, "tets");
    const std::vector<double> values = numbers(topology, nodes * rows);
    if (values.size() != nodes * rows)
      fail(topology, "there are fewer nodes of tets than its Dimensions say");
    std::vector<Index> ids(nodes);
    for (std::size_t t = 0; t < rows; ++t) {
      for (std::size_t k = 0; k < nodes; ++k) {
        ids[k] = index_of(topology, "tet", t, values[nodes * t + k], result_.mesh.points.size());
      }
      result_.mesh.tets.push_back({ids[0], ids[1], ids[2], ids[3]});
      if (nodes > tet_nodes) midside_.add_tet(std::span(ids).subspan(tet_nodes));
    }
  }

  /// Reads the cohesive elements of write_xdmf_mesh().
  void read_wedges() {
    const pugi::xml_node topology = cohesive_.child("Topology");
    const std::size_t rows = checked_rows(topology, "wedges");
    const std::vector<double> values = numbers(topology, wedge_nodes * rows);
    if (values.size() != wedge_nodes * rows)
      fail(topology, "there are fewer nodes of wedges than its Dimensions say");
    KindCounts others;
    for (std::size_t w = 0; w < rows; ++w) {
      Wedge wedge;
      for (std::size_t k = 0; k < wedge_nodes; ++k)
        wedge[k] = index_of(topology, "wedge", w, values[wedge_nodes * w + vtk_wedge_order[k]],
                            result_.mesh.points.size());
      if (is_cohesive(wedge, result_.mesh.points))
        result_.mesh.wedges.push_back(wedge);
      else
        others.add(element::wedge.name);
    }
    if (!others.empty()) fail(topology, unsupported_cells(others, "in this grid"));
  }

  void read_attribute(pugi::xml_node attribute) {
    const std::string center = attribute.attribute("Center").as_string("Node");
    if (center != "Node" && center != "Cell") {
      result_.dropped.push_back({"attributes of " + center, 1});
      return;
    }
    const bool of_cells = center == "Cell";
    TetMesh& mesh = result_.mesh;
    const std::size_t items = of_cells ? mesh.tets.size() : mesh.points.size();
    constexpr std::size_t max_components = 1 << 16;
    MeshField field;
    field.name = field_name(attribute.attribute("Name").as_string());
    field.values = numbers(attribute, max_components * items);
    if (field.values.empty() || field.values.size() % items != 0)
      fail(attribute, in_quotes(field.name) + " has " + std::to_string(field.values.size()) + " values for " +
                          std::to_string(items) + (of_cells ? " tets" : " points"));
    field.components = static_cast<int>(field.values.size() / items);
    const char* type = attribute.child("DataItem").attribute("NumberType").as_string();
    const std::string number_type =
        lower_case(*type ? type : attribute.child("DataItem").attribute("DataType").as_string("Float"));
    if (number_type != "float") take_integers(field, rounded_);
    (of_cells ? mesh.cell_fields : mesh.point_fields).push_back(std::move(field));
  }

  /// Names in text of the form "<main><map key=NAME dim=3>NUMBER</map></main>", for one dimension.
  static std::map<std::int64_t, std::string> names_of(pugi::xml_node grid, std::string_view dimension) {
    std::map<std::int64_t, std::string> found;
    for (const pugi::xml_node information : grid.children("Information")) {
      const std::string text = information.child_value();
      pugi::xml_document names;
      if (!names.load_buffer(text.data(), text.size())) continue;
      for (const pugi::xml_node map : names.child("main").children("map")) {
        std::int64_t number = 0;
        if (map.attribute("dim").as_string() == dimension && parse_number(map.child_value(), number))
          found[number] = map.attribute("key").as_string();
      }
    }
    return found;
  }

  /// Reads the file of write_xdmf_facets(). A file with this name but other contents may come from another
  /// program and belong to other points.
  void read_facets(const NamedBytes& file, FileTriangles& listed) {
    XdmfReader reader(file.bytes, file.name, read_file_);
    if (!reader.list_facets(result_.mesh.points.size(), listed))
      result_.dropped.push_back({"facet files for other points (" +
                                     in_quotes(std::filesystem::path(file.name).filename().string()) + ")",
                                 1});
  }

  /// Lists the triangles of this file by their tags.
  /// \return false if the file does not belong to a mesh of `points` points
  bool list_facets(std::size_t points, FileTriangles& listed) {
    const pugi::xml_node grid = document_.select_node("//Grid[Topology]").node();
    const pugi::xml_node topology = grid.child("Topology"),
                         tags = grid.find_child_by_attribute("Attribute", "Name", facet_attribute);
    const std::string kind = topology_of(grid);
    const std::size_t nodes = kind == "triangle" ? 3 : kind == "triangle_6" ? 6 : 0;
    if (nodes == 0 || !tags || rows_of(grid.child("Geometry")) != points) return false;
    const std::size_t rows = rows_of(topology);
    if (rows == 0) return true;
    const std::vector<double> ids = numbers(topology, nodes * rows), numbers_of = numbers(tags, rows);
    if (ids.size() != nodes * rows || numbers_of.size() != rows)
      fail(topology, "there are fewer triangles, or tags of them, than its Dimensions say");
    for (std::size_t i = 0; i < rows; ++i) {
      Triangle triangle;
      for (std::size_t k = 0; k < 3; ++k)
        triangle[k] = index_of(topology, "triangle", i, ids[nodes * i + k], points);
      const double tag = numbers_of[i];
      if (tag != std::floor(tag) || std::fabs(tag) > max_exact_whole)
        fail(tags, "the tag of triangle " + std::to_string(i) + " is " + short_number(tag) +
                       ", which is not a whole number");
      listed.add(triangle, static_cast<std::int64_t>(tag));
    }
    listed.names = names_of(grid, "2");
    listed.name_form = printable_name;
    return true;
  }

  std::string name_;
  const FileReader& read_file_;
  pugi::xml_document document_;
  std::map<std::string, std::unique_ptr<Hdf5Reader>> hdf5_;
  ReadTetMesh result_;
  pugi::xml_node cohesive_;  ///< grid of cohesive elements
  MidsideNodesRead midside_;
  KindCounts rounded_;  ///< rounded integers of fields
};

/// Writes an element that refers to numbers in the HDF5 file.
void write_item(TextWriter& out, const std::string& hdf5, const std::string& dataset, std::size_t rows,
                std::size_t columns, bool integer, int bytes) {
  // Readers strip leading blanks from a name.
  const char* folder = hdf5.starts_with(' ') ? "./" : "";
  out << "<DataItem Dimensions=\"" << rows << ' ' << columns << "\" NumberType=\""
      << (integer ? "Int" : "Float") << "\" Precision=\"" << bytes << "\" Format=\"HDF\">" << folder
      << xml_text(hdf5) << ":/" << dataset << "</DataItem>\n";
}

void begin_grid(TextWriter& out, const char* name) {
  out << "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n<Domain>\n<Grid Name=\"" << name
      << "\" GridType=\"Uniform\">\n";
}

/// Name of the HDF5 file of facets, next to that of the mesh. dolfinx opens the file with the name of the
/// XDMF file, regardless of which one it refers to.
std::string facet_file(const std::string& hdf5) {
  const std::size_t stem = hdf5.rfind('.');
  return hdf5.substr(0, stem) + (hdf5.ends_with(".H5") ? "_FACETS" : "_facets") + hdf5.substr(stem);
}

void write_geometry(TextWriter& out, const MeshToWrite& written, const std::string& hdf5) {
  out << "<Geometry GeometryType=\"XYZ\">\n";
  write_item(out, hdf5, "points", written.nodes(), 3, false, 8);
  out << "</Geometry>\n";
}

template <class Parts, class NumberOf>
void write_names(TextWriter& out, const Parts& parts, int dimension, const NumberOf& number_of) {
  std::string text = "<main>";
  for (const auto& part : parts)
    text += "<map key=\"" + xml_text(part.name) + "\" dim=\"" + std::to_string(dimension) + "\">" +
            std::to_string(number_of(part)) + "</map>";
  out << "<Information Name=\"names\">" << xml_text(text + "</main>") << "</Information>\n";
}

/// Writes cohesive elements as a grid of their own, since dolfinx reads no grid of tets and wedges.
void write_cohesive(TextWriter& out, const MeshToWrite& written, const std::string& hdf5) {
  const std::size_t wedges = written.mesh.wedges.size();
  out << "<Grid Name=\"" << cohesive_grid << "\" GridType=\"Uniform\">\n<Topology TopologyType=\"Wedge\" "
      << "NumberOfElements=\"" << wedges << "\" NodesPerElement=\"" << wedge_nodes << "\">\n";
  write_item(out, hdf5, "wedges", wedges, wedge_nodes, true, 8);
  out << "</Topology>\n";
  write_geometry(out, written, hdf5);
  write_names(out, xdmf_cohesive(written.mesh), 3, [](const auto& part) { return part.number; });
  out << "<Attribute Name=\"" << xdmf_material << "\" AttributeType=\"Scalar\" Center=\"Cell\">\n";
  write_item(out, hdf5, "cohesive", wedges, 1, true, 4);
  out << "</Attribute>\n</Grid>\n";
}

/// Name of a field's dataset; the field's own name may be invalid in HDF5.
std::string dataset_of(const char* of, std::size_t i) { return of + std::to_string(i); }

void write_fields(TextWriter& out, const std::vector<MeshField>& fields, const char* of, const char* center,
                  std::size_t items, const std::string& hdf5, std::vector<std::string> taken) {
  const std::vector<std::string> names = field_names_to_write(fields, std::move(taken));
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const int n = fields[f].components;
    const char* type = n == 1 ? "Scalar" : n == 3 ? "Vector" : n == 9 ? "Tensor" : "Matrix";
    const bool integer = fields[f].integer && all_whole(fields[f]);
    out << "<Attribute Name=\"" << xml_text(names[f]) << "\" AttributeType=\"" << type << "\" Center=\""
        << center << "\">\n";
    write_item(out, hdf5, dataset_of(of, f), items, static_cast<std::size_t>(n), integer, 8);
    out << "</Attribute>\n";
  }
}

void add_fields(Hdf5Writer& file, const std::vector<MeshField>& fields, const char* of) {
  for (std::size_t f = 0; f < fields.size(); ++f) {
    const auto columns = static_cast<std::size_t>(fields[f].components);
    if (fields[f].integer && all_whole(fields[f])) {
      std::vector<std::int64_t> values;
      for (const double x : fields[f].values) values.push_back(static_cast<std::int64_t>(x));
      file.add(dataset_of(of, f), std::span<const std::int64_t>(values), columns);
    } else {
      file.add(dataset_of(of, f), std::span<const double>(fields[f].values), columns);
    }
  }
}

}  // namespace

ReadTetMesh read_xdmf(std::string_view bytes, const std::string& name, const FileReader& read_file,
                      const ReadTetMeshOptions& options, const std::optional<NamedBytes>& facets) {
  return XdmfReader(bytes, name, read_file).read(options, facets);
}

void add_xdmf_numbers(const MeshToWrite& written, Hdf5Writer& file) {
  const TetMesh& mesh = written.mesh;
  const MidsideNodes* midside = written.midside;
  std::vector<double> points;
  points.reserve(3 * written.nodes());
  for (std::size_t i = 0; i < written.nodes(); ++i)
    for (const double x : written.node(i)) points.push_back(x);
  file.add("points", std::span<const double>(points), 3);

  const auto first_midside = static_cast<std::int64_t>(mesh.points.size());
  std::vector<std::int64_t> ids;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    ids.insert(ids.end(), mesh.tets[t].begin(), mesh.tets[t].end());
    if (midside)
      for (const Index m : midside->of_tets[t]) ids.push_back(first_midside + m);
  }
  file.add("tets", std::span<const std::int64_t>(ids), midside ? quadratic_tet_nodes : tet_nodes);
  file.add(xdmf_material, std::span<const std::int32_t>(mesh.materials), 1);

  if (!mesh.wedges.empty()) {
    ids.clear();
    std::vector<std::int32_t> numbers;
    for (const CohesivePart& part : xdmf_cohesive(mesh))
      for (const std::size_t w : part.wedges) {
        for (const std::size_t k : vtk_wedge_order) ids.push_back(mesh.wedges[w][k]);
        numbers.push_back(static_cast<std::int32_t>(part.number));
      }
    file.add("wedges", std::span<const std::int64_t>(ids), wedge_nodes);
    file.add("cohesive", std::span<const std::int32_t>(numbers), 1);
  }
  add_fields(file, written.node_fields(), "point_field");
  add_fields(file, mesh.cell_fields, "cell_field");
}

void add_xdmf_facet_numbers(const MeshToWrite& written, Hdf5Writer& file) {
  const TetMesh& mesh = written.mesh;
  const MidsideNodes* midside = written.midside;
  const auto first_midside = static_cast<std::int64_t>(mesh.points.size());
  std::vector<std::int64_t> ids;
  std::vector<std::int32_t> numbers(mesh.interfaces.size());
  for (std::size_t i = 0; i < mesh.interfaces.size(); ++i) {
    ids.insert(ids.end(), mesh.interfaces[i].ids.begin(), mesh.interfaces[i].ids.end());
    if (midside)
      for (const Index m : midside->of_faces[i]) ids.push_back(first_midside + m);
  }
  for (const MeshParts::Surface& s : mesh_parts(mesh, printable_names()).surfaces)
    for (const std::size_t f : s.faces) numbers[f] = static_cast<std::int32_t>(s.number);
  file.add("triangles", std::span<const std::int64_t>(ids), midside ? 6 : 3);
  file.add(facet_attribute, std::span<const std::int32_t>(numbers), 1);
}

void write_xdmf_mesh(const MeshToWrite& written, const std::string& hdf5, const ByteSink& sink) {
  const TetMesh& mesh = written.mesh;
  const std::size_t nodes = written.midside ? quadratic_tet_nodes : tet_nodes;
  TextWriter out(sink);
  begin_grid(out, "mesh");
  out << "<Topology TopologyType=\"" << (written.midside ? "Tetrahedron_10" : "Tetrahedron")
      << "\" NumberOfElements=\"" << mesh.tets.size() << "\" NodesPerElement=\"" << nodes << "\">\n";
  write_item(out, hdf5, "tets", mesh.tets.size(), nodes, true, 8);
  out << "</Topology>\n";
  write_geometry(out, written, hdf5);
  write_names(out, mesh_parts(mesh, printable_names()).materials, 3, [](const auto& m) { return m.tag; });
  // Must come first, since dolfinx uses the first attribute as the tags of a grid.
  out << "<Attribute Name=\"" << xdmf_material << "\" AttributeType=\"Scalar\" Center=\"Cell\">\n";
  write_item(out, hdf5, xdmf_material, mesh.tets.size(), 1, true, 4);
  out << "</Attribute>\n";
  write_fields(out, mesh.cell_fields, "cell_field", "Cell", mesh.tets.size(), hdf5, {xdmf_material});
  write_fields(out, written.node_fields(), "point_field", "Node", written.nodes(), hdf5, {});
  out << "</Grid>\n";
  if (!mesh.wedges.empty()) write_cohesive(out, written, hdf5);
  out << "</Domain>\n</Xdmf>\n";
  out.flush();
}

void write_xdmf_facets(const MeshToWrite& written, const std::string& hdf5, const ByteSink& sink) {
  const TetMesh& mesh = written.mesh;
  const std::size_t nodes = written.midside ? 6 : 3;
  TextWriter out(sink);
  begin_grid(out, facet_attribute);
  out << "<Topology TopologyType=\"" << (written.midside ? "Triangle_6" : "Triangle")
      << "\" NumberOfElements=\"" << mesh.interfaces.size() << "\" NodesPerElement=\"" << nodes << "\">\n";
  write_item(out, facet_file(hdf5), "triangles", mesh.interfaces.size(), nodes, true, 8);
  out << "</Topology>\n";
  write_geometry(out, written, hdf5);
  write_names(out, mesh_parts(mesh, printable_names()).surfaces, 2, [](const auto& s) { return s.number; });
  out << "<Attribute Name=\"" << facet_attribute << "\" AttributeType=\"Scalar\" Center=\"Cell\">\n";
  write_item(out, facet_file(hdf5), facet_attribute, mesh.interfaces.size(), 1, true, 4);
  out << "</Attribute>\n</Grid>\n</Domain>\n</Xdmf>\n";
  out.flush();
}

}  // namespace tetwright

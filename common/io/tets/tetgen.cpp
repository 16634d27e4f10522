// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/tetgen.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "common/io/elements/midside_nodes_read.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/names/mesh_parts.h"
#include "common/io/text/text_scanner.h"
#include "tetwright/error.h"
#include "tetwright/io.h"

namespace tetwright {

namespace {

constexpr std::int64_t max_attributes = 1000;
constexpr const char* material_attribute = "attribute";

/// Lines of a file: a line of counts, then a line for each item. # begins a comment.
class Lines {
 public:
  Lines(std::string_view bytes, const std::string& name) : in_(bytes, name, '#') {
    if (in_.at_end()) in_.fail("the file is empty");
  }

  /// Next number on this line.
  /// \param what names it in messages
  template <class Number>
  Number next(const std::string& what) {
    const std::string_view word = in_.word_on_line();
    Number value{};
    if (word.empty()) in_.fail("the line ends where a " + what + " was expected; the file is damaged");
    if (!parse_number(word, value)) in_.fail("expected a number (" + what + "), found " + in_quotes(word));
    return value;
  }
  /// Optional count at the end of the first line; 0 if it is missing.
  std::int64_t optional_count(const std::string& what, std::int64_t max) {
    const std::string_view word = in_.word_on_line();
    std::int64_t value = 0;
    if (word.empty()) return 0;
    if (!parse_number(word, value)) in_.fail("expected a number (" + what + "), found " + in_quotes(word));
    if (value < 0 || value > max)
      in_.fail("the " + what + " is " + std::to_string(value) + ", not 0 to " + std::to_string(max));
    return value;
  }
  /// Advances to the next line that is not empty.
  void begin_line(const std::string& what) {
    if (in_.at_end()) in_.fail_cut_short(what);
  }
  void end_line() { in_.skip_line(); }

  /// \throws InputError if `n` lines of `words` words each do not fit into the rest of the file
  std::size_t checked(std::int64_t n, std::size_t words, const std::string& what) {
    if (n < 0) in_.fail("the number of " + what + " is negative: " + std::to_string(n));
    if (static_cast<std::uint64_t>(n) > (in_.left() + 1) / (2 * words))
      in_.fail("the header gives " + std::to_string(n) + " " + what + ", but only " +
               std::to_string(in_.left()) + " bytes follow; the file is truncated or its header is wrong");
    return static_cast<std::size_t>(n);
  }

  [[noreturn]] void fail(const std::string& message) const { in_.fail(message); }

 private:
  TextScanner in_;
};

/// Makes a field for each attribute and reserves memory for `n` items.
std::vector<MeshField> attribute_fields(std::int64_t attributes, std::size_t n, const char* first) {
  std::vector<MeshField> fields;
  for (std::int64_t k = 0; k < attributes; ++k)
    fields.push_back(
        {k == 0 ? first : "attribute" + std::to_string(k + 1), 1, false, std::vector<double>(n)});
  return fields;
}

/// Reads the points.
/// \return the number of the first one
std::int64_t read_nodes(Lines& in, TetMesh& mesh) {
  const auto promised = in.next<std::int64_t>("number of points");
  if (const auto dimension = in.next<std::int64_t>("dimension"); dimension != 3)
    in.fail("dimension " + std::to_string(dimension) + "; a mesh of tets has 3");
  const std::int64_t attributes = in.optional_count("number of attributes", max_attributes);
  const std::int64_t markers = in.optional_count("number of boundary markers", 1);
  in.end_line();
  const std::size_t n = in.checked(promised, 4 + static_cast<std::size_t>(attributes + markers), "points");
  if (n == 0) in.fail("there are no points in it");
  if (n >= no_index) in.fail("more than " + std::to_string(no_index - 1) + " points; split the mesh");
  mesh.points.resize(n);
  mesh.point_fields = attribute_fields(attributes, n, "attribute1");
  if (markers) mesh.point_fields.push_back({"boundary_marker", 1, true, std::vector<double>(n)});
  std::int64_t first = 0;
  for (std::size_t i = 0; i < n; ++i) {
    in.begin_line("point");
    const auto number = in.next<std::int64_t>("number of a point");
    if (i == 0) {
      if (number != 0 && number != 1)
        in.fail("the first point has the number " + std::to_string(number) + "; numbers begin at 0 or 1");
      first = number;
    }
    if (number - first != static_cast<std::int64_t>(i))
      in.fail("found point " + std::to_string(number) + " instead of point " +
              std::to_string(first + static_cast<std::int64_t>(i)));
    for (int k = 0; k < 3; ++k) {
      mesh.points[i][k] = in.next<double>("coordinate");
      if (!std::isfinite(mesh.points[i][k]))
        in.fail("a coordinate of point " + std::to_string(number) + " is not finite; remove or repair it");
    }
    for (std::int64_t k = 0; k < attributes; ++k)
      mesh.point_fields[static_cast<std::size_t>(k)].values[i] = in.next<double>("attribute");
    if (markers)
      mesh.point_fields.back().values[i] = static_cast<double>(in.next<std::int64_t>("boundary marker"));
    in.end_line();
  }
  return first;
}

/// Reads the tets.
/// \return the midside nodes, which are still among the points
MidsideNodesRead read_tets(Lines& in, std::int64_t first, ReadTetMesh& read) {
  TetMesh& mesh = read.mesh;
  const auto promised = in.next<std::int64_t>("number of tets");
  const auto corners = in.next<std::int64_t>("number of points of a tet");
  if (corners != 4 && corners != 10)
    in.fail("tets of " + std::to_string(corners) + " points; 4 or 10 are supported");
  const std::int64_t attributes = in.optional_count("number of attributes", max_attributes);
  in.end_line();
  const std::size_t n = in.checked(promised, static_cast<std::size_t>(1 + corners + attributes), "tets");
  if (n == 0) in.fail("there are no tets in it; a tet mesh is needed, not a surface");
  mesh.tets.resize(n);
  mesh.cell_fields = attribute_fields(attributes, n, material_attribute);
  MidsideNodesRead midside;
  for (std::size_t t = 0; t < n; ++t) {
    in.begin_line("tet");
    const auto number = in.next<std::int64_t>("number of a tet");
    const auto read_index = [&](Index& vertex) {
      const auto point = in.next<std::int64_t>("number of a point");
      if (point < first || point - first >= std::ssize(mesh.points))
        in.fail("tet " + std::to_string(number) + " refers to point " + std::to_string(point) +
                ", but the .node file has points " + std::to_string(first) + " to " +
                std::to_string(first + std::ssize(mesh.points) - 1) + "; do the files belong together?");
      vertex = static_cast<Index>(point - first);
    };
    for (Index& vertex : mesh.tets[t]) read_index(vertex);
    if (corners == 10) {
      std::array<Index, 6> ids{};
      for (Index& node : ids) read_index(node);
      midside.add_tet(ids);
    }
    for (MeshField& field : mesh.cell_fields) field.values[t] = in.next<double>("attribute");
    in.end_line();
  }
  // Attributes are region numbers, which TetGen writes as floating-point numbers.
  for (MeshField& field : mesh.cell_fields) field.integer = all_whole(field);
  return midside;
}

/// Reads the comments at the beginning of files that this program wrote: lines "# material 3: bone".
std::map<std::int64_t, std::string> read_name_comments(std::string_view bytes, std::string_view what) {
  std::map<std::int64_t, std::string> names;
  const std::string begin = "# " + std::string(what) + " ";
  while (bytes.starts_with('#')) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    std::string_view line = bytes.substr(0, end);
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    const std::size_t colon = line.find(": ");
    std::int64_t number = 0;
    if (line.starts_with(begin) && colon != std::string_view::npos &&
        parse_number(line.substr(begin.size(), colon - begin.size()), number))
      names.emplace(number, line.substr(colon + 2));
  }
  return names;
}

/// Reads the faces with a boundary marker other than 0, grouped by marker.
/// \param midside true: each face has three more nodes, as TetGen writes them with tets of ten nodes
FileTriangles read_faces(Lines& in, std::int64_t first, std::size_t points, bool midside) {
  FileTriangles listed;
  const auto promised = in.next<std::int64_t>("number of faces");
  const std::int64_t markers = in.optional_count("number of boundary markers", 1);
  in.end_line();
  const std::size_t n = in.checked(promised, static_cast<std::size_t>(4 + markers), "faces");
  for (std::size_t f = 0; f < n; ++f) {
    in.begin_line("face");
    const auto number = in.next<std::int64_t>("number of a face");
    Triangle ids{};
    for (Index& id : ids) {
      const auto point = in.next<std::int64_t>("number of a point");
      if (point < first || static_cast<std::uint64_t>(point - first) >= points)
        in.fail("face " + std::to_string(number) + " refers to point " + std::to_string(point) +
                ", but the .node file has points " + std::to_string(first) + " to " +
                std::to_string(first + static_cast<std::int64_t>(points) - 1) +
                "; do the files belong together?");
      id = static_cast<Index>(point - first);
    }
    for (int k = 0; midside && k < 3; ++k) (void)in.next<std::int64_t>("number of a point");
    const std::int64_t marker = markers ? in.next<std::int64_t>("boundary marker") : 0;
    in.end_line();
    // TetGen optionally lists all faces; faces without a marker are in no patch.
    if (marker != 0) listed.add(ids, marker);
  }
  return listed;
}

}  // namespace

ReadTetMesh read_tetgen(const NamedBytes& node, const NamedBytes& ele, const std::optional<NamedBytes>& face,
                        const ReadTetMeshOptions& options) {
  ReadTetMesh read;
  Lines nodes(node.bytes, node.name);
  const std::int64_t first = read_nodes(nodes, read.mesh);
  Lines tets(ele.bytes, ele.name);
  const MidsideNodesRead midside = read_tets(tets, first, read);
  FileTriangles listed;
  if (face) {
    Lines faces(face->bytes, face->name);
    listed = read_faces(faces, first, read.mesh.points.size(), midside.any());
    listed.names = read_name_comments(face->bytes, "marker");
    listed.name_form = printable_name;
  }
  midside.remove_from(read, listed.triangles);
  take_material(read, options, ele.name);
  // The names refer only to the numbers in this field.
  if (read.material_field == material_attribute)
    for (const auto& [tag, name] : read_name_comments(ele.bytes, "material"))
      read.mesh.material_names[checked_material(tag, ele.name, 0)] = name;
  if (face) take_triangles(listed, "boundary marker", face->name, read);
  return read;
}

}  // namespace tetwright

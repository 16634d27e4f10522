// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/medit_binary.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include "common/io/encodings/byte_order.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/text/text_scanner.h"
#include "common/mesh/boundary_groups.h"
#include "tetwright/error.h"
#include "tetwright/io.h"

namespace tetwright {

namespace {

// Keywords of libMeshb.
constexpr std::int32_t dimension_keyword = 3, vertices_keyword = 4, triangles_keyword = 6, tets_keyword = 8,
                       end_keyword = 54;

/// Sections of volume cells, with the kinds of cells.
const std::map<std::int32_t, const char*> volume_keywords{{9, "prisms"},
                                                          {10, "hexahedra"},
                                                          {30, "quadratic tets"},
                                                          {33, "quadratic hexahedra"},
                                                          {46, "polyhedra"},
                                                          {49, "pyramids"},
                                                          {86, "quadratic prisms"},
                                                          {87, "quadratic pyramids"},
                                                          {96, "tets of higher order"},
                                                          {97, "tets of higher order"},
                                                          {98, "hexahedra of higher order"},
                                                          {99, "hexahedra of higher order"},
                                                          {100, "pyramids of higher order"},
                                                          {101, "pyramids of higher order"},
                                                          {102, "prisms of higher order"},
                                                          {103, "prisms of higher order"}};

/// Sections that are counted but not read.
const std::map<std::int32_t, const char*> other_keywords{{5, "edges"},
                                                         {7, "quads"},
                                                         {13, "corners"},
                                                         {14, "ridges"},
                                                         {15, "required vertices"},
                                                         {16, "required edges"},
                                                         {17, "required triangles"},
                                                         {60, "normals"},
                                                         {59, "tangents"}};

class BinaryReader {
 public:
  BinaryReader(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  ReadTetMesh read(const ReadTetMeshOptions& options) {
    read_head();
    while (read_section()) {
    }
    if (!volume_cells_.empty())
      throw InputError(name_ + ": byte " + std::to_string(volume_cells_at_) + ": " +
                       unsupported_cells(volume_cells_, "in the section that begins here"));
    check();
    take_material(result_, options, name_);
    take_triangles(triangles_, "reference", name_, result_);
    others_.append_to(result_.dropped);
    if (point_references_ > 0)
      result_.dropped.push_back({"points with a reference other than 0", point_references_});
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(name_ + ": byte " + std::to_string(position_) + ": " + message);
  }

  template <class Number>
  Number next(const char* what) {
    if (bytes_.size() - position_ < sizeof(Number))
      fail("the file ends where a " + std::string(what) + " was expected; it is truncated");
    const auto value = load<Number>(bytes_.data() + position_, swap_);
    position_ += sizeof(Number);
    return value;
  }
  /// Integers have eight bytes in version 4, file positions since version 3, coordinates since version 2.
  std::int64_t integer(const char* what) {
    return version_ >= 4 ? next<std::int64_t>(what) : next<std::int32_t>(what);
  }
  std::int64_t position(const char* what) {
    return version_ >= 3 ? next<std::int64_t>(what) : next<std::int32_t>(what);
  }
  double coordinate() {
    const double value = version_ >= 2 ? next<double>("coordinate") : next<float>("coordinate");
    if (!std::isfinite(value)) fail("a coordinate is not finite; remove or repair it");
    return value;
  }

  void read_head() {
    if (bytes_.empty()) throw InputError(name_ + ": the file is empty");
    const auto one = next<std::int32_t>("number 1");
    swap_ = one != 1;
    position_ = 0;
    if (next<std::int32_t>("number 1") != 1)
      throw InputError(name_ + ": byte 0: expected the four-byte number 1; this is not a binary Medit mesh");
    version_ = next<std::int32_t>("version");
    if (version_ < 1 || version_ > 4)
      throw InputError(name_ + ": byte 4: version " + std::to_string(version_) + "; 1 to 4 are supported");
  }

  /// Reads a section.
  /// \return false after the last one
  bool read_section() {
    const std::size_t at = position_;
    if (position_ == bytes_.size()) return false;
    const auto keyword = next<std::int32_t>("keyword");
    if (keyword == end_keyword) return false;
    const std::int64_t after = position("position of the next section");
    if (after != 0 &&
        (after < static_cast<std::int64_t>(position_) || after > static_cast<std::int64_t>(bytes_.size())))
      fail("section " + std::to_string(keyword) + " extends to byte " + std::to_string(after) + " of " +
           std::to_string(bytes_.size()) + "; the file is truncated or damaged");
    if (keyword == dimension_keyword)
      read_dimension();
    else if (keyword == vertices_keyword)
      read_vertices();
    else if (keyword == tets_keyword)
      read_tets();
    else if (keyword == triangles_keyword)
      read_triangles();
    else
      note(keyword, at);
    if (after == 0) return false;
    position_ = static_cast<std::size_t>(after);
    return true;
  }

  void read_dimension() {
    if (const auto dimension = next<std::int32_t>("dimension"); dimension != 3)
      fail("dimension " + std::to_string(dimension) + "; a mesh of tets has 3");
  }

  std::size_t count(const char* what, std::size_t numbers_each) {
    const std::int64_t n = integer(what);
    const std::size_t each = numbers_each * (version_ >= 4 ? 8 : 4);
    if (n < 0 || static_cast<std::uint64_t>(n) > (bytes_.size() - position_) / each)
      fail("the " + std::string(what) + " is " + std::to_string(n) + ", but only " +
           std::to_string(bytes_.size() - position_) + " bytes follow; the file is truncated or damaged");
    return static_cast<std::size_t>(n);
  }

  void read_vertices() {
    TetMesh& mesh = result_.mesh;
    if (!mesh.points.empty()) fail("a second section of vertices");
    const std::size_t n = count("number of points", 4);
    if (n >= no_index) fail("more than " + std::to_string(no_index - 1) + " points; split the mesh");
    mesh.points.resize(n);
    for (Vec3& p : mesh.points) {
      for (int k = 0; k < 3; ++k) p[k] = coordinate();
      point_references_ += integer("reference") != 0;
    }
  }

  /// Reads an index, which is checked once all points are read.
  Index index(const char* what) {
    const std::int64_t i = integer(what);
    if (i < 1 || i >= no_index) fail("the index of a point is " + std::to_string(i) + "; indices begin at 1");
    largest_ = std::max(largest_, static_cast<std::size_t>(i));
    return static_cast<Index>(i - 1);
  }

  void read_tets() {
    TetMesh& mesh = result_.mesh;
    if (!mesh.tets.empty()) fail("a second section of tets");
    const std::size_t n = count("number of tets", 5);
    mesh.tets.resize(n);
    mesh.materials.resize(n);
    for (std::size_t t = 0; t < n; ++t) {
      for (Index& vertex : mesh.tets[t]) vertex = index("index of a point");
      mesh.materials[t] = checked_material(integer("reference"), name_, 0);
    }
    result_.material_field = "medit:ref";
  }

  void read_triangles() {
    const std::size_t n = count("number of triangles", 4);
    for (std::size_t i = 0; i < n; ++i) {
      Triangle ids;
      for (Index& vertex : ids) vertex = index("index of a point");
      triangles_.add(ids, integer("reference"));
    }
  }

  void note(std::int32_t keyword, std::size_t at) {
    const std::int64_t n = integer("number of items");
    if (n <= 0) return;
    const auto items = static_cast<std::size_t>(n);
    if (const auto volumes = volume_keywords.find(keyword); volumes != volume_keywords.end()) {
      if (volume_cells_.empty()) volume_cells_at_ = at;
      volume_cells_.add(volumes->second, items);
    } else if (const auto others = other_keywords.find(keyword); others != other_keywords.end()) {
      others_.add(others->second, items);
    } else {
      others_.add("items of section " + std::to_string(keyword), items);
    }
  }

  void check() const {
    const TetMesh& mesh = result_.mesh;
    if (mesh.tets.empty())
      throw InputError(name_ + ": there are no tets in it; a tet mesh is needed, not a surface");
    if (largest_ > mesh.points.size())
      throw InputError(name_ + ": an element refers to point " + std::to_string(largest_) + " of " +
                       std::to_string(mesh.points.size()) + " (counted from 1); export the file again");
  }

  std::string_view bytes_;
  std::string name_;
  std::size_t position_ = 0;
  bool swap_ = false;
  std::int32_t version_ = 0;
  ReadTetMesh result_;
  FileTriangles triangles_;
  KindCounts volume_cells_, others_;
  std::size_t volume_cells_at_ = 0, point_references_ = 0, largest_ = 0;
};

/// Writes sections, each of which contains the position of the next one.
class Sections {
 public:
  /// \param wide true: positions take eight bytes
  Sections(const ByteSink& sink, bool wide) : sink_(sink), wide_(wide) {}

  template <class Number>
  Sections& put(Number number) {
    append_bytes(bytes_, number);
    if (bytes_.size() >= piece_size) flush();
    return *this;
  }

  /// Starts a section whose content takes `size` bytes.
  void begin(std::int32_t keyword, std::uint64_t size) {
    put(keyword);
    const std::uint64_t next = position_ + bytes_.size() + (wide_ ? 8 : 4) + size;
    put_position(next);
  }
  void end() {
    put(end_keyword);
    put_position(0);
    flush();
  }

 private:
  static constexpr std::size_t piece_size = std::size_t{1} << 20;

  void put_position(std::uint64_t position) {
    if (wide_)
      put(position);
    else
      put(static_cast<std::uint32_t>(position));
  }
  void flush() {
    sink_(bytes_);
    position_ += bytes_.size();
    bytes_.clear();
  }

  const ByteSink& sink_;
  bool wide_;
  std::string bytes_;
  std::uint64_t position_ = 0;  ///< bytes written
};

}  // namespace

ReadTetMesh read_medit_binary(std::string_view bytes, const std::string& name,
                              const ReadTetMeshOptions& options) {
  return BinaryReader(bytes, name).read(options);
}

void write_medit_binary(const MeshToWrite& written, const ByteSink& sink) {
  const TetMesh& mesh = written.mesh;
  constexpr std::uint64_t count_size = 4, point_size = 28, tet_size = 20, triangle_size = 16;
  const std::uint64_t size = 100 + point_size * mesh.points.size() + tet_size * mesh.tets.size() +
                             triangle_size * mesh.interfaces.size();
  const bool wide = size > std::numeric_limits<std::int32_t>::max();
  Sections out(sink, wide);
  out.put(std::int32_t{1}).put(std::int32_t{wide ? 3 : 2});
  out.begin(dimension_keyword, sizeof(std::int32_t));
  out.put(std::int32_t{3});

  out.begin(vertices_keyword, count_size + point_size * mesh.points.size());
  out.put(static_cast<std::int32_t>(mesh.points.size()));
  for (const Vec3& p : mesh.points) out.put(p.x()).put(p.y()).put(p.z()).put(std::int32_t{0});

  const auto put_ids = [&](const auto& ids) {
    for (const Index v : ids) out.put(static_cast<std::int32_t>(v + 1));
  };
  out.begin(tets_keyword, count_size + tet_size * mesh.tets.size());
  out.put(static_cast<std::int32_t>(mesh.tets.size()));
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    put_ids(mesh.tets[t]);
    out.put(std::int32_t{mesh.materials[t]});
  }
  if (!mesh.interfaces.empty()) {
    const BoundaryGroups groups(mesh);
    out.begin(triangles_keyword, count_size + triangle_size * mesh.interfaces.size());
    out.put(static_cast<std::int32_t>(mesh.interfaces.size()));
    for (const InterfaceTriangle& t : mesh.interfaces) {
      put_ids(t.ids);
      out.put(static_cast<std::int32_t>(groups.number_of(t)));
    }
  }
  out.end();
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/ply.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "common/io/encodings/byte_order.h"
#include "common/io/names/group_text.h"
#include "common/io/names/label_groups.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/surfaces/declared_space.h"
#include "common/io/surfaces/surface_builder.h"
#include "common/io/text/text_scanner.h"
#include "common/number_text.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

constexpr std::size_t type_size(Type type) {
  constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

std::optional<Type> type_of(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, Type>, 16> names{{{"char", Type::int8},
                                                                     {"int8", Type::int8},
                                                                     {"uchar", Type::uint8},
                                                                     {"uint8", Type::uint8},
                                                                     {"short", Type::int16},
                                                                     {"int16", Type::int16},
                                                                     {"ushort", Type::uint16},
                                                                     {"uint16", Type::uint16},
                                                                     {"int", Type::int32},
                                                                     {"int32", Type::int32},
                                                                     {"uint", Type::uint32},
                                                                     {"uint32", Type::uint32},
                                                                     {"float", Type::float32},
                                                                     {"float32", Type::float32},
                                                                     {"double", Type::float64},
                                                                     {"float64", Type::float64}}};
  for (const auto& [name, type] : names)
    if (name == word) return type;
  return std::nullopt;
}

bool is_integer(Type type) { return type != Type::float32 && type != Type::float64; }

enum class Role { skipped, x, y, z, vertices, label };

struct Property {
  std::string name;
  std::optional<Type> count_type;  ///< type of the count of a list; none: not a list
  Type type = Type::float32;
  Role role = Role::skipped;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::size_t line = 0;
  std::vector<Property> properties;

  bool is_vertex() const { return name == "vertex"; }
  bool is_face() const { return name == "face"; }
  bool has(Role role) const {
    for (const Property& p : properties)
      if (p.role == role) return true;
    return false;
  }
};

enum class Encoding { ascii, little, big };

struct PlyHeader {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  /// Labels of groups by their unique names, from the comments of write_ply().
  std::map<std::string, std::int64_t> labels;
  std::string space;  ///< see TriangleMesh::space
};

constexpr std::string_view group_property = "surface", group_comment = "surface ";

/// Reads a comment such as " surface 3: inlet".
void read_group_name(std::string_view comment, PlyHeader& header) {
  comment.remove_prefix(std::min<std::size_t>(1, comment.size()));
  const std::size_t colon = comment.find(": ");
  if (!comment.starts_with(group_comment) || colon == std::string_view::npos) return;
  std::int64_t label = 0;
  if (!parse_number(comment.substr(group_comment.size(), colon - group_comment.size()), label)) return;
  header.labels.emplace(comment.substr(colon + 2), label);
}

Role role_of(const Element& element, std::string_view name, bool list) {
  if (element.is_vertex() && !list) {
    if (name == "x") return Role::x;
    if (name == "y") return Role::y;
    if (name == "z") return Role::z;
  }
  if (element.is_face() && list && (name == "vertex_indices" || name == "vertex_index"))
    return Role::vertices;
  if (element.is_face() && !list && !element.has(Role::label) && is_face_label(name)) return Role::label;
  return Role::skipped;
}

void read_property(TextScanner& in, Element& element) {
  const auto type = [&] {
    const std::string_view word = in.word_on_line();
    const std::optional<Type> t = type_of(word);
    if (!t) in.fail("unknown type " + in_quotes(word) + " of a property");
    return *t;
  };
  Property property;
  // A list property has the word "list" before its types.
  const std::string_view first = in.word_on_line();
  const bool list = first == "list";
  if (list) {
    property.count_type = type();
    if (!is_integer(*property.count_type)) in.fail("the length of a list must be a whole number");
    property.type = type();
  } else {
    const std::optional<Type> t = type_of(first);
    if (!t) in.fail("unknown type " + in_quotes(first) + " of a property");
    property.type = *t;
  }
  const std::string_view name = in.word_on_line();
  property.name = std::string(name.substr(0, 64));
  property.role = role_of(element, name, list);
  if (property.role == Role::label && !is_integer(property.type)) property.role = Role::skipped;
  if (property.role != Role::skipped && element.has(property.role))
    in.fail("property " + in_quotes(name) + " appears twice");
  if (property.role == Role::vertices && !is_integer(property.type))
    in.fail("the indices of a face must be whole numbers");
  element.properties.push_back(property);
}

PlyHeader read_ply_header(TextScanner& in) {
  PlyHeader header;
  if (in.at_end()) in.fail("the file is empty");
  if (const std::string_view magic = in.word(); magic != "ply")
    in.fail("expected \"ply\" at the beginning, found " + in_quotes(magic) + "; is this a PLY file?");
  in.skip_line();
  bool has_format = false;
  for (;;) {
    if (in.left() == 0) in.fail_cut_short("line \"end_header\"");
    const std::string_view keyword = in.word_on_line();
    if (keyword == "format") {
      const std::string_view format = in.word_on_line();
      has_format = true;
      if (format == "ascii")
        header.encoding = Encoding::ascii;
      else if (format == "binary_little_endian")
        header.encoding = Encoding::little;
      else if (format == "binary_big_endian")
        header.encoding = Encoding::big;
      else
        in.fail("unknown format " + in_quotes(format) +
                "; supported: ascii, binary_little_endian and binary_big_endian");
    } else if (keyword == "element") {
      Element element;
      element.name = std::string(in.word_on_line().substr(0, 64));
      const std::string_view count = in.word_on_line();
      std::int64_t value = 0;
      if (!parse_number(count, value) || value < 0)
        in.fail("expected the number of elements, found " + in_quotes(count));
      element.count = static_cast<std::uint64_t>(value);
      element.line = in.line();
      header.elements.push_back(std::move(element));
    } else if (keyword == "property") {
      if (header.elements.empty()) in.fail("a property before the first element");
      read_property(in, header.elements.back());
    } else if (keyword == "end_header") {
      in.skip_line();
      break;
    } else if (keyword == "comment") {
      const std::string_view comment = in.rest_of_line();
      read_group_name(comment, header);
      if (header.space.empty()) header.space = declared_space(comment);
      continue;
    } else if (keyword != "obj_info" && !keyword.empty()) {
      in.fail("unknown keyword " + in_quotes(keyword) + " in the header");
    }
    in.skip_line();
  }
  if (!has_format) in.fail("the header has no line \"format\"");
  return header;
}

/// Numbers of an ASCII body.
class AsciiBody {
 public:
  AsciiBody(TextScanner& in) : in_(in) {}
  std::string place() const { return "line " + std::to_string(in_.line()); }
  std::size_t left() const { return in_.left() + 1; }  // the last number may lack trailing white space
  /// Minimum number of bytes of a number.
  static std::size_t size(Type) { return 2; }
  double coordinate(Type) { return in_.coordinate(); }
  double number(Type) { return in_.number("property"); }
  std::int64_t integer(Type, std::string_view what) { return in_.integer(what); }
  void skip(Type, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i)
      if (in_.word().empty()) in_.fail_cut_short("property");
  }
  [[noreturn]] void fail(const std::string& message) const { in_.fail(message); }

 private:
  TextScanner& in_;
};

/// Numbers in a binary body.
class BinaryBody {
 public:
  BinaryBody(std::string_view bytes, std::size_t offset, std::string name, bool swap)
      : bytes_(bytes), offset_(offset), name_(std::move(name)), swap_(swap) {}
  std::string place() const { return "byte " + std::to_string(offset_); }
  std::size_t left() const { return bytes_.size() - offset_; }
  static std::size_t size(Type type) { return type_size(type); }
  double coordinate(Type type) { return number(type); }
  double number(Type type) {
    const char* at = take(type, 1);
    switch (type) {
      case Type::float32:
        return load<float>(at, swap_);
      case Type::float64:
        return load<double>(at, swap_);
      default:
        return static_cast<double>(as_integer(at, type));
    }
  }
  std::int64_t integer(Type type, std::string_view) { return as_integer(take(type, 1), type); }
  void skip(Type type, std::size_t n) { (void)take(type, n); }
  [[noreturn]] void fail(const std::string& message) const {
    throw InputError(name_ + ": " + place() + ": " + message);
  }

 private:
  const char* take(Type type, std::size_t n) {
    if (n > left() / type_size(type)) fail("the file ends within the data; it is truncated");
    const char* at = bytes_.data() + offset_;
    offset_ += n * type_size(type);
    return at;
  }
  std::int64_t as_integer(const char* at, Type type) const {
    switch (type) {
      case Type::int8:
        return load<std::int8_t>(at, swap_);
      case Type::uint8:
        return load<std::uint8_t>(at, swap_);
      case Type::int16:
        return load<std::int16_t>(at, swap_);
      case Type::uint16:
        return load<std::uint16_t>(at, swap_);
      case Type::int32:
        return load<std::int32_t>(at, swap_);
      default:
        return load<std::uint32_t>(at, swap_);
    }
  }

  std::string_view bytes_;
  std::size_t offset_;
  std::string name_;
  bool swap_;
};

/// Checks that the promised number of items fits into the rest of the file.
template <class Body>
void check_count(const Body& body, const Element& element) {
  std::size_t min_size = 0;
  for (const Property& p : element.properties) min_size += body.size(p.count_type ? *p.count_type : p.type);
  if (min_size > 0 && element.count > body.left() / min_size)
    body.fail("the header gives " + std::to_string(element.count) + " items of element " +
              in_quotes(element.name) + ", but only " + std::to_string(body.left()) +
              " bytes follow; the file is truncated");
}

/// Output of read_element().
struct PlyContent {
  explicit PlyContent(const std::string& name) : surface(name) {}
  SurfaceBuilder surface;
  LabelGroups labels;
  /// Values of each property of element `vertex`, in its order; empty for properties that are not read.
  std::vector<std::vector<double>> point_values;
};

template <class Body>
void read_element(Body& body, const Element& element, bool with_fields, PlyContent& content) {
  SurfaceBuilder& surface = content.surface;
  // An element without properties takes no bytes, whatever its count.
  if (element.properties.empty()) return;
  check_count(body, element);
  const auto place = [&] { return body.place(); };
  if (element.is_vertex()) {
    surface.reserve(static_cast<std::size_t>(element.count), 0);
    content.point_values.resize(element.properties.size());
  }
  if (element.is_face()) surface.reserve(0, static_cast<std::size_t>(element.count));
  std::vector<std::int64_t> polygon;
  Vec3 point;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const Property& p = element.properties[k];
      if (p.count_type) {
        const std::int64_t n = body.integer(*p.count_type, "length of a list");
        if (n < 0 || static_cast<std::uint64_t>(n) > body.left() / body.size(p.type))
          body.fail("a list of " + std::to_string(n) + " items, but only " + std::to_string(body.left()) +
                    " bytes follow; the file is truncated or damaged");
        const auto length = static_cast<std::size_t>(n);
        if (p.role == Role::vertices) {
          polygon.resize(length);
          for (std::int64_t& index : polygon) index = body.integer(p.type, "index of a point");
        } else {
          body.skip(p.type, length);
        }
      } else if (p.role == Role::label) {
        surface.begin_group(content.labels.index_of(body.integer(p.type, "label of a face")));
      } else if (p.role == Role::skipped && with_fields && element.is_vertex()) {
        content.point_values[k].push_back(body.number(p.type));
      } else if (p.role == Role::skipped) {
        body.skip(p.type, 1);
      } else {
        point[static_cast<int>(p.role) - static_cast<int>(Role::x)] = body.coordinate(p.type);
      }
    }
    if (element.is_vertex()) surface.add_point(point, place);
    if (element.is_face()) surface.add_polygon(polygon, place);
  }
}

/// Counts contents other than coordinates and polygons.
void note_dropped(const PlyHeader& header, SurfaceBuilder& surface) {
  for (const Element& element : header.elements) {
    if (!element.is_vertex() && !element.is_face()) {
      surface.drop("items of element " + in_quotes(element.name), static_cast<std::size_t>(element.count));
      continue;
    }
    std::vector<std::string> names;
    for (const Property& property : element.properties)
      if (property.role == Role::skipped) names.push_back(property.name);
    if (!names.empty())
      surface.drop("properties of element " + in_quotes(element.name) + " (" + quoted_list(names) + ")",
                   names.size());
  }
}

void take_names(const PlyHeader& header, std::vector<SurfaceRegion>& groups) {
  std::map<std::int64_t, std::string> names;
  for (const auto& [name, label] : header.labels) names.emplace(label, name);
  for (SurfaceRegion& group : groups)
    if (const auto known = names.find(group.number); known != names.end()) group.name = known->second;
}

/// Reads the surface, and the point fields unless `point_fields` is null.
TriangleMesh read_polygons(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped,
                           std::vector<MeshField>* point_fields) {
  TextScanner in(bytes, name);
  const PlyHeader header = read_ply_header(in);
  const Element* vertex = nullptr;
  const Element* face = nullptr;
  for (const Element& e : header.elements) {
    if (e.name == "tristrips")
      throw InputError(name, e.line, "triangle strips are not supported; export the surface as faces");
    const Element** which = e.is_vertex() ? &vertex : e.is_face() ? &face : nullptr;
    if (which && *which) throw InputError(name, e.line, "element " + in_quotes(e.name) + " appears twice");
    if (e.is_face() && !vertex) throw InputError(name, e.line, "the faces come before the points");
    if (which) *which = &e;
  }
  if (!vertex) throw InputError(name + ": the header has no element \"vertex\"");
  for (Role role : {Role::x, Role::y, Role::z})
    if (!vertex->has(role))
      throw InputError(name, vertex->line, "element \"vertex\" lacks x, y or z; a 3D surface is needed");
  if (!face)
    throw InputError(name + ": the header has no element \"face\"; a surface is needed, not a point cloud");
  if (!face->has(Role::vertices))
    throw InputError(name, face->line, "element \"face\" has no list \"vertex_indices\"");

  PlyContent content(name);
  const auto read_all = [&](auto body) {
    for (const Element& e : header.elements) {
      read_element(body, e, point_fields != nullptr, content);
      if (&e == face) break;  // later elements are not read
    }
  };
  if (header.encoding == Encoding::ascii)
    read_all(AsciiBody(in));
  else
    read_all(
        BinaryBody(bytes, in.offset(), name, (header.encoding == Encoding::little) != little_endian_machine));
  note_dropped(header, content.surface);
  if (point_fields)
    for (std::size_t k = 0; k < vertex->properties.size(); ++k)
      if (const Property& p = vertex->properties[k]; p.role == Role::skipped && !p.count_type)
        point_fields->push_back(
            {field_name(p.name), 1, is_integer(p.type), std::move(content.point_values[k])});
  std::vector<SurfaceRegion> groups = content.labels.groups();
  if (std::any_of(face->properties.begin(), face->properties.end(),
                  [](const Property& p) { return p.role == Role::label && p.name == group_property; }))
    take_names(header, groups);
  TriangleMesh mesh = content.surface.finish(dropped, groups);
  mesh.space = header.space;
  return mesh;
}

}  // namespace

TriangleMesh read_ply(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped) {
  return read_polygons(bytes, name, dropped, nullptr);
}

SurfaceWithFields read_ply_with_fields(std::string_view bytes, const std::string& name) {
  SurfaceWithFields result;
  result.surface = read_polygons(bytes, name, nullptr, &result.point_fields);
  return result;
}

std::string write_ply(const TriangleMesh& mesh) {
  const bool grouped = !mesh.groups.empty();
  std::string out = "ply\nformat binary_little_endian 1.0\n";
  if (const std::string space = short_name_of_space(mesh.space); !space.empty())
    out += "comment SPACE=" + space + '\n';
  const std::vector<std::int32_t> labels = labels_of(mesh.groups);
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    out += "comment " + std::string(group_comment) + std::to_string(labels[g]) + ": " +
           group_text(mesh.groups[g]) + '\n';
  out += "element vertex ";
  append_number(out, mesh.points.size());
  out += "\nproperty double x\nproperty double y\nproperty double z\nelement face ";
  append_number(out, mesh.triangles.size());
  out += "\nproperty list uchar uint vertex_indices\n";
  if (grouped) out += "property int " + std::string(group_property) + '\n';
  out += "end_header\n";
  for (const Vec3& p : mesh.points)
    for (int k = 0; k < 3; ++k) append_bytes(out, p[k]);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    out += '\3';
    for (const Index v : mesh.triangles[i]) append_bytes(out, v);
    if (grouped) append_bytes(out, labels[mesh.triangle_groups[i]]);
  }
  return out;
}

}  // namespace tetwright

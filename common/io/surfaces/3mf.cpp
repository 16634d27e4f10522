// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/3mf.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <pugixml.hpp>

#include "common/io/encodings/zip_archive.h"
#include "common/io/surfaces/placed_limit.h"
#include "common/io/surfaces/surface_builder.h"
#include "common/io/text/text_scanner.h"
#include "common/message_text.h"
#include "common/unique_names.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

/// Limits on nested and repeated objects: a file may contain an object any number of times. More than any
/// program writes.
constexpr std::size_t max_placed_objects = 100'000, max_depth = 1000;

/// Parts of name spaces of extensions that do not move triangles.
constexpr std::array<std::string_view, 4> harmless_3mf_extensions{"/production/", "/material/",
                                                                  "/beamlattice/", "/trianglesets/"};

/// Name of an element or attribute without its name space prefix.
std::string_view local_name(std::string_view name) {
  const std::size_t colon = name.find(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

template <class Node>
bool is_called(const Node& node, std::string_view name) {
  return local_name(node.name()) == name;
}

pugi::xml_node child(pugi::xml_node parent, std::string_view name) {
  return parent.find_child([&](pugi::xml_node node) { return is_called(node, name); });
}

/// One of the XML files in the archive.
class XmlPart {
 public:
  XmlPart(const ZipArchive& archive, const std::string& file, const std::string& path)
      : name_(file + ": " + path), text_(archive.read(path)) {
    const pugi::xml_parse_result result =
        document_.load_buffer(text_.data(), text_.size(), pugi::parse_minimal | pugi::parse_escapes);
    if (!result)
      throw InputError(name_, line(result.offset),
                       std::string("not XML: ") + result.description() + "; the file is damaged");
  }

  pugi::xml_node root() const { return document_.document_element(); }

  [[noreturn]] void fail(pugi::xml_node node, const std::string& message) const {
    throw InputError(name_, line(node.offset_debug()), message);
  }

  std::string place(pugi::xml_node node) const { return "line " + std::to_string(line(node.offset_debug())); }

  std::string_view attribute(pugi::xml_node node, const char* name) const {
    const pugi::xml_attribute found = node.attribute(name);
    if (!found)
      fail(node, std::string(node.name()) + " without " + in_quotes(name) + "; the file is damaged");
    return found.value();
  }

  template <class Number>
  Number number(pugi::xml_node node, const char* name) const {
    const std::string_view text = attribute(node, name);
    Number value = 0;
    if (!parse_number(text, value))
      fail(node, "expected a number for " + in_quotes(name) + ", found " + in_quotes(text));
    return value;
  }

 private:
  std::size_t line(std::ptrdiff_t offset) const {
    if (offset < 0) return 0;
    const auto end = text_.begin() + std::min(offset, std::ssize(text_));
    return static_cast<std::size_t>(std::count(text_.begin(), end, '\n')) + 1;
  }

  std::string name_, text_;
  pugi::xml_document document_;
};

/// A part of the file that contains objects.
struct Model {
  std::string path;
  XmlPart xml;
  std::map<std::string_view, pugi::xml_node> objects;  ///< by id

  Model(const ZipArchive& archive, const std::string& file, const std::string& in_archive)
      : path(in_archive), xml(archive, file, in_archive) {
    for (const pugi::xml_node node : child(xml.root(), "resources").children())
      if (is_called(node, "object") && !objects.emplace(xml.attribute(node, "id"), node).second)
        xml.fail(node, "there is another object with the id " + in_quotes(xml.attribute(node, "id")));
  }
};

/// Shortens a name space: "booleanoperations/2023/07".
std::string_view short_name(std::string_view space) {
  constexpr std::string_view common_part = "/3dmanufacturing/";
  const std::size_t at = space.find(common_part);
  return at == std::string_view::npos ? space : space.substr(at + common_part.size());
}

/// \throws InputError if the model requires an extension that changes the shape
void check_extensions(const XmlPart& xml) {
  const pugi::xml_node root = xml.root();
  TextScanner prefixes(root.attribute("requiredextensions").value(), "");
  for (std::string_view prefix; !(prefix = prefixes.word()).empty();) {
    const std::string space = root.attribute(("xmlns:" + std::string(prefix)).c_str()).value();
    if (std::none_of(harmless_3mf_extensions.begin(), harmless_3mf_extensions.end(),
                     [&](std::string_view known) { return space.find(known) != std::string::npos; }))
      xml.fail(root, "it needs the extension " + in_quotes(space.empty() ? prefix : short_name(space)) +
                         ", which is not supported; export it without");
  }
}

/// Reads a transform: four rows of three numbers, applied to points as row vectors.
Eigen::Affine3d transform_of(const XmlPart& xml, pugi::xml_node node) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  const pugi::xml_attribute attribute = node.attribute("transform");
  if (!attribute) return result;
  TextScanner words(attribute.value(), "");
  bool good = true;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 3; ++column)
      good = good && parse_number(words.word(), result(column, row)) && std::isfinite(result(column, row));
  if (!good || !words.at_end())
    xml.fail(node, "expected twelve numbers for \"transform\", found " + in_quotes(attribute.value()));
  return result;
}

class Reader3mf {
 public:
  Reader3mf(std::string_view bytes, const std::string& name)
      : name_(name), archive_(bytes, name), surface_(name) {}

  TriangleMesh read(std::vector<Dropped>* dropped) {
    const Model& model = this->model(path_of_root());
    const pugi::xml_node root = model.xml.root();
    if (!is_called(root, "model"))
      model.xml.fail(root, "expected the element model, found " + in_quotes(root.name()));
    const pugi::xml_node build = child(root, "build");
    for (const pugi::xml_node item : build.children())
      if (is_called(item, "item")) place(model, item, Eigen::Affine3d::Identity(), {});
    if (placed_ == 0)
      throw InputError(name_, 0, "no object is placed in its build; export it with the objects placed");
    return surface_.finish(dropped, groups_);
  }

 private:
  /// An object to be placed, with the objects that contain it.
  struct Placing {
    pugi::xml_node object;
    const Placing* within;
    std::size_t depth;
  };

  std::string path_of_root() const {
    constexpr const char* relationships = "_rels/.rels";
    constexpr std::string_view model_type = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
    if (archive_.has(relationships)) {
      const XmlPart xml(archive_, name_, relationships);
      for (const pugi::xml_node node : xml.root().children())
        if (node.attribute("Type").value() == model_type)
          return path_in_archive(xml.attribute(node, "Target"));
    }
    throw InputError(name_, 0, "there is no 3D model in this archive; is it a 3MF file?");
  }

  static std::string path_in_archive(std::string_view path) {
    return std::string(path.starts_with('/') ? path.substr(1) : path);
  }

  const Model& model(const std::string& path) {
    std::unique_ptr<Model>& model = models_[path];
    if (model) return *model;
    model = std::make_unique<Model>(archive_, name_, path);
    check_extensions(model->xml);
    const std::string unit = model->xml.root().attribute("unit").as_string("millimeter");
    if (unit_.empty()) unit_ = unit;
    if (unit != unit_)
      model->xml.fail(model->xml.root(), "its unit is " + in_quotes(unit) + ", but that of another part is " +
                                             in_quotes(unit_) + "; export it in one unit");
    return *model;
  }

  /// Adds the object that an item or a component of `from` refers to.
  void place(const Model& from, pugi::xml_node reference, const Eigen::Affine3d& outer,
             const Placing* within) {
    const Eigen::Affine3d transform = outer * transform_of(from.xml, reference);
    const Model* holder = &from;
    for (const pugi::xml_attribute a : reference.attributes())
      if (is_called(a, "path")) holder = &model(path_in_archive(a.value()));
    const std::string_view id = from.xml.attribute(reference, "objectid");
    const auto found = holder->objects.find(id);
    if (found == holder->objects.end())
      from.xml.fail(reference,
                    "there is no object with the id " + in_quotes(id) + " in " + in_quotes(holder->path));
    const pugi::xml_node object = found->second;
    const Placing here{object, within, within ? within->depth + 1 : 0};
    for (const Placing* p = within; p; p = p->within)
      if (p->object == object) holder->xml.fail(object, "object " + in_quotes(id) + " is a part of itself");
    if (here.depth > max_depth)
      holder->xml.fail(object, "object " + in_quotes(id) + " is nested in more than " +
                                   std::to_string(max_depth) + " objects");
    if (++placed_ > max_placed_objects)
      from.xml.fail(reference,
                    "objects are placed more than " + std::to_string(max_placed_objects) + " times");
    if (object.attribute("pid")) surface_.drop("objects with a colour, material or texture");
    if (const pugi::xml_node components = child(object, "components")) {
      for (const pugi::xml_node component : components.children())
        if (is_called(component, "component")) place(*holder, component, transform, &here);
      return;
    }
    // The type of an object with components has no meaning.
    const std::string_view type = object.attribute("type").value();
    if (type == "support" || type == "solidsupport") {
      surface_.drop("support objects");
    } else if (const pugi::xml_node mesh = child(object, "mesh")) {
      surface_.begin_group(group_of(here));
      add_mesh(holder->xml, mesh, transform);
    } else {
      surface_.drop("objects that are not meshes");
    }
  }

  /// Group of an object, named after the object or else the innermost named object that contains it.
  std::uint32_t group_of(const Placing& placing) {
    const Placing* named = &placing;
    while (named && !*named->object.attribute("name").value()) named = named->within;
    const auto [known, added] = group_numbers_.emplace((named ? named : &placing)->object.hash_value(),
                                                       static_cast<std::uint32_t>(groups_.size()));
    if (added) {
      if (named)
        groups_.push_back({0, names_.add(named->object.attribute("name").value())});
      else
        groups_.push_back({static_cast<std::int64_t>(groups_.size() + 1), ""});
    }
    return known->second;
  }

  void add_mesh(const XmlPart& xml, pugi::xml_node mesh, const Eigen::Affine3d& transform) {
    const auto first = static_cast<std::int64_t>(surface_.point_count());
    for (const pugi::xml_node v : child(mesh, "vertices").children())
      if (is_called(v, "vertex"))
        surface_.add_point(transform * Vec3(xml.number<double>(v, "x"), xml.number<double>(v, "y"),
                                            xml.number<double>(v, "z")),
                           [&] { return xml.place(v); });
    const auto count = static_cast<std::int64_t>(surface_.point_count()) - first;
    limit_.add(static_cast<std::size_t>(count), name_);
    const bool mirrored = transform.linear().determinant() < 0;
    for (const pugi::xml_node t : child(mesh, "triangles").children()) {
      if (!is_called(t, "triangle")) continue;
      limit_.add(1, name_);
      std::array<std::int64_t, 3> corners{xml.number<std::int64_t>(t, "v1"),
                                          xml.number<std::int64_t>(t, "v2"),
                                          xml.number<std::int64_t>(t, "v3")};
      for (std::int64_t& corner : corners) {
        if (corner < 0 || corner >= count)
          xml.fail(t, "a triangle refers to vertex " + std::to_string(corner) + ", but the object has " +
                          std::to_string(count) + "; the file is damaged");
        corner += first;
      }
      if (mirrored) std::swap(corners[1], corners[2]);
      surface_.add_fan(corners);
      if (t.attribute("pid")) surface_.drop("triangles with a colour, material or texture");
    }
    if (child(mesh, "beamlattice")) surface_.drop("beam lattices");
  }

  const std::string& name_;
  ZipArchive archive_;
  SurfaceBuilder surface_;
  std::map<std::string, std::unique_ptr<Model>> models_;
  std::string unit_;  ///< unit of all parts
  std::size_t placed_ = 0;
  PlacedLimit limit_;
  UniqueNames names_{[](const std::string& name) { return name; }};
  std::vector<SurfaceRegion> groups_;
  std::map<std::size_t, std::uint32_t> group_numbers_;  ///< by the hash of the objects, which identifies them
};

}  // namespace

TriangleMesh read_3mf(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped) {
  return Reader3mf(bytes, name).read(dropped);
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/glb.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "common/io/encodings/byte_order.h"
#include "common/io/surfaces/placed_limit.h"
#include "common/io/surfaces/point_merger.h"
#include "common/io/surfaces/surface_builder.h"
#include "common/message_text.h"
#include "common/unique_names.h"
#include "tetwright/error.h"

namespace tetwright {

namespace {

using nlohmann::json;

/// Deeper than the scenes of any program; each level takes stack space.
constexpr std::size_t max_node_depth = 1000;

// glTF 2.0, "Binary glTF Layout": a header of 12 bytes, and 8 bytes before each chunk.
constexpr std::size_t glb_header_size = 12, chunk_header_size = 8;
constexpr std::uint32_t json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;

// glTF 2.0, "Accessors" and "Meshes".
constexpr std::int64_t type_uint8 = 5121, type_uint16 = 5123, type_uint32 = 5125, type_float = 5126;
constexpr std::int64_t mode_points = 0, mode_triangles = 4, mode_strip = 5, mode_fan = 6;

/// Prefixes of extensions that do not move triangles.
constexpr std::array<std::string_view, 5> harmless_gltf_extensions{"KHR_materials_", "KHR_texture_",
                                                                   "EXT_texture_", "KHR_lights_", "KHR_xmp"};

class SceneReader {
 public:
  SceneReader(std::string_view bytes, const std::string& name)
      : name_(name), surface_(name), merger_(surface_, bytes.size() / 64) {
    split(bytes);
  }

  TriangleMesh read(std::vector<Dropped>* dropped) {
    check_extensions();
    const std::size_t scenes = list("scenes").size();
    if (scene_.contains("scene")) {
      add_scene(whole(scene_, "the file", "scene"));
    } else {
      for (std::size_t i = 0; i < scenes; ++i) add_scene(static_cast<std::int64_t>(i));
    }
    if (shown_.empty())
      fail(list("meshes").empty() ? "there is no mesh in it; export it with its meshes"
           : scenes == 0          ? "it has meshes, but no scene that shows them; export it with a scene"
                                  : "its scene shows none of its meshes; export it with them in the scene");
    surface_.drop("meshes that the scene does not show", list("meshes").size() - shown_.size());
    surface_.drop("skins", list("skins").size());
    surface_.drop("animations", list("animations").size());
    return surface_.finish(dropped, groups_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError(name_, 0, message); }

  /// Splits the file into its chunks.
  void split(std::string_view bytes) {
    const auto number = [&](std::size_t at) {
      return load<std::uint32_t>(bytes.data() + at, !little_endian_machine);
    };
    if (bytes.empty()) fail("the file is empty");
    if (bytes.size() < glb_header_size + chunk_header_size || !bytes.starts_with("glTF"))
      fail("not a binary glTF file; export it as .glb");
    if (number(4) != 2)
      fail("version " + std::to_string(number(4)) + " of binary glTF is not supported; export it as 2.0");
    std::string_view text;
    bool found_text = false, found_binary = false;
    for (std::size_t at = glb_header_size; at < bytes.size();) {
      const std::size_t left = bytes.size() - at;
      if (left < chunk_header_size || number(at) > left - chunk_header_size)
        fail("byte " + std::to_string(at) + ": a chunk extends beyond the end of the file; it is truncated");
      const std::string_view content = bytes.substr(at + chunk_header_size, number(at));
      // The first chunk of each kind is used; other kinds may follow.
      if (number(at + 4) == json_chunk && !found_text) {
        found_text = true;
        text = content;
      } else if (number(at + 4) == binary_chunk && !found_binary) {
        found_binary = true;
        binary_ = content;
      }
      at += chunk_header_size + content.size();
    }
    scene_ = json::parse(text, nullptr, false);
    if (!scene_.is_object()) fail("its description is not valid JSON; the file is damaged");
  }

  void check_extensions() const {
    for (const json& item : list("extensionsRequired")) {
      const std::string extension = item.is_string() ? item.get<std::string>() : "";
      if (std::any_of(harmless_gltf_extensions.begin(), harmless_gltf_extensions.end(),
                      [&](std::string_view known) { return extension.starts_with(known); }))
        continue;
      fail("it needs the extension " + in_quotes(extension) +
           ", which is not supported; export it without (without compression and quantisation)");
    }
  }

  /// A list in the file; empty if it is missing.
  const json& list(const char* kind) const {
    static const json none = json::array();
    const auto found = scene_.find(kind);
    if (found == scene_.end()) return none;
    if (!found->is_array()) fail(in_quotes(kind) + " is not a list; the file is damaged");
    return *found;
  }

  const json& at(const char* kind, std::int64_t index) const {
    const json& items = list(kind);
    if (index < 0 || static_cast<std::size_t>(index) >= items.size())
      fail("it refers to index " + std::to_string(index) + " (counted from 0), but has " +
           std::to_string(items.size()) + " " + kind + "; the file is damaged");
    const json& item = items[static_cast<std::size_t>(index)];
    if (!item.is_object()) fail(called(kind, index) + " is not an object; the file is damaged");
    return item;
  }

  static std::string called(const char* kind, std::int64_t index) {
    return std::string(kind) + " " + std::to_string(index);
  }

  /// Reads a whole number; required unless there is a default.
  std::int64_t whole(const json& object, const std::string& what, const char* key,
                     std::optional<std::int64_t> otherwise = {}) const {
    const auto found = object.find(key);
    if (found == object.end() && otherwise) return *otherwise;
    // Some programs write 3.0. Larger doubles are not exact.
    constexpr double exact = 9007199254740992.0;
    if (found == object.end() || !found->is_number() || std::abs(found->get<double>()) > exact ||
        found->get<double>() != std::floor(found->get<double>()))
      fail(what + ": " + in_quotes(key) + " is missing or not a whole number; the file is damaged");
    return static_cast<std::int64_t>(found->get<double>());
  }

  /// Reads a count, or an offset within the file.
  std::size_t size(const json& object, const std::string& what, const char* key,
                   std::optional<std::int64_t> otherwise = {}) const {
    const std::int64_t value = whole(object, what, key, otherwise);
    if (value < 0)
      fail(what + ": " + in_quotes(key) + " is " + std::to_string(value) + "; the file is damaged");
    return static_cast<std::size_t>(value);
  }

  /// Reads a list of numbers; empty if it is missing.
  std::vector<double> numbers(const json& object, const std::string& what, const char* key,
                              std::size_t count) const {
    std::vector<double> values;
    const auto found = object.find(key);
    if (found == object.end()) return values;
    if (!found->is_array() || found->size() != count ||
        !std::all_of(found->begin(), found->end(), [](const json& x) { return x.is_number(); }))
      fail(what + ": " + in_quotes(key) + " is not " + std::to_string(count) +
           " numbers; the file is damaged");
    for (const json& x : *found) values.push_back(x.get<double>());
    return values;
  }

  static std::string text(const json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_string() ? found->get<std::string>() : "";
  }

  const json& list_of(const json& object, const std::string& what, const char* key) const {
    static const json none = json::array();
    const auto found = object.find(key);
    if (found == object.end()) return none;
    if (!found->is_array()) fail(what + ": " + in_quotes(key) + " is not a list; the file is damaged");
    return *found;
  }

  void add_scene(std::int64_t number) {
    const json& scene = at("scenes", number);
    for (const json& node : list_of(scene, called("scenes", number), "nodes")) {
      if (!node.is_number_integer()) fail(called("scenes", number) + ": a node is not a number");
      const auto index = node.get<std::int64_t>();
      if (roots_.insert(index).second)  // a root may be in several scenes
        add_node(index, Eigen::Affine3d::Identity(), 0);
    }
  }

  Eigen::Affine3d transform_of(const json& node, const std::string& what) const {
    const std::vector<double> matrix = numbers(node, what, "matrix", 16);
    if (!matrix.empty()) return Eigen::Affine3d(Eigen::Map<const Eigen::Matrix4d>(matrix.data()));
    const std::vector<double> translation = numbers(node, what, "translation", 3),
                              rotation = numbers(node, what, "rotation", 4),
                              scale = numbers(node, what, "scale", 3);
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    if (!translation.empty()) result.translate(Vec3(translation.data()));
    if (!rotation.empty()) result.rotate(Eigen::Quaterniond(rotation.data()).normalized());
    if (!scale.empty()) result.scale(Vec3(scale.data()));
    return result;
  }

  void add_node(std::int64_t number, const Eigen::Affine3d& outer, std::size_t depth) {
    const std::string what = called("nodes", number);
    const json& node = at("nodes", number);
    // The nodes of a glTF file must form trees.
    if (!placed_.insert(number).second)
      fail(what +
           " is a child of several nodes, of itself, or of both a node and the scene; the file is damaged");
    if (depth > max_node_depth)
      fail(what + " is more than " + std::to_string(max_node_depth) + " nodes below the scene");
    const Eigen::Affine3d transform = outer * transform_of(node, what);
    if (node.contains("mesh")) add_mesh(node, whole(node, what, "mesh"), transform);
    for (const json& child : list_of(node, what, "children")) {
      if (!child.is_number_integer()) fail(what + ": a child is not a number");
      add_node(child.get<std::int64_t>(), transform, depth + 1);
    }
  }

  void add_mesh(const json& node, std::int64_t number, const Eigen::Affine3d& transform) {
    const json& mesh = at("meshes", number);
    const std::string what = called("meshes", number);
    shown_.insert(number);
    const json& primitives = list_of(mesh, what, "primitives");
    std::map<std::int64_t, std::uint32_t> groups;  // by material
    std::set<std::int64_t> materials;
    for (const json& primitive : primitives) {
      if (!primitive.is_object()) fail(what + ": a primitive is not an object; the file is damaged");
      materials.insert(whole(primitive, what, "material", -1));
    }
    for (const json& primitive : primitives) {
      const std::int64_t material = whole(primitive, what, "material", -1);
      const auto [known, added] = groups.emplace(material, static_cast<std::uint32_t>(groups_.size()));
      if (added) groups_.push_back(group_of(node, mesh, materials.size() > 1 ? material : -1));
      surface_.begin_group(known->second);
      add_primitive(primitive, what, transform);
    }
  }

  SurfaceRegion group_of(const json& node, const json& mesh, std::int64_t material) {
    std::string name = text(node, "name").empty() ? text(mesh, "name") : text(node, "name");
    if (material >= 0) {
      const std::string own = text(at("materials", material), "name");
      name += (name.empty() ? "" : ":") + (own.empty() ? "material " + std::to_string(material) : own);
    }
    if (name.empty()) return {static_cast<std::int64_t>(groups_.size() + 1), ""};
    return {0, names_.add(name)};
  }

  void add_primitive(const json& primitive, const std::string& what, const Eigen::Affine3d& transform) {
    const std::int64_t mode = whole(primitive, what, "mode", mode_triangles);
    if (mode < mode_points || mode > mode_fan)
      fail(what + ": unknown mode " + std::to_string(mode) + "; the file is damaged");
    if (mode < mode_triangles) {
      surface_.drop(mode == mode_points ? "sets of points" : "sets of lines");
      return;
    }
    const auto attributes = primitive.find("attributes");
    if (attributes == primitive.end() || !attributes->is_object())
      fail(what + ": a primitive has no attributes; the file is damaged");
    if (!attributes->contains("POSITION")) {
      surface_.drop("sets of triangles without positions");
      return;
    }
    surface_.drop("morph targets", list_of(primitive, what, "targets").size());
    std::vector<std::int64_t> corners = add_points(whole(*attributes, what, "POSITION"), transform);
    if (primitive.contains("indices")) corners = indexed(whole(primitive, what, "indices"), corners);
    limit_.add(corners.size(), name_);
    const bool strip = mode == mode_strip, fan = mode == mode_fan;
    if (!strip && !fan && corners.size() % 3 != 0)
      fail(what + ": triangles have " + std::to_string(corners.size()) +
           " corners, which is not a multiple of three; the file is damaged");
    const bool mirrored = transform.linear().determinant() < 0;
    for (std::size_t i = 2; i < corners.size(); i += strip || fan ? 1 : 3) {
      const bool turned = mirrored != (strip && i % 2 == 1);
      std::array<std::int64_t, 3> triangle{corners[fan ? 0 : i - 2], corners[i - 1], corners[i]};
      if (turned) std::swap(triangle[1], triangle[2]);
      // Triangles without area connect the parts of a strip.
      if (strip && (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]))
        continue;
      surface_.add_fan(triangle);
    }
  }

  /// Items of an accessor.
  struct Items {
    const char* begin;
    std::size_t stride, count;
    std::int64_t component;  ///< component type
  };

  Items items(std::int64_t number, const char* type, std::size_t components,
              std::initializer_list<std::int64_t> component_types) const {
    const std::string what = called("accessors", number);
    const json& accessor = at("accessors", number);
    if (accessor.contains("sparse") || !accessor.contains("bufferView"))
      fail(what + " is sparse or empty, which is not supported; export it with all values stored");
    const std::int64_t component = whole(accessor, what, "componentType");
    if (text(accessor, "type") != type ||
        std::find(component_types.begin(), component_types.end(), component) == component_types.end())
      fail(what + " has a number type that is not valid for positions or indices");
    const std::int64_t view_number = whole(accessor, what, "bufferView");
    const json& view = at("bufferViews", view_number);
    const std::string of_view = called("bufferViews", view_number);
    const std::int64_t buffer = whole(view, of_view, "buffer");
    if (buffer != 0 || at("buffers", buffer).contains("uri"))
      fail(of_view + ": its data are in another file or stored as text; export it with all data in the .glb");
    const std::size_t width = component == type_uint8 ? 1 : component == type_uint16 ? 2 : 4;
    const std::size_t item = width * components;
    const std::size_t stride = size(view, of_view, "byteStride", static_cast<std::int64_t>(item));
    const std::size_t first = size(view, of_view, "byteOffset", 0),
                      length = size(view, of_view, "byteLength"),
                      offset = size(accessor, what, "byteOffset", 0), count = size(accessor, what, "count");
    if (first > binary_.size() || length > binary_.size() - first)
      fail(of_view + " extends beyond the end of the file; it is damaged or truncated");
    if (stride < item || count == 0 || offset > length || length - offset < item ||
        count - 1 > (length - offset - item) / stride)
      fail(what + " extends beyond the end of its buffer view; the file is damaged");
    return {binary_.data() + first + offset, stride, count, component};
  }

  /// Adds the vertices and returns their point numbers.
  std::vector<std::int64_t> add_points(std::int64_t number, const Eigen::Affine3d& transform) {
    const Items of = items(number, "VEC3", 3, {type_float});
    limit_.add(of.count, name_);
    std::vector<std::int64_t> points(of.count);
    for (std::size_t i = 0; i < of.count; ++i) {
      Vec3 p;
      for (int k = 0; k < 3; ++k)
        p[k] = load<float>(of.begin + i * of.stride + static_cast<std::size_t>(k) * sizeof(float),
                           !little_endian_machine);
      points[i] = merger_.add(transform * p,
                              [&] { return called("accessors", number) + ", vertex " + std::to_string(i); });
    }
    return points;
  }

  std::vector<std::int64_t> indexed(std::int64_t number, const std::vector<std::int64_t>& points) const {
    const Items of = items(number, "SCALAR", 1, {type_uint8, type_uint16, type_uint32});
    std::vector<std::int64_t> corners(of.count);
    for (std::size_t i = 0; i < of.count; ++i) {
      const char* from = of.begin + i * of.stride;
      const bool swap = !little_endian_machine;
      const std::uint32_t index = of.component == type_uint8    ? load<std::uint8_t>(from, swap)
                                  : of.component == type_uint16 ? load<std::uint16_t>(from, swap)
                                                                : load<std::uint32_t>(from, swap);
      if (index >= points.size())
        fail(called("accessors", number) + " refers to vertex " + std::to_string(index) + ", but there are " +
             std::to_string(points.size()) + "; the file is damaged");
      corners[i] = points[index];
    }
    return corners;
  }

  const std::string& name_;
  json scene_;
  std::string_view binary_;
  SurfaceBuilder surface_;
  PointMerger merger_;
  PlacedLimit limit_;
  UniqueNames names_{[](const std::string& name) { return name; }};
  std::vector<SurfaceRegion> groups_;
  std::set<std::int64_t> roots_, placed_, shown_;
};

}  // namespace

TriangleMesh read_glb(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped) {
  return SceneReader(bytes, name).read(dropped);
}

}  // namespace tetwright

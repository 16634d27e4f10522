#include "common/formats/glb.h"

#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

#include "common/error.h"
#include "common/formats/byte_order.h"
#include "common/formats/point_merger.h"
#include "common/formats/surface_builder.h"
#include "common/message_text.h"
#include "common/trimmed.h"

namespace tetwright {

namespace {

/// Deeper than any scene that a program writes; each level takes room on the stack.
constexpr std::size_t max_node_depth = 1000;

/// Without images, which say nothing about the shape, and other files.
bool load_scene(std::string_view bytes, tinygltf::Model& model, std::string& error) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*,
                           int, void*) { return true; },
                        nullptr);
  loader.SetFsCallbacks({.FileExists = [](const std::string&, void*) { return false; },
                         .ExpandFilePath = [](const std::string& path, void*) { return path; },
                         .ReadWholeFile = [](std::vector<unsigned char>*, std::string*, const std::string&,
                                             void*) { return false; },
                         .WriteWholeFile = [](std::string*, const std::string&,
                                              const std::vector<unsigned char>&, void*) { return false; },
                         .user_data = nullptr});
  std::string warning;
  return loader.LoadBinaryFromMemory(&model, &error, &warning,
                                     reinterpret_cast<const unsigned char*>(bytes.data()),
                                     static_cast<unsigned>(bytes.size()));
}

class SceneReader {
 public:
  SceneReader(std::string_view bytes, const std::string& name)
      : name_(name), surface_(name), merger_(surface_, bytes.size() / 64) {
    if (bytes.size() > std::numeric_limits<unsigned>::max())
      fail("larger than the 4 GB that the format allows");
    std::string error;
    if (!load_scene(bytes, model_, error)) {
      const std::size_t end = trimmed(error).find('\n');
      fail("not a binary glTF file: " + std::string(trimmed(error).substr(0, end)) +
           "; the file is damaged, or needs other files beside it");
    }
  }

  TriangleMesh read(std::vector<Dropped>* dropped) {
    for (const std::string& extension : model_.extensionsRequired)
      if (extension.ends_with("_compression") || extension == "KHR_mesh_quantization")
        fail("its triangles need the extension " + in_quotes(extension) +
             "; export it without compression and quantisation");
    if (model_.defaultScene >= 0) {
      add_scene(at(model_.scenes, model_.defaultScene, "scene"));
    } else {
      for (const tinygltf::Scene& scene : model_.scenes) add_scene(scene);
    }
    if (!model_.skins.empty()) surface_.drop("skins", model_.skins.size());
    return surface_.finish(dropped, groups_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw InputError(name_, 0, message); }

  template <class Item>
  const Item& at(const std::vector<Item>& items, int index, const char* kind) const {
    if (index < 0 || static_cast<std::size_t>(index) >= items.size())
      fail(std::string("there is no ") + kind + ' ' + std::to_string(index) + " among the " +
           std::to_string(items.size()) + "; the file is damaged");
    return items[static_cast<std::size_t>(index)];
  }

  void add_scene(const tinygltf::Scene& scene) {
    for (const int node : scene.nodes) add_node(node, Eigen::Affine3d::Identity(), 0);
  }

  Eigen::Affine3d transform_of(const tinygltf::Node& node, int number) const {
    const auto check = [&](const std::vector<double>& values, std::size_t size) {
      if (!values.empty() && values.size() != size)
        fail("node " + std::to_string(number) + " has a transform of " + std::to_string(values.size()) +
             " numbers instead of " + std::to_string(size));
      return !values.empty();
    };
    if (check(node.matrix, 16)) return Eigen::Affine3d(Eigen::Map<const Eigen::Matrix4d>(node.matrix.data()));
    Eigen::Affine3d result = Eigen::Affine3d::Identity();
    if (check(node.translation, 3)) result.translate(Vec3(node.translation.data()));
    if (check(node.rotation, 4)) result.rotate(Eigen::Quaterniond(node.rotation.data()).normalized());
    if (check(node.scale, 3)) result.scale(Vec3(node.scale.data()));
    return result;
  }

  void add_node(int number, const Eigen::Affine3d& outer, std::size_t depth) {
    const tinygltf::Node& node = at(model_.nodes, number, "node");
    // The format's nodes are trees: each has one parent at most.
    if (depth > max_node_depth || !(depth == 0 ? roots_ : children_).insert(number).second) {
      if (depth == 0) return;  // another scene shows it, too
      fail("node " + std::to_string(number) + " is a child of several nodes or of itself");
    }
    const Eigen::Affine3d transform = outer * transform_of(node, number);
    if (node.mesh >= 0) add_mesh(node, at(model_.meshes, node.mesh, "mesh"), transform);
    for (const int child : node.children) add_node(child, transform, depth + 1);
  }

  void add_mesh(const tinygltf::Node& node, const tinygltf::Mesh& mesh, const Eigen::Affine3d& transform) {
    const bool materials = std::any_of(mesh.primitives.begin(), mesh.primitives.end(), [&](const auto& p) {
      return p.material != mesh.primitives[0].material;
    });
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      std::string group = node.name.empty() ? mesh.name : node.name;
      if (materials && primitive.material >= 0) {
        const std::string& material = at(model_.materials, primitive.material, "material").name;
        group += (group.empty() ? "" : ":") +
                 (material.empty() ? "material " + std::to_string(primitive.material) : material);
      }
      surface_.begin_group(group_number(group));
      add_primitive(primitive, transform);
    }
  }

  std::uint32_t group_number(const std::string& name) {
    const auto [known, added] = group_numbers_.emplace(name, static_cast<std::uint32_t>(groups_.size()));
    if (added) groups_.push_back({0, name});
    return known->second;
  }

  void add_primitive(const tinygltf::Primitive& primitive, const Eigen::Affine3d& transform) {
    if (primitive.mode != -1 && primitive.mode < TINYGLTF_MODE_TRIANGLES) {
      surface_.drop(primitive.mode == TINYGLTF_MODE_POINTS ? "sets of points" : "sets of lines");
      return;
    }
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) {
      surface_.drop("sets of triangles without positions");
      return;
    }
    if (!primitive.targets.empty()) surface_.drop("morph targets", primitive.targets.size());
    const std::vector<std::int64_t> points = add_points(position->second, transform);
    std::vector<std::int64_t> corners = points;
    if (primitive.indices >= 0) corners = indexed(primitive.indices, points);
    const bool mirrored = transform.linear().determinant() < 0;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      std::array<std::int64_t, 3> triangle{corners[a], corners[b], corners[c]};
      if (mirrored) std::swap(triangle[1], triangle[2]);
      // Between strips programs put triangles without an area; so do vertices that became one.
      if (triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0])
        surface_.add_fan(triangle);
    };
    const bool strip = primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP,
               fan = primitive.mode == TINYGLTF_MODE_TRIANGLE_FAN;
    for (std::size_t i = 2; i < corners.size(); i += strip || fan ? 1 : 3) {
      if (fan)
        add(0, i - 1, i);
      else
        add(i - 2, strip && i % 2 == 1 ? i : i - 1, strip && i % 2 == 1 ? i - 1 : i);
    }
  }

  /// The bytes of the accessor's items and how far apart they begin, with all of them within the file.
  std::pair<const unsigned char*, std::size_t> items(int number, int type,
                                                     std::initializer_list<int> component_types) const {
    const tinygltf::Accessor& accessor = at(model_.accessors, number, "accessor");
    const std::string called = "accessor " + std::to_string(number);
    if (accessor.sparse.isSparse || accessor.bufferView < 0)
      fail(called + " is sparse or empty, which is not supported; export it with all its numbers");
    if (accessor.type != type || std::find(component_types.begin(), component_types.end(),
                                           accessor.componentType) == component_types.end())
      fail(called + " has numbers of another kind than positions or indices have");
    const tinygltf::BufferView& view = at(model_.bufferViews, accessor.bufferView, "buffer view");
    const tinygltf::Buffer& buffer = at(model_.buffers, view.buffer, "buffer");
    const int step = accessor.ByteStride(view);
    const auto size = static_cast<std::size_t>(
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(accessor.componentType)) *
        tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(type)));
    const auto stride = static_cast<std::size_t>(step);
    const std::size_t begin = view.byteOffset + accessor.byteOffset;
    if (step < static_cast<int>(size) || begin < view.byteOffset || begin > buffer.data.size() ||
        (accessor.count > 0 && (buffer.data.size() - begin < size ||
                                (accessor.count - 1) > (buffer.data.size() - begin - size) / stride)))
      fail(called + " goes beyond the end of its buffer; the file is damaged or cut short");
    return {buffer.data.data() + begin, stride};
  }

  /// The numbers of the points at the vertices.
  std::vector<std::int64_t> add_points(int number, const Eigen::Affine3d& transform) {
    const auto [bytes, stride] = items(number, TINYGLTF_TYPE_VEC3, {TINYGLTF_COMPONENT_TYPE_FLOAT});
    std::vector<std::int64_t> points(model_.accessors[static_cast<std::size_t>(number)].count);
    for (std::size_t i = 0; i < points.size(); ++i) {
      Vec3 p;
      for (std::size_t k = 0; k < 3; ++k)
        p[static_cast<Eigen::Index>(k)] = load<float>(
            reinterpret_cast<const char*>(bytes) + i * stride + k * sizeof(float), !little_endian_machine);
      points[i] = merger_.add(transform * p, [&] {
        return "accessor " + std::to_string(number) + ", vertex " + std::to_string(i);
      });
    }
    return points;
  }

  std::vector<std::int64_t> indexed(int number, const std::vector<std::int64_t>& points) const {
    const auto [bytes, stride] =
        items(number, TINYGLTF_TYPE_SCALAR,
              {TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
               TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT});
    const tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(number)];
    std::vector<std::int64_t> corners(accessor.count);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const char* at = reinterpret_cast<const char*>(bytes) + i * stride;
      const std::uint32_t index = accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE
                                      ? load<std::uint8_t>(at, !little_endian_machine)
                                  : accessor.componentType == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT
                                      ? load<std::uint16_t>(at, !little_endian_machine)
                                      : load<std::uint32_t>(at, !little_endian_machine);
      if (index >= points.size())
        fail("accessor " + std::to_string(number) + " names vertex " + std::to_string(index) +
             ", but there are " + std::to_string(points.size()) + "; the file is damaged");
      corners[i] = points[index];
    }
    return corners;
  }

  const std::string& name_;
  tinygltf::Model model_;
  SurfaceBuilder surface_;
  PointMerger merger_;
  std::vector<FaceGroup> groups_;
  std::map<std::string, std::uint32_t> group_numbers_;
  std::set<int> roots_, children_;
};

}  // namespace

TriangleMesh read_glb(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped) {
  return SceneReader(bytes, name).read(dropped);
}

}  // namespace tetwright

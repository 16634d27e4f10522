#include "common/formats/glb.h"

#include <nlohmann/json.hpp>

#include "common/formats/byte_order.h"
#include "tests/common/formats/expect_error.h"

namespace tetwright::glb_test {
namespace {

using nlohmann::json;

std::string glb(const json& scene, const std::string& binary) {
  const auto padded = [](std::string text, char with) {
    text.resize((text.size() + 3) / 4 * 4, with);
    return text;
  };
  const std::string text = padded(scene.dump(), ' '), numbers = padded(binary, '\0');
  std::string out = "glTF";
  append_bytes(out, std::uint32_t{2});
  append_bytes(out, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + numbers.size()));
  append_bytes(out, static_cast<std::uint32_t>(text.size()));
  out += "JSON" + text;
  append_bytes(out, static_cast<std::uint32_t>(numbers.size()));
  return out + std::string("BIN\0", 4) + numbers;
}

/// A tet whose vertices are there twice, as where normals differ, with 16-bit indices behind them.
std::string tet_bytes() {
  std::string bytes;
  for (int twice = 0; twice < 2; ++twice)
    for (const std::array<float, 3>& p : {std::array<float, 3>{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
      for (const float x : p) append_bytes(bytes, x);
  for (const int i : {0, 2, 1, 0, 1, 3, 4, 7, 6, 5, 6, 7}) append_bytes(bytes, static_cast<std::uint16_t>(i));
  return bytes;
}

json tet_scene() {
  return {{"asset", {{"version", "2.0"}}},
          {"scene", 0},
          {"scenes", {{{"nodes", {0}}}}},
          {"nodes", {{{"mesh", 0}, {"name", "bone"}}}},
          {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"indices", 1}}}}}}},
          {"buffers", {{{"byteLength", 120}}}},
          {"bufferViews",
           {{{"buffer", 0}, {"byteLength", 96}}, {{"buffer", 0}, {"byteOffset", 96}, {"byteLength", 24}}}},
          {"accessors",
           {{{"bufferView", 0}, {"componentType", 5126}, {"count", 8}, {"type", "VEC3"}},
            {{"bufferView", 1}, {"componentType", 5123}, {"count", 12}, {"type", "SCALAR"}}}}};
}

TriangleMesh read(const json& scene, std::vector<Dropped>* dropped = nullptr) {
  return read_glb(glb(scene, tet_bytes()), "f", dropped);
}

TEST(Glb, VerticesAtOnePlaceBecomeOnePoint) {
  const TriangleMesh mesh = read(tet_scene());
  EXPECT_EQ(mesh.points, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}));
  EXPECT_TRUE(mesh.groups.empty());
}

TEST(Glb, NodesPlaceTheirMeshes) {
  json scene = tet_scene();
  scene["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}, {"scale", {2, 2, 2}}},
                    {{"mesh", 0}, {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}}};
  const TriangleMesh mesh = read(scene);
  EXPECT_TRUE(mesh.points[1].isApprox(Vec3(10, 2, 0)));  // the x axis becomes the y axis
  EXPECT_TRUE(mesh.points[2].isApprox(Vec3(8, 0, 0)));
  scene["nodes"] = {{{"mesh", 0}, {"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}}};
  const TriangleMesh mirrored = read(scene);
  EXPECT_EQ(mirrored.points[1], Vec3(4, 6, 7));
  EXPECT_EQ(mirrored.triangles[0], (Triangle{0, 1, 2}));  // faces outwards still
}

TEST(Glb, NodesAndMaterialsAreGroups) {
  json scene = tet_scene();
  const json primitive = scene["meshes"][0]["primitives"][0];
  json red = primitive, unnamed = primitive;
  red["material"] = 0;
  unnamed["material"] = 1;
  scene["materials"] = {{{"name", "red"}}, json::object()};
  scene["meshes"] = {{{"primitives", {red, unnamed}}}, {{"primitives", {primitive}}, {"name", "skin"}}};
  scene["scenes"] = {{{"nodes", {0, 1}}}};
  scene["nodes"] = {{{"mesh", 0}, {"name", "bone"}}, {{"mesh", 1}}};
  const TriangleMesh mesh = read(scene);
  EXPECT_EQ(mesh.groups, (std::vector<FaceGroup>{{0, "bone:red"}, {0, "bone:material 1"}, {0, "skin"}}));
  EXPECT_EQ(mesh.triangle_groups, (std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2}));
}

TEST(Glb, StripsAndFans) {
  json scene = tet_scene();
  json& primitive = scene["meshes"][0]["primitives"][0];
  primitive.erase("indices");
  primitive["mode"] = 5;
  scene["accessors"][0]["count"] = 4;
  EXPECT_EQ(read(scene).triangles, (std::vector<Triangle>{{0, 1, 2}, {1, 3, 2}}));
  primitive["mode"] = 6;
  EXPECT_EQ(read(scene).triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(Glb, WhatIsDroppedIsNamed) {
  json scene = tet_scene();
  json& primitives = scene["meshes"][0]["primitives"];
  json lines = primitives[0], points = primitives[0];
  lines["mode"] = 1;
  points["mode"] = 0;
  primitives[0]["targets"] = {{{"POSITION", 0}}};
  primitives.push_back(lines);
  primitives.push_back(points);
  scene["skins"] = {{{"joints", {0}}}};
  std::vector<Dropped> dropped;
  (void)read(scene, &dropped);
  EXPECT_EQ(dropped, (std::vector<Dropped>{
                         {"morph targets", 1}, {"sets of lines", 1}, {"sets of points", 1}, {"skins", 1}}));
}

TEST(Glb, BadInput) {
  expect_input_error(read_glb, "", "not a binary glTF file");
  expect_input_error(read_glb, "solid", "not a binary glTF file");
  const std::string good = glb(tet_scene(), tet_bytes());
  expect_input_error(read_glb, good.substr(0, good.size() - 8), "not a binary glTF file");
  const auto refused = [](const std::vector<std::pair<std::string, json>>& changes, const std::string& first,
                          const std::string& second = "") {
    json scene = tet_scene();
    for (const auto& [where, value] : changes) scene[json::json_pointer(where)] = value;
    expect_input_error(read_glb, glb(scene, tet_bytes()), first, second);
  };
  refused({{"/scene", 3}}, "no scene 3");
  refused({{"/scenes/0/nodes/0", 5}}, "no node 5");
  refused({{"/nodes/0/mesh", 2}}, "no mesh 2");
  refused({{"/nodes/0/children", {0}}}, "node 0", "child");
  refused({{"/nodes/0/scale", {1, 1}}}, "2 numbers instead of 3");
  refused({{"/meshes/0/primitives/0/indices", 9}}, "indices accessor");
  refused({{"/meshes/0/primitives/0/attributes/POSITION", 1}}, "accessor 1", "another kind");
  refused({{"/accessors/0/count", 1000000000}}, "accessor 0", "beyond the end");
  refused({{"/accessors/0/byteOffset", 1000000000}}, "accessor 0", "beyond the end");
  refused({{"/accessors/1/bufferView", 7}}, "bufferView");
  refused({{"/accessors/0/count", 4}}, "names vertex 4", "there are 4");
  refused({{"/extensionsRequired", {"KHR_draco_mesh_compression"}}}, "KHR_draco_mesh_compression",
          "without compression");
  refused({{"/accessors/0/sparse",
            {{"count", 1},
             {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
             {"values", {{"bufferView", 0}}}}}},
          "sparse");
}

}  // namespace
}  // namespace tetwright::glb_test

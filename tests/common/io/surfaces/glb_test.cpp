// SPDX-License-Identifier: Apache-2.0
#include "common/io/surfaces/glb.h"

#include <nlohmann/json.hpp>

#include "common/io/encodings/byte_order.h"
#include "tests/common/io/expect_error.h"

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

/// A tet with duplicate vertices, as written if normals differ, followed by 16-bit indices.
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
  EXPECT_EQ(mirrored.triangles[0], (Triangle{0, 1, 2}));  // still faces outwards
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
  EXPECT_EQ(mesh.groups, (std::vector<SurfaceRegion>{{0, "bone:red"}, {0, "bone:material 1"}, {0, "skin"}}));
  EXPECT_EQ(mesh.triangle_groups, (std::vector<std::uint32_t>{0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2}));
}

TEST(Glb, WithoutAMeshInASceneIsNoPointCloud) {
  const auto refusal = [](const json& scene) { return error_of<InputError>([&] { (void)read(scene); }); };
  json scene = tet_scene();
  scene.erase("scenes");
  scene.erase("scene");
  EXPECT_EQ(refusal(scene).find("f: it has meshes, but no scene"), 0u) << refusal(scene);
  scene.erase("meshes");
  EXPECT_EQ(refusal(scene).find("f: there is no mesh in it"), 0u) << refusal(scene);
  scene = tet_scene();
  scene["scenes"][0]["nodes"] = json::array();
  EXPECT_EQ(refusal(scene).find("f: its scene shows none of its meshes"), 0u) << refusal(scene);
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

TEST(Glb, WhatTheSceneDoesNotShowIsNamed) {
  json scene = tet_scene();
  scene["meshes"].push_back(scene["meshes"][0]);
  scene["animations"] = {json::object(), json::object()};
  std::vector<Dropped> dropped;
  EXPECT_EQ(read(scene, &dropped).triangles.size(), 4u);
  EXPECT_EQ(dropped, (std::vector<Dropped>{{"meshes that the scene does not show", 1}, {"animations", 2}}));
}

TEST(Glb, EqualAndMissingNamesStayApart) {
  json scene = tet_scene();
  scene["scenes"] = {{{"nodes", {0, 1, 2, 3}}}};
  scene["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}}, {{"mesh", 0}, {"name", "a"}}, {{"mesh", 0}, {"name", "a"}}};
  EXPECT_EQ(read(scene).groups, (std::vector<SurfaceRegion>{{1, ""}, {2, ""}, {0, "a"}, {0, "a_2"}}));
}

TEST(Glb, BadInput) {
  expect_input_error(read_glb, "", "empty");
  expect_input_error(read_glb, "solid", "not a binary glTF file");
  const std::string good = glb(tet_scene(), tet_bytes());
  for (std::size_t cut = 20; cut < good.size(); cut += 7)
    EXPECT_THROW((void)read_glb(good.substr(0, cut), "f"), InputError) << cut;
  expect_input_error(read_glb, good.substr(0, good.size() - 8), "beyond the end of the file");
  std::string old = good;
  old[4] = 1;
  expect_input_error(read_glb, old, "version 1");
  std::string broken = good;
  broken[20] = '?';
  expect_input_error(read_glb, broken, "not valid JSON");
  const auto refused = [](const std::vector<std::pair<std::string, json>>& changes, const std::string& first,
                          const std::string& second = "") {
    json scene = tet_scene();
    for (const auto& [where, value] : changes) scene[json::json_pointer(where)] = value;
    expect_input_error(read_glb, glb(scene, tet_bytes()), first, second);
  };
  refused({{"/scene", 3}}, "index 3 ", "scenes");
  refused({{"/scene", -1}}, "index -1 ", "scenes");
  refused({{"/nodes", 7}}, "\"nodes\" is not a list");
  refused({{"/scenes/0/nodes/0", 5}}, "index 5 ", "nodes");
  refused({{"/nodes/0/mesh", 2}}, "index 2 ", "meshes");
  refused({{"/nodes/0/mesh", "a"}}, "nodes 0", "\"mesh\"");
  refused({{"/nodes/0/children", {0}}}, "nodes 0", "child");
  refused({{"/nodes/0/children", {1}}, {"/nodes/1", json::object()}, {"/scenes/0/nodes", {0, 1}}}, "nodes 1",
          "both a node and the scene");
  refused({{"/nodes/0/scale", {1, 1}}}, "nodes 0", "not 3 numbers");
  refused({{"/nodes/0/translation", {1e300, 1e300, "a"}}}, "nodes 0", "not 3 numbers");
  refused({{"/meshes/0/primitives/0/indices", 9}}, "index 9 ", "accessors");
  refused({{"/meshes/0/primitives/0/indices", -2}}, "index -2 ", "accessors");
  refused({{"/meshes/0/primitives/0/mode", 7}}, "unknown mode 7");
  refused({{"/meshes/0/primitives/0/attributes/POSITION", 0.5}}, "meshes 0", "\"POSITION\"");
  refused({{"/meshes/0/primitives/0/attributes/POSITION", 1}}, "accessors 1",
          "has a number type that is not valid");
  refused({{"/accessors/0/count", 9}}, "accessors 0", "its buffer view");
  refused({{"/accessors/0/count", 1000000000000}}, "accessors 0", "its buffer view");
  refused({{"/accessors/0/count", -1}}, "accessors 0", "\"count\" is -1");
  refused({{"/accessors/0/byteOffset", 1000000000}}, "accessors 0", "its buffer view");
  refused({{"/bufferViews/0/byteLength", 1000}}, "bufferViews 0", "end of the file");
  refused({{"/bufferViews/0/byteStride", 4}}, "accessors 0", "its buffer view");
  refused({{"/accessors/1/bufferView", 7}}, "index 7 ", "bufferViews");
  refused({{"/accessors/1/count", 11}}, "11 corners", "multiple of three");
  refused({{"/accessors/0/count", 4}}, "refers to vertex 4", "there are 4");
  refused({{"/buffers/0/uri", "a.bin"}}, "another file");
  refused({{"/accessors/0/sparse", json::object()}}, "sparse");
  refused({{"/extensionsRequired", {"KHR_materials_unlit", "EXT_mesh_gpu_instancing"}}}, "gpu_instancing");
  // Draco stores the numbers elsewhere: the accessors have no buffer views.
  json draco = tet_scene();
  draco["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  for (json& accessor : draco["accessors"]) accessor.erase("bufferView");
  expect_input_error(read_glb, glb(draco, tet_bytes()), "KHR_draco_mesh_compression", "without compression");
}

TEST(Glb, NestedInAnyDepthEnds) {
  constexpr int depth = 100'000;
  json scene = tet_scene();
  scene["nodes"] = json::array();
  for (int i = 0; i < depth; ++i) scene["nodes"].push_back({{"children", {i + 1}}});
  expect_input_error(read_glb, glb(scene, tet_bytes()), "more than 1000 nodes below the scene");
  std::string text = tet_scene().dump();
  text.insert(1, "\"extras\":" + std::string(depth, '[') + std::string(depth, ']') + ",");
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string rest = glb(tet_scene(), tet_bytes());
  std::string bytes = rest.substr(0, 12);
  append_bytes(bytes, static_cast<std::uint32_t>(text.size()));
  bytes += "JSON" + text + rest.substr(rest.size() - 128);
  EXPECT_EQ(read_glb(bytes, "f").triangles.size(), 4u);
}

TEST(Glb, ObjectsThatMultiplyAreRefused) {
  json scene = tet_scene();
  scene["scenes"][0]["nodes"] = json::array();
  scene["nodes"] = json::array();
  std::string bytes = tet_bytes();
  bytes.resize(bytes.size() + 12 * 1'000'000);
  scene["buffers"][0]["byteLength"] = bytes.size();
  scene["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 120}, {"byteLength", bytes.size() - 120}});
  scene["accessors"][0]["bufferView"] = 2;
  scene["accessors"][0]["count"] = 1'000'000;
  for (int i = 0; i < 600; ++i) {
    scene["scenes"][0]["nodes"].push_back(i);
    scene["nodes"].push_back({{"mesh", 0}});
  }
  expect_input_error(read_glb, glb(scene, bytes), "500000000", "place fewer");
}

}  // namespace
}  // namespace tetwright::glb_test

// SPDX-License-Identifier: Apache-2.0

// Tests the command embed through the program.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "common/io/encodings/zip_archive.h"
#include "tests/tools/program.h"
#include "tetwright/embedding.h"
#include "tetwright/io.h"

namespace tetwright::embed_test {
namespace {

/// A tet mesh of a cube, and a sphere within it.
class Embed : public testing::Test {
 protected:
  Embed() {
    EXPECT_EQ(run("sample tet_cube -o " + path("m.vtu")).status, 0);
    EXPECT_EQ(run("sample sphere -o " + path("s.ply")).status, 0);
    mesh_ = read_tet_mesh(path("m.vtu")).mesh;
    surface_ = read_surface(path("s.ply"));
    Vec3 low = mesh_.points[0], high = low;
    for (const Vec3& p : mesh_.points) low = low.cwiseMin(p), high = high.cwiseMax(p);
    for (Vec3& p : surface_.points) p = (low + high) / 2 + p.normalized() * 0.4 * (high - low).minCoeff();
    write_surface(surface_, path("s.ply"));
    edge_ = (high - low).minCoeff();
  }
  std::string path(const std::string& file) const { return folder_ / file; }
  Answer embed(const std::string& more, const std::string& surface = "s.ply") const {
    return run("embed " + path("m.vtu") + " " + path(surface) + " " + more);
  }
  nlohmann::json json(const std::string& file) const { return nlohmann::json::parse(contents(path(file))); }
  /// Moves the surface by so many edges of the cube and writes it to another file.
  void shift(double edges) {
    for (Vec3& p : surface_.points) p.x() += edges * edge_;
    write_surface(surface_, path("shifted.ply"));
  }

  TemporaryFolder folder_;
  TetMesh mesh_;
  TriangleMesh surface_;
  double edge_ = 0;
};

void expect_same(const Embedding& expected, const nlohmann::json& weights) {
  EXPECT_EQ(weights.at("tets").get<std::vector<Index>>(), expected.tets);
  EXPECT_EQ(weights.at("nodes").get<std::vector<Tet>>(), expected.nodes);
  EXPECT_EQ((weights.at("weights").get<std::vector<std::array<double, 4>>>()), expected.weights);
  EXPECT_EQ(weights.at("distances").get<std::vector<double>>(), expected.distances);
}

TEST_F(Embed, WritesTheWeightsOfAllPoints) {
  const Answer a = embed("-o " + path("w.json") + " --stats " + path("stats.json"));
  ASSERT_EQ(a.status, 0) << a.err;
  EXPECT_EQ(a.err, "");
  EXPECT_EQ(a.out.rfind(std::to_string(surface_.points.size()) + " points in " +
                            std::to_string(mesh_.tets.size()) + " tets: 0 outside",
                        0),
            0u)
      << a.out;
  expect_same(embed_points(mesh_, surface_.points), json("w.json"));
  const nlohmann::json found = json("stats.json").at("embedding");
  EXPECT_EQ(found.at("points"), surface_.points.size());
  EXPECT_EQ(found.at("outside"), 0);
  EXPECT_EQ(found.at("largest_distance"), 0);
  EXPECT_EQ(json("stats.json").at("command"), "embed");
}

TEST_F(Embed, WritesNpzThatRepeats) {
  ASSERT_EQ(embed("-o " + path("a.npz") + " --threads 1 --quiet").out, "");
  ASSERT_EQ(embed("-o " + path("b.npz") + " --threads 3").status, 0);
  const std::string bytes = contents(path("a.npz"));
  EXPECT_EQ(bytes, contents(path("b.npz")));
  const ZipArchive archive(bytes, "a.npz");
  for (const char* name : {"tets.npy", "nodes.npy", "weights.npy", "distances.npy"})
    EXPECT_TRUE(archive.has(name)) << name;
  EXPECT_EQ(archive.read("nodes.npy").size() - archive.read("tets.npy").size(), 24 * surface_.points.size());
}

TEST_F(Embed, TellsOfPointsOutside) {
  shift(0.5);
  const Answer a = embed("-o " + path("w.json") + " --stats " + path("stats.json"), "shifted.ply");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_NE(
      a.err.find("points outside the mesh (they have the weights of the nearest point of a tet; at most 0."),
      std::string::npos)
      << a.err;
  EXPECT_NE(a.out.find(" outside; the farthest is 0."), std::string::npos) << a.out;
  const Embedding expected = embed_points(mesh_, surface_.points);
  expect_same(expected, json("w.json"));
  const EmbeddingSummary summary = summary_of(expected, mesh_, surface_.points);
  const nlohmann::json found = json("stats.json").at("embedding");
  EXPECT_GT(summary.outside, 0u);
  EXPECT_EQ(found.at("outside"), summary.outside);
  EXPECT_EQ(found.at("largest_distance"), summary.largest_distance);
  EXPECT_NEAR(summary.largest_distance, 0.4 * edge_, 0.01 * edge_);
  EXPECT_EQ(found.at("place").at(0), summary.place.x());
  EXPECT_EQ(json("stats.json").at("diagnostics").at(0).at("code"), "points-outside");
}

TEST_F(Embed, BoxesMustMeet) {
  shift(3);
  expect_refused("embed " + path("m.vtu") + " " + path("shifted.ply") + " -o " + path("w.npz"), 3,
                 {"shifted.ply: it does not meet", "m.vtu", "reaches from ("});
  EXPECT_FALSE(std::filesystem::exists(path("w.npz")));
}

TEST_F(Embed, ReadsOtherFormats) {
  ASSERT_EQ(embed("-o " + path("w.json")).status, 0);
  ASSERT_EQ(run("improve " + path("m.vtu") + " --quiet -o " + path("i.vtu")).status, 0);
  const TetMesh improved = read_tet_mesh(path("i.vtu")).mesh;
  const nlohmann::json expected = [&] {
    write_embedding(embed_points(improved, surface_.points), path("e.json"));
    return json("e.json");
  }();
  write_surface(surface_, path("s.obj"));
  write_surface(surface_, path("s.vtp"));
  for (const char* mesh : {"i.msh", "i.mesh", "i.vtk", "i.inp", "i.node"}) {
    write_tet_mesh(improved, path(mesh));
    const Answer a = run("embed " + path(mesh) + " " + path("s.obj") + " -o " + path("o.json"));
    ASSERT_EQ(a.status, 0) << a.err;
    EXPECT_EQ(json("o.json").at("tets").size(), surface_.points.size()) << mesh;
    EXPECT_EQ(json("o.json").at("distances"), expected.at("distances")) << mesh;
  }
  ASSERT_EQ(embed("-o " + path("o.json"), "s.vtp").status, 0);
  EXPECT_EQ(json("o.json"), json("w.json"));
  ASSERT_EQ(run("improve " + path("m.vtu") + " --order 2 --quiet -o " + path("q.vtu")).status, 0);
  const Answer second = run("embed " + path("q.vtu") + " " + path("s.ply") + " -o " + path("o.json"));
  EXPECT_EQ(second.status, 0);
  EXPECT_NE(second.err.find("midside nodes"), std::string::npos) << second.err;
}

TEST_F(Embed, Streams) {
  ASSERT_EQ(embed("-o " + path("w.json")).status, 0);
  const Answer out = embed("-o - --output-format json");
  EXPECT_EQ(out.status, 0) << out.err;
  EXPECT_EQ(out.out, contents(path("w.json")));
  const std::string from = "cat " + path("s.ply") + " | " + program() + " embed " + path("m.vtu") + " - ";
  ASSERT_EQ(std::system((from + "--input-format ply --quiet -o " + path("p.json")).c_str()), 0);
  EXPECT_EQ(contents(path("p.json")), contents(path("w.json")));
  const Answer stats = embed("-o " + path("o.npz") + " --stats -");
  EXPECT_EQ(nlohmann::json::parse(stats.out).at("command"), "embed");
}

TEST_F(Embed, WrongCallsAreRefused) {
  const std::string call = "embed " + path("m.vtu") + " " + path("s.ply") + " ";
  expect_refused(call + "-o " + path("w.txt"), 2, {"\".txt\"", "supported: .npz .json"});
  expect_refused(call + "-o -", 2, {"give --output-format"});
  expect_refused(call + "-o - --output-format vtu", 2, {"\"vtu\"", ".npz .json"});
  expect_refused(call, 2, {"-o", "required"});
  expect_refused("embed " + path("m.vtu") + " -o " + path("w.npz"), 2, {"SURFACE"});
  expect_refused(call + path("s.ply") + " -o " + path("w.npz"), 2, {"s.ply"});
  expect_refused(call + "-o " + path("no/w.npz"), 5, {"no"});
  expect_refused("embed - - --input-format ply -o " + path("w.npz"), 2,
                 {"standard input (-) can be given once"});
  expect_refused("embed " + path("s.ply") + " " + path("s.ply") + " -o " + path("w.npz"), 2, {"s.ply"});
  expect_refused("embed " + path("m.vtu") + " " + path("m.vtu") + " -o " + path("w.npz"), 2, {"m.vtu"});
  expect_refused("embed " + path("none.vtu") + " " + path("s.ply") + " -o " + path("w.npz"), 3, {"none.vtu"});
  expect_refused(call + "-o " + path("w.npz") + " --stats " + path("w.npz"), 2, {"--stats"});
  EXPECT_FALSE(std::filesystem::exists(path("w.npz")));
}

TEST_F(Embed, IsAJobOfABatch) {
  std::ofstream(path("jobs.jsonl")) << R"({"id": "a", "args": ["embed", ")" << path("m.vtu") << R"(", ")"
                                    << path("s.ply") << R"(", "-o", ")" << path("w.npz") << "\"]}\n";
  ASSERT_EQ(run("batch " + path("jobs.jsonl")).status, 0);
  EXPECT_TRUE(std::filesystem::exists(path("w.npz")));
  const nlohmann::json result = json("jobs.results.jsonl");
  EXPECT_EQ(result.at("stats").at("embedding").at("points"), surface_.points.size());
}

}  // namespace
}  // namespace tetwright::embed_test

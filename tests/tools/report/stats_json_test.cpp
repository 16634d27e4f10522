// SPDX-License-Identifier: Apache-2.0

// Tests that every key written by --stats is in the schema, and that every key required by the schema is
// written.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "tests/common/features/parts.h"
#include "tests/tools/program.h"
#include "tetwright/io.h"

namespace tetwright::stats_json_test {
namespace {

std::string violations(const nlohmann::json& document, const std::string& kind = "stats") {
  const auto schema_json = nlohmann::json::parse(contents(TETWRIGHT_DATA "/" + kind + ".schema.json"));
  valijson::Schema schema;
  valijson::SchemaParser().populateSchema(valijson::adapters::NlohmannJsonAdapter(schema_json), schema);
  valijson::ValidationResults results;
  valijson::Validator().validate(schema, valijson::adapters::NlohmannJsonAdapter(document), &results);
  std::string out;
  valijson::ValidationResults::Error error;
  while (results.popError(error)) {
    for (const std::string& place : error.context) out += place;
    out += ": " + error.description + "\n";
  }
  return out;
}

TEST(StatsJson, FollowsItsSchema) {
  const TemporaryFolder f;
  const auto stats = [&](const std::string& arguments) {
    EXPECT_LE(run(arguments + " --stats " + (f / "s.json")).status, 1) << arguments;
    const auto j = nlohmann::json::parse(contents(f / "s.json"));
    EXPECT_EQ(violations(j), "") << arguments;
    return j;
  };
  stats("sample torus -o " + (f / "t.ply"));
  stats("mesh " + (f / "t.ply") + " -o " + (f / "d.vtu") + " --resolution 24");
  stats("simplify " + (f / "d.vtu") + " -o " + (f / "s.vtu") + " --target-tets 3");
  stats("improve " + (f / "s.vtu") + " -o " + (f / "i.vtu"));
  stats("check " + (f / "d.vtu"));
  EXPECT_GT(
      stats("embed " + (f / "d.vtu") + " " + (f / "t.ply") + " -o " + (f / "w.npz"))["embedding"]["points"],
      0);
  stats("sample organs -o " + (f / "o.nrrd"));
  const auto organs = stats("mesh " + (f / "o.nrrd") + " -o " + (f / "o.vtu") + " --voxel-size 2 --uniform");
  EXPECT_EQ(organs["input"]["volume"]["labels"].size(), organs["result"]["materials"].size());
  EXPECT_FALSE(organs["result"]["interfaces"].empty());
  auto j = stats("prepare " + (f / "t.ply") + " -o " + (f / "p.vtu") + " --target-tets 1000 --threads 2");
  EXPECT_EQ(j["threads"], 2);
  EXPECT_EQ(j["result"]["materials"][0]["name"], "t");
  EXPECT_GT(j["peak_bytes"], 0);
  EXPECT_EQ(j["loops"].size(), j["seconds"].size());
  for (const nlohmann::json& stage : j["loops"]) {
    EXPECT_TRUE(j["seconds"].contains(stage["stage"]));
    EXPECT_LE(stage["seconds"], stage["thread_seconds"]) << stage["stage"];
  }
  EXPECT_GT(j["loops"].back()["count"], 0);
  EXPECT_FALSE(j["iterations"].empty());
  const auto bounded = stats("prepare " + (f / "t.ply") + " -o " + (f / "p.vtu") +
                             " --tolerance 2% --max-edge 20% --target-tets 2000");
  EXPECT_TRUE(bounded["tolerance"]["held"]);
  EXPECT_GT(bounded["edge_lengths"]["edges"], 0);
  const auto values = stats("values " + (f / "o.vtu") + " labels=" + (f / "o.nrrd") + " -o " + (f / "v.inp") +
                            " --bins labels=2 --modulus labels=10,1 --min-modulus 1");
  EXPECT_EQ(values["bins"][0]["values"], values["values"][0]["name"]);
  // The schema rejects unknown keys and wrong types.
  j["surprise"] = 1;
  EXPECT_NE(violations(j), "");
  j.erase("surprise");
  j["result"]["tets"] = "many";
  EXPECT_NE(violations(j), "");
}

TEST(CheckJson, FollowsItsSchema) {
  const TemporaryFolder f;
  const auto check = [&](const std::string& arguments) {
    const Answer a = run("check --json " + arguments);
    EXPECT_LE(a.status, 1) << a.err;
    const auto j = nlohmann::json::parse(a.out);
    EXPECT_EQ(violations(j, "check"), "") << arguments;
    return j;
  };
  ASSERT_EQ(run("sample organs -o " + (f / "o.nrrd")).status, 0);
  ASSERT_EQ(
      run("mesh " + (f / "o.nrrd") + " -o " + (f / "o.vtu") + " --voxel-size 2 --uniform --accept-changes")
          .status,
      0);
  const auto organs = check((f / "o.vtu") + " --before " + (f / "o.vtu"));
  EXPECT_EQ(organs["topology"], organs["topology_before"]);
  EXPECT_TRUE(organs["topology_differences"].empty());
  EXPECT_EQ(organs["topology"]["materials"].size(), organs["mesh"]["materials"].size());
  EXPECT_EQ(organs["topology"]["materials"][0]["name"], organs["mesh"]["materials"][0]["name"]);
  EXPECT_GT(organs["topology"]["junction_curves"]["components"], 0);

  ASSERT_EQ(run("sample torus -o " + (f / "t.ply")).status, 0);
  ASSERT_EQ(
      run("mesh " + (f / "t.ply") + " -o " + (f / "t.vtu") + " --resolution 24 --accept-changes").status, 0);
  const auto torus = check((f / "t.vtu") + " --surface " + (f / "t.ply") + " --tolerance 10%");
  EXPECT_EQ(torus["topology"]["domain"]["euler"], 0);
  EXPECT_TRUE(torus["tolerance"]["held"]);
  EXPECT_EQ(torus["surface"]["solid"]["result"]["handles"], 1);
  EXPECT_NE(violations(nlohmann::json::object(), "check"), "");
}

TEST(CheckJson, PlacesAreCoordinates) {
  const TemporaryFolder f;
  // The second tet is inverted, and the last point is unused.
  put(f / "bad.mesh",
      "MeshVersionFormatted 2\nDimension 3\nVertices 6\n0 0 0 0\n3 0 0 0\n0 3 0 0\n0 0 3 0\n0 0 -3 0\n"
      "9 9 9 0\nTetrahedra 2\n1 2 3 4 1\n1 2 3 5 1\nEnd\n");
  const Answer a = run("check --json " + (f / "bad.mesh"));
  EXPECT_EQ(a.status, 1);
  const auto j = nlohmann::json::parse(a.out);
  EXPECT_EQ(violations(j, "check"), "");
  std::map<std::string, nlohmann::json> places;
  for (const auto& finding : j["findings"]) places[finding["name"]] = finding["places"][0];
  EXPECT_EQ(places["inverted"]["points"], nlohmann::json({0, 1, 2, 4}));
  EXPECT_EQ(places["inverted"]["at"], nlohmann::json({0.75, 0.75, -0.75}));
  EXPECT_EQ(places["unused_points"]["points"], nlohmann::json({5}));
  EXPECT_EQ(places["unused_points"]["at"], nlohmann::json({9.0, 9.0, 9.0}));
}

TEST(StatsJson, SayWhatBecameOfEachCurve) {
  const TemporaryFolder f;
  std::string said;
  // Curves of the first surface by fate, and the number of those that are not listed.
  const auto fates = [&](const std::string& arguments) {
    const Answer a = run("mesh " + arguments + " -o " + (f / "o.vtu") + " --stats " + (f / "s.json"));
    EXPECT_LE(a.status, 1) << a.err;
    said = a.out;
    const auto j = nlohmann::json::parse(contents(f / "s.json"));
    EXPECT_EQ(violations(j), "") << arguments;
    const auto& feature = j["features"][0];
    std::map<std::string, int> found;
    double length = std::numeric_limits<double>::infinity();
    for (const auto& curve : feature["curves"]) {
      ++found[curve["fate"]];
      EXPECT_LE(curve["length"], length);
      length = curve["length"];
      EXPECT_GT(curve["turn"], 34.9);
      if (curve["fate"] == "kept" && feature["verdict"] == "part")
        EXPECT_LT(curve["distance"], 0.5) << curve;
      else
        EXPECT_FALSE(curve.contains("distance")) << curve;
    }
    found["further"] = feature["further_curves"];
    return found;
  };
  using Fates = std::map<std::string, int>;
  write_surface(folded_block(8), f / "block.off");
  EXPECT_EQ(fates((f / "block.off") + " --resolution 48"),
            (Fates{{"kept", 13}, {"faded", 1}, {"further", 0}}));
  EXPECT_NE(said.find("curves of 'block' that are not kept: 1 of length 11"), std::string::npos) << said;
  EXPECT_EQ(fates((f / "block.off") + " --resolution 16 --feature-angle off"), (Fates{{"further", 0}}));

  // Two cubes that cross, one of them with a hole around an edge, which cannot be closed flat: its faces are
  // walls, and the other cube keeps its edges.
  TriangleMesh open = unit_cube();
  std::erase_if(open.triangles, [&](const Triangle& t) {
    return std::count_if(t.begin(), t.end(),
                         [&](Index p) { return open.points[p].x() == 1 && open.points[p].z() == 1; }) == 2;
  });
  TriangleMesh both = unit_cube();
  for (Vec3& p : both.points) p += Vec3(0.3, 0.4, -0.2);
  for (Triangle t : open.triangles) {
    for (Index& p : t) p += static_cast<Index>(both.points.size());
    both.triangles.push_back(t);
  }
  both.points.insert(both.points.end(), open.points.begin(), open.points.end());
  write_surface(both, f / "both.off");
  EXPECT_EQ(fates((f / "both.off") + " --resolution 16"), (Fates{{"kept", 12}, {"further", 0}}));

  // A surface that touches the open one is not joined with it.
  write_surface(open, f / "open.off");
  TriangleMesh beside = unit_cube();
  for (Vec3& p : beside.points) p.x() += 1;
  write_surface(beside, f / "beside.off");
  EXPECT_EQ(fates((f / "beside.off") + " --material o=" + (f / "open.off") + " --resolution 16"),
            (Fates{{"given_up", 8}, {"kept", 8}, {"further", 0}}));
  EXPECT_NE(said.find("given up where surfaces cross or meet"), std::string::npos) << said;

  write_surface(terrain(24), f / "terrain.off");
  const Fates of_terrain = fates((f / "terrain.off") + " --resolution 24");
  EXPECT_GT(of_terrain.at("noise"), 20);
  EXPECT_GE(of_terrain.at("kept"), 12);
  EXPECT_NE(said.find("; on 1"), std::string::npos) << said;
  EXPECT_NE(said.find(" % of the area edges look like those of a scan"), std::string::npos) << said;
  EXPECT_EQ(said.find("not kept"), std::string::npos) << said;
}

TEST(StatsJson, OfARunThatFails) {
  const TemporaryFolder f;
  put(f / "flat.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const Answer a = run("mesh " + (f / "flat.off") + " -o " + (f / "o.vtu") + " --stats " + (f / "s.json"));
  EXPECT_EQ(a.status, 3);
  const auto j = nlohmann::json::parse(contents(f / "s.json"));
  EXPECT_EQ(violations(j), "");
  EXPECT_EQ(j["status"], 3);
  EXPECT_NE(j["error"]["message"].get<std::string>().find("flat.off"), std::string::npos);
  EXPECT_NE(j["error"]["stage"], "");
  EXPECT_EQ(f.entries(), 2u);  // and no mesh
}

TEST(StatsJson, ToStandardOutput) {
  const TemporaryFolder f;
  put(f / "t.off", tetrahedron_off);
  const std::string mesh = "mesh " + (f / "t.off") + " -o " + (f / "o.vtu") + " --resolution 16";
  const auto j = nlohmann::json::parse(run(mesh + " --stats -").out);
  EXPECT_EQ(violations(j), "");
  EXPECT_EQ(j["status"], 0);
  const auto checked = nlohmann::json::parse(run("check " + (f / "o.vtu") + " --stats -").out);
  EXPECT_EQ(violations(checked), "");
  expect_refused("check " + (f / "o.vtu") + " --stats - --json", 2, {"--json", "--stats -"});
}

TEST(StatsJson, ProgressAsLinesOfJsonAndTheLog) {
  const TemporaryFolder f;
  put(f / "t.off", tetrahedron_off);
  const std::string call =
      "mesh " + (f / "t.off") + " -o " + (f / "o.vtu") + " --resolution 32 --log-file " + (f / "run.log");
  const Answer a = run(call + " --progress json --quiet");
  EXPECT_EQ(a.status, 0);
  std::istringstream lines(a.err);
  std::vector<std::string> stages;
  int percent = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto j = nlohmann::json::parse(line);
    const std::string stage = j["stage"];
    if (stages.empty() || stages.back() != stage) {
      stages.push_back(stage);
      EXPECT_EQ(j["percent"], 0);
    } else {
      EXPECT_GT(j["percent"], percent);
    }
    percent = j["percent"];
    EXPECT_LE(percent, 100);
  }
  EXPECT_GT(stages.size(), 2u);
  EXPECT_EQ(stages.front(), "read");
  EXPECT_EQ(run("mesh " + (f / "t.off") + " -o " + (f / "o.vtu") + " --threads 1 --resolution 8 --log-file " +
                (f / "run.log") + " --voxel-size 9 --progress none")
                .status,
            2);
  EXPECT_EQ(
      run("mesh " + (f / "none.off") + " -o " + (f / "o.vtu") + " --log-file " + (f / "run.log")).status, 3);
  const std::string log = contents(f / "run.log");
  for (const char* said :
       {"--resolution 32", "stage: read", "stage: write", "exit status 0", "none.off", "exit status 3"})
    EXPECT_NE(log.find(said), std::string::npos) << log << "lacks: " << said;
  expect_refused("mesh " + (f / "t.off") + " -o " + (f / "o.vtu") + " --log-file " + (f / "no/where.log"), 5,
                 {"where.log"});
  expect_refused("mesh " + (f / "t.off") + " -o " + (f / "o.vtu") + " --log-file " + (f / "t.off"), 2,
                 {"--log-file", "is also an input"});
}

}  // namespace
}  // namespace tetwright::stats_json_test

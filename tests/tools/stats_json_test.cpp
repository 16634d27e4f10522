// Every key that --stats writes is in the schema, and every key that the schema requires is written.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "tests/tools/program.h"

namespace tetwright::stats_json_test {
namespace {

std::string violations(const nlohmann::json& document) {
  const auto schema_json = nlohmann::json::parse(contents(TETWRIGHT_SCHEMA));
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
  stats("sample organs -o " + (f / "o.nrrd"));
  const auto organs = stats("mesh " + (f / "o.nrrd") + " -o " + (f / "o.vtu") + " --voxel-size 2 --uniform");
  EXPECT_EQ(organs["input"]["volume"]["labels"].size(), organs["result"]["materials"].size());
  EXPECT_FALSE(organs["result"]["interfaces"].empty());
  auto j = stats("prepare " + (f / "t.ply") + " -o " + (f / "p.vtu") + " --target-tets 1000 --threads 2");
  EXPECT_EQ(j["threads"], 2);
  EXPECT_EQ(j["result"]["materials"][0]["name"], "t");
  EXPECT_GT(j["peak_bytes"], 0);
  EXPECT_FALSE(j["iterations"].empty());
  const auto bounded = stats("prepare " + (f / "t.ply") + " -o " + (f / "p.vtu") +
                             " --tolerance 2% --max-edge 20% --target-tets 2000");
  EXPECT_TRUE(bounded["tolerance"]["held"]);
  EXPECT_GT(bounded["edge_lengths"]["edges"], 0);
  // The schema refuses unknown keys and wrong types.
  j["surprise"] = 1;
  EXPECT_NE(violations(j), "");
  j.erase("surprise");
  j["result"]["tets"] = "many";
  EXPECT_NE(violations(j), "");
}

}  // namespace
}  // namespace tetwright::stats_json_test

// SPDX-License-Identifier: Apache-2.0

// Tests the page of --report: its contents, its size and when it is written. tests/report_page/ tests it in a
// browser.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "common/io/encodings/base64.h"
#include "common/samples/samples.h"
#include "tests/tools/program.h"
#include "tetwright/mesh_quality.h"
#include "tools/report/page/charts.h"
#include "tools/report/page/html_text.h"
#include "tools/report/page/page.h"
#include "tools/report/page/skin.h"

namespace tetwright::page_test {
namespace {

std::size_t number_at(const std::string& bytes, std::size_t index, std::size_t size) {
  std::size_t value = 0;
  for (std::size_t i = 0; i < size; ++i)
    value |= std::size_t{static_cast<unsigned char>(bytes[index * size + i])} << (8 * i);
  return value;
}

TetMesh sample_mesh(const char* name) {
  TetMesh mesh = std::get<TetMesh>(make_sample(name));
  mesh.interfaces = find_interfaces(mesh);
  return mesh;
}

/// Page of a mesh that was only read.
std::string page_of(const TetMesh& mesh, const PageLimits& limits = {}) {
  CommandLine line;
  line.command = Command::check;
  line.inputs = {"mesh.vtu"};
  PrepareReport run;
  run.inputs = line.inputs;
  run.result = mesh_statistics(mesh);
  return report_page(line, run, mesh, nullptr, nullptr, limits);
}

TEST(ReportPage, PointsAreOffByHalfAStepAtMost) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> far(-3e5, 1e6), thin(10, 10.5);
  std::vector<Vec3> points;
  for (int i = 0; i < 5000; ++i) points.emplace_back(far(random), far(random), thin(random));
  const QuantisedPoints q = quantise(points);
  ASSERT_EQ(q.bytes.size(), 6 * points.size());
  double worst = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) {
      const auto steps = static_cast<double>(number_at(q.bytes, 3 * i + static_cast<std::size_t>(axis), 2));
      worst = std::max(worst, std::abs(q.origin[axis] + q.step * steps - points[i][axis]));
    }
  EXPECT_LE(worst, 0.5001 * q.step);
  EXPECT_NEAR(q.step, 1.3e6 / 65535, 1);
}

TEST(ReportPage, PointsOfAnyBoxAreQuantised) {
  EXPECT_EQ(quantise({}).bytes, "");
  const QuantisedPoints one = quantise(std::vector<Vec3>{{1, 2, 3}});
  EXPECT_EQ(one.bytes, std::string(6, '\0'));
  EXPECT_GT(one.step, 0);
  const QuantisedPoints large =
      quantise(std::vector<Vec3>{Vec3::Constant(-1.7e308), Vec3::Constant(1.7e308)});
  EXPECT_TRUE(std::isfinite(large.step));
  EXPECT_EQ(number_at(large.bytes, 0, 2), 0u);
  EXPECT_EQ(number_at(large.bytes, 3, 2), 65535u);
  const QuantisedPoints tiny = quantise(std::vector<Vec3>{Vec3::Zero(), Vec3::Constant(5e-324)});
  EXPECT_GT(tiny.step, 0);
}

TEST(ReportPage, TextIsNoMarkup) {
  EXPECT_EQ(html_text("<b>\"a\" & 'b'</b>"), "&lt;b&gt;&quot;a&quot; &amp; 'b'&lt;/b&gt;");
  EXPECT_EQ(html_text(std::string("a\0\n\xff", 4)), "a__\xef\xbf\xbd");
  EXPECT_EQ(script_json("{\"a\":\"</script><!--\"}"), "{\"a\":\"\\u003c/script\\u003e\\u003c!--\"}");
  EXPECT_EQ(nlohmann::json::parse(script_json("[\"</script>\"]"))[0], "</script>");
}

TEST(ReportPage, NamesOfTheUserAreNoMarkup) {
  const std::string evil = "</script><script>x()</script><img src=\"q\">";
  TetMesh mesh = sample_mesh("two_materials");
  for (auto& [tag, name] : mesh.material_names) name = evil;
  ASSERT_FALSE(mesh.material_names.empty());
  CommandLine line;
  line.command = Command::improve;
  line.outputs.mesh = evil + ".vtu";
  line.arguments = " improve " + evil;
  PrepareReport run;
  run.inputs = {evil};
  run.material_names = mesh.material_names;
  run.dense = run.result = mesh_statistics(mesh);
  run.diagnostics.push_back({.code = DiagnosticCode::points_merged,
                             .file = evil,
                             .what = evil,
                             .count = 3,
                             .done = evil,
                             .places = {Vec3::Zero()}});
  run.diagnostics.push_back({.code = DiagnosticCode::target_missed,
                             .file = evil,
                             .what = evil,
                             .remedy = evil,
                             .asked = 1,
                             .reached = 2,
                             .limited_by = evil,
                             .places = {Vec3::Zero()}});
  const SurfaceDistances distances{evil, std::vector<float>(mesh.points.size(), 1)};
  const std::string page = report_page(line, run, mesh, &distances);
  EXPECT_EQ(page.find("<script>x()"), std::string::npos);
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_NE(page.find("&lt;img"), std::string::npos);
  // The code of a diagnostic explains itself.
  EXPECT_NE(page.find("<code title=\"The file repeats points, as STL does for each triangle. None needed.\">"
                      "points-merged</code>"),
            std::string::npos);
}

TEST(ReportPage, DrawsABarForEachIteration) {
  EXPECT_EQ(iterations_chart({}), "");
  IterationReport close;
  close.kind = "close";
  close.tets_before = 7;
  EXPECT_EQ(iterations_chart({&close, 1}), "");
  std::vector<IterationReport> iterations(2);
  for (IterationReport& it : iterations) it.kind = "simplify";
  iterations[0].tets_before = 1000;
  iterations[0].tets_by_quality = {100, 0, 900};
  iterations[0].percent = 10;
  iterations[1].tets_before = 250;
  iterations[1].tets_by_quality = {0, 0, 250};
  iterations[1].percent = 20;
  iterations.push_back(close);
  const std::string chart = iterations_chart(iterations);
  // The plot is 150 high, from 10 at the top to 160. The worst 100 of 1,000 tets fill its topmost 15, the
  // others 135; the 250 of the second iteration fill the lowest 37.5.
  EXPECT_NE(chart.find("<path class=\"shade9\" d=\"M67 10H235V25H67z\"/>"), std::string::npos) << chart;
  EXPECT_NE(chart.find("<path class=\"shade7\" d=\"M67 25H235V160H67zM277 122.5H445V160H277z\"/>"),
            std::string::npos)
      << chart;
  // The worst 10 % and 20 % are worked on.
  EXPECT_NE(chart.find("<path class=\"outline\" d=\"M67 25H235M277 130H445\"/>"), std::string::npos) << chart;
}

TEST(ReportPage, NumbersDoNotDependOnTheLocale) {
  EXPECT_EQ(fixed_number(1234.5678, 2), "1234.57");
  EXPECT_EQ(fixed_number(std::nan(""), 2), "nan");
  EXPECT_EQ(grouped_number(7), "7");
  EXPECT_EQ(grouped_number(123), "123");
  EXPECT_EQ(grouped_number(1234567), "1,234,567");
}

TEST(ReportPage, HoldsAllTetsWithTheirMaterialsAndAngles) {
  const TetMesh mesh = sample_mesh("two_materials");
  const PageMesh page = page_mesh(mesh, nullptr);
  EXPECT_TRUE(page.whole);
  EXPECT_EQ(page.triangles, "");
  ASSERT_EQ(page.tet_count, mesh.tets.size());
  ASSERT_EQ(page.materials.size(), 2u);
  const MeshStatistics statistics = mesh_statistics(mesh);
  int smallest = 255;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    for (std::size_t k = 0; k < 4; ++k)
      EXPECT_EQ(number_at(page.tets, 4 * t + k, page.index_bytes), mesh.tets[t][k]);
    EXPECT_EQ(page.materials[number_at(page.tags, t, page.material_bytes)], mesh.materials[t]);
    smallest = std::min(smallest, static_cast<int>(number_at(page.solid, t, 1)));
  }
  EXPECT_NEAR(smallest / 255.0 * 0.5513, statistics.min_solid_angle, 0.5513 / 255);
}

TEST(ReportPage, OfAHundredThousandTetsIsBelowFiveMegabytes) {
  // A dense mesh has the most points; random meshes have the most tets for each point.
  const TemporaryFolder f;
  ASSERT_EQ(run("sample sphere -o " + (f / "s.ply")).status, 0);
  ASSERT_LE(run("mesh " + (f / "s.ply") + " -o " + (f / "s.vtu") + " --resolution 56 --report " +
                (f / "s.html") + " --stats " + (f / "s.json"))
                .status,
            1);
  const std::size_t tets = nlohmann::json::parse(contents(f / "s.json"))["result"]["tets"];
  const double bytes = static_cast<double>(contents(f / "s.html").size());
  EXPECT_GT(tets, 60'000u);
  EXPECT_LT(bytes * std::max(1.0, 100'000.0 / static_cast<double>(tets)), 5e6);
  // 200,000 tets: below twice the limit for 100,000, since the page has the script only once.
  EXPECT_LT(page_of(sample_mesh("random-interior-large")).size(), 8'000'000u);
}

TEST(ReportPage, OfALargerMeshIsBounded) {
  const TetMesh mesh = sample_mesh("random-interior");
  const PageLimits limits{1000, 2000, 5000};
  const PageMesh page = page_mesh(mesh, nullptr, limits);
  EXPECT_FALSE(page.whole);
  EXPECT_LE(page.triangle_count, limits.triangles);
  EXPECT_GT(page.triangle_count, 100u);
  EXPECT_LT(page.tet_count, mesh.tets.size());
  EXPECT_EQ(page.layer.size(), page.tet_count);
  EXPECT_GT(page.tet_count, 100u);
  // Everything that is exposed by a cut along the plane x = middle is on the page.
  EXPECT_TRUE(page.layers[0]);
  const std::string text = page_of(mesh, limits);
  EXPECT_NE(text.find("too many for a page"), std::string::npos);
  EXPECT_EQ(page_of(mesh).find("too many for a page"), std::string::npos);
  // A layer that is too large is left out, and the page reports it.
  const PageLimits no_layers{1000, 2000, 10};
  EXPECT_EQ(page_mesh(mesh, nullptr, no_layers).tet_count, 0u);
  EXPECT_NE(page_of(mesh, no_layers).find("not across x, y, z, where they are too many"), std::string::npos);
}

TEST(ReportPage, ASkinIsCoarsenedToWhatIsAllowed) {
  const TetMesh mesh = sample_mesh("random-interior");
  EXPECT_EQ(skin_within(mesh, mesh.interfaces.size()), mesh.interfaces);
  const auto fewer = skin_within(mesh, mesh.interfaces.size() / 2);
  EXPECT_LE(fewer.size(), mesh.interfaces.size() / 2);
  EXPECT_GT(fewer.size(), mesh.interfaces.size() / 20);
  EXPECT_TRUE(skin_within(mesh, 0).empty());
}

TEST(ReportPage, DistancesAreThoseOfThePoints) {
  const TetMesh mesh = sample_mesh("tet_cube");
  double low = mesh.points[0].x();
  for (const Vec3& p : mesh.points) low = std::min(low, p.x());
  // A plane far beyond the mesh, parallel to one of its sides.
  constexpr double apart = 2, far = 1e4;
  const TriangleMesh plane{{{low - apart, -far, -far}, {low - apart, far, -far}, {low - apart, 0, far}},
                           {{0, 1, 2}}};
  const SurfaceDistances d = surface_distances(mesh, plane, "a plane");
  std::vector<char> on_interface(mesh.points.size(), 0);
  for (const InterfaceTriangle& t : mesh.interfaces)
    for (const Index p : t.ids) on_interface[p] = 1;
  for (std::size_t p = 0; p < mesh.points.size(); ++p) {
    EXPECT_EQ(std::isnan(d.values[p]), !on_interface[p]);
    if (on_interface[p]) {
      EXPECT_NEAR(d.values[p], mesh.points[p].x() - low + apart, 1e-5);
    }
  }
  const PageMesh page = page_mesh(mesh, &d);
  EXPECT_EQ(page.distance.size(), 2 * page.point_count);
  EXPECT_GT(page.max_distance, apart);
}

TEST(ReportPage, IsWrittenWithTheMeshAndIsTheSameEachTime) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample open_sphere -o " + (f / "s.ply")).status, 0);
  const std::string call = "prepare " + (f / "s.ply") + " -o " + (f / "s.vtu") +
                           " --target-tets 1000 --threads 2 --report " + (f / "s.html");
  ASSERT_EQ(run(call).status, 0);
  const std::string page = contents(f / "s.html");
  EXPECT_EQ(page.rfind("<!doctype html>", 0), 0u);
  EXPECT_TRUE(page.ends_with("</html>\n"));
  EXPECT_EQ(page.find("{{"), std::string::npos);
  EXPECT_NE(page.find("dense mesh"), std::string::npos);
  EXPECT_NE(page.find("data-mark=\"1\""), std::string::npos);  // the hole
  ASSERT_EQ(run(call).status, 0);
  EXPECT_EQ(contents(f / "s.html"), page);
}

TEST(ReportPage, OfEveryCommandThatHasAMesh) {
  const TemporaryFolder f;
  ASSERT_EQ(run("sample layers -o " + (f / "l.vtu")).status, 0);
  for (const char* call : {"improve", "simplify --target-tets 500", "check"}) {
    const std::string output = std::string(call) == "check" ? "" : " -o " + (f / "o.vtu");
    EXPECT_LE(run(std::string(call) + " " + (f / "l.vtu") + output + " --report " + (f / "p.html")).status,
              1);
    EXPECT_NE(contents(f / "p.html").find("id=\"tets\""), std::string::npos) << call;
    std::filesystem::remove(f / "p.html");
  }
}

TEST(ReportPage, ReplacesNothingElse) {
  const TemporaryFolder f;
  put(f / "t.off", tetrahedron_off);
  const std::string mesh = "mesh " + (f / "t.off") + " --accept-changes --resolution 8 -o " + (f / "a.vtu");
  expect_refused(mesh + " --report " + (f / "a.txt"), 2, {"--report", ".html"});
  expect_refused(mesh + " --report " + (f / "t.off"), 2, {"--report", ".html"});
  ASSERT_EQ(run(mesh).status, 0);
  std::filesystem::create_symlink(f / "a.vtu", f / "link.html");
  expect_refused(mesh + " --report " + (f / "link.html"), 2, {"--report", "-o"});
  expect_refused("check " + (f / "a.vtu") + " --report " + (f / "link.html"), 2, {"is also an input"});
  std::filesystem::create_symlink(f / "t.off", f / "input.htm");
  expect_refused(mesh + " --report " + (f / "input.htm"), 2, {"is also an input"});
  EXPECT_EQ(contents(f / "t.off"), tetrahedron_off);
}

TEST(ReportPage, ThatCannotBeWrittenLeavesNothing) {
  const TemporaryFolder f;
  put(f / "t.off", tetrahedron_off);
  const std::string mesh = "mesh " + (f / "t.off") + " --accept-changes --resolution 8 -o " + (f / "a.vtu");
  const std::size_t files = f.entries();
  expect_refused(mesh + " --report " + (f / "nowhere/p.html"), 5, {"nowhere"});
  EXPECT_EQ(f.entries(), files);
  // A file size limit that the mesh does not reach and the page exceeds.
  expect_refused(mesh + " --quiet --report " + (f / "p.html"), 5, {"p.html"}, "ulimit -f 400;");
  EXPECT_EQ(f.entries(), files);
}

}  // namespace
}  // namespace tetwright::page_test

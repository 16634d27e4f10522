// SPDX-License-Identifier: Apache-2.0

// Bodies, sheets and partitions that do not fit together: each call ends soon, with an error or a note that
// says what to do.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "tests/mesher/test_surfaces.h"
#include "tests/tools/program.h"

namespace tetwright::wrong_assemblies_test {
namespace {

constexpr const char* bounded = "timeout 20";

/// A folder with the unit cube box.off, and calls that mesh it together with other files.
class Assembly {
 public:
  Assembly() { put_surface("box.off", make_box({0, 0, 0}, {1, 1, 1})); }

  void put_surface(const std::string& name, const TriangleMesh& mesh) {
    std::string text =
        "OFF\n" + std::to_string(mesh.points.size()) + " " + std::to_string(mesh.triangles.size()) + " 0\n";
    const auto number = [](double x) { return std::to_string(x) + " "; };
    for (const Vec3& p : mesh.points) text += number(p.x()) + number(p.y()) + number(p.z()) + "\n";
    for (const auto& [a, b, c] : mesh.triangles)
      text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
    put(folder_ / name, text);
  }
  void put_text(const std::string& name, const std::string& text) { put(folder_ / name, text); }

  /// Runs the call with "%" replaced by the folder.
  Answer call(std::string options) const {
    for (std::size_t at = 0; (at = options.find('%', at)) != std::string::npos;)
      options.replace(at, 1, folder_ / "");
    return run("prepare " + (folder_ / "box.off") + " " + options + " -o " + (folder_ / "out.vtu") +
                   " --target-tets 600",
               "", bounded);
  }

  void expect_refused(const std::string& options, int status, const std::vector<std::string>& said) const {
    const Answer a = call(options);
    EXPECT_EQ(a.status, status) << options << "\n" << a.err;
    EXPECT_EQ(a.err.rfind("tetwright: ", 0), 0U) << a.err;
    for (const std::string& s : said) EXPECT_NE(a.err.find(s), std::string::npos) << a.err << "lacks: " << s;
    EXPECT_FALSE(folder_.has("out.vtu")) << options;
  }
  void expect_note(const std::string& options, const std::vector<std::string>& said) const {
    const Answer a = call(options);
    EXPECT_LE(a.status, 1) << options << "\n" << a.err;
    for (const std::string& s : said) EXPECT_NE(a.err.find(s), std::string::npos) << a.err << "lacks: " << s;
  }

 private:
  TemporaryFolder folder_;
};

TriangleMesh rectangle(const Vec3& corner, const Vec3& u, const Vec3& v) {
  return {{corner, corner + u, corner + u + v, corner + v}, {{0, 1, 2}, {0, 2, 3}}};
}

const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

TEST(WrongAssemblies, BodyGivenTwice) {
  const Assembly a;
  a.expect_refused("--material again=%box.off", 3, {"nothing is left", "'box'", "later surfaces cover it"});
}

TEST(WrongAssemblies, BodyTurnedInsideOut) {
  Assembly a;
  a.put_surface("bad.off", turned_over(make_box({1, 0, 0}, {2, 1, 1})));
  a.expect_note("--material bad=%bad.off", {"oriented inwards", "reoriented outwards"});
}

TEST(WrongAssemblies, OpenBody) {
  Assembly a;
  TriangleMesh open = make_box({1, 0, 0}, {2, 1, 1});
  open.triangles.erase(open.triangles.begin());
  a.put_surface("flat.off", open);
  a.expect_note("--material bad=%flat.off", {"3 boundary edges of flat holes"});
  // Without the triangles at a corner the rim is not flat.
  const Vec3 corner(2, 1, 1);
  std::erase_if(open.triangles, [&](const Triangle& t) {
    return std::any_of(t.begin(), t.end(), [&](Index p) { return open.points[p] == corner; });
  });
  a.put_surface("bad.off", open);
  a.expect_note("--material bad=%bad.off", {"boundary edges of holes", "not joined", "surface is open"});
}

TEST(WrongAssemblies, BodiesWithoutVolume) {
  Assembly a;
  a.put_surface("flat.off", {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {{0, 1, 2}, {1, 2, 3}}});
  a.put_surface("plane.off", rectangle(x, y, z));
  a.expect_refused("--material flat=%flat.off", 3, {"flat.off", "without any area"});
  a.expect_refused("--material plane=%plane.off", 3, {"plane.off", "encloses nothing"});
}

TEST(WrongAssemblies, CoordinatesThatAreNoNumbers) {
  Assembly a;
  a.put_text("bad.off", "OFF\n4 4 0\n1 0 nan\n2 0 0\n1 1 0\n1 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  a.expect_refused("--material bad=%bad.off", 3, {"bad.off", "line 3", "nan", "not finite"});
}

TEST(WrongAssemblies, TrianglesAtRandom) {
  Assembly a;
  std::mt19937 random(5);
  TriangleMesh soup;
  for (Index t = 0; t < 100; ++t) {
    for (int k = 0; k < 3; ++k) {
      const auto coordinate = [&] { return 0.01 * static_cast<double>(random() % 100); };
      const double px = coordinate(), py = coordinate(), pz = coordinate();
      soup.points.emplace_back(px, py, pz);
    }
    soup.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  a.put_surface("bad.off", soup);
  a.expect_refused("--material bad=%bad.off", 3,
                   {"bad.off", "form no surface", "100 of 100", "one at (", "connected triangles"});
}

TEST(WrongAssemblies, TwoBodiesOfOneName) {
  Assembly a;
  a.put_surface("inside.off", make_box({0.3, 0.3, 0.3}, {0.7, 0.7, 0.7}));
  a.expect_refused("--material box=%inside.off", 2, {"two materials are called 'box'", "another name"});
}

TEST(WrongAssemblies, ToleranceLargerThanABody) {
  Assembly a;
  a.put_surface("small.off", make_box({1, 0, 0}, {1.01, 0.01, 0.01}));
  a.put_surface("level.off", rectangle({-1, -1, 0.5}, 3 * x, 3 * y));
  a.put_surface("sheet.off", rectangle({0.2, 0.2, 0.5}, 0.6 * x, 0.6 * y));
  a.expect_refused("--material small=%small.off --contact-tolerance 0.01", 3,
                   {"small.off", "0.01 is too large for 'small'", "use a smaller --contact-tolerance"});
  for (const std::string part : {"--partition level=%level.off", "--sheet sheet=%sheet.off"})
    a.expect_refused(part + " --contact-tolerance 0.5", 3,
                     {"too large for 'box'", "smaller --contact-tolerance"});
}

TEST(WrongAssemblies, SheetsElsewhere) {
  Assembly a;
  a.put_surface("outside.off", rectangle({3, 0, 0}, x, y));
  a.put_surface("side.off", rectangle({0.2, 0.2, 0}, 0.6 * x, 0.6 * y));
  a.put_surface("inside.off", rectangle({0.2, 0.2, 0.5}, 0.6 * x, 0.6 * y));
  a.put_surface("half.off", rectangle({0.5, 0.2, 0.5}, x, 0.6 * y));
  a.put_surface("closed.off", make_box({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}));
  a.expect_refused("--sheet s=%outside.off", 3, {"'s' is in no body", "at (", "units and position"});
  a.expect_refused("--sheet s=%side.off", 3, {"'s' lies on the boundary", "at (", "named groups"});
  a.expect_refused("--sheet s=%closed.off", 3, {"closed at (", "--material NAME=FILE"});
  a.expect_refused("--sheet a=%inside.off --sheet b=%inside.off", 3,
                   {"'b' lies on another sheet", "leave one"});
  a.expect_note("--sheet a=%inside.off --sheet a=%inside.off", {"of the sheet 'a' on another sheet", "0.36"});
  a.expect_note("--sheet s=%half.off", {"of the sheet 's' outside all bodies", "area of 0.3"});
}

TEST(WrongAssemblies, PartitionsElsewhere) {
  Assembly a;
  a.put_surface("away.off", rectangle({-1, -1, 5}, 3 * x, 3 * y));
  a.put_surface("level.off", rectangle({-1, -1, 0.5}, 3 * x, 3 * y));
  a.put_surface("short.off", rectangle({0.2, 0.2, 0.5}, 0.6 * x, 0.6 * y));
  a.expect_refused("--partition p=%away.off", 3, {"'p' divides no body", "units and position"});
  a.expect_refused("--partition p=%short.off", 3, {"'p' divides no body", "--extend"});
  a.expect_refused("--partition a=%level.off --partition b=%level.off", 3,
                   {"'b' divides no body", "lies on an earlier one", "leave it out"});
  a.expect_refused("--partition a=%level.off --sheet b=%level.off", 3, {"'b' lies on the boundary"});
}

TEST(WrongAssemblies, SeedsThatContradictEachOther) {
  Assembly a;
  a.put_surface("level.off", rectangle({-1, -1, 0.5}, 3 * x, 3 * y));
  const std::string divided = "--partition p=%level.off ";
  a.expect_refused(divided + "--region top@5,5,5", 2, {"'top' at (5, 5, 5)", "no cell", "another point"});
  a.expect_refused(divided + "--region top@0.5,0.5,0.8 --region other@0.4,0.5,0.9", 2,
                   {"'other'", "the same cell as 'top'", "leave one of them out"});
  a.expect_refused(divided + "--region top@0.5,0.5,0.8 --region top@0.4,0.5,0.1", 2,
                   {"two materials are called 'top'"});
  a.expect_refused("--region top@0.5,0.5,0.5", 2, {"'top'", "no cell", "another point"});
}

}  // namespace
}  // namespace tetwright::wrong_assemblies_test

#include "mesher/surface_input.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "common/error.h"
#include "test_surfaces.h"

namespace tetwright {
namespace {

constexpr double sphere_volume = 4 * std::numbers::pi / 3;

std::string refusal(const TriangleMesh& mesh) {
  try {
    close_surface(mesh, "scan.ply");
  } catch (const InputError& e) {
    EXPECT_EQ(e.status(), ExitStatus::bad_input);
    return e.what();
  }
  return "";
}

TEST(SurfaceInput, MergesASoupAndDropsWhatIsDegenerate) {
  const TriangleMesh box = make_box({0, 0, 0}, {1, 2, 3});
  TriangleMesh soup;
  for (const Triangle& t : box.triangles) {
    const auto first = static_cast<Index>(soup.points.size());
    for (Index v : t) soup.points.push_back(box.points[v]);
    soup.triangles.push_back({first, first + 1, first + 2});
    soup.triangles.push_back({first, first + 1, first});
    soup.triangles.push_back({first + 1, first + 2, first});  // once more
  }
  soup.points[0].x() = -0.0;
  soup.points.emplace_back(100, 100, 100);  // unused
  const ClosedSurface s = close_surface(soup, "soup");
  EXPECT_EQ(s.points.size(), 8u);
  EXPECT_EQ(s.triangles.size(), 12u);
  EXPECT_NEAR(s.volume, 6, 1e-12);
  EXPECT_NEAR(s.area, 22, 1e-12);
  EXPECT_EQ(s.high, Vec3(1, 2, 3));
}

TEST(SurfaceInput, NamesHoles) {
  TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1});
  box.triangles.pop_back();
  const std::string why = refusal(box);
  EXPECT_NE(why.find("scan.ply"), std::string::npos);
  EXPECT_NE(why.find("3 boundary edges"), std::string::npos) << why;
}

TEST(SurfaceInput, RefusesNonsense) {
  EXPECT_NE(refusal({}), "");
  TriangleMesh box = make_box({0, 0, 0}, {1, 1, 1});
  box.triangles[3][1] = 99;
  EXPECT_NE(refusal(box), "");
  box = make_box({0, 0, 0}, {1, 1, 1});
  box.points[2].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(box), "");
}

// Six triangles of the projective plane: every edge in two triangles, but one-sided.
TEST(SurfaceInput, RefusesOneSidedSurfaces) {
  TriangleMesh plane;
  plane.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}};
  plane.triangles = {{0, 1, 4}, {0, 1, 5}, {0, 2, 3}, {0, 2, 5}, {0, 3, 4},
                     {1, 2, 3}, {1, 2, 4}, {1, 3, 5}, {2, 4, 5}, {3, 4, 5}};
  EXPECT_NE(refusal(plane).find("wound"), std::string::npos) << refusal(plane);
}

TEST(SurfaceInput, TurnsComponentsOutwards) {
  const TriangleMesh sphere = make_sphere(1), far = make_sphere(1, {5, 0, 0});
  EXPECT_NEAR(close_surface(turned_over(sphere), "").volume, sphere_volume, 0.03);
  EXPECT_NEAR(close_surface(joined(sphere, turned_over(far)), "").volume, 2 * sphere_volume, 0.06);
  TriangleMesh mixed = sphere;
  for (std::size_t t = 0; t < mixed.triangles.size(); t += 3)
    std::swap(mixed.triangles[t][0], mixed.triangles[t][1]);
  EXPECT_NEAR(close_surface(mixed, "").volume, sphere_volume, 0.03);
}

TEST(SurfaceInput, KeepsCavities) {
  const TriangleMesh shell = joined(make_sphere(1), turned_over(make_sphere(0.5)));
  EXPECT_NEAR(close_surface(shell, "").volume, sphere_volume * 7 / 8, 0.03);
  EXPECT_NEAR(close_surface(turned_over(shell), "").volume, sphere_volume * 7 / 8, 0.03);
}

// Whichever triangle is wound wrongly, the majority of its component decides.
TEST(SurfaceInput, OneWrongTriangleTurnsNothingElse) {
  const TriangleMesh shell = joined(make_sphere(1), turned_over(make_sphere(0.5)));
  const std::size_t half = shell.triangles.size() / 2;
  for (std::size_t wrong : {std::size_t{0}, std::size_t{1}, half, half + 1}) {
    TriangleMesh mesh = shell;
    std::swap(mesh.triangles[wrong][0], mesh.triangles[wrong][1]);
    EXPECT_NEAR(close_surface(mesh, "").volume, sphere_volume * 7 / 8, 0.03) << wrong;
  }
}

}  // namespace
}  // namespace tetwright

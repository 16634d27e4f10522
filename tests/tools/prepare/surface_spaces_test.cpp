// SPDX-License-Identifier: Apache-2.0
#include "tools/prepare/surface_spaces.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/samples/samples.h"
#include "tests/common/io/expect_error.h"
#include "tetwright/mesher.h"
#include "tetwright/remesher.h"
#include "tetwright/simplify.h"

namespace tetwright::surface_spaces_test {
namespace {

const char* const lps = "left-posterior-superior";
const char* const ras = "right-anterior-superior";

TriangleMesh triangle(const std::string& space) {
  TriangleMesh surface{{{1, 2, 3}, {4, 2, 3}, {4, 6, 3}}, {{0, 1, 2}}};
  surface.space = space;
  return surface;
}

/// The texts of all findings, one a line.
std::string texts(const SurfaceSpaces& spaces) {
  std::string out;
  for (const Diagnostic& d : spaces.findings()) out += d.file + ": " + diagnostic_text(d) + "\n";
  return out;
}

TEST(SurfaceSpaces, AreBroughtIntoThatOfTheVolume) {
  SurfaceSpaces spaces("");
  spaces.begin_with(ras, "head.nii.gz");
  TriangleMesh lead = triangle(lps), plate = triangle(ras), screw = triangle("");
  spaces.add(lead, "lead.stl");
  spaces.add(plate, "plate.stl");
  spaces.add(screw, "screw.stl");
  EXPECT_EQ(lead.points[0], Vec3(-1, -2, 3));
  EXPECT_EQ(lead.space, ras);
  EXPECT_EQ(plate.points[0], Vec3(1, 2, 3));
  EXPECT_EQ(screw.points[0], Vec3(1, 2, 3));
  EXPECT_EQ(
      texts(spaces),
      "head.nii.gz: 1 surface in another space, left-posterior-superior: 'lead.stl' (brought into that of "
      "the first input, right-anterior-superior)\n"
      "head.nii.gz: 1 surface whose file names no space: 'screw.stl' (taken as it is, in that of the "
      "first input, right-anterior-superior)\n");
  EXPECT_EQ(spaces.findings()[1].code, DiagnosticCode::surface_space_unknown);
  EXPECT_NE(spaces.findings()[1].remedy.find("--surface-space"), std::string::npos);
}

TEST(SurfaceSpaces, TheHeaderCountsMoreThanTheOption) {
  SurfaceSpaces spaces(lps);
  spaces.begin_with(ras, "head.nii.gz");
  TriangleMesh lead = triangle(""), plate = triangle(ras);
  spaces.add(lead, "lead.stl");
  spaces.add(plate, "plate.stl");
  EXPECT_EQ(lead.points[0], Vec3(-1, -2, 3));
  EXPECT_EQ(plate.points[0], Vec3(1, 2, 3));
  EXPECT_EQ(
      texts(spaces),
      "head.nii.gz: 1 surface in another space, left-posterior-superior: 'lead.stl' (brought into that of "
      "the first input, right-anterior-superior)\n");
}

TEST(SurfaceSpaces, OfSurfacesAloneAreThatOfTheFirst) {
  SurfaceSpaces spaces("");
  TriangleMesh skin = triangle(lps), lead = triangle(ras), plate = triangle(ras);
  spaces.add(skin, "skin.ply");
  spaces.add(lead, "lead.ply");
  spaces.add(plate, "plate.ply");
  EXPECT_EQ(skin.points[0], Vec3(1, 2, 3));
  EXPECT_EQ(lead.points[0], Vec3(-1, -2, 3));
  EXPECT_EQ(spaces.space(), lps);
  EXPECT_EQ(
      texts(spaces),
      "skin.ply: 2 surfaces in another space, right-anterior-superior: 'lead.ply', 'plate.ply' (brought "
      "into that of the first input, left-posterior-superior)\n");
}

TEST(SurfaceSpaces, WithoutAnyHeaderNothingIsSaid) {
  SurfaceSpaces spaces("");
  TriangleMesh skin = triangle(""), lead = triangle("");
  spaces.add(skin, "skin.ply");
  spaces.add(lead, "lead.ply");
  EXPECT_EQ(texts(spaces), "");
  // One that names a space cannot be compared with the first one.
  TriangleMesh plate = triangle(ras);
  spaces.add(plate, "plate.ply");
  EXPECT_EQ(plate.points[0], Vec3(1, 2, 3));
  EXPECT_EQ(
      texts(spaces),
      "skin.ply: 1 surface in another space, right-anterior-superior: 'plate.ply' (taken as it is, since "
      "it cannot be compared with that of the first input, unknown)\n");
}

TEST(SurfaceSpaces, NothingIsSaidOfValuesInMemoryThatNameNone) {
  SurfaceSpaces spaces("");
  spaces.begin_with(ras, "m.vtu", true);
  TriangleMesh skin = triangle(""), lead = triangle(lps), plate = triangle("");
  spaces.add(skin, {"skin", skin});
  spaces.add(lead, {"lead", lead});
  EXPECT_EQ(lead.points[0], Vec3(-1, -2, 3));
  EXPECT_EQ(texts(spaces),
            "m.vtu: 1 surface in another space, left-posterior-superior: 'lead' (brought into that of the "
            "first input, right-anterior-superior)\n");
  // The option counts for them, too.
  SurfaceSpaces given(lps);
  given.begin_with(ras, "m.vtu", true);
  given.add(plate, {"plate", plate});
  EXPECT_EQ(plate.points[0], Vec3(-1, -2, 3));
}

TEST(SurfaceSpaces, OfSizesAreThatOfTheMesh) {
  const auto sizes_in = [](const std::string& space) -> std::shared_ptr<const SizeSource> {
    return surface_sizes(triangle(space), {1, 2, 3});
  };
  for (const std::string given : {"", lps}) {
    SurfaceSpaces spaces(given, "size field");
    spaces.begin_with(ras, "m.vtu", true);
    std::shared_ptr<const SizeSource> known = sizes_in(lps), unknown = sizes_in("");
    spaces.add(known, "sizes.vtk");
    spaces.add(unknown, "sizes.ply");
    EXPECT_EQ(known->at({-1, -2, 3})->distance, 0);
    EXPECT_EQ(unknown->at({-1, -2, 3})->distance == 0, !given.empty());
    EXPECT_EQ(
        texts(spaces),
        given.empty()
            ? "m.vtu: 1 size field in another space, left-posterior-superior: 'sizes.vtk' (brought into "
              "that of the first input, right-anterior-superior)\n"
              "m.vtu: 1 size field whose file names no space: 'sizes.ply' (taken as it is, in that of "
              "the first input, right-anterior-superior)\n"
            : "m.vtu: 2 size fields in another space, left-posterior-superior: 'sizes.vtk', 'sizes.ply' "
              "(brought into that of the first input, right-anterior-superior)\n");
  }
}

TEST(SurfaceSpaces, AMeshWithoutOneIsNamedByAnOption) {
  SurfaceSpaces spaces("");
  spaces.begin_with("", "m.msh", true);
  TriangleMesh lead = triangle(lps);
  spaces.add(lead, "lead.stl");
  EXPECT_EQ(lead.points[0], Vec3(1, 2, 3));
  EXPECT_NE(texts(spaces).find("unknown; --mesh-space LPS or RAS names it)"), std::string::npos)
      << texts(spaces);
  SurfaceSpaces given(lps);
  const std::string message = error_of<UsageError>([&] { given.begin_with("", "m.msh", true); });
  EXPECT_NE(message.find("name it by --mesh-space"), std::string::npos) << message;
}

TEST(SurfaceSpaces, AMeshThatNamesItsOwnDoesNotUseTheOption) {
  TetMesh mesh = std::get<TetMesh>(make_sample("two_materials"));
  PrepareReport report;
  EXPECT_EQ(space_of_tets(mesh, "m.msh", ras, report), ras);
  mesh.space = lps;
  EXPECT_EQ(space_of_tets(mesh, "m.vtu", lps, report), lps);
  EXPECT_EQ(space_of_tets(mesh, "m.vtu", "", report), lps);
  EXPECT_TRUE(report.diagnostics.empty());
  EXPECT_EQ(space_of_tets(mesh, "m.vtu", ras, report), lps);
  ASSERT_EQ(report.diagnostics.size(), 1u);
  EXPECT_EQ(report.diagnostics[0].code, DiagnosticCode::mesh_space_unused);
  EXPECT_EQ(
      diagnostic_text(report.diagnostics[0]),
      "mesh in left-posterior-superior, not right-anterior-superior (--mesh-space is not used, since the "
      "mesh names its space)");
}

TEST(SurfaceSpaces, ShortNamesInOptionsAreRefused) {
  PrepareOptions options;
  options.mesh_space = "LPS";
  const auto improved = [&] {
    (void)improve_mesh({"m", std::get<TetMesh>(make_sample("two_materials"))}, options);
  };
  EXPECT_NE(error_of<UsageError>(improved).find("give left-posterior-superior or right-anterior-superior"),
            std::string::npos);
  options.mesh_space = lps;
  EXPECT_EQ(improve_mesh({"m", std::get<TetMesh>(make_sample("two_materials"))}, options).mesh.space, lps);
}

TEST(SurfaceSpaces, AnOptionForAVolumeWithoutASpaceIsRefused) {
  for (const char* space : {"", "scanner-xyz"}) {
    SurfaceSpaces spaces(lps);
    const std::string message = error_of<UsageError>([&] { spaces.begin_with(space, "head.nrrd"); });
    EXPECT_NE(message.find("--surface-space"), std::string::npos) << message;
    EXPECT_NE(message.find("head.nrrd"), std::string::npos) << message;
  }
}

TEST(SpacesOfMeshes, AreThoseOfLabelsAndSurfaces) {
  LabelVolume volume;
  volume.size = {6, 6, 6};
  volume.space = ras;
  for (int z = 0; z < 6; ++z)
    for (int y = 0; y < 6; ++y)
      for (int x = 0; x < 6; ++x) volume.labels.push_back(std::max({x, y, z}) < 5 && x * y * z > 0 ? 1 : 0);
  const LabelInput labels =
      make_label_input(std::make_unique<MemoryLabelSource>(std::move(volume)), "v.nrrd", {}, nullptr);
  EXPECT_EQ(mesh_labels(labels, {}, nullptr).mesh.space, ras);
  auto ball = std::get<TriangleMesh>(make_sample("sphere"));
  ball.space = lps;
  MesherOptions options;
  options.resolution = 8;
  EXPECT_EQ(mesh_surfaces(make_mesher_input({{"ball", 1, ball, "ball.ply"}}), options, nullptr).mesh.space,
            lps);
}

TEST(SpacesOfMeshes, AreKeptByTheSimplifier) {
  TetMesh mesh = std::get<TetMesh>(make_sample("two_materials"));
  mesh.space = ras;
  EXPECT_EQ(improve(mesh, {}).space, ras);
  SimplifyOptions options;
  options.target_tets = mesh.tets.size();
  EXPECT_EQ(simplify(mesh, options).space, ras);
  CoarsenOptions coarser;
  coarser.target_tets = static_cast<double>(mesh.tets.size());
  EXPECT_EQ(coarsen(mesh, coarser).space, ras);
  EXPECT_EQ(Remesher(mesh).mesh().space, ras);
}

}  // namespace
}  // namespace tetwright::surface_spaces_test

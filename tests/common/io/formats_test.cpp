// SPDX-License-Identifier: Apache-2.0
#include "tetwright/io.h"

#include "common/io/encodings/netcdf_image.h"
#include "common/io/volumes/volume_formats.h"
#include "tests/common/io/expect_error.h"
#include "tests/common/io/file_test.h"
#include "tests/common/io/tricky_meshes.h"
#include "tests/common/small_meshes.h"

namespace tetwright::formats_test {
namespace {

using Formats = FileTest;

TEST_F(Formats, KindsByExtension) {
  EXPECT_EQ(file_kind("a/b.PLY"), FileKind::surface);
  EXPECT_EQ(file_kind("b.StL"), FileKind::surface);
  EXPECT_EQ(file_kind("x.off"), FileKind::surface);
  EXPECT_EQ(file_kind("x.y.obj"), FileKind::surface);
  EXPECT_EQ(file_kind("x.VTU"), FileKind::tet_mesh);
  EXPECT_EQ(file_kind("x.msh"), FileKind::tet_mesh);
  EXPECT_EQ(file_kind("x.mesh"), FileKind::tet_mesh);
  for (const char* name : {"x.vtk", "x.NODE", "x.ele", "x.msh"}) {
    EXPECT_EQ(file_kind(name), FileKind::tet_mesh);
    EXPECT_EQ(file_kind(name, FileUse::write), FileKind::tet_mesh);
  }
  EXPECT_EQ(file_kind("x.feb"), FileKind::unknown);
  EXPECT_EQ(known_extensions(FileKind::tet_mesh),
            ".vtu .pvtu .msh .mesh .meshb .vtk .inp .bdf .xdmf .node .ele");
  EXPECT_EQ(known_extensions(FileKind::tet_mesh, FileUse::write),
            ".vtu .pvtu .vtkhdf .msh .mesh .meshb .vtk .inp .bdf .feb .exo .e .ex2 .xdmf .node .ele .usda");
  for (const char* name : {"", "ply", "a/.ply/b", "x.vtl", "x.", "x.ply "})
    EXPECT_EQ(file_kind(name), FileKind::unknown);
}

TEST_F(Formats, VolumesAndTheirCompoundExtensions) {
  for (const char* name :
       {"a.nrrd", "a.NHDR", "a.mhd", "a.mha", "a.nii", "b/a.x.nii.GZ", "a.inr", "a.inr.gz", "a.zarr",
        "a.ome.ZARR/0", "b/a.zarr/labels/cells/", "a.TIF", "a.tiff", "a.h5", "a.hdf5", "b/a.H5:/x/y.z"})
    EXPECT_EQ(file_kind(name), FileKind::volume) << name;
  for (const char* name :
       {"a.gz", "a.vtu.gz", "nii.gz", "a.nii.gz.x", "zarr", "a.zarr.x", "a.h5:x", "a.h5/x"})
    EXPECT_EQ(file_kind(name), FileKind::unknown) << name;
  EXPECT_EQ(file_kind("a.zarr/b.ply"), FileKind::surface);
  EXPECT_EQ(volume_path("a.zarr/b.nrrd").extension, ".nrrd");
  EXPECT_EQ(volume_path("a.zarr/b.c").extension, ".zarr");
  EXPECT_EQ(file_kind("a.nrrd", FileUse::write), FileKind::volume);
  EXPECT_EQ(file_kind("a.nii.gz", FileUse::write), FileKind::unknown);
  EXPECT_EQ(
      known_extensions(FileKind::volume),
      ".nrrd .nhdr .mhd .mha .nii .nii.gz .hdr .img .inr .inr.gz .zarr .tif .tiff .dcm .h5 .hdf5 .npy .raw");
  EXPECT_EQ(known_extensions(FileKind::volume, FileUse::write), ".nrrd");
  EXPECT_EQ(file_stem("a/b.c/liver.NII.gz"), "liver");
  EXPECT_EQ(file_stem("liver.v2.inr.gz"), "liver.v2");
  EXPECT_EQ(file_stem("a/bone.stl"), "bone");
  EXPECT_EQ(file_stem("bone"), "bone");
  EXPECT_EQ(file_stem(".stl"), ".stl");
  const std::string message =
      error_of<UsageError>([&] { check_output_path(path("x.nii.gz"), FileKind::volume); });
  EXPECT_NE(message.find("\".nii.gz\" can be read, not written, for a volume of labels; supported: .nrrd"),
            std::string::npos)
      << message;
}

TEST_F(Formats, VolumesThroughFiles) {
  LabelVolume volume;
  volume.size = {1, 2, 3};
  volume.labels = {0, 1, 2, 3, 4, 500};
  write_label_volume(volume, path("a.nrrd"));
  EXPECT_EQ(read_label_volume(path("a.nrrd")).labels, volume.labels);
  put(path("h.mhd"), "NDims = 3\nDimSize = 1 1 2\nElementType = MET_UCHAR\nElementDataFile = h.raw\n");
  EXPECT_NE(error_of<InputError>([&] { (void)read_label_volume(path("h.mhd")); }).find(path("h.raw")),
            std::string::npos);
  put(path("h.raw"), "\1\2");
  EXPECT_EQ(read_label_volume(path("h.mhd")).labels, (std::vector<MaterialTag>{1, 2}));
}

TEST_F(Formats, RoundTripThroughFiles) {
  for (const char* name : {"a.vtu", "a.msh", "a.mesh"}) {
    write_tet_mesh(tricky_measurable_tets(), path(name));
    const TetMesh back = read_tet_mesh(path(name)).mesh;
    EXPECT_TRUE(same_bits(back.points, tricky_measurable_tets().points)) << name;
    EXPECT_EQ(back.tets, tricky_measurable_tets().tets);
    EXPECT_EQ(back.materials, tricky_measurable_tets().materials);
  }
  for (const char* name : {"a.off", "a.obj", "a.ply"}) {
    write_surface(tricky_surface(), path(name));
    EXPECT_TRUE(same_bits(read_surface(path(name)).points, tricky_surface().points)) << name;
  }
  EXPECT_EQ(files(), 6u);
}

TEST_F(Formats, EveryFormatOfTetMeshesIsWritten) {
  for (const TetFormatInfo& format : written_tet_formats()) {
    const std::string file = path("m" + format.extension);
    if (format.name == "exodus" && !has_netcdf()) {
      EXPECT_NE(error_of<UsageError>([&] {
                  check_output_path(file, FileKind::tet_mesh);
                }).find("the netCDF library"),
                std::string::npos);
      continue;
    }
    write_tet_mesh(format.single_precision ? one_tet() : tricky_measurable_tets(), file, nullptr,
                   format.name);
    EXPECT_EQ(written_tet_format(file, format.name).name, format.name);
    if (file_kind(file) == FileKind::unknown) continue;  // can only be written
    EXPECT_EQ(read_tet_mesh(file).mesh.tets.size(), tricky_measurable_tets().tets.size()) << format.name;
  }
  EXPECT_EQ(files_of_tet_mesh("a/b.ELE"), (std::vector<std::string>{"a/b.NODE", "a/b.ELE", "a/b.FACE"}));
  EXPECT_EQ(files_of_tet_mesh("a/b.x", "vtu"), (std::vector<std::string>{"a/b.x"}));
  EXPECT_TRUE(written_tet_format("a.bdf").second_order);
  EXPECT_FALSE(written_tet_format("a.node").second_order);
  const std::string message = error_of<UsageError>([] { (void)written_tet_format("a.msh", "msh5"); });
  EXPECT_NE(message.find("no format \"msh5\""), std::string::npos) << message;
  EXPECT_NE(message.find("vtu pvtu vtkhdf msh22 msh41 msh41-binary"), std::string::npos) << message;
}

TEST_F(Formats, SeveralFilesHaveExtensionsOfTheirOwn) {
  for (const auto& [name, format] : {std::pair{"m.vtk", "xdmf"}, {"m.h5", "xdmf"}, {"m.xdmf", "tetgen"}}) {
    const std::string message =
        error_of<UsageError>([&, n = name, f = format] { write_tet_mesh(one_tet(), path(n), nullptr, f); });
    EXPECT_NE(message.find(std::string(name) + ": " + format + " writes several files"), std::string::npos)
        << message;
  }
  EXPECT_EQ(files(), 0u);
  write_tet_mesh(one_tet(), path("m"), nullptr, "tetgen");
  EXPECT_EQ(files(), 3u);
}

TEST_F(Formats, MeshesThatNothingCanBeComputedForAreRefused) {
  TetMesh mesh = one_tet();
  for (const double scale : {1e300, 1e150, 1e-60, 1e-300, 1e49, 1e-49}) {
    for (std::size_t i = 0; i < 4; ++i) mesh.points[i] = one_tet().points[i] * scale;
    write_tet_mesh(mesh, path("m.vtu"));
    if (scale == 1e49 || scale == 1e-49) {
      EXPECT_EQ(read_tet_mesh(path("m.vtu")).mesh.points, mesh.points);
      continue;
    }
    const std::string message = error_of<InputError>([&] { (void)read_tet_mesh(path("m.vtu")); });
    EXPECT_NE(message.find("m.vtu: a size of "), std::string::npos) << message;
    EXPECT_NE(message.find("scale the mesh to between 1e-50 and 1e50"), std::string::npos) << message;
  }
}

TEST_F(Formats, AFormatThatAnotherKindHas) {
  const auto refusal = [&](FileKind kind, const char* format) {
    return error_of<UsageError>([&] { check_output_path("-", kind, format); });
  };
  EXPECT_EQ(refusal(FileKind::volume, "ply"),
            "there is no format \"ply\" for a volume of labels; supported: .nrrd");
  EXPECT_EQ(
      refusal(FileKind::surface, ".glb"),
      "the format \".glb\" can be read, not written, for a surface; supported: .ply .obj .stl .off .vtp");
}

TEST_F(Formats, GroupsOfSurfaces) {
  TriangleMesh surface{one_tet().points, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}, {}, {}};
  surface.groups = {{3, "in let"}, {4, "wall"}};
  surface.triangle_groups = {0, 0, 1, 1};
  const auto names = [&](const char* name) {
    write_surface(surface, path(name));
    const TriangleMesh back = read_surface(path(name));
    EXPECT_EQ(back.triangle_groups, surface.triangle_groups) << name;
    return back.groups;
  };
  EXPECT_EQ(names("a.obj"), (std::vector<SurfaceRegion>{{0, "in_let"}, {0, "wall"}}));
  EXPECT_EQ(names("a.stl"), (std::vector<SurfaceRegion>{{0, "in_let"}, {0, "wall"}}));
  EXPECT_EQ(names("a.ply"), (std::vector<SurfaceRegion>{{3, "in let"}, {4, "wall"}}));
  EXPECT_EQ(names("a.vtp"), (std::vector<SurfaceRegion>{{3, "in let"}, {4, "wall"}}));
  write_surface(surface, path("a.off"));
  EXPECT_TRUE(read_surface(path("a.off")).groups.empty());
}

TEST_F(Formats, UnknownExtensions) {
  const std::string in = error_of<UsageError>([&] { (void)read_surface(path("x.xyz")); });
  EXPECT_NE(in.find("\".xyz\" for a surface; supported: .ply .obj .stl .off"), std::string::npos) << in;
  const std::string out = error_of<UsageError>([&] { check_output_path(path("x")); });
  EXPECT_NE(out.find("no extension for a tet mesh; supported: .vtu .pvtu .vtkhdf .msh .mesh"),
            std::string::npos)
      << out;
  // Formats of surfaces cannot hold a tet mesh.
  (void)error_of<UsageError>([&] { check_output_path(path("x.ply")); });
  (void)error_of<UsageError>([&] { check_output_path(path("x.vtu"), FileKind::surface); });
  (void)error_of<UsageError>([&] { write_tet_mesh(tricky_measurable_tets(), path("x.ply")); });
  (void)error_of<UsageError>([&] { (void)read_tet_mesh(path("x.ply")); });
  EXPECT_EQ(files(), 0u);
}

TEST_F(Formats, MissingFiles) {
  EXPECT_NE(error_of<InputError>([&] { (void)read_surface(path("no.ply")); }).find("no.ply"),
            std::string::npos);
  (void)error_of<OutputError>([&] { check_output_path(path("no/a.vtu")); });
  std::filesystem::create_directory(path("a.ply"));
  (void)error_of<InputError>([&] { (void)read_surface(path("a.ply")); });
}

TEST_F(Formats, EitherNameOfAPairWillDo) {
  put(path("a.node"), "4 3 0 0\n0 0 0 0\n1 1 0 0\n2 0 1 0\n3 0 0 1\n");
  EXPECT_NE(error_of<InputError>([&] { (void)read_tet_mesh(path("a.node")); }).find("a.ele"),
            std::string::npos);
  put(path("a.ele"), "1 4 1\n0 0 1 2 3 7\n");
  for (const char* name : {"a.node", "a.ele"}) {
    const ReadTetMesh read = read_tet_mesh(path(name));
    EXPECT_EQ(read.mesh.tets, (std::vector<Tet>{{0, 1, 2, 3}}));
    EXPECT_EQ(read.mesh.materials, (std::vector<MaterialTag>{7}));
  }
  std::filesystem::rename(path("a.node"), path("B.NODE"));
  std::filesystem::rename(path("a.ele"), path("B.ELE"));
  EXPECT_EQ(read_tet_mesh(path("B.ELE")).mesh.tets.size(), 1u);
}

TEST_F(Formats, OptionsReachTheReader) {
  TetMesh mesh = tricky_measurable_tets();
  mesh.cell_fields = {{"region", 1, true, {4, 5, 6}}};
  write_tet_mesh(mesh, path("a.vtu"));
  const ReadTetMesh read = read_tet_mesh(path("a.vtu"), {.material_field = "region"});
  EXPECT_EQ(read.material_field, "region");
  EXPECT_EQ(read.mesh.materials, (std::vector<MaterialTag>{4, 5, 6}));
}

TEST_F(Formats, MessagesNameTheFile) {
  put(path("bad.off"), "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  const std::string message = error_of<InputError>([&] { (void)read_surface(path("bad.off")); });
  EXPECT_EQ(message.find(path("bad.off") + ": line 6: "), 0u) << message;
}

}  // namespace
}  // namespace tetwright::formats_test

// SPDX-License-Identifier: Apache-2.0
#include "common/io/tets/tet_formats.h"

#include <filesystem>
#include <optional>
#include <set>

#include "common/files/file_names.h"
#include "common/io/elements/vtk_cells.h"
#include "common/io/elements/vtk_pieces.h"
#include "common/io/encodings/hdf5_file.h"
#include "common/io/encodings/hdf5_image.h"
#include "common/io/encodings/netcdf_image.h"
#include "common/io/tets/abaqus.h"
#include "common/io/tets/exodus.h"
#include "common/io/tets/febio.h"
#include "common/io/tets/medit.h"
#include "common/io/tets/medit_binary.h"
#include "common/io/tets/msh.h"
#include "common/io/tets/msh4_pieces.h"
#include "common/io/tets/msh_data.h"
#include "common/io/tets/msh_groups.h"
#include "common/io/tets/nastran.h"
#include "common/io/tets/pvtu.h"
#include "common/io/tets/tetgen.h"
#include "common/io/tets/usd.h"
#include "common/io/tets/vtk.h"
#include "common/io/tets/vtkhdf.h"
#include "common/io/tets/vtu.h"
#include "common/io/tets/xdmf.h"
#include "common/io/volumes/data_file.h"

namespace tetwright {

namespace {

ReadTetMesh read_xdmf_files(const std::string& path, const ReadTetMeshOptions& options) {
  const std::string file = with_extension(path, "_facets.xdmf");
  std::string bytes;
  std::optional<NamedBytes> facets;
  if (std::error_code error; std::filesystem::exists(file, error))
    facets = NamedBytes{bytes = read_whole_file(file), file};
  return read_xdmf(read_whole_file(path), path, read_whole_file, options, facets);
}

ReadTetMesh read_pvtu_files(const std::string& path, const ReadTetMeshOptions& options) {
  return read_pvtu(path, options, read_whole_file);
}

/// Reads the .node, .ele and, if it exists, .face file with the same name.
/// \param path path of the .node or .ele file
ReadTetMesh read_tetgen_files(const std::string& path, const ReadTetMeshOptions& options) {
  const auto name = [&](const char* extension) {
    return extension_of(path) == extension ? path : with_extension(path, extension);
  };
  const std::string node = name(".node"), ele = name(".ele"), face = name(".face");
  const std::string node_bytes = read_whole_file(node), ele_bytes = read_whole_file(ele);
  std::string face_bytes;
  std::optional<NamedBytes> faces;
  if (std::error_code error; std::filesystem::exists(face, error))
    faces = NamedBytes{face_bytes = read_whole_file(face), face};
  return read_tetgen({node_bytes, node}, {ele_bytes, ele}, faces, options);
}

template <bool binary>
void write_msh_piece(const MeshPiece& piece, const DividedMesh& whole, const ByteSink& sink) {
  write_msh41_piece(piece, whole, binary, sink);
}

std::vector<std::string> only_this_file(const std::string& path, PartNumber /*parts*/) { return {path}; }

template <void (*write)(const MeshToWrite&, const ByteSink&)>
void write_alone(const MeshToWrite& mesh, const std::string& /*first*/, const ByteSink& sink) {
  write(mesh, sink);
}

template <std::string (*write)(const MeshToWrite&)>
void write_as_one(const MeshToWrite& mesh, const std::string& /*first*/, const ByteSink& sink) {
  sink(write(mesh));
}

template <void (*add)(const MeshToWrite&, Hdf5Writer&)>
void write_image(const MeshToWrite& mesh, const std::string& /*first*/, const ByteSink& sink) {
  Hdf5Image image;
  add(mesh, image);
  sink(image.bytes());
}

const std::vector<WrittenFile>& xdmf_files() {
  static const std::vector<WrittenFile> files{
      {".h5", write_image<add_xdmf_numbers>, add_xdmf_numbers},
      {".xdmf", write_xdmf_mesh},
      {"_facets.h5", write_image<add_xdmf_facet_numbers>, add_xdmf_facet_numbers},
      {"_facets.xdmf", write_xdmf_facets}};
  return files;
}

std::vector<std::string> files_of_xdmf(const std::string& path, PartNumber /*parts*/) {
  std::vector<std::string> files;
  for (const WrittenFile& file : xdmf_files()) files.push_back(with_extension(path, file.extension));
  return files;
}

/// Writes the mesh as one, with the tets of each part in succession.
void write_xdmf_parts(const MeshPieces& pieces, const std::string& path, OutputFiles& files,
                      const FileSharing* share) {
  const OrderedMesh ordered = ordered_by_part(pieces);
  const MeshToWrite mesh(ordered.mesh, ordered.midside ? &*ordered.midside : nullptr);
  const std::vector<std::string> paths = files_of_xdmf(path, pieces.whole().parts);
  const std::string first = std::filesystem::path(paths.front()).filename().string();
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const WrittenFile& file = xdmf_files()[i];
    if (file.add)
      write_hdf5_file(
          paths[i], files, [&](Hdf5Writer& writer) { file.add(mesh, writer); }, share);
    else
      files.write(paths[i], [&](const ByteSink& sink) { file.write(mesh, first, sink); });
  }
}

template <NameRules (*rules)()>
MeshParts parts_by(const TetMesh& mesh) {
  return names_of_parts(mesh, rules());
}
constexpr auto printable_parts = parts_by<printable_names>;

TetFormat exodus_with(const char* extension) {
  return {.extension = extension,
          .name = "exodus",
          .write = {{extension, write_alone<write_exodus>}},
          .parts = parts_by<exodus_names>,
          .field_name = exodus_name,
          .second_order = true,
          .missing_library = has_netcdf() ? nullptr : "the netCDF library"};
}

/// Names as .vtu has them, and those of all surfaces.
MeshParts vtk_piece_parts(const TetMesh& mesh) {
  MeshParts parts = names_of_parts(mesh, printable_names());
  parts.materials = vtu_materials(mesh);
  return parts;
}

}  // namespace

const std::vector<TetFormat>& tet_formats() {
  static const std::vector<WrittenFile> tetgen{{".node", write_alone<write_tetgen_node>},
                                               {".ele", write_alone<write_tetgen_ele>},
                                               {".face", write_alone<write_tetgen_face>}};
  static const std::vector<std::string> own_vtk_points{vtk_node_numbers, vtk_ghosts},
      own_vtk_cells{"material", vtk_face_groups, vtk_cell_numbers, vtk_ghosts};
  static const std::vector<TetFormat> formats{
      {.extension = ".vtu",
       .name = "vtu",
       .read = read_vtu,
       .write = {{".vtu", write_alone<write_vtu>}},
       .parts = vtu_parts,
       .own_cell_fields = {"material"},
       .surfaces = false,
       .second_order = true,
       .wedges = true},
      {.extension = ".pvtu",
       .name = "pvtu",
       .read_files = read_pvtu_files,
       .part_files = {.names = files_of_pvtu,
                      .write_piece = write_vtu_piece,
                      .write_index = write_pvtu_index,
                      .own_point_fields = own_vtk_points,
                      .own_cell_fields = own_vtk_cells},
       .parts = vtk_piece_parts,
       .own_cell_fields = own_vtk_cells,
       .second_order = true},
      {.extension = ".vtkhdf",
       .name = "vtkhdf",
       .part_files = {.names = only_this_file,
                      .write = write_vtkhdf,
                      .own_point_fields = own_vtk_points,
                      .own_cell_fields = own_vtk_cells},
       .parts = vtk_piece_parts,
       .own_cell_fields = own_vtk_cells,
       .field_name = vtkhdf_name,
       .second_order = true},
      {.extension = ".msh",
       .name = "msh22",
       .read = read_msh,
       .write = {{".msh", write_as_one<write_msh>}},
       .parts = msh_parts,
       .field_name = msh_name,
       .second_order = true,
       .wedges = true,
       .bins = BinsAs::materials},
      {.extension = ".msh",
       .name = "msh41",
       .read = read_msh,
       .write = {{".msh", write_alone<write_msh41>}},
       .part_files = {.names = files_of_msh_pieces, .write_piece = write_msh_piece<false>},
       .parts = msh_parts,
       .field_name = msh_name,
       .second_order = true,
       .wedges = true,
       .bins = BinsAs::sets},
      {.extension = ".msh",
       .name = "msh41-binary",
       .read = read_msh,
       .write = {{".msh", write_alone<write_msh41_binary>}},
       .part_files = {.names = files_of_msh_pieces, .write_piece = write_msh_piece<true>},
       .parts = msh_parts,
       .field_name = msh_name,
       .second_order = true,
       .wedges = true,
       .bins = BinsAs::sets},
      {.extension = ".mesh",
       .name = "medit",
       .read = read_medit,
       .write = {{".mesh", write_as_one<write_medit>}},
       .parts = medit_parts,
       .point_fields = false,
       .names = false,
       .fields = false},
      {.extension = ".meshb",
       .name = "medit-binary",
       .read = read_medit_binary,
       .write = {{".meshb", write_alone<write_medit_binary>}},
       .parts = medit_parts,
       .point_fields = false,
       .names = false,
       .patch_names = false,
       .fields = false},
      {.extension = ".vtk",
       .name = "vtk",
       .read = read_vtk,
       .write = {{".vtk", write_alone<write_vtk>}},
       .parts = printable_parts,
       .own_cell_fields = {"material", vtk_surface_field},
       .second_order = true,
       .wedges = true},
      {.extension = ".inp",
       .name = "abaqus",
       .read = read_abaqus,
       .write = {{".inp", write_alone<write_abaqus>}},
       .parts = parts_by<abaqus_names>,
       .point_fields = false,
       .fields = false,
       .second_order = true,
       .wedges = true,
       .bins = BinsAs::sets,
       .moduli = true},
      {.extension = ".bdf",
       .name = "nastran",
       .read = read_nastran,
       .write = {{".bdf", write_alone<write_nastran>}},
       .parts = parts_by<nastran_names>,
       .point_fields = false,
       .fields = false,
       .second_order = true,
       .bins = BinsAs::materials_and_sets,
       .moduli = true},
      {.extension = ".feb",
       .name = "febio",
       .write = {{".feb", write_alone<write_febio>}},
       .parts = parts_by<febio_names>,
       .fields = false,
       .second_order = true,
       .bins = BinsAs::materials_and_sets,
       .moduli = true},
      exodus_with(".exo"),
      exodus_with(".e"),
      exodus_with(".ex2"),
      {.extension = ".xdmf",
       .name = "xdmf",
       .read_files = read_xdmf_files,
       .write = xdmf_files(),
       .part_files = {.names = files_of_xdmf,
                      .write = write_xdmf_parts,
                      .own_cell_fields = {"material", partition_field}},
       .parts = printable_parts,
       .own_cell_fields = {"material"},
       .second_order = true,
       .wedges = true},
      {.extension = ".node",
       .name = "tetgen",
       .read_files = read_tetgen_files,
       .write = tetgen,
       .parts = printable_parts,
       .fields = false},
      {.extension = ".ele",
       .name = "tetgen",
       .read_files = read_tetgen_files,
       .write = tetgen,
       .parts = printable_parts,
       .fields = false},
      {.extension = ".usda",
       .name = "usd",
       .write = {{".usda", write_alone<write_usd>}},
       .parts = usd_parts,
       .fields = false,
       .inner_surfaces = false,
       .single_precision = true}};
  return formats;
}

TetFormatInfo info_of(const TetFormat& format) {
  return {format.name,
          format.extension,
          format.names,
          format.surfaces,
          format.patch_names,
          format.fields,
          format.second_order,
          format.wedges,
          static_cast<bool>(format.part_files),
          format.bins,
          format.moduli,
          format.inner_surfaces,
          format.single_precision};
}

void drop_names_of_cohesive(TetMesh& mesh) {
  if (mesh.wedges.empty()) return;
  const std::set<std::int64_t> used = tags_of(mesh.materials);
  std::erase_if(mesh.material_names, [&](const auto& named) { return !used.contains(named.first); });
}

}  // namespace tetwright

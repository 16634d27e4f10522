#include "common/formats/formats.h"

#include <array>
#include <cctype>
#include <filesystem>

#include "common/error.h"
#include "common/formats/atomic_file.h"
#include "common/formats/medit.h"
#include "common/formats/msh.h"
#include "common/formats/obj.h"
#include "common/formats/off.h"
#include "common/formats/ply.h"
#include "common/formats/stl.h"
#include "common/formats/tetgen.h"
#include "common/formats/text_scanner.h"
#include "common/formats/vtk.h"
#include "common/formats/vtu.h"

namespace tetwright {

namespace {

struct SurfaceFormat {
  const char* extension;
  TriangleMesh (*read)(std::string_view bytes, const std::string& name);
  std::string (*write)(const TriangleMesh& mesh);
};
constexpr std::array<SurfaceFormat, 4> surface_formats{{{".ply", read_ply, write_ply},
                                                        {".obj", read_obj, write_obj},
                                                        {".stl", read_stl, write_stl},
                                                        {".off", read_off, write_off}}};

template <ReadTetMesh (*read)(std::string_view, const std::string&, const ReadTetMeshOptions&)>
ReadTetMesh read_one_file(const std::string& path, const ReadTetMeshOptions& options) {
  return read(read_whole_file(path), path, options);
}

/// `path` with another extension, in upper case if its own is.
std::string with_extension(const std::string& path, std::string extension) {
  const std::string own = std::filesystem::path(path).extension().string();
  if (own.size() > 1 && std::isupper(static_cast<unsigned char>(own[1])))
    for (char& c : extension) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return std::filesystem::path(path).replace_extension(extension).string();
}

ReadTetMesh read_node_with_ele(const std::string& path, const ReadTetMeshOptions& options) {
  const std::string ele = with_extension(path, ".ele");
  return read_tetgen(read_whole_file(path), path, read_whole_file(ele), ele, options);
}

ReadTetMesh read_ele_with_node(const std::string& path, const ReadTetMeshOptions& options) {
  const std::string node = with_extension(path, ".node");
  return read_tetgen(read_whole_file(node), node, read_whole_file(path), path, options);
}

struct TetFormat {
  const char* extension;
  ReadTetMesh (*read)(const std::string& path, const ReadTetMeshOptions& options);
  std::string (*write)(const TetMesh& mesh);  ///< null: the format is only read
};
constexpr std::array<TetFormat, 6> tet_formats{{{".vtu", read_one_file<read_vtu>, write_vtu},
                                                {".msh", read_one_file<read_msh>, write_msh},
                                                {".mesh", read_one_file<read_medit>, write_medit},
                                                {".vtk", read_one_file<read_vtk>, nullptr},
                                                {".node", read_node_with_ele, nullptr},
                                                {".ele", read_ele_with_node, nullptr}}};

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

template <class Format>
bool is_for(const Format& format, FileUse use) {
  return use == FileUse::read || format.write != nullptr;
}

/// The format of a file's extension; null if there is none.
template <class Formats>
const typename Formats::value_type* find_format(const Formats& formats, const std::string& path,
                                                FileUse use) {
  const std::string extension = extension_of(path);
  for (const auto& format : formats)
    if (extension == format.extension && is_for(format, use)) return &format;
  return nullptr;
}

template <class Formats>
const typename Formats::value_type& need_format(const Formats& formats, const std::string& path,
                                                FileKind kind, FileUse use) {
  if (const auto* format = find_format(formats, path, use)) return *format;
  const std::string extension = extension_of(path);
  const bool only_read = find_format(formats, path, FileUse::read) != nullptr;
  throw UsageError(path + ": " +
                   (extension.empty() ? "no extension"
                    : only_read       ? "extension " + in_quotes(extension) + " can be read, not written,"
                                      : "unknown extension " + in_quotes(extension)) +
                   " for a " + (kind == FileKind::surface ? "surface" : "tet mesh") + "; known are " +
                   known_extensions(kind, use));
}

}  // namespace

FileKind file_kind(const std::string& path, FileUse use) {
  if (find_format(surface_formats, path, use)) return FileKind::surface;
  if (find_format(tet_formats, path, use)) return FileKind::tet_mesh;
  return FileKind::unknown;
}

std::string known_extensions(FileKind kind, FileUse use) {
  std::string out;
  const auto add = [&](const auto& formats) {
    for (const auto& format : formats) {
      if (!is_for(format, use)) continue;
      if (!out.empty()) out += ' ';
      out += format.extension;
    }
  };
  if (kind != FileKind::tet_mesh) add(surface_formats);
  if (kind != FileKind::surface) add(tet_formats);
  return out;
}

TriangleMesh read_surface(const std::string& path) {
  const SurfaceFormat& format = need_format(surface_formats, path, FileKind::surface, FileUse::read);
  return format.read(read_whole_file(path), path);
}

ReadTetMesh read_tet_mesh(const std::string& path, const ReadTetMeshOptions& options) {
  return need_format(tet_formats, path, FileKind::tet_mesh, FileUse::read).read(path, options);
}

void write_surface(const TriangleMesh& mesh, const std::string& path) {
  const SurfaceFormat& format = need_format(surface_formats, path, FileKind::surface, FileUse::write);
  write_file_atomically(path, format.write(mesh));
}

void write_tet_mesh(const TetMesh& mesh, const std::string& path) {
  const TetFormat& format = need_format(tet_formats, path, FileKind::tet_mesh, FileUse::write);
  write_file_atomically(path, format.write(mesh));
}

void check_output_path(const std::string& path, FileKind kind) {
  if (kind == FileKind::surface)
    (void)need_format(surface_formats, path, kind, FileUse::write);
  else
    (void)need_format(tet_formats, path, kind, FileUse::write);
  check_output_file(path);
}

}  // namespace tetwright

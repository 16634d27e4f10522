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
#include "common/formats/text_scanner.h"
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

struct TetFormat {
  const char* extension;
  ReadTetMesh (*read)(std::string_view bytes, const std::string& name);
  std::string (*write)(const TetMesh& mesh);
};
constexpr std::array<TetFormat, 3> tet_formats{
    {{".vtu", read_vtu, write_vtu}, {".msh", read_msh, write_msh}, {".mesh", read_medit, write_medit}}};

std::string extension_of(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

/// The format of a file's extension; null if there is none.
template <class Formats>
const typename Formats::value_type* find_format(const Formats& formats, const std::string& path) {
  const std::string extension = extension_of(path);
  for (const auto& format : formats)
    if (extension == format.extension) return &format;
  return nullptr;
}

template <class Formats>
const typename Formats::value_type& need_format(const Formats& formats, const std::string& path,
                                                FileKind kind) {
  if (const auto* format = find_format(formats, path)) return *format;
  const std::string extension = extension_of(path);
  throw UsageError(path + ": " +
                   (extension.empty() ? "no extension" : "unknown extension " + in_quotes(extension)) +
                   " for a " + (kind == FileKind::surface ? "surface" : "tet mesh") + "; known are " +
                   known_extensions(kind));
}

}  // namespace

FileKind file_kind(const std::string& path) {
  if (find_format(surface_formats, path)) return FileKind::surface;
  if (find_format(tet_formats, path)) return FileKind::tet_mesh;
  return FileKind::unknown;
}

std::string known_extensions(FileKind kind) {
  std::string out;
  const auto add = [&](const auto& formats) {
    for (const auto& format : formats) {
      if (!out.empty()) out += ' ';
      out += format.extension;
    }
  };
  if (kind != FileKind::tet_mesh) add(surface_formats);
  if (kind != FileKind::surface) add(tet_formats);
  return out;
}

TriangleMesh read_surface(const std::string& path) {
  const SurfaceFormat& format = need_format(surface_formats, path, FileKind::surface);
  return format.read(read_whole_file(path), path);
}

ReadTetMesh read_tet_mesh(const std::string& path) {
  const TetFormat& format = need_format(tet_formats, path, FileKind::tet_mesh);
  return format.read(read_whole_file(path), path);
}

void write_surface(const TriangleMesh& mesh, const std::string& path) {
  const SurfaceFormat& format = need_format(surface_formats, path, FileKind::surface);
  write_file_atomically(path, format.write(mesh));
}

void write_tet_mesh(const TetMesh& mesh, const std::string& path) {
  const TetFormat& format = need_format(tet_formats, path, FileKind::tet_mesh);
  write_file_atomically(path, format.write(mesh));
}

void check_output_path(const std::string& path, FileKind kind) {
  if (kind == FileKind::surface)
    (void)need_format(surface_formats, path, kind);
  else
    (void)need_format(tet_formats, path, kind);
  check_output_file(path);
}

}  // namespace tetwright

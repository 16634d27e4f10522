// SPDX-License-Identifier: Apache-2.0
#include "tetwright/io.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <type_traits>

#include "common/files/file_names.h"
#include "common/geometry/measurable.h"
#include "common/io/names/group_text.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/names/mesh_parts.h"
#include "common/io/surfaces/3mf.h"
#include "common/io/surfaces/glb.h"
#include "common/io/surfaces/obj.h"
#include "common/io/surfaces/off.h"
#include "common/io/surfaces/ply.h"
#include "common/io/surfaces/stl.h"
#include "common/io/surfaces/vtp.h"
#include "common/io/tets/medit.h"
#include "common/io/tets/msh.h"
#include "common/io/tets/piece_files.h"
#include "common/io/tets/pvtu.h"
#include "common/io/tets/tet_formats.h"
#include "common/io/tets/vtk.h"
#include "common/io/tets/vtu.h"
#include "common/io/text/text_scanner.h"
#include "common/io/volumes/volume_formats.h"
#include "tetwright/error.h"
#include "tetwright/files.h"

namespace tetwright {

namespace {

struct SurfaceFormat {
  const char* extension;
  TriangleMesh (*read)(std::string_view bytes, const std::string& name, std::vector<Dropped>* dropped);
  void (*write)(const TriangleMesh& mesh, const ByteSink& sink);  ///< null: the format can only be read
  /// Null: the format has no point fields. Returns std::nullopt for a tet mesh.
  std::optional<SurfaceWithFields> (*read_with_fields)(std::string_view bytes, const std::string& name);
  /// Converts the name of a group of triangles to a form that the format can hold; null: it writes no names.
  std::string (*group_name)(const std::string& name) = nullptr;
};

template <std::string (*write)(const TriangleMesh&)>
void write_whole_surface(const TriangleMesh& mesh, const ByteSink& sink) {
  sink(write(mesh));
}

template <SurfaceWithFields (*read)(std::string_view, const std::string&)>
std::optional<SurfaceWithFields> always_surface(std::string_view bytes, const std::string& name) {
  return read(bytes, name);
}

constexpr std::array<SurfaceFormat, 7> surface_formats{
    {{".ply", read_ply, write_whole_surface<write_ply>, always_surface<read_ply_with_fields>, printable_name},
     {".obj", read_obj, write_whole_surface<write_obj>, nullptr, word_without_hash},
     {".stl", read_stl, write_whole_surface<write_stl>, nullptr, printable_word},
     {".off", read_off, write_whole_surface<write_off>, nullptr},
     {".vtp", read_vtp, write_vtp, always_surface<read_vtp_with_fields>, printable_name},
     {".3mf", read_3mf, nullptr, nullptr},
     {".glb", read_glb, nullptr, nullptr}}};
/// Tet mesh formats that may hold a surface instead.
constexpr std::array<SurfaceFormat, 3> shared_formats{
    {{".msh", read_msh_surface, nullptr, read_msh_surface_with_fields},
     {".mesh", read_medit_surface, nullptr, nullptr},
     {".vtk", read_vtk_surface, nullptr, read_vtk_surface_with_fields}}};

template <class Format>
bool is_for(const Format& format, FileUse use) {
  return use == FileUse::read || format.write != nullptr;
}
bool is_for(const TetFormat& format, FileUse use) {
  return use == FileUse::read ? format.read || format.read_files : !format.write.empty() || format.part_files;
}

bool is_one_file(const SurfaceFormat&) { return true; }
bool is_one_file(const TetFormat& format) { return format.read != nullptr; }
bool is_one_file(const VolumeFormat& format) { return (format.read && format.one_file) || format.headerless; }

/// Extension that selects among the formats.
template <class Format>
std::string selecting_extension(const std::string& path) {
  if constexpr (std::is_same_v<Format, VolumeFormat>)
    return volume_path(path).extension;
  else
    return extension_of(path);
}

/// Format of the file's extension, or null.
template <class Formats>
const typename Formats::value_type* find_format(const Formats& formats, const std::string& path,
                                                FileUse use) {
  const std::string extension = selecting_extension<typename Formats::value_type>(path);
  for (const auto& format : formats)
    if (extension == format.extension && is_for(format, use)) return &format;
  return nullptr;
}

const char* kind_name(FileKind kind) {
  return kind == FileKind::surface ? "surface" : kind == FileKind::volume ? "volume of labels" : "tet mesh";
}

template <class Formats>
const typename Formats::value_type& need_format(const Formats& formats, const std::string& path,
                                                FileKind kind, FileUse use) {
  if (const auto* format = find_format(formats, path, use)) return *format;
  const std::string extension = selecting_extension<typename Formats::value_type>(path);
  const bool only_read = find_format(formats, path, FileUse::read) != nullptr;
  throw UsageError(path + ": " +
                   (extension.empty() ? "no extension"
                    : only_read       ? "extension " + in_quotes(extension) + " can be read, not written,"
                                      : "unknown extension " + in_quotes(extension)) +
                   " for a " + kind_name(kind) + "; supported: " + known_extensions(kind, use));
}

/// A format of several files replaces the path's extension by its own ones. The path must not have the
/// extension of another format, since no such file would be written.
void check_names_format(const std::string& path, const std::string& name) {
  const std::string extension = extension_of(path);
  bool several = false;
  std::string own;
  for (const TetFormat& format : tet_formats()) {
    if (name != format.name) continue;
    several = format.write.size() > 1 ||
              (format.write.empty() && format.part_files.names(path, PartNumber{1}).size() > 1);
    if (extension == format.extension) return;
    own.append(own.empty() ? "" : " or ").append(format.extension);
  }
  if (several && !extension.empty())
    throw UsageError(path + ": " + name +
                     " writes several files with their own extensions; give a name that ends in " + own +
                     ", or has no extension");
}

/// Format with this name, or of the path's extension if the name is empty.
const TetFormat& need_written_format(const std::string& path, const std::string& name) {
  if (name.empty()) return need_format(tet_formats(), path, FileKind::tet_mesh, FileUse::write);
  std::string known;
  for (const TetFormat& format : tet_formats()) {
    if (!is_for(format, FileUse::write)) continue;
    if (name == format.name) {
      check_names_format(path, format.name);
      return format;
    }
    if (!known.ends_with(format.name)) known.append(known.empty() ? "" : " ").append(format.name);
  }
  throw UsageError("there is no format " + in_quotes(name) + " for a tet mesh; supported: " + known);
}

/// Format with this name, or the first one of the path's extension, that can hold a mesh in parts.
const TetFormat& need_format_of_parts(const std::string& path, const std::string& name) {
  const TetFormat& format = need_written_format(path, name);
  if (format.part_files) return format;
  std::string known;
  for (const TetFormat& other : tet_formats()) {
    if (!other.part_files) continue;
    if (name.empty() && extension_of(path) == other.extension) return other;
    if (!known.ends_with(other.extension)) known.append(known.empty() ? "" : " ").append(other.extension);
  }
  throw UsageError("--parts: " + path + " would be in the format " + format.name +
                   ", which does not hold a mesh in parts; write one of " + known);
}

/// \param parts 0: the mesh is not divided
const TetFormat& need_written_format(const std::string& path, const std::string& name, PartNumber parts) {
  const TetFormat& format = parts > 0 ? need_format_of_parts(path, name) : need_written_format(path, name);
  if (format.missing_library)
    throw UsageError(path + ": this program was built without " + format.missing_library +
                     ", which the format " + format.name + " needs; write another format");
  return format;
}

/// Format with this name, an extension with or without its dot, or of the path's extension if the name is
/// empty.
template <class Formats>
const typename Formats::value_type& need_written_format(const Formats& formats, const std::string& path,
                                                        FileKind kind, const std::string& name) {
  if (name.empty()) return need_format(formats, path, kind, FileUse::write);
  const std::string path_of_name = (name.starts_with('.') ? "x" : "x.") + name;
  if (const auto* format = find_format(formats, path_of_name, FileUse::write)) return *format;
  const bool only_read = find_format(formats, path_of_name, FileUse::read) != nullptr;
  throw UsageError((only_read ? "the format " + in_quotes(name) + " can be read, not written,"
                              : "there is no format " + in_quotes(name)) +
                   " for a " + kind_name(kind) + "; supported: " + known_extensions(kind, FileUse::write));
}

const SurfaceFormat& need_surface_format(const std::string& path) {
  const SurfaceFormat* shared = find_format(shared_formats, path, FileUse::read);
  return shared ? *shared : need_format(surface_formats, path, FileKind::surface, FileUse::read);
}

/// Checks that the format consists of one file, and returns it.
template <class Format>
const Format& streamed(const Format& format, const std::string& name) {
  if (is_one_file(format)) return format;
  throw UsageError(
      name + ": " + format.extension +
      " is several files or is read by parts, which a stream does not allow; give a file name, or one "
      "of " +
      streamed_extensions());
}

/// Checks the mesh by require_measurable(), and returns it.
ReadTetMesh measurable(ReadTetMesh read, const std::string& name) {
  require_measurable(read.mesh, name);
  drop_names_of_cohesive(read.mesh);
  return read;
}

const VolumeFormat& need_volume_format(const std::string& path) {
  return need_format(volume_formats(), path, FileKind::volume, FileUse::read);
}

NameRules names_of_groups(const SurfaceFormat& format) {
  return {
      .form = format.group_name ? format.group_name : printable_name,
  };
}

/// Writes a file as one of `files`, or separately if that is null.
void write_into(OutputFiles* files, const std::string& path,
                const std::function<void(const ByteSink&)>& content) {
  if (files)
    files->write(path, content);
  else
    write_file_atomically(path, content);
}

}  // namespace

FileKind file_kind(const std::string& path, FileUse use) {
  if (find_format(surface_formats, path, use)) return FileKind::surface;
  if (find_format(tet_formats(), path, use)) return FileKind::tet_mesh;
  if (find_format(volume_formats(), path, use)) return FileKind::volume;
  return FileKind::unknown;
}

bool is_dicom(const std::string& path) { return volume_path(path).extension == ".dcm"; }

std::string known_extensions(FileKind kind, FileUse use) {
  std::string out;
  std::string_view last;
  const auto add = [&](const auto& formats) {
    for (const auto& format : formats) {
      if (!is_for(format, use) || format.extension == last) continue;
      last = format.extension;
      if (!out.empty()) out += ' ';
      out += last;
    }
  };
  if (kind == FileKind::surface || kind == FileKind::unknown) add(surface_formats);
  if (kind == FileKind::surface && use == FileUse::read) add(shared_formats);
  if (kind == FileKind::tet_mesh || kind == FileKind::unknown) add(tet_formats());
  if (kind == FileKind::volume || kind == FileKind::unknown) add(volume_formats());
  return out;
}

bool may_hold_surface(const std::string& path) {
  return file_kind(path) == FileKind::surface || find_format(shared_formats, path, FileUse::read);
}

std::vector<TetFormatInfo> written_tet_formats() {
  std::vector<TetFormatInfo> out;
  for (const TetFormat& format : tet_formats())
    if (is_for(format, FileUse::write) && (out.empty() || out.back().name != format.name))
      out.push_back(info_of(format));
  return out;
}

TetFormatInfo written_tet_format(const std::string& path, const std::string& name, PartNumber parts) {
  return info_of(need_written_format(path, name, parts));
}

NameChanges written_name_changes(const TetMesh& mesh, const std::string& path, const std::string& name,
                                 PartNumber parts) {
  const TetFormat& format = need_written_format(path, name, parts);
  const bool in_parts = parts > 0 || format.write.empty();
  NameChanges changes = name_changes(mesh, format.parts(mesh));
  const auto add_fields = [&](const std::vector<MeshField>& fields, const std::vector<std::string>& taken) {
    if (!format.fields) return;
    add_field_changes(fields, field_names_to_write(fields, taken, format.field_name), changes.fields);
  };
  add_fields(mesh.point_fields, in_parts ? format.part_files.own_point_fields : std::vector<std::string>());
  add_fields(mesh.cell_fields, in_parts ? format.part_files.own_cell_fields : format.own_cell_fields);
  if (!format.names) changes.material_names.clear();
  if (!format.patch_names) changes.patch_names.clear();
  return changes;
}

SurfaceFormatInfo written_surface_format(const std::string& path, const std::string& name) {
  const SurfaceFormat& format = need_written_format(surface_formats, path, FileKind::surface, name);
  return {format.extension, format.group_name != nullptr};
}

std::vector<NameChange> written_interface_name_changes(const TetMesh& mesh, const std::string& path,
                                                       const std::string& name) {
  const SurfaceFormat& format = need_written_format(surface_formats, path, FileKind::surface, name);
  if (!format.group_name) return {};
  return name_changes(mesh, names_of_parts(mesh, names_of_groups(format))).patch_names;
}

std::vector<std::string> files_of_tet_mesh(const std::string& path, const std::string& name,
                                           PartNumber parts) {
  std::vector<std::string> files;
  const TetFormat& format = need_written_format(path, name, parts);
  if (parts > 0 || format.write.empty()) return format.part_files.names(path, std::max(parts, PartNumber{1}));
  for (const WrittenFile& file : format.write)
    files.push_back(format.write.size() == 1 ? path : with_extension(path, file.extension));
  return files;
}

bool may_hold_point_fields(const std::string& path) {
  if (const TetFormat* tets = find_format(tet_formats(), path, FileUse::read)) return tets->point_fields;
  const SurfaceFormat* surface = find_format(surface_formats, path, FileUse::read);
  return surface && surface->read_with_fields;
}

std::string point_field_extensions() {
  std::string out;
  const auto add = [&](const char* extension) {
    if (!out.ends_with(extension)) out.append(out.empty() ? "" : " ").append(extension);
  };
  for (const TetFormat& format : tet_formats())
    if (format.point_fields && is_for(format, FileUse::read)) add(format.extension);
  for (const SurfaceFormat& format : surface_formats)
    if (format.read_with_fields) add(format.extension);
  return out;
}

std::string file_stem(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  return name.substr(0, name.size() - extension_of(path).size());
}

TriangleMesh read_surface(const std::string& path, std::vector<Dropped>* dropped) {
  return need_surface_format(path).read(read_whole_file(path), path, dropped);
}

ReadTetMesh read_tet_mesh(const std::string& path, const ReadTetMeshOptions& options) {
  const TetFormat& format = need_format(tet_formats(), path, FileKind::tet_mesh, FileUse::read);
  return measurable(
      format.read ? format.read(read_whole_file(path), path, options) : format.read_files(path, options),
      path);
}

TriangleMesh read_surface_bytes(std::string_view bytes, const std::string& name, const std::string& extension,
                                std::vector<Dropped>* dropped) {
  return streamed(need_surface_format(name + extension), name).read(bytes, name, dropped);
}

ReadTetMesh read_tet_mesh_bytes(std::string_view bytes, const std::string& name, const std::string& extension,
                                const ReadTetMeshOptions& options) {
  const TetFormat& format = need_format(tet_formats(), name + extension, FileKind::tet_mesh, FileUse::read);
  return measurable(streamed(format, name).read(bytes, name, options), name);
}

LabelVolume read_label_volume_bytes(std::string_view bytes, const std::string& name,
                                    const std::string& extension, const VolumeFileOptions& options) {
  return labels_of(volume_of_bytes(streamed(need_volume_format(name + extension), name), bytes, name,
                                   VoxelUse::labels, options));
}

ImageVolume read_image_bytes(std::string_view bytes, const std::string& name, const std::string& extension,
                             const VolumeFileOptions& options) {
  return image_of(volume_of_bytes(streamed(need_volume_format(name + extension), name), bytes, name,
                                  VoxelUse::image, options));
}

std::string streamed_extensions() {
  std::string out;
  const auto add = [&](const auto& formats) {
    for (const auto& format : formats)
      if (is_for(format, FileUse::read) && is_one_file(format) && !out.ends_with(format.extension))
        out.append(out.empty() ? "" : " ").append(format.extension);
  };
  add(surface_formats);
  add(tet_formats());
  add(volume_formats());
  return out;
}

bool streams(const std::string& extension) {
  return (" " + streamed_extensions() + " ").find(" " + extension + " ") != std::string::npos;
}

std::optional<SurfaceWithFields> read_surface_with_fields(const std::string& path) {
  const SurfaceFormat* format = find_format(shared_formats, path, FileUse::read);
  if (!format) format = find_format(surface_formats, path, FileUse::read);
  if (!format && file_kind(path) == FileKind::tet_mesh) return {};
  if (!format || !format->read_with_fields)
    throw UsageError(
        path + ": " + in_quotes(extension_of(path)) +
        " is not an extension of files with point fields; supported: " + point_field_extensions());
  return format->read_with_fields(read_whole_file(path), path);
}

LabelVolume read_label_volume(const std::string& path, const VolumeFileOptions& options) {
  return read_whole_volume(need_volume_format(path), path, options);
}

ImageVolume read_image(const std::string& path, const VolumeFileOptions& options) {
  return read_whole_image(need_volume_format(path), path, options);
}

std::int64_t label_layers(const std::string& path) { return layers_of(need_volume_format(path), path); }

std::vector<LabelVolume> read_label_layers(const std::string& path, const VolumeFileOptions& options) {
  return read_layers(need_volume_format(path), path, options);
}

std::unique_ptr<LabelSource> open_label_source(const std::string& path, const LabelSourceOptions& options) {
  const VolumeFormat& format = need_volume_format(path);
  if (auto source = open_by_boxes(format, path, options.cache_bytes, VoxelUse::labels, options.file))
    return source;
  return std::make_unique<MemoryLabelSource>(read_whole_volume(format, path, options.file));
}

void write_surface(const TriangleMesh& mesh, const std::string& path, OutputFiles* files,
                   const std::string& name) {
  const SurfaceFormat& format = need_written_format(surface_formats, path, FileKind::surface, name);
  write_into(files, path, [&](const ByteSink& sink) { format.write(mesh, sink); });
}

void write_interfaces(const TetMesh& mesh, const std::string& path, OutputFiles* files,
                      const std::string& name) {
  const SurfaceFormat& format = need_written_format(surface_formats, path, FileKind::surface, name);
  write_surface(interface_surface(mesh, names_of_groups(format)), path, files, name);
}

void write_tet_mesh(const MeshToWrite& mesh, const std::string& path, OutputFiles* files,
                    const std::string& name) {
  const TetFormat& format = need_written_format(path, name, PartNumber{0});
  if (format.write.empty()) {
    write_tet_mesh(mesh, TetPartition{}, path, files, name);
    return;
  }
  const std::vector<std::string> paths = files_of_tet_mesh(path, name);
  const std::string first = std::filesystem::path(paths.front()).filename().string();
  std::optional<OutputFiles> own;  // makes the mesh's files appear together
  if (!files) files = &own.emplace();
  for (std::size_t i = 0; i < paths.size(); ++i)
    files->write(paths[i], [&](const ByteSink& sink) { format.write[i].write(mesh, first, sink); });
  if (own) own->commit();
}

void write_tet_mesh(const MeshToWrite& mesh, const TetPartition& partition, const std::string& path,
                    OutputFiles* files, const std::string& name, const FileSharing* share) {
  const TetFormat& format = need_format_of_parts(path, name);
  const MeshPieces pieces(mesh.mesh, mesh.midside, partition);
  std::optional<OutputFiles> own;  // makes the files appear together
  if (!files) files = &own.emplace();
  write_part_files(format, pieces, path, *files, share);
  if (own) own->commit();
}

void write_label_volume(const LabelVolume& volume, const std::string& path, OutputFiles* files,
                        const std::string& name) {
  const VolumeFormat& format = need_written_format(volume_formats(), path, FileKind::volume, name);
  write_into(files, path, [&](const ByteSink& sink) { sink(format.write(volume)); });
}

void write_label_source(const LabelSource& source, MaterialTag largest, const std::string& path,
                        OutputFiles* files, const std::string& name, Progress* progress) {
  const VolumeFormat& format = need_written_format(volume_formats(), path, FileKind::volume, name);
  write_into(files, path,
             [&](const ByteSink& sink) { format.write_source(source, largest, sink, progress); });
}

std::vector<std::string> files_of_input(const std::string& path) {
  static const std::vector<std::vector<const char*>> families{
      {".node", ".ele", ".face"}, {".xdmf", ".h5", "_facets.xdmf", "_facets.h5"}, {".hdr", ".img"}};
  std::vector<std::string> files{path};
  if (const VolumePath volume = volume_path(path); volume.file != path) files.push_back(volume.file);
  const std::string extension = extension_of(path);
  for (const auto& family : families) {
    if (std::none_of(family.begin(), family.end(), [&](const char* of) { return extension == of; })) continue;
    for (const char* other : family)
      if (extension != other) files.push_back(with_extension(path, other));
  }
  if (extension == ".pvtu")
    for (std::string& piece : pieces_of_pvtu(path)) files.push_back(std::move(piece));
  return files;
}

void check_output_path(const std::string& path, FileKind kind, const std::string& format, PartNumber parts) {
  if (kind == FileKind::surface)
    (void)need_written_format(surface_formats, path, kind, format);
  else if (kind == FileKind::volume)
    (void)need_written_format(volume_formats(), path, kind, format);
  else
    for (const std::string& file : files_of_tet_mesh(path, format, parts)) check_output_file(file);
  if (kind != FileKind::tet_mesh) check_output_file(path);
}

}  // namespace tetwright

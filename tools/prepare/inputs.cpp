// SPDX-License-Identifier: Apache-2.0
#include "tetwright/prepare.h"

#include <filesystem>

#include "common/geometry/measurable.h"
#include "common/io/names/mesh_fields.h"
#include "common/io/volumes/encoded_volume.h"
#include "common/lower_case.h"
#include "tetwright/prepare_steps.h"

namespace tetwright {

namespace {

std::string read_stream(const InputStream& stream, double& waited) {
  const Stopwatch watch;
  std::string bytes = stream.read();
  waited += watch.seconds();
  return bytes;
}

}  // namespace

bool is_vdb(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string()) == ".vdb";
}

FileKind Input::kind() const {
  if (std::holds_alternative<InputSurface>(value)) return FileKind::surface;
  if (std::holds_alternative<InputMesh>(value)) return FileKind::tet_mesh;
  if (std::holds_alternative<LabelVolume>(value) || std::holds_alternative<ImageVolume>(value))
    return FileKind::volume;
  return file_kind(typed_name());
}

std::string Input::typed_name() const {
  const auto* stream = std::get_if<InputStream>(&value);
  return stream ? name + stream->extension : name;
}

bool Input::is_vdb_file() const { return !is_value() && is_vdb(name); }

std::string Input::material_name() const { return is_value() ? name : file_stem(name); }

TriangleMesh take_surface(Input& input, std::vector<Dropped>* dropped, double& waited) {
  if (auto* of = std::get_if<InputSurface>(&input.value)) {
    if (dropped) dropped->insert(dropped->end(), of->dropped.begin(), of->dropped.end());
    return std::move(of->surface);
  }
  if (const auto* stream = std::get_if<InputStream>(&input.value))
    return read_surface_bytes(read_stream(*stream, waited), input.name, stream->extension, dropped);
  return read_surface(input.name, dropped);
}

ReadTetMesh take_tet_mesh(Input& input, const ReadTetMeshOptions& options, double& waited) {
  if (auto* of = std::get_if<InputMesh>(&input.value)) {
    ReadTetMesh read = std::move(of->read);
    const FileTriangles listed = std::exchange(of->triangles, {});
    require_measurable(read.mesh, input.name);
    take_material(read, options, input.name);
    take_triangles(listed, "group", input.name, read);
    return read;
  }
  if (const auto* stream = std::get_if<InputStream>(&input.value))
    return read_tet_mesh_bytes(read_stream(*stream, waited), input.name, stream->extension, options);
  return read_tet_mesh(input.name, options);
}

LabelVolume take_label_volume(Input& input, double& waited) {
  if (auto* volume = std::get_if<LabelVolume>(&input.value)) return std::move(*volume);
  if (const auto* image = std::get_if<ImageVolume>(&input.value)) return labels_of(*image, input.name);
  if (const auto* stream = std::get_if<InputStream>(&input.value))
    return read_label_volume_bytes(read_stream(*stream, waited), input.name, stream->extension,
                                   input.volume_file);
  return read_label_volume(input.name, input.volume_file);
}

ImageVolume take_image(Input& input, double& waited) {
  if (auto* image = std::get_if<ImageVolume>(&input.value)) return std::move(*image);
  if (const auto* volume = std::get_if<LabelVolume>(&input.value)) return image_of(*volume);
  if (const auto* stream = std::get_if<InputStream>(&input.value))
    return read_image_bytes(read_stream(*stream, waited), input.name, stream->extension, input.volume_file);
  return read_image(input.name, input.volume_file);
}

std::unique_ptr<LabelSource> take_label_source(Input& input, double& waited) {
  if (!std::holds_alternative<InputFile>(input.value))
    return std::make_unique<MemoryLabelSource>(take_label_volume(input, waited));
  constexpr std::size_t cache_bytes = std::size_t{1} << 24;  // each chunk is needed once
  return open_label_source(input.name, {.cache_bytes = cache_bytes, .file = input.volume_file});
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/io/contents/dropped.h"
#include "common/io/contents/read_tet_mesh_result.h"
#include "common/io/formats.h"
#include "common/io/tets/file_triangles.h"
#include "common/label_volume.h"
#include "common/tet_mesh.h"
#include "common/triangle_mesh.h"

namespace tetwright {

/// A file, whose extension says what it holds.
struct InputFile {};

/// The bytes of a file from elsewhere.
struct InputStream {
  std::string extension;              ///< says what it holds: ".ply"
  std::function<std::string()> read;  ///< called once, when its turn comes
};

struct InputSurface {
  TriangleMesh surface;
  std::vector<Dropped> dropped = {};  ///< what the host's object had beside it
};

/// A tet mesh as the reader of a file leaves it before it chooses the material.
struct InputMesh {
  ReadTetMesh read;
  FileTriangles triangles = {};  ///< that the host lists beside the tets
};

/// An input: a file, or a value in memory.
struct Input {
  using Value = std::variant<InputFile, InputStream, InputSurface, InputMesh, LabelVolume>;

  // An input is written as what it is: prepare({"scan.ply"}), prepare({{"body", surface}}).
  Input(const char* file) : name(file) {}             // NOLINT(google-explicit-constructor)
  Input(std::string file) : name(std::move(file)) {}  // NOLINT(google-explicit-constructor)
  Input(std::string of, Value in_memory) : name(std::move(of)), value(std::move(in_memory)) {}
  Input(std::string of, TriangleMesh surface) : Input(std::move(of), InputSurface{std::move(surface)}) {}
  Input(std::string of, TetMesh mesh) : Input(std::move(of), InputMesh{{std::move(mesh), "material"}}) {}

  /// Makes it the material of this name; later ones carve earlier ones. For surfaces and level sets.
  Input as(std::string material_name) && {
    material = std::move(material_name);
    return std::move(*this);
  }

  bool is_value() const {
    return !std::holds_alternative<InputFile>(value) && !std::holds_alternative<InputStream>(value);
  }
  /// By the extension of a file, or what a value is.
  FileKind kind() const;
  /// The name, with the extension that a stream is read by.
  std::string typed_name() const;
  /// A level set or a segmented volume of OpenVDB, .vdb.
  bool is_vdb_file() const;
  /// The name of a material that is the whole input: a value's name, a file's without folders and extension.
  std::string material_name() const;

  std::string name;  ///< of a file: its path; names the input in messages
  Value value = InputFile{};
  std::string material;  ///< empty: named after the input
};

/// The readers of formats.h for any input, which is moved out of. The time for which a stream was waited for
/// is added to `waited`, seconds.
TriangleMesh take_surface(Input& input, std::vector<Dropped>* dropped, double& waited);
ReadTetMesh take_tet_mesh(Input& input, const ReadTetMeshOptions& options, double& waited);
LabelVolume take_label_volume(Input& input, double& waited);

/// True for a name with the extension .vdb, in upper or lower case.
bool is_vdb(const std::string& path);

}  // namespace tetwright

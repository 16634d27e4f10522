// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/io/elements/midside_nodes_read.h"
#include "common/io/tets/abaqus_part.h"
#include "tetwright/io.h"

namespace tetwright {

/// Position of an instance: a translation, then a rotation.
struct AbaqusPlacement {
  struct Rotation {
    Vec3 point, axis;     ///< a point of the axis; its direction, of length 1
    double cosine, sine;  ///< of the angle
  };
  std::optional<Vec3> translation;
  std::optional<Rotation> rotation;

  explicit operator bool() const { return translation || rotation; }
  /// Without translation and rotation, the point itself, bit by bit.
  Vec3 operator()(const Vec3& p) const;
  /// Reads the data lines of *INSTANCE, at most two.
  /// \throws InputError with the line
  static AbaqusPlacement read(AbaqusLines& in);
};

/// An *INSTANCE: its part, or its own mesh.
struct AbaqusInstance {
  std::string name;  ///< as spelled in the file
  std::size_t line;
  std::string part_name;
  const AbaqusPart* part;
  AbaqusPlacement placement;
  /// The part with what the instance adds to it; null: nothing.
  std::unique_ptr<AbaqusPart> own = {};

  const AbaqusPart& mesh() const { return own ? *own : *part; }
};

/// Puts the instances of a file together as one mesh. Nodes are not merged: bodies that share faces have
/// nodes of their own, as in Abaqus.
class AbaqusAssembly {
 public:
  /// \param root what is outside of parts and instances
  /// \param instances those of the file, or one that has no name for the only part of a file without an
  ///   assembly. There must be tets, and element numbers sorted. All arguments must outlive this object.
  AbaqusAssembly(const AbaqusLines& in, const AbaqusPart& root, const std::vector<AbaqusInstance>& instances);

  /// Fills the points, tets, materials and their names.
  void fill(ReadTetMesh& read, MidsideNodesRead& midside);
  /// The triangles of all surfaces, with their names.
  /// \param tets those of fill()
  FileTriangles triangles(const std::vector<Tet>& tets);
  /// Appends what is not read.
  void note_dropped(std::vector<Dropped>& dropped) const;

 private:
  /// An instance with tets.
  struct Body {
    const AbaqusInstance* instance;
    const AbaqusPart* mesh;
    std::size_t first_tet;
  };
  struct Material {
    std::string key, name;  ///< set in upper case; name as spelled, may be empty
    std::vector<Index> tets;
  };

  bool several() const { return bodies_.size() > 1; }
  /// Name of something of a body among those of others.
  std::string name_in(const Body& body, const std::string& name) const;
  void add_tets_of(const Body& body, const std::string& set, std::size_t line, std::set<std::string>& open,
                   std::vector<Index>& tets) const;
  /// \return false if there is no such element, or it is no tet
  static bool add_tet_of(const Body& body, std::int64_t number, std::vector<Index>& tets);
  /// Adds tets of a set, or of an element or set of an instance ("PIPE-1.TOP"), named outside of instances.
  void add_tets_of_root(const std::string& name, std::size_t line, std::set<std::string>& open,
                        std::vector<Index>& tets);
  /// Body of an instance; null: the instance has no tets.
  const Body* body_of(const std::string& instance, std::size_t line) const;
  std::vector<Material> materials_of(const Body& body) const;
  std::vector<Material> all_materials();
  void set_materials(ReadTetMesh& read);
  std::vector<const AbaqusPart*> used_parts() const;
  std::size_t wedges_left_out() const;
  void check_nesting(std::size_t sets, std::size_t line) const;

  const AbaqusLines& in_;
  const AbaqusPart& root_;
  const std::vector<AbaqusInstance>& instances_;
  std::vector<Body> bodies_;
  std::map<std::string, std::size_t> bodies_by_name_;  ///< name in upper case; no_body: without tets
  static constexpr std::size_t no_body = static_cast<std::size_t>(-1);
  std::size_t twice_ = 0, other_faces_ = 0;
};

}  // namespace tetwright

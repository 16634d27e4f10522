// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "tetwright/tet_mesh.h"

namespace tetwright {

/// A face with what identifies it in a mesh.
struct KeyedFace {
  Triangle key;  ///< ascending points
  InterfaceTriangle face;
  bool operator<(const KeyedFace& other) const {
    return key != other.key ? key < other.key : face.material < other.face.material;
  }
};

KeyedFace keyed(const InterfaceTriangle& face);

/// Adds those of the cut faces that separate two materials, or a material from the outside, ascending.
void add_interfaces(std::vector<KeyedFace> cut, std::vector<InterfaceTriangle>& interfaces);

/// Sets the patches of the faces on the border of the volume.
void set_patches(std::vector<KeyedFace> patched, std::vector<InterfaceTriangle>& interfaces);

}  // namespace tetwright

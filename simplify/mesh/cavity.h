#pragma once

#include <vector>

#include "simplify/mesh/editable_mesh.h"

namespace tetwright {

/// A tet that an operation puts into a cavity.
struct NewTet {
  Tet points;
  RegionId region;
  float quality;
};

/// Tets that go and tets that fill their place. Kept by the task, so that its memory is reused.
struct Cavity {
  std::vector<Index> removed;
  std::vector<NewTet> added;
  void clear() {
    removed.clear();
    added.clear();
  }
};

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tools/bricks/keyed_faces.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/parallel/parallel_sort.h"
#include "tetwright/error.h"

namespace tetwright {

KeyedFace keyed(const InterfaceTriangle& face) {
  Triangle key = face.ids;
  std::sort(key.begin(), key.end());
  return {key, face};
}

void add_interfaces(std::vector<KeyedFace> cut, std::vector<InterfaceTriangle>& interfaces) {
  parallel_sort(cut);
  for (std::size_t i = 0; i < cut.size(); ++i) {
    InterfaceTriangle face = cut[i].face;
    if (i + 1 < cut.size() && cut[i + 1].key == cut[i].key) {
      face.other = cut[++i].face.material;
      TETWRIGHT_CHECK(i + 1 == cut.size() || cut[i + 1].key != cut[i].key);
      if (face.is_sheet()) continue;
    }
    interfaces.push_back(face);
  }
}

void set_patches(std::vector<KeyedFace> patched, std::vector<InterfaceTriangle>& interfaces) {
  if (patched.empty()) return;
  parallel_sort(patched);
  for (InterfaceTriangle& t : interfaces) {
    if (t.other) continue;
    const KeyedFace wanted{keyed(t).key, {{}, std::numeric_limits<MaterialTag>::min(), {}}};
    const auto found = std::lower_bound(patched.begin(), patched.end(), wanted);
    if (found != patched.end() && found->key == wanted.key) t.patch = found->face.patch;
  }
}

}  // namespace tetwright

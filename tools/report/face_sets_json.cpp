// SPDX-License-Identifier: Apache-2.0
#include "tools/report/face_sets_json.h"

namespace tetwright {

nlohmann::json selections_json(const std::vector<SelectedFaces>& selected) {
  nlohmann::json all = nlohmann::json::array();
  for (const SelectedFaces& s : selected)
    all.push_back({{"name", s.name}, {"faces", s.faces}, {"area", s.area}});
  return all;
}

nlohmann::json parted_json(const std::vector<PartedInterface>& parted) {
  nlohmann::json all = nlohmann::json::array();
  for (const PartedInterface& p : parted)
    all.push_back({{"name", p.name},
                   {"sides", p.sides},
                   {"faces", p.faces},
                   {"joined_faces", p.joined_faces},
                   {"pairs", p.pairs.size()},
                   {"cohesive", p.cohesive},
                   {"degenerate_wedges", p.degenerate_wedges}});
  return all;
}

}  // namespace tetwright

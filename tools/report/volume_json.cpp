// SPDX-License-Identifier: Apache-2.0
#include "tools/report/volume_json.h"

#include <cmath>
#include <string>

#include "tetwright/compare.h"
#include "tools/report/diagnostics_json.h"

namespace tetwright {

nlohmann::json volume_json(const VolumeReport& v,
                           const std::map<MaterialTag, std::array<double, 3>>& colours) {
  nlohmann::json directions = nlohmann::json::array();
  for (int a = 0; a < 3; ++a) directions.push_back(place_json(v.directions.col(a)));
  const double voxel = std::abs(v.directions.determinant());
  nlohmann::json labels = nlohmann::json::array(), lost = nlohmann::json::array();
  for (const LabelMaterial& l : v.labels) {
    labels.push_back({{"tag", l.tag},
                      {"name", l.name},
                      {"voxels", l.voxels},
                      {"voxels_in_file", l.voxels_in_file},
                      {"volume", voxel * expected_volume(l)}});
    if (l.carved) labels.back()["carved_voxels"] = *l.carved;
    if (const auto colour = colours.find(l.tag); colour != colours.end())
      labels.back()["color"] = colour->second;
  }
  for (const LostLabel& l : v.lost) lost.push_back({{"tag", l.tag}, {"name", l.name}, {"voxels", l.voxels}});
  nlohmann::json json = {{"size", v.size},
                         {"spacing", place_json(v.spacing())},
                         {"directions", directions},
                         {"origin", place_json(v.origin)},
                         {"space", v.space.empty() ? "unknown" : v.space},
                         {"labels", labels},
                         {"lost", lost},
                         {"merged_islands", v.merged_islands},
                         {"merged_voxels", v.merged_voxels}};
  for (const UsedIso& iso : v.isos)
    json["isos"].push_back({{"name", iso.name}, {"value", iso.value}, {"automatic", iso.automatic}});
  return json;
}

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "tools/report/features_json.h"

#include <nlohmann/json.hpp>
#include <numbers>

#include "tools/report/diagnostics_json.h"

namespace tetwright {

namespace {

const char* name_of(CreaseChain::Fate fate) {
  static constexpr const char* names[CreaseChain::fates] = {"kept",  "kept",  "noise",
                                                            "faded", "small", "given_up"};
  return names[static_cast<std::size_t>(fate)];
}

nlohmann::json curves_json(const CreaseChains& chains) {
  nlohmann::json j = nlohmann::json::array();
  for (const CreaseChain& c : chains.longest) {
    j.push_back({{"fate", name_of(c.fate)},
                 {"length", c.length},
                 {"turn", c.turn * 180 / std::numbers::pi},
                 {"point", place_json(c.middle)}});
    if (c.distance) j.back()["distance"] = *c.distance;
  }
  return j;
}

}  // namespace

nlohmann::json features_json(const std::vector<FeatureReport>& all) {
  static constexpr const char* verdicts[] = {"off",     "smooth",    "scan", "intersecting",
                                             "meeting", "staircase", "part"};
  nlohmann::json j = nlohmann::json::array();
  for (const FeatureReport& f : all)
    j.push_back({{"name", f.name},
                 {"verdict", verdicts[static_cast<std::size_t>(f.found.verdict)]},
                 {"patches", f.found.count},
                 {"dropped_patches", f.found.dropped},
                 {"loose_ends", {f.found.loose_ends_low, f.found.loose_ends_high}},
                 {"noisy_share", f.found.noisy_share},
                 {"curves", curves_json(f.found.chains)},
                 {"further_curves", f.found.chains.count() - f.found.chains.longest.size()}});
  return j;
}

}  // namespace tetwright

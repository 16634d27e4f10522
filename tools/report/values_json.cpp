// SPDX-License-Identifier: Apache-2.0
#include "tools/report/values_json.h"

#include <cmath>

#include "tools/report/diagnostics_json.h"

namespace tetwright {

namespace {

nlohmann::json found_json(const FoundPlaces& found) {
  nlohmann::json j = {{"count", found.count}};
  if (found.count > 0) j["first"] = place_json(found.first);
  return j;
}

}  // namespace

nlohmann::json values_json(const std::vector<ValueReport>& values) {
  nlohmann::json all = nlohmann::json::array();
  for (const ValueReport& v : values)
    all.push_back({{"name", v.name},
                   {"file", v.file},
                   {"image_min", v.lowest},
                   {"image_max", v.highest},
                   {"min", v.smallest},
                   {"max", v.largest},
                   {"mean", v.mean},
                   {"partly_outside", found_json(v.partly_outside)},
                   {"nearest", found_json(v.nearest)},
                   {"nearest_points", found_json(v.nearest_points)},
                   {"not_finite", v.not_finite}});
  return all;
}

nlohmann::json embedding_json(const EmbeddingReport& embedding) {
  const EmbeddingSummary& found = embedding.summary;
  nlohmann::json j = {{"points", found.points},
                      {"tets", embedding.tets},
                      {"outside", found.outside},
                      {"largest_distance", found.largest_distance},
                      {"seconds", embedding.seconds}};
  if (found.largest_distance > 0) j["place"] = place_json(found.place);
  return j;
}

nlohmann::json bins_json(const std::vector<BinsReport>& divisions) {
  nlohmann::json all = nlohmann::json::array();
  const auto bound = [](double x) { return std::isfinite(x) ? nlohmann::json(x) : nlohmann::json(); };
  for (const BinsReport& bins : divisions) {
    nlohmann::json each = nlohmann::json::array();
    for (const ValueBin& bin : bins.bins) {
      each.push_back({{"name", bin.name},
                      {"material", bin.material},
                      {"bin", bin.number},
                      {"low", bound(bin.low)},
                      {"high", bound(bin.high)},
                      {"tets", bin.tets},
                      {"volume", bin.volume},
                      {"mean", bin.mean}});
      if (bin.modulus) each.back()["modulus"] = *bin.modulus;
    }
    all.push_back({{"values", bins.field}, {"each", each}});
    if (bins.poisson) all.back()["poisson"] = *bins.poisson;
  }
  return all;
}

}  // namespace tetwright

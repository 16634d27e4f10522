// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tetwright {

/// What an attempted operation answers. Every one but `done` changes nothing; the statistics count them.
enum class Outcome : std::uint8_t {
  done,
  conflict,           ///< an earlier winner of the batch claims some of its read set: tried again
  stale,              ///< the element changed since it was listed
  no_candidate,       ///< the element has no such operation
  material_rule,      ///< the dimensions of point and edge forbid it (interfaces, junction curves, spanning
                      ///< edges)
  surface_error,      ///< Weight or Error above E
  inverts,            ///< a tet would become flat or negative
  quality,            ///< the worst tet would become worse, and annealing did not let it pass
  link_condition,     ///< the topology would change
  self_intersection,  ///< a boundary or interface triangle would meet another
  no_room,            ///< never answered: arrays grow (kept for the statistics, whose keys are fixed)
  count,              ///< fewer tets than wanted would be left, or more
  too_large,          ///< the star holds more points than are worth the time
  volume,             ///< a material's volume would leave its bounds (VolumeLedger)
  edge_length,        ///< an edge would be longer or shorter than it should be (EdgeSizes)
};
inline constexpr std::size_t outcome_count = 15;

/// As the statistics call them: their keys are fixed.
inline constexpr std::array<std::string_view, outcome_count> outcome_names{
    "done",          "lock_taken", "stale",     "no_candidate",   "material_rule",
    "surface_error", "inverts",    "quality",   "link_condition", "self_intersection",
    "no_room",       "count",      "too_large", "volume",         "edge_length"};

/// The kinds of operation that are counted.
enum class Operation : std::uint8_t {
  flip23,
  flip32,
  flip22,
  flip44,
  collapse,
  smooth,
  insert_in_tet,
  insert_in_face,
  insert_in_edge,
  optimise,
  edge_removal,
  face_removal,
  fit
};
inline constexpr std::size_t operation_count = 13;
inline constexpr std::array<std::string_view, operation_count> operation_names{
    "flip23",         "flip32",         "flip22",   "flip44",       "collapse",     "smooth", "insert_in_tet",
    "insert_in_face", "insert_in_edge", "optimise", "edge_removal", "face_removal", "fit"};

/// How often each operation had each outcome.
struct OperationCounts {
  std::array<std::array<std::uint64_t, outcome_count>, operation_count> counts{};

  void add(Operation operation, Outcome outcome) {
    ++counts[static_cast<std::size_t>(operation)][static_cast<std::size_t>(outcome)];
  }
  std::uint64_t of(Operation operation, Outcome outcome) const {
    return counts[static_cast<std::size_t>(operation)][static_cast<std::size_t>(outcome)];
  }
  std::uint64_t tried(Operation operation) const {
    std::uint64_t sum = 0;
    for (std::uint64_t n : counts[static_cast<std::size_t>(operation)]) sum += n;
    return sum;
  }
  void add(const OperationCounts& other) {
    for (std::size_t i = 0; i < operation_count; ++i)
      for (std::size_t j = 0; j < outcome_count; ++j) counts[i][j] += other.counts[i][j];
  }
};

}  // namespace tetwright

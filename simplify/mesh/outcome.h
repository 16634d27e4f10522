// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace tetwright {

/// Result of an attempted operation. Only `done` changes something; the statistics count all.
enum class Outcome : std::uint8_t {
  done,
  conflict,           ///< an earlier winner of the batch has claimed part of its read set: retried
  stale,              ///< the element changed since it was listed
  no_candidate,       ///< the element does not admit this operation
  material_rule,      ///< the dimensions of point and edge forbid it (interfaces, junction curves, spanning
                      ///< edges)
  surface_error,      ///< Weight or Error above E
  inverts,            ///< a tet would become flat or negative
  quality,            ///< the worst tet would get worse, and annealing did not allow it
  link_condition,     ///< the topology would change
  self_intersection,  ///< a boundary or interface triangle would intersect another
  no_room,            ///< never returned, since arrays grow (kept because the statistics' keys are fixed)
  count,              ///< the number of tets would leave CountBounds
  too_large,          ///< the star or ring is too large to be worth the time
  volume,             ///< a material's volume would leave its bounds (VolumeLedger)
  edge_length,        ///< an edge would leave its bounds (EdgeSizes)
};
inline constexpr std::size_t outcome_count = 15;

/// Keys of the statistics: fixed.
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

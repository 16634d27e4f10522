// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/reservations.h"

#include <algorithm>
#include <limits>

#include "common/error.h"

namespace tetwright {

void Reservations::begin_batch(std::size_t items) {
  if (items > std::numeric_limits<std::uint32_t>::max() - next_) {
    std::fill(words_.begin(), words_.end(), 0);
    next_ = 1;
  }
  first_ = next_;
}

#ifndef NDEBUG

namespace {

enum class Phase : std::uint8_t { serial, deciding, committing };
thread_local Phase phase = Phase::serial;
thread_local std::span<const Index> may_write;

}  // namespace

WriteRule::Deciding::Deciding() { phase = Phase::deciding; }
WriteRule::Deciding::~Deciding() { phase = Phase::serial; }

WriteRule::Committing::Committing(std::span<const Index> write_set) {
  phase = Phase::committing;
  may_write = write_set;
}
WriteRule::Committing::~Committing() { phase = Phase::serial; }

void WriteRule::check(Index vertex) {
  check();
  TETWRIGHT_CHECK(phase == Phase::serial ||
                  std::find(may_write.begin(), may_write.end(), vertex) != may_write.end());
}

void WriteRule::check() { TETWRIGHT_CHECK(phase != Phase::deciding); }

#endif

}  // namespace tetwright

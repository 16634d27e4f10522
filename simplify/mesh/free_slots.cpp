#include "simplify/mesh/free_slots.h"

#include <algorithm>

namespace tetwright {

namespace {

/// Slots that a worker takes at once: few enough to waste little, enough to meet others seldom.
constexpr std::size_t lot = 64;

}  // namespace

void FreeSlotReserve::reset(std::size_t first, std::size_t end) {
  next_ = first;
  end_ = end;
}

bool FreeSlotReserve::take_lot(std::vector<Index>& free) {
  // Relaxed: the number carries no other data.
  const std::size_t first = next_.fetch_add(lot, std::memory_order_relaxed);
  if (first >= end_) {
    next_.store(end_, std::memory_order_relaxed);
    return false;
  }
  for (std::size_t i = std::min(end_, first + lot); i-- > first;) free.push_back(static_cast<Index>(i));
  return true;
}

}  // namespace tetwright

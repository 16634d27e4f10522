// SPDX-License-Identifier: Apache-2.0
#include "simplify/mesh/local_numbers.h"

namespace tetwright {

std::size_t LocalNumbers::grow(Index key) {
  std::vector<Slot> old(2 * slots_.size());
  old.swap(slots_);
  mask_ = slots_.size() - 1;
  const auto free_slot = [&](Index k) {
    std::size_t i = home(k);
    while (slots_[i].stamp >= first_) i = (i + 1) & mask_;
    return i;
  };
  for (const Slot& s : old)
    if (s.stamp >= first_) slots_[free_slot(s.key)] = s;
  return free_slot(key);
}

void LocalNumbers::restart() {
  for (Slot& s : slots_) s.stamp = 0;
  first_ = 1;
}

}  // namespace tetwright

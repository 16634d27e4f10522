#include "simplify/mesh/local_numbers.h"

namespace tetwright {

std::size_t LocalNumbers::grow(Index key) {
  std::vector<Slot> old(2 * slots_.size());
  old.swap(slots_);
  const auto free_slot = [&](Index k) {
    std::size_t i = home(k);
    while (slots_[i].epoch == epoch_) i = (i + 1) & (slots_.size() - 1);
    return i;
  };
  for (const Slot& s : old)
    if (s.epoch == epoch_) slots_[free_slot(s.key)] = s;
  return free_slot(key);
}

void LocalNumbers::restart() {
  for (Slot& s : slots_) s.epoch = 0;
  epoch_ = 1;
}

}  // namespace tetwright

#include "simplify/local_numbers.h"

namespace tetwright {

std::uint32_t LocalNumbers::number(Index key, bool& added) {
  std::size_t i = home(key);
  for (; slots_[i].epoch == epoch_; i = (i + 1) & (slots_.size() - 1))
    if (slots_[i].key == key) {
      added = false;
      return slots_[i].number;
    }
  added = true;
  if (2 * (size_ + 1) > slots_.size()) {  // keep it at most half full
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    for (const Slot& s : old)
      if (s.epoch == epoch_) {
        std::size_t j = home(s.key);
        while (slots_[j].epoch == epoch_) j = (j + 1) & (slots_.size() - 1);
        slots_[j] = s;
      }
    i = home(key);
    while (slots_[i].epoch == epoch_) i = (i + 1) & (slots_.size() - 1);
  }
  slots_[i] = {key, size_, epoch_};
  return size_++;
}

}  // namespace tetwright

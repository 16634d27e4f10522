#include "simplify/operations/workspace.h"

#include <algorithm>

namespace tetwright {

float Workspace::acceptance_limit(const BlockRules& rules, float worst) {
  const bool may_worsen = rules.accept_worse > 0 && random.uniform() < rules.accept_worse;
  return std::min(rules.good_enough, may_worsen ? rules.annealing_floor * worst : worst);
}

}  // namespace tetwright

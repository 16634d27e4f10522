// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace tetwright {

/// with_threads() for a library in a host program: leaves the settings of oneTBB, which are the process's, as
/// they are. More threads than oneTBB has are then as many as it has; results do not depend on it.
void with_threads_of_host(unsigned threads, const std::function<void()>& work);

}  // namespace tetwright

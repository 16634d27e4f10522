// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace tetwright {

/// with_threads() for a library in a host program: leaves the settings of oneTBB, which apply to the whole
/// process, unchanged. A larger number of threads than oneTBB allows is lowered to oneTBB's; results do not
/// depend on it.
void with_threads_of_host(unsigned threads, const std::function<void()>& work);

}  // namespace tetwright

// SPDX-License-Identifier: Apache-2.0
#include "common/error.h"

namespace tetwright::detail {

void check_failed(const char* condition, const char* file, int line) {
  throw InternalError(std::string("internal error at ") + file + ":" + std::to_string(line) + ": '" +
                      condition + "' is false");
}

}  // namespace tetwright::detail

#include "common/error.h"

#include <cstdio>
#include <cstdlib>

namespace tetwright::detail {

void check_failed(const char* condition, const char* file, int line) {
  std::fprintf(stderr, "tetwright: internal error at %s:%d: %s does not hold; please report it\n", file, line,
               condition);
  std::abort();
}

}  // namespace tetwright::detail

#include "common/base/check.h"

#include <cstdio>
#include <cstdlib>

namespace isotherm::internal {

void CheckFailed(std::string_view condition, std::string_view file, int line) {
  std::fprintf(stderr, "<2>%.*s:%d: check failed: %.*s\n", static_cast<int>(file.size()),
               file.data(), line, static_cast<int>(condition.size()), condition.data());
  std::abort();
}

}  // namespace isotherm::internal

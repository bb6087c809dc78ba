#include "common/base/freed_memory.h"

#include <malloc.h>

namespace isotherm {
namespace {

constexpr std::chrono::seconds kInterval{10};

}  // namespace

void FreedMemory::GiveBackIfDue(std::chrono::steady_clock::time_point now) {
  if (last_ && now - *last_ < kInterval) return;
  if (last_) malloc_trim(0);
  last_ = now;
}

}  // namespace isotherm

#pragma once

#include <string_view>

namespace isotherm::internal {
/// Prints where and what, then aborts. For bugs in this program, never for bad input.
[[noreturn]] void CheckFailed(std::string_view condition, std::string_view file, int line);
}  // namespace isotherm::internal

/// Aborts on a bug; always on.
#define CHECK(condition)                                                 \
  do {                                                                   \
    if (!(condition)) [[unlikely]]                                       \
      ::isotherm::internal::CheckFailed(#condition, __FILE__, __LINE__); \
  } while (false)

/// The same for inner loops; compiled out with NDEBUG.
#ifdef NDEBUG
#define DCHECK(condition) static_cast<void>(0)
#else
#define DCHECK(condition) CHECK(condition)
#endif

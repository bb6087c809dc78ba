#pragma once

#include <cstdint>

#include "common/transport/refusal.h"

namespace isotherm {

/// Holds what one stream has received of one session.
struct StreamTally {
  std::uint64_t session = 0;
  std::uint64_t next = 0;  ///< One above the highest number.
  std::uint64_t received = 0;
  std::uint64_t recorded_before = 0;  ///< Part of received: an earlier process has recorded them.
  std::uint64_t late = 0;
  std::uint64_t duplicates = 0;
  RefusalCounts refused{};  ///< Samples since the session began, by cause.
};

}  // namespace isotherm

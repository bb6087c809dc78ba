#pragma once

#include <cstdint>

#include "common/messages/messages.h"

namespace isotherm {

/// Returns whether the ground lacks more of the recorded frames than are always on their way, or
/// wait for their turn: somebody should know.
inline bool HasBacklog(const EdgeStatus& status) {
  // One and a half seconds of frames at 30 and 40 Hz.
  constexpr std::uint64_t kUsual = 100;
  return status.spool_frames > kUsual;
}

}  // namespace isotherm

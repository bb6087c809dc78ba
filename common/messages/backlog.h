#pragma once

#include <cstdint>
#include <string>

#include "common/messages/messages.h"

namespace isotherm {

/// Returns whether the ground lacks more of the recorded frames than are always on their way, or
/// wait for their turn: somebody should know.
inline bool HasBacklog(const EdgeStatus& status) {
  // One and a half seconds of frames at 30 and 40 Hz.
  constexpr std::uint64_t kUsual = 100;
  return status.spool_frames > kUsual;
}

/// The reason in EdgeStatus for frames that the rig has not sent while they were new, because the
/// link is too narrow for all of them.
inline constexpr const char* kLeftForLater = "left for later";

/// Returns how many frames wait on the rig for that reason.
inline std::uint64_t LeftForLater(const EdgeStatus& status) {
  std::uint64_t frames = 0;
  for (const StreamStatus* stream : {&status.depth, &status.thermal}) {
    for (const DropCount& drop : stream->dropped) {
      if (drop.reason == kLeftForLater) frames += drop.frames;
    }
  }
  return frames;
}

/// "640 frames of 9 s, 42 MB (link too narrow)": what the ground lacks, and how much of the scan
/// that is, while both cameras deliver.
std::string BacklogText(const EdgeStatus& status);

/// Says how the link to a rig that is heard is, by its newest status.
std::string LinkText(const EdgeStatus& status);

}  // namespace isotherm

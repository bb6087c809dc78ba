#pragma once

#include <fmt/format.h>

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

/// "640 frames of 9 s (link too narrow)": what the ground lacks, and how much of the scan that is,
/// while both cameras deliver.
inline std::string BacklogText(const EdgeStatus& status) {
  const double depth_hz = status.depth.rate_hz, thermal_hz = status.thermal.rate_hz;
  const bool is_known =
      status.scan_state == ScanState::kScanning && depth_hz > 0.0 && thermal_hz > 0.0;
  const double seconds = static_cast<double>(status.spool_frames) / (depth_hz + thermal_hz);
  return fmt::format("{} frames{}{}", status.spool_frames,
                     is_known ? fmt::format(" of {:.0f} s", seconds) : "",
                     LeftForLater(status) > 0 ? " (link too narrow)" : "");
}

}  // namespace isotherm

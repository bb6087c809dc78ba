#include "common/messages/backlog.h"

#include <fmt/format.h>

#include "common/base/units.h"

namespace isotherm {

std::string BacklogText(const EdgeStatus& status) {
  const double depth_hz = status.depth.rate_hz, thermal_hz = status.thermal.rate_hz;
  const bool is_known =
      status.scan_state == ScanState::kScanning && depth_hz > 0.0 && thermal_hz > 0.0;
  const double seconds = static_cast<double>(status.spool_frames) / (depth_hz + thermal_hz);
  const double megabytes = static_cast<double>(status.spool_bytes) / kBytesPerMb;
  return fmt::format("{} frames{}{}{}", status.spool_frames,
                     is_known ? fmt::format(" of {:.0f} s", seconds) : "",
                     status.spool_bytes > 0 ? fmt::format(", {:.0f} MB", megabytes) : "",
                     LeftForLater(status) > 0 ? " (link too narrow)" : "");
}

std::string LinkText(const EdgeStatus& status) {
  std::string text = HasBacklog(status) ? "to come from the rig's recording: " + BacklogText(status)
                                        : (status.frames_gone > 0 ? "" : "link good");
  if (status.frames_gone == 0) return text;
  return fmt::format("{}{}THE RIG HAS DELETED {} frames that did not arrive", text,
                     text.empty() ? "" : ", ", status.frames_gone);
}

}  // namespace isotherm

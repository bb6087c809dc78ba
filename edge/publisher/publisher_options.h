#pragma once

#include <string>

#include "common/base/status.h"
#include "common/messages/messages.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Says as whom and with which patience an edge publishes.
struct PublisherOptions {
  std::string edge_id = "edge";  ///< Key of everything this rig writes; 1..32 bytes.
  std::string software_version;  ///< Goes into the hello.
  PublishPolicy policy = PublishPolicy::kLive;
  /// With kLive: frames go in pieces, if the ground that follows this rig reads them.
  bool pieces = true;
  /// With kLossless: over a link on which whole frames do not get along (RepairWatch) they go as
  /// with kLive, and in pieces, until the session ends. Right if frames come at a camera's pace,
  /// and what gets lost is sent again from a recording.
  bool leaves_whole_frames = false;
  /// With kLossless: frames of one stream that may be under way beyond what the ground has handled.
  /// Larger: faster replay, more memory on both sides. 1..kMaxFlowWindowFrames (qos.h), so that no
  /// history overflows.
  int flow_window_frames = 24;
  /// With kLossless: the ground may be silent for this long before a frame is published all the
  /// same (and counted).
  Nanoseconds flow_timeout = std::chrono::seconds(10);
};

Status Validate(const PublisherOptions& options);

}  // namespace isotherm

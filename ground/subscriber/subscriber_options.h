#pragma once

#include <string>

#include "common/base/status.h"
#include "common/time/time_types.h"

namespace isotherm {

/// Says whom a ground follows and how long it waits for what.
struct SubscriberOptions {
  std::string edge_id = "edge";  ///< The rig to follow; empty follows the first one seen.
  std::string ground_id = "ground";
  std::string software_version;  ///< Goes into the hello.
  /// Frames may arrive out of order by this much; later ones are counted as late. 0..200 ms. The
  /// middleware keeps the order of what a rig sends: what is missing before a frame was left out,
  /// and is not waited for.
  Nanoseconds reorder_window{};
  /// A receipt goes out this often, and after every eighth frame.
  Nanoseconds receipt_interval = std::chrono::milliseconds(200);
  /// After the edge has ended its session, missing frames are given up when nothing has come for
  /// this long.
  Nanoseconds end_grace = std::chrono::seconds(2);
  /// The rig's wall clock may differ from ours by this much before there is an alarm; 0 = no alarm.
  Nanoseconds max_clock_offset = std::chrono::milliseconds(50);
};

Status Validate(const SubscriberOptions& options);

}  // namespace isotherm

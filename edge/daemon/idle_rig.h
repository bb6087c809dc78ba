#pragma once

#include <stop_token>

#include "common/time/clock.h"
#include "edge/publisher/publisher.h"

namespace isotherm {

/// Waits for the order to start a scan, with the cameras closed (link.wait_for_order): tells the
/// ground that the rig is there, once a second, and refuses every other order. Returns whether the
/// order came; false when stop is requested. Needs a publisher without a session, on which nobody
/// else calls Run().
bool WaitForScanOrder(Publisher& publisher, const Clock& clock, const std::stop_token& stop);

}  // namespace isotherm

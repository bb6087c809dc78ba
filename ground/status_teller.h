#pragma once

#include <string>

#include "common/time/clock.h"
#include "ground/subscriber/subscriber.h"

namespace isotherm {

/// One line: what has arrived of the scan, and how the rig's clock is.
std::string StatusText(const SubscriberStats& stats);

/// Writes what the rig's cameras are into the log; a replay or a simulation has none.
void TellAboutCameras(const RigDescription& rig);

/// Tells the service manager every ten seconds, and the journal while a scan runs.
/// Thread-compatible.
class StatusTeller {
 public:
  /// `clock` must outlive it.
  explicit StatusTeller(const Clock& clock) : clock_(clock), next_(clock.SteadyNow() + kInterval) {}

  /// To be called more often than the interval.
  void Tell(const SubscriberStats& stats);

 private:
  static constexpr Nanoseconds kInterval = std::chrono::seconds(10);

  const Clock& clock_;
  SteadyTime next_;
};

}  // namespace isotherm

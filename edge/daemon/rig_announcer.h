#pragma once

#include <functional>
#include <string>

#include "edge/daemon/session_start.h"
#include "edge/pipeline/camera_health.h"
#include "edge/publisher/publisher.h"
#include "edge/spool/spool.h"

namespace isotherm {

class EdgeOptions;

/// Announces and records the rig anew when a camera that was missing at the start has been opened:
/// what it says of itself, the scale of its temperatures among it, was not known before.
/// Thread-bound.
class RigAnnouncer {
 public:
  /// All but `start` must outlive it; the rig is announced as `start` describes it. `record` takes
  /// it to the recording.
  RigAnnouncer(const EdgeOptions& options, EdgeSession start, const CameraHealth& health,
               Publisher& publisher, std::function<void(RigUpdate)> record);

  /// Call it often: what could not be announced is tried again.
  void Tick();

 private:
  bool IsAnnounced(Sensor sensor) const;

  const EdgeOptions& options_;
  const CameraHealth& health_;
  Publisher& publisher_;
  const std::function<void(RigUpdate)> record_;
  EdgeSession announced_;
  bool is_due_ = false;  ///< A camera is known that could not be announced so far.
  std::string problem_;  ///< Why not; logged once.
};

}  // namespace isotherm

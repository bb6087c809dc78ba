#pragma once

#include "edge/daemon/session_start.h"
#include "edge/pipeline/camera_health.h"
#include "edge/publisher/publisher.h"

namespace isotherm {

class EdgeOptions;

/// Announces the rig anew when a camera that was missing at the start has been opened: what it says
/// of itself, the scale of its temperatures among it, was not known before. Thread-bound.
class RigAnnouncer {
 public:
  /// All but `start` must outlive it; the rig is announced as `start` describes it.
  RigAnnouncer(const EdgeOptions& options, SessionStart start, const CameraHealth& health,
               Publisher& publisher);

  /// Call it often.
  void Tick();

 private:
  bool IsAnnounced(Sensor sensor) const;

  const EdgeOptions& options_;
  const CameraHealth& health_;
  Publisher& publisher_;
  SessionStart announced_;
};

}  // namespace isotherm

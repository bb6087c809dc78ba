#pragma once

#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "common/base/status.h"
#include "common/rig/rig.h"
#include "common/time/clock.h"
#include "edge/frame_counters/frame_counters.h"
#include "edge/pipeline/camera_health.h"
#include "edge/source/frame_source.h"

namespace isotherm {

class EdgeOptions;
class SourceOptions;

Status Validate(const SourceOptions& options);

/// Holds what a source is put together with. All must outlive it.
struct SourceContext {
  const Clock& clock;
  FrameCounters& counters;
  CameraHealth& health;
  /// A calibration that overrides the source's own: frames of other sizes are refused.
  const std::optional<Rig>& calibration;
  std::stop_token stop;  ///< Ends the rendering of a simulated scan, or the opening of a camera.
};

/// Keeps why a camera cannot be used at all, as last logged.
using ToldProblems = std::map<Sensor, std::string>;

/// The source that the options ask for, supervised: a recording, a simulated scan, or the cameras,
/// each on a thread of its own. Not opened yet. `told` keeps it from saying the same again when it
/// is called once more.
Result<std::unique_ptr<FrameSource>> MakeSource(const EdgeOptions& options,
                                                const SourceContext& context, ToldProblems& told);

}  // namespace isotherm

#pragma once

#include <memory>
#include <string>

#include "common/base/status.h"
#include "common/time/clock.h"
#include "edge/source/frame_source.h"

namespace isotherm {

class SourceOptions;

/// The driver's source for one camera, not supervised, in this process. `clock` must outlive it.
/// kUnavailable: this program was built without it.
Result<std::unique_ptr<FrameSource>> MakeCamera(Sensor sensor, const SourceOptions& options,
                                                const Clock& clock);

/// What is connected, for people: a line per camera with driver, serial number and modes.
std::string ListCameras();

}  // namespace isotherm

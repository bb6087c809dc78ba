#pragma once

#include <optional>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/recording/recording.h"

namespace isotherm {

/// Unpacks a recorded frame. `depth_scale` replaces the frame's own, `thermal_delay` is added to
/// its capture time. Fails if the image cannot be decoded.
Result<DepthFramePtr> Unpack(const RecordedDepth& recorded, std::optional<double> depth_scale);
Result<ThermalFramePtr> Unpack(const RecordedThermal& recorded, Nanoseconds thermal_delay);

}  // namespace isotherm

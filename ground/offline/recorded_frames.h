#pragma once

#include <functional>
#include <optional>
#include <stop_token>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/recording/recording.h"

namespace isotherm {

/// Hands on all items of a recording in order, and for each that cannot be read the error.
/// `progress`, if there is one, gets the fraction done, 0..1. Ends early when `stop` is requested.
void ReadItems(RecordingReader& reader, const std::function<void(RecordedItem&)>& take,
               const std::function<void(const Status&)>& fail,
               const std::function<void(double)>& progress, const std::stop_token& stop = {});

/// Unpacks a recorded frame. `depth_scale` replaces the frame's own, `thermal_delay` is added to
/// its capture time. Fails if the image cannot be decoded.
Result<DepthFramePtr> Unpack(const RecordedDepth& recorded, std::optional<double> depth_scale);
Result<ThermalFramePtr> Unpack(const RecordedThermal& recorded, Nanoseconds thermal_delay);

}  // namespace isotherm

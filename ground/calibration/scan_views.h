#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <stop_token>

#include "common/base/status.h"
#include "ground/calibration/texture_consistency.h"

namespace isotherm {

struct RecordingInfo;
struct ScanModel;

/// The least number of thermal frames that a delay is found from.
inline constexpr std::size_t kMinThermalFrames = 40;

/// Adds the certain poses of `scan` and up to `max_points` points of its surface (in `world`) to
/// thermal frames, and which of them the frames show at all delays in [-range_s,
/// range_s]. Fails with what is missing: frames, surface, motion. `progress` gets the fraction
/// done, 0..1. Gives up soon after `stop` was requested; frames may show nothing then.
Status AddSurface(const ScanModel& scan, std::size_t max_points, double range_s, ScanViews& views,
                  const std::function<void(double)>& progress, const std::stop_token& stop = {});

/// The delay that a recording's thermal stamps contain already: that of the edge that made it, in
/// seconds; 0 for other recordings; nullopt if it was made by the ground, which is not told.
std::optional<double> AppliedDelay(const RecordingInfo& info);

}  // namespace isotherm

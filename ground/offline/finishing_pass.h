#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <vector>

#include "common/base/status.h"
#include "common/time/time_types.h"
#include "ground/pipeline/thermal_pass.h"

namespace isotherm {

/// Says how the frames of a recording were given to the first pass.
struct FirstPass {
  std::filesystem::path recording;
  std::optional<double> depth_scale;  ///< Instead of the frames' own.
  Nanoseconds thermal_delay;          ///< Added to the recorded capture times.
  std::vector<CaptureTime> held_out;  ///< Stamps of the thermal frames left out, ascending.
  std::stop_token stop{};             ///< Ends the second pass early.
};

/// Gives the same frames to a pass over the finished surface, in the same order. What cannot be
/// read was told the first time. `progress` gets the fraction done, 0..1. Fails if the recording is
/// gone.
Status FuseOnFinishedSurface(const FirstPass& first, ThermalPass& pass,
                             const std::function<void(double)>& progress);

}  // namespace isotherm

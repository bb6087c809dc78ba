#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/rig/rig.h"

namespace isotherm {

/// Hands the thermal frames of a recording to `take`, valid or not (those without an image),
/// until one is refused. `rig` is compared with the recording's by the thermal camera's serial
/// number, and set to it if there is none. `progress` gets the fraction done, 0..1. The message of
/// a failure names the recording.
Status ReadThermalFrames(const std::filesystem::path& recording, std::optional<Rig>& rig,
                         const std::function<void(double)>& progress,
                         const std::function<Status(const ThermalFrame&)>& take);

}  // namespace isotherm

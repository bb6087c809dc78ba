#pragma once

#include <vector>

#include "common/base/status.h"
#include "ground/camera_calibration/calibration_images.h"
#include "ground/camera_calibration/target.h"
#include "ground/cli/rig_order.h"

namespace isotherm {

/// Receives a running rig's frames and keeps the poses in which nothing moves, until the program is
/// told to stop (Ctrl-C), the rig ends its session, or there are many. After each pose it prints
/// what is still missing (CalibrationCoach). By stream, as `streams` and `lenses`. Fails if no rig
/// is there, or no pose was kept.
Result<std::vector<ImageSeries>> TakeLiveSeries(const RigAddress& address,
                                                const CalibrationTarget& target,
                                                const std::vector<CalibratedStream>& streams,
                                                const std::vector<LensKind>& lenses);

}  // namespace isotherm

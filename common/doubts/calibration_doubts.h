#pragma once

#include <chrono>

#include "common/doubts/doubts.h"

namespace isotherm {

class RigCalibration;

/// Holds from where on a calibration is to be doubted.
struct CalibrationLimits {
  int max_age_days = 365;       ///< 0 = any age will do.
  double uncertainty_px = 0.5;  ///< The fusion takes as much as a registration error.
};

/// Doubts a calibration file whose values are old, dated later than tomorrow, or less certain than
/// the limit.
Doubts DoubtsAboutRecords(const RigCalibration& rig, std::chrono::sys_days today,
                          const CalibrationLimits& limits);

}  // namespace isotherm

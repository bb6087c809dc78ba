#pragma once

#include <functional>
#include <string>

#include "common/base/status.h"
#include "common/rig/rig.h"

namespace isotherm {

class RigCalibration;

/// Holds where a calibration comes from and goes to.
struct RigFilePaths {
  std::string rig;     ///< The file that was calibrated; empty: the recording's own calibration.
  std::string output;  ///< May be the same.
};

/// Writes the calibration with what `change` makes of it, and says so on standard output: that of
/// the file with all that a Rig does not hold, or `recorded`. A file that was there before is kept
/// beside it as FILE.bak.
Status WriteCalibratedRig(const RigFilePaths& paths, const Rig& recorded,
                          const std::function<void(RigCalibration&)>& change);

}  // namespace isotherm

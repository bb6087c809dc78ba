#pragma once

#include <filesystem>
#include <string>

#include "common/base/status.h"
#include "ground/camera_calibration/calibration_report.h"

namespace isotherm {

/// Writes what was calibrated into a rig file: a new one, or an existing one whose other values
/// stay, and which is kept beside it as FILE.bak. `serials` are those of the report's cameras,
/// empty if not known; the file's own serial numbers must not be others.
Status UpdateRigFile(const std::filesystem::path& path, const CalibrationReport& report,
                     const std::vector<std::string>& serials);

}  // namespace isotherm

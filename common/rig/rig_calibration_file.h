#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>

#include "common/base/status.h"

namespace isotherm {

class CalibrationRecord;
class RigCalibration;

/// Sets the whole matrix, row by row.
void SetCovariance(const Eigen::MatrixXd& covariance, CalibrationRecord& record);

/// Changes a rig file, or makes a new one: `edit` gets what the file says. Nothing is written if it
/// fails or if the result could not be read again. As it was, the file is kept beside it as
/// FILE.bak. Comments are lost.
Status EditRigFile(const std::filesystem::path& path,
                   const std::function<Status(RigCalibration&)>& edit);

}  // namespace isotherm

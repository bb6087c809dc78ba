#pragma once

#include <vector>

#include "common/base/status.h"
#include "edge/source/device_description.h"

namespace isotherm {

/// The depth cameras that OpenNI2 can see now; `bus_port` is OpenNI2's address. Opens each for its
/// serial number and modes.
Result<std::vector<DeviceDescription>> ListOpenniCameras();

}  // namespace isotherm

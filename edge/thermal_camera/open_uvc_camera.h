#pragma once

#include <memory>

#include "common/base/status.h"
#include "common/time/clock.h"
#include "edge/thermal_camera/thermal_camera.h"
#include "edge/usb/uvc_camera.h"

namespace isotherm {

/// Opens the camera of the video class at `info.bus_port`, and puts into `info` what the device
/// says of itself. `clock` must outlive the camera.
Result<std::unique_ptr<UvcCamera>> OpenUvcCamera(const Clock& clock, ThermalCameraInfo& info);

/// Returns what is known of any frame before its bytes are read: when it came and whether it is
/// whole.
RawThermalFrame BeginFrame(const UvcFrame& frame);

}  // namespace isotherm

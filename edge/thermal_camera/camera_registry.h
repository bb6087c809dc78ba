#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/time/clock.h"
#include "edge/source/device_description.h"
#include "edge/thermal_camera/thermal_camera.h"

namespace isotherm {

class ThermalCameraOptions;

Status Validate(const ThermalCameraOptions& options);

/// Returns the thermal cameras for which there is a driver, connected or not.
std::vector<DeviceDescription> SupportedThermalCameras();

/// Returns the thermal cameras that are connected.
Result<std::vector<DeviceDescription>> ListThermalCameras();

/// The camera of `devices` that the options ask for. `pinned_serial` is the serial number of the
/// camera that was in use before (empty: none): another one is refused, because the calibration is
/// not its own. The Status says which cameras are there instead.
Result<DeviceDescription> ChooseThermalCamera(const std::vector<DeviceDescription>& devices,
                                              const ThermalCameraOptions& options,
                                              const std::string& pinned_serial);

/// The driver for `device`, which ListThermalCameras has found; not opened yet. `clock` must
/// outlive it.
std::unique_ptr<ThermalCamera> MakeThermalCamera(const DeviceDescription& device,
                                                 const ThermalCameraOptions& options,
                                                 const Clock& clock);

}  // namespace isotherm

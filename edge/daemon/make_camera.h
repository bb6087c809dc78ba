#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "common/base/status.h"
#include "common/time/clock.h"
#include "edge/source/frame_source.h"

namespace isotherm {

class DepthCameraOptions;
class SourceOptions;

Status Validate(const DepthCameraOptions& options);

/// The driver's source for one camera, not supervised, in this process. `clock` must outlive it.
/// kUnavailable: this program was built without it.
Result<std::unique_ptr<FrameSource>> MakeCamera(Sensor sensor, const SourceOptions& options,
                                                const Clock& clock);

/// Returns whether the camera's library may crash or hang without taking the edge along.
bool RunsInOwnProcess(Sensor sensor, const SourceOptions& options);
/// The same camera in a process of its own: this program again, with --camera-process. `stop`
/// ends an opening early.
std::unique_ptr<FrameSource> MakeCameraProcess(Sensor sensor, const SourceOptions& options,
                                               const Clock& clock, std::stop_token stop);
/// Runs the program when it was started so; returns the exit status. `sensor_name`: "depth" or
/// "thermal"; `source_options`: text format.
int RunCameraProcess(const std::string& sensor_name, const std::string& source_options,
                     const Clock& clock);

/// Returns what is connected, for people: a line per camera with driver, serial number and modes.
std::string ListCameras();

}  // namespace isotherm

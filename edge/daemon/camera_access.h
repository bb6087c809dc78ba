#pragma once

#include <optional>
#include <span>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "edge/camera_process/camera_sandbox.h"
#include "edge/camera_process/usb_nodes.h"

namespace isotherm {

class CameraSandboxOptions;
class SourceOptions;

Status Validate(const CameraSandboxOptions& options);

/// Returns what the library of this camera needs: the system's libraries, its camera or its file,
/// and what the options add. Nullopt if the options want no sandbox. `connected` is what is on the
/// USB: of that the camera of source.depth_camera.uri, or else the cameras that OpenNI2's drivers
/// are for; an Optris camera. Others must be named by the options.
std::optional<CameraSandbox> AccessFor(Sensor sensor, const SourceOptions& options,
                                       std::span<const UsbNode> connected);

}  // namespace isotherm

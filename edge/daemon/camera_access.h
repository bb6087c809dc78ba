#pragma once

#include <optional>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "edge/camera_process/camera_sandbox.h"

namespace isotherm {

class CameraSandboxOptions;
class SourceOptions;

Status Validate(const CameraSandboxOptions& options);

/// Returns what the library of this camera needs: the system's libraries, its camera or its file,
/// and what the options add. Nullopt if the options want no sandbox.
std::optional<CameraSandbox> AccessFor(Sensor sensor, const SourceOptions& options);

}  // namespace isotherm

#pragma once

#include <chrono>
#include <string>

#include "edge/camera_process/camera_process.h"

namespace isotherm {

/// The process of testing/fake_camera_process.cc, which does `what` after this many frames.
inline CameraProcess::Settings Fake(const std::string& what, int after_frames) {
  CameraProcess::Settings settings;
  settings.name = "fake camera";
  settings.program = FAKE_CAMERA_PROCESS;
  settings.arguments = {what, std::to_string(after_frames)};
  settings.hang_timeout = std::chrono::milliseconds(500);
  return settings;
}

}  // namespace isotherm

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/geometry/camera.h"

namespace openni {
class Device;
class VideoStream;
}  // namespace openni

namespace isotherm {

class DepthCameraOptions;

/// Keeps OpenNI2 and its drivers loaded. Nesting is counted by the library. Thread-compatible.
class OpenniLibrary {
 public:
  OpenniLibrary();
  ~OpenniLibrary();
  OpenniLibrary(const OpenniLibrary&) = delete;
  OpenniLibrary& operator=(const OpenniLibrary&) = delete;

  const Status& status() const { return status_; }

 private:
  Status status_;
};

/// Returns what the library says about its last failure, in one line.
std::string OpenniError();

/// Empty: the camera does not say.
std::string SerialOf(const openni::Device& device);

/// The depth modes in units that we understand: "640x480@30 1 mm".
std::vector<std::string> DepthModes(const openni::VideoStream& stream);

/// Holds what a stream was found to do after it was set up.
struct ActiveSettings {
  int width = 0;
  int height = 0;
  int rate_hz = 0;
  double depth_scale = 1000.0;  ///< Raw units per metre.
  bool mirrored = false;        ///< The camera did not stop mirroring: each line is reversed.
  std::string text;             ///< "unit 1 mm, mirroring off, registration off, close range on".
};

/// Sets mode, mirroring, registration and close range of a camera and reads them back.
/// kInvalidArgument: the camera has no such mode or setting.
Result<ActiveSettings> Configure(const DepthCameraOptions& options, openni::Device& device,
                                 openni::VideoStream& stream);
/// The same for a file: nothing is set.
Result<ActiveSettings> ReadSettings(const openni::Device& device,
                                    const openni::VideoStream& stream);

/// A pinhole camera for `width` x `height` pixels from the stream's field of view, or from its
/// zero-plane properties (PrimeSense): focal length = plane distance / pixel size at 1280 pixels'
/// width. Nullopt if it has neither.
std::optional<CameraModel> NominalIntrinsics(const openni::VideoStream& stream, int width,
                                             int height);

}  // namespace isotherm

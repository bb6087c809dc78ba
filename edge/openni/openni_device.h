#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "common/base/status.h"
#include "common/frame/image.h"
#include "common/geometry/camera.h"
#include "common/time/time_types.h"
#include "edge/source/frame_source.h"

namespace isotherm {

class DepthCameraOptions;

/// One depth camera or .oni file, opened and streaming: the thin layer over OpenNI2. What was asked
/// for is set and read back. A file that was played to its end or let go of before keeps its memory
/// and an idle thread until the process ends, because OpenNI2 cannot close it safely. Thread-bound.
class OpenniDevice {
 public:
  /// Holds a depth image as the library delivers it.
  struct Frame {
    /// Row-major, `depth_scale` units per metre, 0 = no return. Empty if the library's buffer does
    /// not have the size it says.
    Image<std::uint16_t> pixels;
    double depth_scale = 1000.0;
    std::uint64_t timestamp_us = 0;  ///< Camera clock, arbitrary zero.
    int index = 0;                   ///< Counts frames of the stream, also those that were lost.
  };

  /// Opens what the options name. A file plays at `file_rate` (1 = real time, 0 = a frame per
  /// Wait), once. kUnavailable: no such camera; kNotFound: no such file; kInvalidArgument: it
  /// cannot do what was asked, with what it can.
  static Result<std::unique_ptr<OpenniDevice>> Open(const DepthCameraOptions& options,
                                                    double file_rate);
  virtual ~OpenniDevice() = default;
  OpenniDevice(const OpenniDevice&) = delete;
  OpenniDevice& operator=(const OpenniDevice&) = delete;

  /// The next frame; nullopt if there was none within `timeout` (at most 0.1 s). kUnavailable: the
  /// camera was unplugged.
  virtual Result<std::optional<Frame>> Wait(Nanoseconds timeout) = 0;
  /// All frames of a file were delivered.
  virtual bool ended() const = 0;
  virtual bool is_file() const = 0;
  virtual const CameraDescription& description() const = 0;
  virtual double depth_scale() const = 0;  ///< Raw units per metre.
  /// From the camera's field of view: right to a few percent, without distortion. Nullopt if the
  /// camera says nothing.
  virtual const std::optional<CameraModel>& nominal_intrinsics() const = 0;

 protected:
  OpenniDevice() = default;
};

}  // namespace isotherm

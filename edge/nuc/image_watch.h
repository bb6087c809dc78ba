#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/doubts/repeat_detector.h"
#include "common/frame/image.h"
#include "common/frame/radiometric_scale.h"
#include "common/time/time_types.h"

namespace isotherm {

class NucOptions;

/// Holds what thermal images alone say about the shutter.
struct ImageEvidence {
  bool is_frozen = false;        ///< The same image again and again: no camera is free of noise.
  bool is_like_shutter = false;  ///< Uniform from one frame to the next, where there was a scene.
};

/// Looks for the shutter in thermal images, for cameras that do not say when it is closed.
///
/// Frozen: more repeats in a row than the camera may make (IsFrozen).
/// Like the shutter: the spread of the image's values (their standard deviation) falls below a
/// fraction of the least spread of the last frames with a scene. A camera that is turned towards a
/// wall takes longer than that; if the image stays uniform, it is taken for the scene.
/// Thread-compatible.
class ImageWatch {
 public:
  explicit ImageWatch(const NucOptions& options);

  /// `temperature_raw`: height x width, counts of `scale`, 0 = no value. `known_closed`: the camera
  /// says that it shows no scene. `time` must not decrease between calls.
  ImageEvidence Add(const Image<std::uint16_t>& temperature_raw, const RadiometricScale& scale,
                    CaptureTime time, bool known_closed);

 private:
  bool IsLikeShutter(double spread_k, CaptureTime time, bool known_closed);

  const int native_repeats_;
  const double uniform_fraction_;  ///< 0 = never.
  const Nanoseconds longest_;
  RepeatDetector repeats_;
  std::deque<double> scene_spreads_k_;  ///< Spreads of the last frames with a scene.
  std::optional<CaptureTime> uniform_since_;
};

/// Standard deviation of the values of an image, kelvin; pixels without a value do not count.
double ImageSpread(const Image<std::uint16_t>& temperature_raw, const RadiometricScale& scale);

}  // namespace isotherm

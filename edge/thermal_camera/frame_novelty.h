#pragma once

#include <cstdint>
#include <optional>

#include "common/doubts/repeat_detector.h"
#include "edge/source/missed_frames.h"
#include "edge/thermal_camera/thermal_camera.h"

namespace isotherm {

/// Holds what a frame is in relation to those before it.
struct Novelty {
  /// Says whether an image is new.
  enum class Kind {
    kNew,
    kRepeat,  ///< The same image again, as the camera may do; nothing is lost without it.
    kFrozen,  ///< The same image for too often: the camera hangs, or corrects itself silently.
  };
  Kind kind = Kind::kNew;
  std::uint64_t lost = 0;     ///< Images that the camera counted and we did not get.
  Nanoseconds frozen_for{0};  ///< Since the image came first.
};

/// Tells new images from repeated and frozen ones, by the camera's counter and by the pixels: no
/// two images of a working detector are bit for bit the same. Thread-compatible.
class FrameNovelty {
 public:
  /// `counter_step`, `native_repeats`: see ThermalCameraInfo.
  FrameNovelty(int counter_step, int native_repeats) : native_repeats_(native_repeats) {
    if (counter_step > 0) missed_.emplace(static_cast<std::uint64_t>(counter_step));
  }

  Novelty Process(const RawThermalFrame& frame);

 private:
  std::uint64_t LostBefore(const RawThermalFrame& frame);

  const int native_repeats_;
  std::optional<MissedFrames> missed_;  ///< Absent: the camera does not count.
  std::optional<std::uint64_t> counter_;
  RepeatDetector images_;
  int repeats_ = 0;
  bool was_correcting_ = false;
  SteadyTime first_seen_{};
};

}  // namespace isotherm

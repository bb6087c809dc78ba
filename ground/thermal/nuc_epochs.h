#pragma once

#include <cstdint>
#include <optional>

#include "common/frame/frame.h"

namespace isotherm {

/// Says which NUC a thermal frame's temperatures rest on.
struct NucAge {
  std::uint8_t epoch = 0;               ///< NUCs seen before, modulo 256.
  std::optional<double> seconds_since;  ///< Since the shutter opened; nullopt = none seen.
  double seconds_followed = 0.0;        ///< Since the first frame of the stream.
  /// Change of the housing's temperature since the first valid frame after it; nullopt = the camera
  /// does not tell.
  std::optional<double> housing_change_k = std::nullopt;
  /// Seconds between the NUC and that frame, in which it may have changed unseen; 0 before the
  /// first NUC that was seen, since what drifted until then is the same for all frames.
  double unseen_s = 0.0;
};

/// Follows the shutter through a stream of thermal frames, valid or not, in order.
/// Thread-compatible.
class NucEpochs {
 public:
  /// A NUC lies between two frames if the camera's own count of seconds fell, or if frames were not
  /// valid in between. Without the camera's count, seconds run from the last such frame.
  NucAge Follow(const ThermalFrame& frame);

 private:
  void CountNuc();

  NucAge age_;
  bool had_nuc_ = false;
  bool had_valid_ = false;
  bool shut_ = false;  ///< The last frame was not valid.
  std::optional<CaptureTime> first_, last_shut_;
  std::optional<double> last_seconds_;    ///< The camera's count.
  std::optional<float> housing_celsius_;  ///< From the first valid frame of the epoch that told it.
};

}  // namespace isotherm

#pragma once

#include <memory>
#include <optional>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/simulation/simulation_options.pb.h"
#include "edge/source/frame_source.h"

namespace isotherm {

/// The shutter of a simulated thermal camera, for a scan that was rendered beforehand: closes it
/// when it is told to, by putting shutter images, or the last one again, into frames that go by.
/// A correction takes the error away that the housing's temperature had caused (thesis fig. 3.4b);
/// the closings that are part of the rendered scan count as well.
///
///   open --(order, order_delay_s)--> closed --(duration_s)--> open
///
/// Times are arrivals. The drift is that of one pass: a scan that is played in a loop starts again
/// with the error of its first pass. Thread-compatible.
class SimulatedShutter {
 public:
  explicit SimulatedShutter(const SimulationOptions& options);
  ~SimulatedShutter();

  /// Takes effect with the frames that follow. Refuses to switch the camera's own corrections off
  /// if the scan was rendered with some.
  Status Control(const CameraControl& control);
  /// To be called for each thermal frame, in order.
  void Apply(RawFrame& frame);

 private:
  void FollowOrder(CaptureTime time);
  void Correct(const RawFrame& frame);
  void ShowShutter(RawFrame& frame) const;
  void Say(RawFrame& frame, bool closed);

  const SimulationOptions options_;
  bool ordered_ = false;
  std::optional<CaptureTime> closes_at_;
  std::optional<CaptureTime> opens_at_;  ///< While it is closed by order.
  std::optional<CaptureTime> opened_at_;
  bool was_closed_ = false;
  bool closed_by_scan_ = false;
  std::optional<float> scan_reference_celsius_;  ///< Housing when the scan was last corrected.
  double correction_k_ = 0.0;  ///< The last ordered correction takes this off the scan's error.
  Image<std::uint16_t> last_open_;
};

}  // namespace isotherm

#pragma once

#include <cstdint>
#include <string_view>

#include "common/base/enum_array.h"
#include "ground/icp/icp_tracker.h"
#include "ground/thermal/thermal_fuser.h"

namespace isotherm {

/// Says why a thermal frame was not fused, in the order of the names, as in stats.json.
enum class LeftOutReason : std::uint8_t {
  kBehind,  ///< For want of time.
  kCounts,  ///< The camera sends counts, no temperatures.
  kDepthGap,
  kDiskFull,
  kNoCalibration,
  kDepthStopped,  ///< Too many frames waited for a depth frame: "no_depth".
  kNoDepthAfter,  ///< The scan ended before another depth frame.
  kNuc,           ///< Taken during a correction.
  kPoseUncertain,
  kPoseUnknown,
  kTimeUncertain,
  kWrongSize,
  kCount
};
/// "behind", as in stats.json.
std::string_view ToString(LeftOutReason reason);

/// Holds what the pipeline did with the frames it was given: in = sum of the outcomes.
struct ScanCounts {
  std::uint64_t depth_in = 0;
  std::uint64_t depth_repeated = 0;  ///< The image of the frame before again.
  std::uint64_t depth_tracked = 0;
  std::uint64_t depth_degraded = 0;     ///< Some of the tracked ones.
  std::uint64_t depth_unconfirmed = 0;  ///< Found again, but not yet believed.
  std::uint64_t depth_integrated = 0;   ///< Some of the tracked ones.
  std::uint64_t depth_behind = 0;       ///< Not integrated for want of time.
  std::uint64_t depth_uncertain = 0;    ///< Not integrated, because the pose was too uncertain.
  std::uint64_t depth_refused = 0;      ///< Frames of another size than the calibration's.
  EnumArray<LostReason, std::uint64_t> depth_lost;
  std::uint64_t relocalisations = 0;  ///< Times that the rig was found again after a loss.
  std::uint64_t thermal_in = 0;
  std::uint64_t thermal_fused = 0;
  EnumArray<LeftOutReason, std::uint64_t> thermal_left_out;
  /// By capture time, between two frames that were fused one after the other, where some between
  /// them were left out to keep up and none for another reason.
  double longest_thermal_pause_s = 0.0;
  FusionReport fusion;  ///< Sum over all fused frames; dropped counts the last review, too.

  /// For a scan whose thermal frames come again.
  void ForgetThermal() {
    thermal_in = thermal_fused = 0;
    thermal_left_out = {};
    longest_thermal_pause_s = 0.0;
    fusion = {};
  }
};

}  // namespace isotherm

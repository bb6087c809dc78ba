#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "ground/calibration/delay_search.h"
#include "ground/calibration/rig_refinement.h"

namespace isotherm {

/// Tells whether a part of the calibration is still what a scan says.
enum class CheckVerdict : std::uint8_t {
  kOff,          ///< Not to be checked.
  kNotAssessed,  ///< The scan cannot tell.
  kRefuted,  ///< It seems to have moved, but images that were held out do not agree better then.
  kAgrees,
  kMoved,
};
std::string_view ToString(CheckVerdict verdict);

/// Holds from where on a part of the calibration counts as moved.
struct CheckLimits {
  double shift_px = 0.5;  ///< In the thermal image, root mean square.
  double delay_s = 0.003;
  double influence = 0.01;      ///< The scene's, both fractions together (SceneInfluence).
  double epoch_offset_k = 1.0;  ///< From one NUC to another, at one place.
};

/// Says how the parts of a calibration fit a scan.
struct CalibrationVerdict {
  CheckVerdict pose = CheckVerdict::kNotAssessed;  ///< With the principal point.
  CheckVerdict delay = CheckVerdict::kNotAssessed;
  CheckVerdict influence = CheckVerdict::kNotAssessed;
  CheckVerdict offset = CheckVerdict::kNotAssessed;  ///< Temperatures between NUCs.

  /// Returns whether the thermal camera is to be calibrated again, which does not help against an
  /// offset.
  bool Moved() const;
  /// Returns whether pose and delay agree, and the influence has not moved: where a scan hardly
  /// tells it, there is little of it.
  bool Agrees() const;
};

/// Moved: by more than the limit and more than three standard deviations. Not assessed: neither,
/// but so uncertain that it agrees with nearly any delay.
CheckVerdict Assess(const DelayEstimate& off_by, double max_shift_s);

/// The same of all parts. All but the offset are refuted unless images that were held out
/// agree better afterwards.
CalibrationVerdict Assess(const Refinement& refinement, const CheckLimits& limits);

/// Says by how much both fractions of the scene's influence together differ from the calibration,
/// with one standard deviation.
struct FractionChange {
  double sum = 0.0, sigma = 0.0;
};
FractionChange ChangeOfInfluence(const Refinement& refinement);

/// A sentence about a part, without its name and end: "ok, within 0.28 px in the thermal image,
/// uncertain by 0.26 px".
std::string DescribePose(const Refinement& refinement, CheckVerdict verdict);
std::string DescribeDelay(const Refinement& refinement, CheckVerdict verdict);
std::string DescribeInfluence(const Refinement& refinement, CheckVerdict verdict);
std::string DescribeOffset(const Refinement& refinement, CheckVerdict verdict);

}  // namespace isotherm

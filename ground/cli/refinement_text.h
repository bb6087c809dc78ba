#pragma once

#include <string>

#include "common/frame/image.h"
#include "ground/calibration/delay_check.h"
#include "ground/json/json.h"
#include "ground/offline/recording_refinement.h"

namespace isotherm {

/// Says how two parts of a calibration fit a scan.
struct RefinementVerdict {
  DelayVerdict geometry = DelayVerdict::kNotAssessed;  ///< Pose and principal point.
  DelayVerdict delay = DelayVerdict::kNotAssessed;

  bool Moved() const { return geometry == DelayVerdict::kMoved || delay == DelayVerdict::kMoved; }
};

/// Moved: by more than `max_shift_s`, or half a pixel in the image, and more than three standard
/// deviations, and so that images that were held out agree better. Not assessed: neither, but so
/// uncertain that the scan would agree with nearly anything.
RefinementVerdict Assess(const RecordingRefinement& refined, double max_shift_s);

/// A table of all values before and after, and what the result rests on.
std::string RefinementText(const RecordingRefinement& refined);

/// Two lines: each part of the calibration is right, moved, or cannot be told, and why.
std::string CheckText(const RecordingRefinement& refined, const RefinementVerdict& verdict);

/// The same, and the covariance of the corrections in radians, metres, seconds and pixels.
Json RefinementJson(const RecordingRefinement& refined, const RefinementVerdict& verdict);

/// The two renderings beside each other.
Image<float> BeforeAndAfter(const RecordingRefinement& refined);

}  // namespace isotherm

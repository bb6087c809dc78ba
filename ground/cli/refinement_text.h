#pragma once

#include <string>

#include "common/frame/image.h"
#include "ground/calibration/calibration_verdict.h"
#include "ground/json/json.h"
#include "ground/offline/recording_refinement.h"

namespace isotherm {

/// A table of all values before and after, and what the result rests on.
std::string RefinementText(const RecordingRefinement& refined);

/// A line for each part of the calibration: it is right, has moved, or cannot be told, and why.
std::string CheckText(const RecordingRefinement& refined, const CalibrationVerdict& verdict);

/// The same, and the covariance of the corrections in radians, metres, seconds, pixels and
/// fractions.
Json RefinementJson(const RecordingRefinement& refined, const CalibrationVerdict& verdict);

/// The two renderings beside each other.
Image<float> BeforeAndAfter(const RecordingRefinement& refined);

}  // namespace isotherm

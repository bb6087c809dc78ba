#pragma once

#include <filesystem>
#include <functional>

#include "common/base/status.h"
#include "ground/calibration/depth_consistency.h"

namespace isotherm {

class GroundOptions;
class TrackedRecording;

/// Compares depth images of a recording with the surface that all of them made (DepthConsistency),
/// some 150 of them, spread over the recording. `progress` gets the fraction done, 0..1.
Result<DepthAssessment> CheckDepth(const std::filesystem::path& recording,
                                   const TrackedRecording& tracked, const GroundOptions& options,
                                   const std::function<void(double)>& progress);

}  // namespace isotherm

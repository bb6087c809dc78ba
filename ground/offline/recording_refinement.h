#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "common/base/status.h"
#include "common/frame/image.h"
#include "common/rig/rig.h"
#include "ground/calibration/depth_consistency.h"
#include "ground/calibration/rig_refinement.h"

namespace isotherm {

class GroundOptions;

/// Says what is refined, and by which recording.
struct RefinementInput {
  std::filesystem::path recording;
  std::optional<Rig> rig;  ///< The calibration to refine; nullopt: the recording's.
  RefinementPrior prior;
  bool with_rendering = false;
  bool with_depth = false;  ///< Distances are checked, too.
};

/// Holds what a recording says about its rig.
struct RecordingRefinement {
  Rig rig;  ///< As it was before.
  Refinement refinement;
  /// The delay that the recording's stamps contain: those of the placements are added to it.
  double delay_in_stamps_s = 0.0;
  std::optional<DepthAssessment> depth;
  /// With a rendering: the mean of all images before and after (MeanTexture).
  Image<float> before_celsius, after_celsius;

  double DelayBefore() const { return delay_in_stamps_s + refinement.before.delay_s; }
  double DelayAfter() const { return delay_in_stamps_s + refinement.after.delay_s; }
};

/// Tracks the depth camera through a recording and refines where and when its thermal camera looks.
/// Fails and says what the recording lacks. `progress` gets the fraction done, 0..1.
Result<RecordingRefinement> RefineByRecording(const RefinementInput& input,
                                              const GroundOptions& options,
                                              const std::function<void(double)>& progress);

}  // namespace isotherm

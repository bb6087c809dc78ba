#include "ground/experiment/experiment.h"

#include <algorithm>
#include <utility>

namespace isotherm {
namespace {

constexpr Experiment kExperiments[] = {
    {"focus", "fig. 3.7", "What the lens blurs is left out where the rig file tells the lens.",
     &RunFocusExperiment},
    {"spot-size", "fig. 3.8", "A pixel shows the mean radiation of the area that it sees.",
     &RunSpotSizeExperiment},
    {"motion", "fig. 3.9", "A fast sweep leaves no smeared temperatures in the model.",
     &RunMotionExperiment},
    {"background", "fig. 3.10",
     "How much radiation enters the camera changes a reading, and is taken out again.",
     &RunBackgroundExperiment},
    {"scene-influence", "figs. 5.6 to 5.9",
     "What the radiation on other pixels adds to each one is taken out again.",
     &RunSceneInfluenceExperiment},
    {"calibration", "tables 5.1 to 5.3, fig. 5.12",
     "A target's holes tell lenses and poses, whatever the target's warp, and how certain they "
     "are.",
     &RunCalibrationExperiment},
    {"calibration-check", "5.2.5",
     "A scan of anything tells whether the thermal camera is still where it was calibrated to be.",
     &RunCalibrationCheckExperiment},
    {"voxel-size", "fig. 6.3", "Large voxels lose detail, small ones are noisy.",
     &RunVoxelSizeExperiment},
    {"conditional-integration", "fig. 6.4",
     "Frames that the rig moved too fast for do not spoil the model.",
     &RunConditionalIntegrationExperiment},
    {"timing", "fig. 6.7, app. F",
     "Temperatures are put off by speed times the error of their time.", &RunTimingExperiment},
    {"parallax", "fig. 6.8",
     "What hides a surface from the thermal camera keeps its temperature to itself.",
     &RunParallaxExperiment},
    {"foreground", "figs. 7.3 and 7.4",
     "It does so after it has left the depth camera's view or come too close for it.",
     &RunForegroundExperiment},
    {"distance", "fig. 6.10",
     "Detail that was measured from close by is not blurred from farther away.",
     &RunDistanceExperiment},
    {"angle", "fig. 6.11",
     "Temperatures that were measured at a good angle are not lost at a bad one.",
     &RunAngleExperiment},
    {"shading", "fig. 6.12", "Shading shows shape where temperature does not.",
     &RunShadingExperiment},
    {"confidence", "figs. 6.13 and 6.14",
     "The class layers say from where each temperature was really measured.",
     &RunConfidenceExperiment},
    {"merging", "fig. 7.2",
     "One scan along a large object fits together better than several that are merged.",
     &RunMergingExperiment},
    {"reflection", "fig. 7.5",
     "The disagreement layer shows what is seen in a mirror instead of on the surface.",
     &RunReflectionExperiment},
    {"nuc", "8.2", "A shutter that closes during the scan leaves no trace in the model.",
     &RunNucExperiment},
    {"nuc-drift", "fig. 3.4b",
     "Corrections as the camera's housing drifts keep the error small that it would cause.",
     &RunNucDriftExperiment},
    {"guidance", "8.2", "Who follows the feedback is done sooner than who scans by plan.",
     &RunGuidanceExperiment},
    {"link", "3.3", "What a poor link loses comes later: the result is that of a good one.",
     &RunLinkExperiment},
};

}  // namespace

Requirement NegativeControl(const Requirement& requirement, std::string what, double measured) {
  Requirement control = requirement;
  control.what = std::move(what);
  control.measured = measured;
  control.role = Requirement::Role::kNegativeControl;
  return control;
}

bool ExperimentReport::HasNegativeControl() const {
  return std::ranges::count(requirements, Requirement::Role::kNegativeControl, &Requirement::role) >
         0;
}

bool ExperimentReport::AllMet() const {
  return HasNegativeControl() && std::ranges::all_of(requirements, &Requirement::IsMet);
}

std::span<const Experiment> AllExperiments() { return kExperiments; }

const Experiment* FindExperiment(std::string_view name) {
  const auto* const found = std::ranges::find(kExperiments, name, &Experiment::name);
  return found == std::end(kExperiments) ? nullptr : found;
}

}  // namespace isotherm

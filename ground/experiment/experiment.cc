#include "ground/experiment/experiment.h"

#include <algorithm>
#include <utility>

namespace isotherm {
namespace {

constexpr Experiment kExperiments[] = {
    {"motion", "fig. 3.9", "A fast sweep leaves no smeared temperatures in the model.",
     &RunMotionExperiment},
    {"scene-influence", "figs. 5.6 to 5.9",
     "What the radiation on other pixels adds to each one is taken out again.",
     &RunSceneInfluenceExperiment},
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

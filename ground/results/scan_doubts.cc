#include "ground/results/scan_doubts.h"

#include <fmt/format.h>

#include <optional>
#include <string>

#include "ground/results/outcome_text.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

/// Says why there is nothing but the model that the scan went on with.
std::string NotFoundInModel(const ScanOutcome& outcome) {
  const std::string elsewhere =
      outcome.maps > 1 ? "; what this scan saw is in model-2.iso and so on" : "";
  return fmt::format(
      "none of {} depth frames was found in the model that the scan was to go on with: what was "
      "written is that model, unchanged{}. Does the recording show the same place, from about the "
      "same directions? Reconstruct it without --continue to see what it shows",
      outcome.counts.depth_in, elsewhere);
}

std::string CauseOfNoPose(const ScanOutcome& outcome) {
  // One sentence for the user: the most frequent cause is what to change first.
  const std::optional<LostReason> reason = MainReason(outcome.counts.depth_lost);
  if (reason == LostReason::kTooFewPixels) {
    const DepthRange range = RangeOf(outcome.options.preprocessor(), outcome.depth_sensor);
    return fmt::format(
        "nearly all depths lie outside of the depth camera's range or of "
        "preprocessor.expert.min_depth_m "
        "to max_depth_m ({:g} to {:g} m): is depth_scale (raw units per metre) of the calibration "
        "right?",
        range.min_m, range.max_m);
  }
  if (reason == LostReason::kOutsideVolume) {
    return "at the first pose nothing in view lies in the scan volume: correct --initial-pose "
           "(T_world_depth), --volume or --volume-min, or leave the pose out";
  }
  return std::string(reason ? ExplainLost(*reason) : "they could not be used");
}

std::string NoTemperature(const ScanOutcome& outcome) {
  const ScanCounts& counts = outcome.counts;
  if (counts.thermal_fused == 0) {
    const std::optional<LeftOutReason> reason = MainReason(counts.thermal_left_out);
    return fmt::format("none of {} thermal frames could be used: {}", counts.thermal_in,
                       reason ? ExplainLeftOut(*reason) : "");
  }
  if (counts.fusion.considered == 0) {
    return fmt::format(
        "{} thermal frames were used, but the thermal camera does not look at the surface: is "
        "T_thermal_depth right (metres, depth to thermal coordinates), and are the thermal "
        "intrinsics?",
        counts.thermal_fused);
  }
  const ThermalOptions limits = CompleteLimits(outcome.options.thermal(), outcome.thermal_sensor);
  return fmt::format(
      "{} thermal frames were used, but no temperature was measured under acceptable conditions: "
      "go nearer than thermal.distance.max_m ({:.3g} m) and less oblique than "
      "thermal.angle.max_deg ({:g} degrees), or keep such temperatures with "
      "thermal.expert.keep_bad",
      counts.thermal_fused, limits.distance().max_m(), limits.angle().max_deg());
}

}  // namespace

Doubts DoubtsAboutResult(const ScanOutcome& outcome) {
  const ScanCounts& counts = outcome.counts;
  if (counts.depth_in > 0 && outcome.poses == 0) {
    if (outcome.continued) return {NotFoundInModel(outcome)};
    return {fmt::format("none of {} depth frames was tracked, so there is no surface: {}",
                        counts.depth_in, CauseOfNoPose(outcome))};
  }
  if (counts.thermal_in > 0 && outcome.can_fuse && outcome.points > 0 &&
      outcome.measured_points == 0) {
    return {NoTemperature(outcome)};
  }
  return {};
}

}  // namespace isotherm

#include "ground/offline/recording_refinement.h"

#include <fmt/format.h>

#include <utility>

#include "ground/calibration/part_of_progress.h"
#include "ground/calibration/scan_views.h"
#include "ground/calibration/texture_rendering.h"
#include "ground/offline/calibration_scan.h"
#include "ground/options/ground_options.pb.h"
#include "ground/scan/scan_model.h"

namespace isotherm {
namespace {

// Of the progress.
constexpr double kTracked = 0.4, kRefined = 0.9;
// As many as the finest comparison takes, with some that hardly any frame shows.
constexpr std::size_t kSampledPoints = 30'000;

Status CheckFits(const Rig& rig, const Rig& recorded) {
  if (Status status = CheckThermalFusion(rig); !status.ok()) return status;
  if (rig.thermal->width == recorded.thermal->width &&
      rig.thermal->height == recorded.thermal->height)
    return OkStatus();
  return InvalidArgument(fmt::format(
      "the calibration's thermal camera has {} x {} pixels, the recording's {} x {}",
      rig.thermal->width, rig.thermal->height, recorded.thermal->width, recorded.thermal->height));
}

}  // namespace

Result<RecordingRefinement> RefineByRecording(const RefinementInput& input,
                                              const GroundOptions& options,
                                              const std::function<void(double)>& progress) {
  const Result<TrackedRecording> tracked =
      TrackedRecording::Read(input.recording, options, PartOf(progress, 0.0, kTracked));
  if (!tracked) return Err(tracked.error());
  RecordingRefinement result;
  result.rig = input.rig.value_or(tracked->rig());
  if (Status status = CheckFits(result.rig, tracked->rig()); !status.ok())
    return Err(status.WithContext(input.recording.string()));
  const Result<double> delay_s = DelayInStamps(tracked->applied_delay_s(), input.rig);
  if (!delay_s) return Err(delay_s.error().WithContext(input.recording.string()));
  result.delay_in_stamps_s = *delay_s;
  // A recording's own calibration says what is still to be added to its stamps.
  const ThermalPlacement before{
      *result.rig.thermal, *result.rig.T_thermal_depth,
      input.rig ? result.rig.thermal_delay_s - *delay_s : result.rig.thermal_delay_s};
  const ScanModel model = tracked->model();
  ScanViews views;
  const LookAgain look_again = [&](const ThermalPlacement& placement, double range_s) {
    views.thermal_camera = placement.camera;
    views.T_thermal_depth = placement.T_thermal_depth;
    views.delay_s = placement.delay_s;
    views.frames = tracked->frames();
    return AddSurface(model, kSampledPoints, range_s, views, {});
  };
  Result<Refinement> refined = RefinePlacement(views, before, input.prior, look_again, model.pool,
                                               PartOf(progress, kTracked, kRefined));
  if (!refined) return Err(refined.error().WithContext(input.recording.string()));
  result.refinement = std::move(*refined);
  if (input.with_rendering) {
    const std::size_t shown = WidestFrame(views);
    result.before_celsius = MeanTexture(model.tsdf(), views, before, shown, model.pool);
    result.after_celsius =
        MeanTexture(model.tsdf(), views, result.refinement.after, shown, model.pool);
  }
  if (progress) progress(1.0);
  return result;
}

}  // namespace isotherm

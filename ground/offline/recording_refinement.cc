#include "ground/offline/recording_refinement.h"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "common/recording/recording.h"
#include "ground/calibration/part_of_progress.h"
#include "ground/calibration/scan_refinement.h"
#include "ground/calibration/scan_views.h"
#include "ground/calibration/texture_rendering.h"
#include "ground/offline/calibration_scan.h"
#include "ground/offline/depth_check.h"
#include "ground/options/ground_options.pb.h"
#include "ground/scan/scan_model.h"

namespace isotherm {
namespace {

// What tracking and refining take of the progress.
constexpr double kTracked = 0.3, kDepthChecked = 0.4, kRefined = 0.95;

Status CheckSerial(std::string_view name, const std::string& in_file, const std::string& recorded) {
  if (in_file.empty() || recorded.empty() || in_file == recorded) return OkStatus();
  return FailedPrecondition(fmt::format(
      "it was recorded with the {} camera with serial number {}, the calibration is of the one "
      "with {}: name that rig's own",
      name, recorded, in_file));
}

/// Checks what can be told before the frames are read.
Status CheckFits(const Rig& rig, const Rig& recorded) {
  if (Status status = CheckThermalFusion(rig); !status.ok()) return status;
  ISOTHERM_RETURN_IF_ERROR(CheckSerial("depth", rig.depth_serial, recorded.depth_serial));
  ISOTHERM_RETURN_IF_ERROR(CheckSerial("thermal", rig.thermal_serial, recorded.thermal_serial));
  if (!recorded.thermal || (rig.thermal->width == recorded.thermal->width &&
                            rig.thermal->height == recorded.thermal->height))
    return OkStatus();
  return InvalidArgument(fmt::format(
      "the calibration's thermal camera has {} x {} pixels, the recording's {} x {}: name the "
      "calibration that it was recorded with",
      rig.thermal->width, rig.thermal->height, recorded.thermal->width, recorded.thermal->height));
}

/// Holds what is known before the frames are read.
struct Beginning {
  Rig rig;
  double delay_in_stamps_s = 0.0;
};

Result<Beginning> Begin(const RefinementInput& input) {
  const Result<std::unique_ptr<RecordingReader>> reader = RecordingReader::Open(input.recording);
  if (!reader) return Err(reader.error());
  const Result<Rig> recorded = (*reader)->ReadRig();
  if (!recorded && !input.rig) return Err(recorded.error());
  const Rig rig = input.rig ? *input.rig : *recorded;
  if (Status status = CheckFits(rig, recorded ? *recorded : Rig()); !status.ok())
    return Err(status);
  const Result<double> delay_s = DelayInStamps(AppliedDelay((*reader)->info()), input.rig);
  if (!delay_s) return Err(delay_s.error());
  return Beginning{rig, *delay_s};
}

}  // namespace

Result<RecordingRefinement> RefineByRecording(const RefinementInput& input,
                                              const GroundOptions& options,
                                              const std::function<void(double)>& progress) {
  const Result<Beginning> beginning = Begin(input);
  if (!beginning) return Err(beginning.error().WithContext(input.recording.string()));
  const Result<TrackedRecording> tracked =
      TrackedRecording::Read(input.recording, input.rig, options, PartOf(progress, 0.0, kTracked));
  if (!tracked) return Err(tracked.error());
  RecordingRefinement result;
  result.rig = beginning->rig;
  result.delay_in_stamps_s = beginning->delay_in_stamps_s;
  // A recording's own calibration says what is still to be added to its stamps.
  const ThermalPlacement before{*result.rig.thermal, *result.rig.T_thermal_depth,
                                input.rig ? result.rig.thermal_delay_s - result.delay_in_stamps_s
                                          : result.rig.thermal_delay_s,
                                result.rig.thermal_sensor.scene_influence};
  if (input.with_depth) {
    const auto depth =
        CheckDepth(input.recording, *tracked, options, PartOf(progress, kTracked, kDepthChecked));
    if (!depth) return Err(depth.error());
    result.depth = *depth;
  }
  const ScanModel model = tracked->model();
  ScanViews views;
  Result<Refinement> refined = RefineByScan(model, tracked->frames(), before, input.prior, views,
                                            PartOf(progress, kDepthChecked, kRefined));
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

#include "ground/calibration/calibration_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/base/log.h"
#include "ground/calibration/scan_refinement.h"
#include "ground/scan/scan_model.h"
#include "ground/thermal/reading_corrections.h"

namespace isotherm {
namespace {

// A frame that is stamped less certainly says little.
constexpr double kMaxStampSigma_s = 0.003;
constexpr const char* kWhatToDo = "`isotherm calibrate refine RECORDING --rig RIG_FILE`";

/// How fast the image moves, pixels per second, by the last two poses.
double SpeedNow(const ScanModel& scan, const CameraModel& camera) {
  const std::optional<StampedMapPose> before = scan.motion.before_last();
  const std::optional<StampedMapPose> now = scan.motion.last();
  if (!before || !now || now->time <= before->time) return 0.0;
  const double shift_rad =
      RotationAngle(before->T_map_depth, now->T_map_depth) +
      TranslationDistance(before->T_map_depth, now->T_map_depth) / scan.uncertainty.mean_depth_m();
  return camera.fx * shift_rad / ToSeconds(now->time - before->time);
}

}  // namespace

Status Validate(const CalibrationCheckOptions& o) {
  const auto check = [](const char* name, double value, double most, const char* unit) {
    if (value > 0.0 && value <= most) return OkStatus();
    return InvalidArgument(
        fmt::format("calibration_check.expert.{} must be above 0 and at most {} {}, got {}", name,
                    most, unit, value));
  };
  ISOTHERM_RETURN_IF_ERROR(check("max_shift_s", o.expert().max_shift_s(), 0.1, "s"));
  ISOTHERM_RETURN_IF_ERROR(check("max_shift_px", o.expert().max_shift_px(), 20.0, "pixels"));
  ISOTHERM_RETURN_IF_ERROR(check("max_influence", o.expert().max_influence(), 0.5, "of one"));
  ISOTHERM_RETURN_IF_ERROR(
      check("max_epoch_offset_k", o.expert().max_epoch_offset_k(), 100.0, "K"));
  if (o.expert().max_frames() < 50 || o.expert().max_frames() > 2000) {
    return InvalidArgument(fmt::format(
        "calibration_check.expert.max_frames must be 50..2000, got {}", o.expert().max_frames()));
  }
  return OkStatus();
}

CheckLimits LimitsOf(const CalibrationCheckOptions& options) {
  return {.shift_px = options.expert().max_shift_px(),
          .delay_s = options.expert().max_shift_s(),
          .influence = options.expert().max_influence(),
          .epoch_offset_k = options.expert().max_epoch_offset_k()};
}

std::vector<std::string> Describe(const CalibrationCheckReport& report) {
  if (!report.is_on) return {"not checked (calibration_check.expert.enabled)"};
  if (!report.refinement) return {"could not be checked: " + report.reason};
  const Refinement& refinement = *report.refinement;
  std::vector<std::string> lines = {
      "pose " + DescribePose(refinement, report.verdict.pose),
      "delay " + DescribeDelay(refinement, report.verdict.delay),
  };
  if (report.calibrated_delay_s)
    lines.back() += fmt::format(" (calibrated {:+.1f} ms)", 1e3 * *report.calibrated_delay_s);
  lines.push_back("influence " + DescribeInfluence(refinement, report.verdict.influence));
  if (report.verdict.Moved())
    lines.push_back(fmt::format("calibrate it again: {}, and reconstruct once more", kWhatToDo));
  // Most scans see no place before and after a NUC; that is no news.
  if (refinement.epoch_offset)
    lines.push_back("temperatures " + DescribeOffset(refinement, report.verdict.offset));
  if (report.verdict.offset == CheckVerdict::kMoved) {
    lines.emplace_back(
        "the object changes, or the camera has not warmed up: let it, and scan again");
  }
  return lines;
}

CheckVerdict Overall(const CalibrationCheckReport& report) {
  if (!report.is_on) return CheckVerdict::kOff;
  if (report.verdict.Moved()) return CheckVerdict::kMoved;
  return report.verdict.Agrees() ? CheckVerdict::kAgrees : CheckVerdict::kNotAssessed;
}

std::string WhatHasMoved(const CalibrationCheckReport& report) {
  if (!report.verdict.Moved()) return "";
  const Refinement& refinement = *report.refinement;
  const CalibrationVerdict& verdict = report.verdict;
  std::vector<std::string> parts;
  if (verdict.pose == CheckVerdict::kMoved)
    parts.push_back("pose " + DescribePose(refinement, verdict.pose));
  if (verdict.delay == CheckVerdict::kMoved)
    parts.push_back("delay " + DescribeDelay(refinement, verdict.delay));
  if (verdict.influence == CheckVerdict::kMoved)
    parts.push_back("influence " + DescribeInfluence(refinement, verdict.influence));
  return fmt::format("the thermal camera is not as it was calibrated ({}): calibrate it again, {}",
                     fmt::join(parts, "; "), kWhatToDo);
}

CalibrationCheck::CalibrationCheck(const CalibrationCheckOptions& options, const Rig& rig,
                                   std::optional<double> calibrated_delay_s)
    : options_(options),
      rig_(rig),
      calibrated_delay_s_(calibrated_delay_s),
      selection_(static_cast<std::size_t>(std::max(2, options.expert().max_frames()))) {}

void CalibrationCheck::Add(const ThermalFramePtr& frame, const ScanModel& scan) {
  if (!options_.expert().enabled() || !rig_.thermal) return;
  const NucAge nuc = nuc_epochs_.Follow(*frame);
  if (!frame->valid || ToSeconds(frame->header.capture_sigma) > kMaxStampSigma_s) return;
  if (frame->temperature_raw.width() != rig_.thermal->width ||
      frame->temperature_raw.height() != rig_.thermal->height)
    return;
  selection_.Add({frame->header.capture_time,
                  {frame, &frame->temperature_raw},
                  WithoutDrift(frame->scale, rig_.thermal_sensor.housing_drift, nuc),
                  {},
                  nuc.epoch},
                 SpeedNow(scan, *rig_.thermal));
}

CalibrationCheckReport CalibrationCheck::Finish(const ScanModel& scan,
                                                const std::function<void(double)>& progress,
                                                const std::stop_token& stop) const {
  CalibrationCheckReport report;
  report.calibrated_delay_s = calibrated_delay_s_;
  report.is_on = options_.expert().enabled();
  if (!report.is_on) return report;
  const auto start = std::chrono::steady_clock::now();
  Result<Refinement> refinement = Refine(scan, progress, stop);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  report.elapsed_s = elapsed.count();
  if (!refinement) {
    report.reason = refinement.error().message();
    return report;
  }
  report.verdict = Assess(*refinement, LimitsOf(options_));
  report.refinement = std::move(*refinement);
  const std::string moved = WhatHasMoved(report);
  if (!moved.empty()) {
    LOG(Calibrate, Warning) << moved;
  }
  return report;
}

Result<Refinement> CalibrationCheck::Refine(const ScanModel& scan,
                                            const std::function<void(double)>& progress,
                                            const std::stop_token& stop) const {
  if (Status status = CheckThermalFusion(rig_); !status.ok()) return Err(status);
  // The stamps contain the delay.
  const ThermalPlacement before{*rig_.thermal, *rig_.T_thermal_depth, 0.0,
                                rig_.thermal_sensor.scene_influence};
  ScanViews views;
  return RefineByScan(scan, selection_.frames(), before, {}, views, progress, stop);
}

}  // namespace isotherm

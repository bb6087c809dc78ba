#include "ground/calibration/delay_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/base/log.h"
#include "ground/calibration/part_of_progress.h"
#include "ground/calibration/scan_views.h"
#include "ground/scan/scan_model.h"

namespace isotherm {
namespace {

// A moved delay is reported from here on: at three standard deviations one scan in 400 would be
// told so wrongly.
constexpr double kSigmas = 3.0;
// An estimate less certain than this may tell that a delay has moved by much, but agrees with
// nearly all.
constexpr double kMaxSigmaToAgree_s = 0.005;
// A frame that is stamped less certainly says little.
constexpr double kMaxStampSigma_s = 0.003;
// Fraction of the progress that finding visible points takes; only what is shown depends on it.
constexpr double kVisibilityFraction = 0.4;
// Fewer than a calibration takes, for the operator waits.
constexpr std::size_t kMaxPoints = 12'000, kCoarsePoints = 2000, kFinePoints = kMaxPoints;
// Half of a calibration's: the spread is then known within 7 %, which is enough for a verdict.
constexpr int kResamplings = 100;

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

std::string InMilliseconds(const DelayEstimate& off_by, double calibrated_s) {
  return fmt::format("{:+.1f} ms (one sigma {:.1f} ms)", 1e3 * (calibrated_s + off_by.delay_s),
                     1e3 * off_by.sigma_s);
}

std::string WhatToDo() {
  return "calibrate it again: `isotherm calibrate time RECORDING --rig RIG_FILE`";
}

std::string WithHint(const std::string& verdict, const DelayEstimate& off_by) {
  const std::string hint = HintOfDrift(off_by);
  return hint.empty() ? verdict : verdict + " (" + hint + ")";
}

}  // namespace

Status Validate(const DelayCheckOptions& o) {
  if (!(o.expert().max_shift_s() > 0.0 && o.expert().max_shift_s() <= 0.1)) {
    return InvalidArgument(
        fmt::format("delay_check.expert.max_shift_s must be above 0 and at most 0.1 s, got {}",
                    o.expert().max_shift_s()));
  }
  if (!(o.expert().max_sigma_s() > 0.0 && o.expert().max_sigma_s() <= 0.1)) {
    return InvalidArgument(
        fmt::format("delay_check.expert.max_sigma_s must be above 0 and at most 0.1 s, got {}",
                    o.expert().max_sigma_s()));
  }
  if (o.expert().max_frames() < 50 || o.expert().max_frames() > 2000) {
    return InvalidArgument(fmt::format("delay_check.expert.max_frames must be 50..2000, got {}",
                                       o.expert().max_frames()));
  }
  return OkStatus();
}

std::string_view ToString(DelayVerdict verdict) {
  switch (verdict) {
    case DelayVerdict::kOff:
      return "off";
    case DelayVerdict::kNotAssessed:
      return "could not be assessed";
    case DelayVerdict::kAgrees:
      return "agrees";
    case DelayVerdict::kMoved:
      return "moved";
  }
  return "?";
}

DelayVerdict Assess(const DelayEstimate& off_by, double max_shift_s) {
  if (std::abs(off_by.delay_s) > std::max(max_shift_s, kSigmas * off_by.sigma_s))
    return DelayVerdict::kMoved;
  return off_by.sigma_s > kMaxSigmaToAgree_s ? DelayVerdict::kNotAssessed : DelayVerdict::kAgrees;
}

std::string Describe(const DelayReport& report) {
  if (!report.off_by) {
    return report.verdict == DelayVerdict::kOff ? "not checked (delay_check.expert.enabled)"
                                                : "could not be checked: " + report.reason;
  }
  const bool moved = report.verdict == DelayVerdict::kMoved;
  if (!report.calibrated_s) {
    return fmt::format("thermal stamps are off by {}: {}", InMilliseconds(*report.off_by, 0.0),
                       moved ? WhatToDo() : WithHint("as calibrated", *report.off_by));
  }
  return fmt::format("thermal camera calibrated {:+.1f} ms, this scan says {}: {}",
                     1e3 * *report.calibrated_s,
                     InMilliseconds(*report.off_by, *report.calibrated_s),
                     moved ? "moved; " + WhatToDo() : WithHint("agrees", *report.off_by));
}

DelayCheck::DelayCheck(const DelayCheckOptions& options, const Rig& rig,
                       std::optional<double> calibrated_s)
    : options_(options),
      rig_(rig),
      calibrated_s_(calibrated_s),
      selection_(static_cast<std::size_t>(std::max(2, options.expert().max_frames()))) {}

void DelayCheck::Add(const ThermalFramePtr& frame, const ScanModel& scan) {
  if (!options_.expert().enabled() || !rig_.thermal || !frame->valid ||
      ToSeconds(frame->header.capture_sigma) > kMaxStampSigma_s)
    return;
  if (frame->temperature_raw.width() != rig_.thermal->width ||
      frame->temperature_raw.height() != rig_.thermal->height)
    return;
  selection_.Add(frame, SpeedNow(scan, *rig_.thermal));
}

DelayReport DelayCheck::Finish(const ScanModel& scan,
                               const std::function<void(double)>& progress) const {
  DelayReport report;
  report.calibrated_s = calibrated_s_;
  if (!options_.expert().enabled()) return report;
  const auto start = std::chrono::steady_clock::now();
  const Result<DelayEstimate> estimate = Estimate(scan, progress);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  report.elapsed_s = elapsed.count();
  if (!estimate) {
    report.verdict = DelayVerdict::kNotAssessed;
    report.reason = estimate.error().message();
    return report;
  }
  report.verdict = Assess(*estimate, options_.expert().max_shift_s());
  if (report.verdict == DelayVerdict::kNotAssessed) {
    report.reason =
        fmt::format("{}, so that it is uncertain by {:.0f} ms",
                    HintOfDrift(*estimate).empty() ? "parts of the scan say different things"
                                                   : "the rig hardly went back and forth",
                    1e3 * estimate->sigma_s);
    return report;
  }
  report.off_by = *estimate;
  if (report.verdict == DelayVerdict::kMoved) {
    LOG(Calibrate, Warning) << "the delay between depth and thermal camera has changed: "
                            << Describe(report);
  }
  return report;
}

Result<DelayEstimate> DelayCheck::Estimate(const ScanModel& scan,
                                           const std::function<void(double)>& progress) const {
  if (Status status = CheckThermalFusion(rig_); !status.ok()) return Err(status);
  FindDelayOptions options;
  options.search.max_sigma_s = options_.expert().max_sigma_s();
  options.search.resamplings = kResamplings;
  options.coarse_points = kCoarsePoints;
  options.fine_points = kFinePoints;
  ScanViews views;
  views.thermal_camera = *rig_.thermal;
  views.T_thermal_depth = *rig_.T_thermal_depth;
  for (const ThermalFramePtr& frame : selection_.frames()) {
    views.frames.push_back(
        {frame->header.capture_time, {frame, &frame->temperature_raw}, frame->scale, {}});
  }
  const Status surface = AddSurface(scan, kMaxPoints, options.search.range_s, views,
                                    PartOf(progress, 0.0, kVisibilityFraction));
  if (!surface.ok()) return Err(surface);
  return FindDelay(views, options, scan.pool, PartOf(progress, kVisibilityFraction, 1.0));
}

}  // namespace isotherm

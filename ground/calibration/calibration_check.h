#pragma once

#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/rig/rig.h"
#include "ground/calibration/calibration_verdict.h"
#include "ground/calibration/thermal_selection.h"
#include "ground/options/ground_options.pb.h"
#include "ground/thermal/nuc_epochs.h"

namespace isotherm {

struct ScanModel;

Status Validate(const CalibrationCheckOptions& options);

CheckLimits LimitsOf(const CalibrationCheckOptions& options);

/// Says how the thermal camera's calibration fits the scan.
struct CalibrationCheckReport {
  bool is_on = false;
  std::string reason;  ///< Why the scan cannot tell; empty if it can.
  CalibrationVerdict verdict;
  /// The stamps contain this delay by calibration, seconds; nullopt = an edge added it and did not
  /// say.
  std::optional<double> calibrated_delay_s;
  std::optional<Refinement> refinement;  ///< Unless there is a reason.
  double elapsed_s = 0.0;                ///< Time that the check took.
};

/// Lines for the user, without their ends: one for each part of the calibration, or why none can be
/// told. What has moved comes with what to do.
std::vector<std::string> Describe(const CalibrationCheckReport& report);

/// The worst of its parts' verdicts, of temperatures apart.
CheckVerdict Overall(const CalibrationCheckReport& report);

/// Returns what has moved, in one sentence for an operator; empty = nothing.
std::string WhatHasMoved(const CalibrationCheckReport& report);

/// Checks the calibration with what one scan has anyway: its poses, its surface and some of its
/// thermal frames. Thread-bound, with the pipeline.
class CalibrationCheck {
 public:
  /// `calibrated_delay_s`: see CalibrationCheckReport.
  CalibrationCheck(const CalibrationCheckOptions& options, const Rig& rig,
                   std::optional<double> calibrated_delay_s);

  /// After each thermal frame that the pipeline got. Keeps a reference to some of their images.
  void Add(const ThermalFramePtr& frame, const ScanModel& scan);

  /// After the pipeline's Finish. Logs a warning if something has moved. `progress` gets the
  /// fraction done, 0..1.
  /// Gives up soon after `stop` was requested.
  CalibrationCheckReport Finish(const ScanModel& scan, const std::function<void(double)>& progress,
                                const std::stop_token& stop = {}) const;

 private:
  Result<Refinement> Refine(const ScanModel& scan, const std::function<void(double)>& progress,
                            const std::stop_token& stop) const;

  const CalibrationCheckOptions options_;
  const Rig rig_;
  const std::optional<double> calibrated_delay_s_;
  NucEpochs nuc_epochs_;
  ThermalSelection selection_;
};

}  // namespace isotherm

#pragma once

#include <functional>
#include <optional>
#include <string>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/rig/rig.h"
#include "ground/calibration/find_delay.h"
#include "ground/calibration/thermal_selection.h"
#include "ground/options/ground_options.pb.h"

namespace isotherm {

struct ScanModel;

Status Validate(const DelayCheckOptions& options);

/// Tells whether the constant delay between depth and thermal camera is still what was calibrated.
enum class DelayVerdict : std::uint8_t {
  kOff,          ///< Not to be checked.
  kNotAssessed,  ///< The scan cannot tell.
  kAgrees,
  kMoved,
};
std::string_view ToString(DelayVerdict verdict);

/// Says how the thermal camera's calibrated delay fits the scan.
struct DelayReport {
  DelayVerdict verdict = DelayVerdict::kOff;
  std::string reason;  ///< Why the scan cannot tell.
  /// The stamps contain this delay by calibration, seconds; nullopt = an edge added it and did not
  /// say.
  std::optional<double> calibrated_s;
  std::optional<DelayEstimate> off_by;  ///< To be added to it.
  double elapsed_s = 0.0;               ///< Time that the check took.
};

/// Moved: by more than `max_shift_s` and more than three standard deviations. Not assessed:
/// neither, but so uncertain that it agrees with nearly any delay.
DelayVerdict Assess(const DelayEstimate& off_by, double max_shift_s);

/// A line for the user, without its end.
std::string Describe(const DelayReport& report);

/// Checks the delay with what one scan has anyway: its poses, its surface and some of its thermal
/// frames. Thread-bound, with the pipeline.
class DelayCheck {
 public:
  /// `calibrated_s`: see DelayReport.
  DelayCheck(const DelayCheckOptions& options, const Rig& rig, std::optional<double> calibrated_s);

  /// After each thermal frame that the pipeline got. Keeps a reference to some of them.
  void Add(const ThermalFramePtr& frame, const ScanModel& scan);

  /// After the pipeline's Finish. Logs a warning if the delay has moved. `progress` gets the
  /// fraction done, 0..1.
  DelayReport Finish(const ScanModel& scan, const std::function<void(double)>& progress) const;

 private:
  Result<DelayEstimate> Estimate(const ScanModel& scan,
                                 const std::function<void(double)>& progress) const;

  const DelayCheckOptions options_;
  const Rig rig_;
  const std::optional<double> calibrated_s_;
  ThermalSelection selection_;
};

}  // namespace isotherm

#include "edge/nuc/nuc_need.h"

#include <fmt/format.h>

#include <cmath>

#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

/// Empty if `now` is within `limit_k` of `then`, if either is not known, or without a limit.
std::string DriftOf(const char* part, float then_celsius, float now_celsius, double limit_k) {
  const double drift_k = static_cast<double>(now_celsius) - static_cast<double>(then_celsius);
  // Written so that NaN, a temperature that is not known, is no reason.
  if (limit_k <= 0.0 || !(std::abs(drift_k) > limit_k)) return "";
  return fmt::format("the {} is {:+.2f} K off the last correction", part, drift_k);
}

}  // namespace

NucNeed::NucNeed(const NucOptions& options, bool is_ordered, NucNotices& notices)
    : rules_{.require_first = options.expert().require_initial_nuc(),
             .before_scan = is_ordered && options.before_scan(),
             .max_housing_drift_k = options.expert().max_housing_drift_k(),
             .max_fpa_drift_k = options.expert().max_fpa_drift_k(),
             .max_interval_s = options.max_interval_s()},
      notices_(notices) {}

void NucNeed::OnCorrected(const ThermalHousekeeping& housekeeping) {
  seen_ = true;
  reference_ = housekeeping;
}

void NucNeed::OnGivenUp() {
  if (!WaitsForFirst()) return;
  waived_ = true;
  notices_.Add(LogLevel::kWarning, rules_.require_first
                                       ? "no first correction: no temperatures are taken"
                                       : "no first correction: the scan goes on without");
}

void NucNeed::OnCameraAway() {
  // A camera that was switched off has lost its correction.
  if (rules_.before_scan) seen_ = waived_ = false;
}

bool NucNeed::WaitsForFirst() const {
  if (seen_) return false;
  return rules_.require_first || (rules_.before_scan && !waived_);
}

std::string NucNeed::Reason(const NucObservation& seen, Nanoseconds age) const {
  if (!seen_ && (rules_.require_first || rules_.before_scan)) return "start of the scan";
  if (seen.camera && seen.camera->state == NucState::kDesired) return "the camera asks for it";
  std::string drift = Drift(seen.housekeeping);
  if (!drift.empty()) return drift;
  const double age_s = ToSeconds(age);
  if (rules_.max_interval_s > 0.0 && age_s > rules_.max_interval_s)
    return fmt::format("the last correction is {:.0f} s old", age_s);
  return "";
}

std::string NucNeed::Drift(const ThermalHousekeeping& now) const {
  std::string housing = DriftOf("housing", reference_.housing_celsius, now.housing_celsius,
                                rules_.max_housing_drift_k);
  if (!housing.empty()) return housing;
  return DriftOf("detector", reference_.fpa_celsius, now.fpa_celsius, rules_.max_fpa_drift_k);
}

}  // namespace isotherm

#pragma once

#include <string>

#include "edge/nuc/nuc_notices.h"
#include "edge/nuc/nuc_observation.h"

namespace isotherm {

class NucOptions;

/// Says why a correction is needed: none has been seen yet, the camera asks for it, its
/// temperatures have drifted since the last one, or that one is old (thesis 3.2.3).
/// Thread-compatible.
class NucNeed {
 public:
  /// `is_ordered`: the first correction of a scan can be ordered, there is a camera. `notices` must
  /// outlive it.
  NucNeed(const NucOptions& options, bool is_ordered, NucNotices& notices);

  /// The camera corrected itself at these temperatures; or the first frame came, which stands for
  /// it.
  void SetReference(const ThermalHousekeeping& housekeeping) { reference_ = housekeeping; }
  void OnCorrected(const ThermalHousekeeping& housekeeping);
  /// The camera does not follow: the scan goes on without a first correction where it may.
  void OnGivenUp();
  /// The camera was away and may be as it was built.
  void OnCameraAway();

  /// Nothing is valid before a first correction, which has not come.
  bool WaitsForFirst() const;
  /// `age` is the time since the last correction or the first frame. Empty: none is needed.
  std::string Reason(const NucObservation& seen, Nanoseconds age) const;

 private:
  std::string Drift(const ThermalHousekeeping& now) const;

  /// Holds the options that say when a correction is due.
  struct Rules {
    bool require_first;  ///< Nothing is valid before a first correction.
    bool before_scan;
    double max_housing_drift_k, max_fpa_drift_k, max_interval_s;  ///< 0 = no limit.
  };
  const Rules rules_;
  NucNotices& notices_;
  ThermalHousekeeping reference_;  ///< At the last correction, or at the first frame.
  bool seen_ = false;
  bool waived_ = false;  ///< The first one did not come; the scan goes on without.
};

}  // namespace isotherm

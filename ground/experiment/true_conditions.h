#pragma once

#include <optional>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/simulation/simulated_scan.h"
#include "ground/options/ground_options.pb.h"
#include "ground/thermal/thermal_volume.h"

namespace isotherm {

/// Tells how one thermal frame saw a point of the true surface, by true poses and exact geometry.
struct TrueCondition {
  double distance_m = 0.0;
  double angle_deg = 0.0;
  bool surely_seen = false;  ///< By both cameras, away from borders and silhouettes.
  bool maybe_seen = false;   ///< By the thermal camera.
};

/// One per thermal frame in `frames`, in order.
std::vector<TrueCondition> TrueConditions(const SimulatedScan& scan,
                                          const std::vector<std::size_t>& frames,
                                          const SurfacePoint& point);

/// Classes of the measurement that a point must end with.
struct TrueClasses {
  ConditionClass distance = ConditionClass::kBad;
  ConditionClass angle = ConditionClass::kBad;
  friend bool operator==(const TrueClasses&, const TrueClasses&) = default;
};

/// By algorithm 6 from the conditions; nullopt if the point is near a border: if its classes would
/// be others with all distances 1 cm larger or smaller, all angles 5 degrees, or if they depend on
/// frames that may or may not have seen it.
std::optional<TrueClasses> ExpectClasses(const std::vector<TrueCondition>& conditions,
                                         const ThermalOptions& limits);

}  // namespace isotherm

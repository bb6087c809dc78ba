#pragma once

#include <cstdint>
#include <vector>

#include "common/geometry/external_odometry.h"

namespace isotherm {

class OdometryOptions;
class SimulatedScan;

/// Returns what odometry beside the cameras says about the whole of a simulated scan: noisy, of
/// another scale, in a reference frame of its own. In order of time; empty if its rate is 0.
/// Everything random follows from `seed`.
std::vector<ExternalOdometry> SimulateOdometry(const OdometryOptions& options,
                                               const SimulatedScan& scan, std::uint64_t seed);

}  // namespace isotherm

#include "ground/calibration/find_delay.h"

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "ground/calibration/image_motion.h"

namespace isotherm {
namespace {

constexpr double kPart_s = 1.0;
// What is wrong alike in the whole scan, so that resampling does not show it: the surface that
// drifting poses made, emissivity that changes with the angle. With true poses on simulated scans,
// +0.8 ms on average (docs/timing.md).
constexpr double kCommonError_s = 0.001;

}  // namespace

Result<DelayEstimate> FindDelay(const ScanViews& views, const FindDelayOptions& options,
                                ThreadPool& pool, const std::function<void(double)>& progress) {
  TextureConsistency consistency(views, kPart_s, pool);
  const auto disagreement = [&](double delay_s, bool fine,
                                const std::vector<PartWeights>& resamplings) {
    return consistency.Measure(delay_s, fine ? options.fine_points : options.coarse_points,
                               resamplings);
  };
  Result<DelayEstimate> estimate = SearchDelay(
      disagreement, [&](double delay_s) { consistency.WeighAt(delay_s); }, consistency.parts(),
      options.search, progress);
  if (!estimate) return estimate;
  const std::vector<StampedVelocity> motion = ImageVelocities(views);
  const std::optional<double> pixels_per_metre = PixelsPerMetre(views);
  estimate->drift_sigma_s = pixels_per_metre
                                ? DelaySigmaOfDrift(motion, views.pose_drift_m * *pixels_per_metre)
                                : std::numeric_limits<double>::infinity();
  estimate->sigma_s = std::hypot(estimate->sigma_s, kCommonError_s, estimate->drift_sigma_s);
  return estimate;
}

std::string HintOfDrift(const DelayEstimate& estimate) {
  const bool is_mostly_drift =
      std::isinf(estimate.drift_sigma_s) ||
      estimate.drift_sigma_s * estimate.drift_sigma_s > 0.5 * estimate.sigma_s * estimate.sigma_s;
  if (!is_mostly_drift) return {};
  return "move the rig back and forth more often for a more certain one";
}

}  // namespace isotherm

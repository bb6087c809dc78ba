#include "ground/calibration/find_delay.h"

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "ground/calibration/image_motion.h"

namespace isotherm {
namespace {

// Parts of the scan: short, so that there are many to draw from, where all images are compared;
// where those of a part are, as long as a swing of the hand, for steady motion says nothing.
constexpr double kPart_s = 1.0, kComparedPart_s = 2.0;
// Images are compared by parts where that leaves less than this fraction of what drift makes: it is
// worth the slow motion that they cannot tell from rest.
constexpr double kWorthwhile = 0.7;
constexpr double kWholeScan_s = std::numeric_limits<double>::infinity();
// What is wrong alike in the whole scan, so that resampling does not show it: the surface that
// drifting poses made, emissivity that changes with the angle. With true poses on simulated scans,
// +0.8 ms on average (docs/timing.md).
constexpr double kCommonError_s = 0.001;
// The same where images are compared within parts: such errors change with the view, so slowly.
// With true poses on simulated scans, -0.1 +- 0.2 ms on average.
constexpr double kCommonErrorOfParts_s = 0.0003;

/// Says which images are compared, and what the drift of poses makes of the delay then.
struct Comparison {
  ComparedImages images = ComparedImages::kOfScan;
  double part_s = kPart_s;
  double drift_sigma_s = std::numeric_limits<double>::infinity();
  double common_error_s = kCommonError_s;
};

/// By the motion alone, so that the choice does not favour a delay.
Comparison ChooseComparison(const ScanViews& views) {
  const std::optional<double> pixels_per_metre = PixelsPerMetre(views);
  if (!pixels_per_metre) return {};
  const std::vector<StampedVelocity> motion = ImageVelocities(views);
  const double drift_px = views.pose_drift_m * *pixels_per_metre;
  const double part_s = PartLength(views, kComparedPart_s);
  // Which is better does not depend on how far poses drift.
  const bool by_parts = DelaySigmaOfDrift(motion, 1.0, part_s) <
                        kWorthwhile * DelaySigmaOfDrift(motion, 1.0, kWholeScan_s);
  if (by_parts) {
    return {ComparedImages::kOfPart, part_s, DelaySigmaOfDrift(motion, drift_px, part_s),
            kCommonErrorOfParts_s};
  }
  return {ComparedImages::kOfScan, kPart_s, DelaySigmaOfDrift(motion, drift_px, kWholeScan_s),
          kCommonError_s};
}

}  // namespace

Result<DelayEstimate> FindDelay(const ScanViews& views, const FindDelayOptions& options,
                                ThreadPool& pool, const std::function<void(double)>& progress) {
  const Comparison comparison = ChooseComparison(views);
  TextureConsistency consistency(views, comparison.part_s, comparison.images, pool);
  const auto disagreement = [&](double delay_s, bool fine,
                                const std::vector<PartWeights>& resamplings) {
    return consistency.Measure(delay_s, fine ? options.fine_points : options.coarse_points,
                               resamplings);
  };
  Result<DelayEstimate> estimate = SearchDelay(
      disagreement, [&](double delay_s) { consistency.WeighAt(delay_s); }, consistency.parts(),
      options.search, progress);
  if (!estimate) return estimate;
  estimate->drift_sigma_s = comparison.drift_sigma_s;
  estimate->sigma_s =
      std::hypot(estimate->sigma_s, comparison.common_error_s, comparison.drift_sigma_s);
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

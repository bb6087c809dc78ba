#include "ground/calibration/find_delay.h"

#include <cmath>
#include <vector>

namespace isotherm {
namespace {

constexpr double kPart_s = 1.0;
// What tracked poses are off by makes about that much (1.0 ms on a rendered scan, where true poses
// say so), and resampling does not show it. It can be several times as much where the rig hardly
// reverses (docs/timing.md).
constexpr double kPoseError_s = 0.001;

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
  if (estimate) estimate->sigma_s = std::hypot(estimate->sigma_s, kPoseError_s);
  return estimate;
}

}  // namespace isotherm

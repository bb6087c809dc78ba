#pragma once

#include <cstddef>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "common/concurrency/thread_pool.h"
#include "common/frame/image.h"
#include "ground/calibration/alignment_equations.h"
#include "ground/calibration/epoch_offset.h"
#include "ground/calibration/own_temperatures.h"
#include "ground/calibration/point_samples.h"
#include "ground/calibration/texture_consistency.h"
#include "ground/calibration/thermal_placement.h"
#include "ground/calibration/trajectory_drift.h"

namespace isotherm {

/// Says how well held-out frames fit what the others say about the surface, at two placements.
struct HeldOutComparison {
  double before_k = 0.0, after_k = 0.0;  ///< Weighted root mean square of the differences, kelvin.
  bool improves = false;  ///< The second predicts them better, as a normal distribution.
};

/// Compares the thermal images of a scan point by point of its surface, each with the mean of all
/// that show the point in the same NUC epoch, and linearises the differences by the placement
/// (Gauss-Newton). The gradient along the surface is the mean over all images that show it: that of
/// a single one holds noise, which would pass for knowledge. Points without a gradient above chance
/// do not count. Every third part of the scan is held out. Thread-compatible.
class TextureAlignment {
 public:
  /// `views` and `pool` must outlive it. Every frame's `visible` is filled.
  TextureAlignment(const ScanViews& views, ThreadPool& pool);

  /// Before anything else: takes the scene's influence out of the images, and blurs them by a
  /// Gaussian of this standard deviation at the usual distance, so that it is as wide on the
  /// surface from any distance. Otherwise nearness would sharpen edges, which passes for a
  /// misalignment. Placements with another influence are compared by how temperatures change with
  /// it. Gives up soon after `stop` was requested; nothing can be compared then.
  void PrepareImages(const SceneInfluence& influence, double sigma_px,
                     const std::stop_token& stop = {});

  /// By the first `points` of the points; by the drift's values too if it has any.
  AlignmentEquations Linearize(const ThermalPlacement& placement, const TrajectoryDrift& drift,
                               std::size_t points) const;

  /// By those of the first `points` of the points that held-out and other frames show at both
  /// placements, each weighed alike at both.
  HeldOutComparison CompareHeldOut(const ThermalPlacement& before, const ThermalPlacement& after,
                                   std::size_t points) const;

  /// How the first `points` of the points differ from one NUC epoch that shows them to the next.
  std::vector<PlaceDifference> CompareEpochs(const ThermalPlacement& placement,
                                             std::size_t points) const;

 private:
  struct FrameGeometry;
  struct HeldOutPoint;

  std::vector<double> Distances() const;
  std::vector<FrameGeometry> Geometries(const ThermalPlacement& placement,
                                        const TrajectoryDrift& drift) const;
  void Gather(const TexturePoint& point, const std::vector<std::uint32_t>& frames,
              const ThermalPlacement& placement, const TrajectoryDrift& drift,
              const std::vector<FrameGeometry>& geometries,
              std::vector<PointSample>& samples) const;
  static HeldOutPoint HeldOutAt(const std::vector<PointSample>& samples);

  const ScanViews& views_;
  ThreadPool& pool_;
  int parts_ = 0;
  std::vector<int> part_of_frame_;
  std::vector<bool> held_out_;                       ///< By frame.
  std::vector<std::vector<std::uint32_t>> showing_;  ///< By point: frames that show it.
  SceneInfluence influence_;                         ///< Taken out of `images_`.
  std::vector<OwnTemperatures> images_;              ///< By frame; empty if it shows no point.
};

}  // namespace isotherm

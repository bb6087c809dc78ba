#pragma once

#include <functional>
#include <optional>
#include <stop_token>

#include "common/base/status.h"
#include "common/concurrency/thread_pool.h"
#include "ground/calibration/texture_alignment.h"
#include "ground/calibration/thermal_placement.h"

namespace isotherm {

/// Says how far values may be off, one standard deviation along each axis. What a scan cannot tell
/// at least twice as certainly stays as it was; 0 keeps a value.
struct RefinementPrior {
  double rotation_rad = 0.0175;  ///< One degree.
  double translation_m = 0.010;
  double delay_s = 0.020;
  double principal_point_px = 5.0;
  double influence = 0.05;  ///< Each fraction of the scene's influence.
};

/// Holds a distance in the thermal image, pixels, with its standard deviation.
struct ImageShift {
  double rms_px = 0.0;
  double sigma_px = 0.0;
};

/// Holds what a scan says about its rig.
struct Refinement {
  ThermalPlacement before, after;
  PlacementVector correction = PlacementVector::Zero();  ///< From `before` to `after`.
  PlacementVector prior_sigma = PlacementVector::Zero();
  PlacementMatrix covariance = PlacementMatrix::Zero();  ///< The correction's.
  int observed_directions = 0;  ///< How many of kPlacementParameters the scan tells.
  /// How far the scanned points move in the thermal images, the delay apart.
  ImageShift shift;
  /// How the third of the scan that was held out fits the rest.
  HeldOutComparison held_out;
  std::optional<EpochOffset> epoch_offset;  ///< nullopt = too little was seen in two NUC epochs.
  std::size_t frames = 0;  ///< Thermal frames that were compared, those held out too.
  int textured_points = 0, points = 0;

  /// One standard deviation of the correction of one value.
  double Sigma(PlacementParameter parameter) const;
  /// Returns whether one value was to be kept.
  bool Keeps(PlacementParameter parameter) const { return prior_sigma[parameter] == 0.0; }
  /// Returns whether the scan says more about one value than was known before.
  bool Tells(PlacementParameter parameter) const;
};

/// Points of the surface that the last comparison takes.
inline constexpr std::size_t kFinestPoints = 30'000;

/// Sees the scan again from a placement: fills the views' camera, pose between the cameras, delay,
/// points and visibility. `range_s` is how far the delay may be off; `progress` gets the fraction
/// done, 0..1.
using LookAgain = std::function<Status(const ThermalPlacement& placement, double range_s,
                                       const std::function<void(double)>& progress)>;

/// Finds the placement of the thermal camera at which the images of `views` agree best about the
/// surface, from blurred to sharp images, beginning at `before`; at last together with what the
/// tracked poses are off by. A third of the scan is held out. Fails and says what the scan lacks,
/// or soon after `stop` was requested. Deterministic. `progress` gets the fraction done, 0..1.
Result<Refinement> RefinePlacement(const ScanViews& views, const ThermalPlacement& before,
                                   const RefinementPrior& prior, const LookAgain& look_again,
                                   ThreadPool& pool, const std::function<void(double)>& progress,
                                   const std::stop_token& stop = {});

}  // namespace isotherm

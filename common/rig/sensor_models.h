#pragma once

#include <optional>

#include "common/base/status.h"
#include "common/rig/depth_bias.h"
#include "common/rig/radiometric_correction.h"

namespace isotherm {

/// Says what a depth camera can see. The defaults are those of a PrimeSense-like camera.
struct DepthSensorModel {
  /// It sees nothing closer, so something there may hide surfaces unnoticed; 0 = nothing is there.
  double near_range_m = 0.35;
  double min_depth_m = 0.3, max_depth_m = 4.0;  ///< Depth outside is no return.
  double noise_at_1m_m = 0.006;  ///< Noise and unevenness; it grows with the square of the depth.
  DepthBias bias{};              ///< Says what is wrong with its distances.
};

/// Describes a lens set to one distance.
struct LensModel {
  double focal_length_m = 0.0;
  double f_number = 0.0;
  double focus_m = 0.0;  ///< Distance of what is sharp.
};

/// Tells what the radiation on other pixels adds to each one (thesis 5.1): measured = own +
/// near_fraction (near - own) + total_fraction (total - own), in temperature, where `near` is the
/// mean of the surroundings, weighted by a Gaussian, and `total` that of the whole image. None by
/// default.
struct SceneInfluence {
  double near_fraction = 0.0;
  double near_sigma_px = 40.0;
  double total_fraction = 0.0;

  double Total() const { return near_fraction + total_fraction; }

  /// The correction converges for these (SceneInfluenceCorrector): each step leaves at most half of
  /// the error at the largest fractions. A PI 450 has 0.0387 each.
  static constexpr double kMaxFraction = 0.25;
  /// Narrower than a cell of 8 pixels the correction does not see it; wider than 1000 pixels it is
  /// `total`.
  static constexpr double kMinSigma_px = 8.0;
  static constexpr double kMaxSigma_px = 1000.0;
};

/// Tells how readings drift after a NUC as the housing, whose radiation falls on the detector,
/// warms up (thesis 3.2.3, fig. 3.4b).
struct HousingDrift {
  double error_per_kelvin = 0.0;  ///< Rise of all readings per kelvin since the NUC.
  double sigma = 0.0;             ///< Its standard uncertainty.

  /// A PI 450 has about 4.
  static constexpr double kMaxErrorPerKelvin = 50.0;
};

/// Says how a thermal camera takes its images. The defaults are those of a microbolometer whose
/// lens is not known.
struct ThermalSensorModel {
  double time_constant_s = 0.010;  ///< A pixel follows a change of temperature with it.
  double row_readout_s = 0.0;      ///< From one row to the next; 0 = all at once.
  std::optional<double> pixel_pitch_m;
  std::optional<LensModel> lens;
  SceneInfluence scene_influence;
  /// Corrects readings without the scene's influence and the housing's drift.
  RadiometricCorrection radiometric_correction{};
  std::optional<HousingDrift> housing_drift{};
};

/// The message names the field of the rig file.
Status Validate(const DepthSensorModel& sensor);
Status Validate(const ThermalSensorModel& sensor);

}  // namespace isotherm

#pragma once

#include <Eigen/Core>
#include <optional>

#include "ground/thermal/nuc_epochs.h"

namespace isotherm {

/// The housing of a warm camera changes by less than this, as the edge takes it for warm by default
/// (nuc.expert.warm_up_housing_rate_k_per_min).
inline constexpr double kWarmHousingRate_k_per_min = 0.1;

/// Says how uncertain the readings of a thermal camera are. The defaults are those of an Optris PI
/// 450, as far as its data sheet and the thesis tell.
struct CameraUncertainty {
  double netd_k = 0.040;  ///< Noise of a single pixel (thesis table C.3).
  /// Random walk of the pixels' pattern after a NUC; no data sheet states it. 0 = not known.
  double pattern_drift_k_per_sqrt_min = 0.0;
  /// Error of a reading per kelvin that the housing has warmed up since the NUC (thesis fig. 3.4b:
  /// 20 K for 5 K).
  double error_per_housing_k = 4.0;
  /// So much of it is left in frames that it was taken out of: the change of the housing is known.
  double left_per_housing_k = 4.0;
  /// Fraction by which the rest of the image pulls a pixel's temperature towards its own mean
  /// (thesis 5.1); after it was taken out, what is left. 0 = not known.
  double scene_influence = 0.0;
};

/// Holds what all temperatures of a thermal frame owe their uncertainty to. Standard uncertainties.
struct FrameUncertainty {
  double noise_k = 0.0;  ///< NETD, of a pixel of the camera.
  double drift_k = 0.0;  ///< Since the NUC.
  /// Uncertainty of the frame's place on the surface: of the pose and the extrinsic calibration,
  /// pixels along each axis of the image.
  double registration_px = 0.0;
  double time_s = 0.0;           ///< Uncertainty of the capture time.
  double voxel_m = 0.0;          ///< Edge length of the cells that temperatures are kept in.
  double scene_influence = 0.0;  ///< CameraUncertainty's.
  double scene_celsius = 0.0;    ///< Mean of the image.
};

/// Holds what a pixel of the ideal thermal camera adds to that.
struct PixelUncertainty {
  double celsius = 0.0;
  /// Variance of the noise after resampling, as a fraction of that before (ThermalRectifier).
  double noise_gain = 1.0;
  Eigen::Vector2d slope_k_px =
      Eigen::Vector2d::Zero();  ///< Change of the temperature in the image.
  /// Second derivatives of the temperature along the image's axes.
  Eigen::Vector2d curvature_k_px2 = Eigen::Vector2d::Zero();
  Eigen::Vector2d speed_px_s = Eigen::Vector2d::Zero();  ///< Speed of the surface in the image.
  double smear_s = 0.0;  ///< How long motion smears the pixel's row.
  double spot_m = 1.0;   ///< Size of the surface that a pixel covers at right angles.
};

/// The terms of an apparent temperature's standard uncertainty, kelvin. They are independent, so
/// that their squares add up (GUM 5.1.2). docs/uncertainty.md says where each one comes from.
struct UncertaintyBudget {
  double noise_k = 0.0;
  double drift_k = 0.0;
  double resolution_k = 0.0;    ///< Step of a voxel's code.
  double registration_k = 0.0;  ///< Pose, extrinsic calibration and time, by the slope.
  double footprint_k = 0.0;     ///< Pixel and voxel, by the slope.
  double curvature_k = 0.0;     ///< The part that a slope leaves out over an uncertain place.
  double smear_k = 0.0;
  double scene_k = 0.0;

  double Combined() const;
};

/// The budget of one pixel. Specification of what the kernel computes (MakePixelRow).
UncertaintyBudget BudgetOf(const FrameUncertainty& frame, const PixelUncertainty& pixel);

/// Variance of a value that is uniformly distributed over a width of 1 (GUM 4.3.7).
inline constexpr double kUniformVariance = 1.0 / 12.0;

/// Standard uncertainty by what the camera's reading drifts after a NUC: the pattern's random walk,
/// and the housing, by its change since then if the camera tells it, else by the rate that a warm
/// camera stays below. If no NUC was seen, since the first frame: what drifted before is the same
/// for all temperatures, as the camera's absolute calibration is. Kelvin.
double DriftKelvin(const CameraUncertainty& camera, const NucAge& nuc);

/// Standard uncertainty of the extrinsic calibration in the thermal image, pixels along each axis.
double ExtrinsicSigmaPx(std::optional<double> reprojection_error_px);

}  // namespace isotherm

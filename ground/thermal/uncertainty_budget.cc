#include "ground/thermal/uncertainty_budget.h"

#include <cmath>
#include <numbers>

#include "common/base/units.h"
#include "ground/thermal/voxel_layout.h"

namespace isotherm {
namespace {

/// Mean error of reprojection between the cameras where the rig file has none (thesis table 5.1).
constexpr double kReprojectionError_px = 0.141;

}  // namespace

double UncertaintyBudget::Combined() const {
  double squares = 0.0;
  for (const double term_k :
       {noise_k, drift_k, resolution_k, registration_k, footprint_k, curvature_k, smear_k, scene_k})
    squares += term_k * term_k;
  return std::sqrt(squares);
}

UncertaintyBudget BudgetOf(const FrameUncertainty& frame, const PixelUncertainty& pixel) {
  const double slope_k_px = pixel.slope_k_px.norm();
  const double rate_k_s = pixel.slope_k_px.dot(pixel.speed_px_s);
  const double sigma_of_uniform = std::sqrt(kUniformVariance);
  UncertaintyBudget budget;
  budget.noise_k = frame.noise_k * std::sqrt(pixel.noise_gain);
  budget.drift_k = frame.drift_k;
  budget.resolution_k = double{ThermalLayout::kStep_k} * sigma_of_uniform;
  budget.registration_k = std::hypot(slope_k_px * frame.registration_px, rate_k_s * frame.time_s);
  const double footprint_px = sigma_of_uniform * std::hypot(1.0, frame.voxel_m / pixel.spot_m);
  budget.footprint_k = slope_k_px * footprint_px;
  // Moments of a quadratic form of a normally distributed place: mean and variance, squared.
  const double place_px2 =
      footprint_px * footprint_px + frame.registration_px * frame.registration_px;
  const double mean_k_px2 = 0.5 * pixel.curvature_k_px2.sum();
  budget.curvature_k =
      place_px2 * std::sqrt(mean_k_px2 * mean_k_px2 + 0.5 * pixel.curvature_k_px2.squaredNorm());
  budget.smear_k = std::abs(rate_k_s) * pixel.smear_s;
  budget.scene_k = frame.scene_influence * std::abs(pixel.celsius - frame.scene_celsius);
  return budget;
}

double DriftKelvin(const CameraUncertainty& camera, const NucAge& nuc) {
  const double minutes = nuc.seconds_since.value_or(nuc.seconds_followed) / kSPerMin;
  const double pattern_k = camera.pattern_drift_k_per_sqrt_min * std::sqrt(minutes);
  const auto unseen_k = [&](double seconds) {
    // A rate that lies anywhere between its limits: half their distance over the root of 3.
    return camera.error_per_housing_k * kWarmHousingRate_k_per_min * seconds / kSPerMin /
           std::numbers::sqrt3;
  };
  if (!nuc.housing_change_k) return std::hypot(pattern_k, unseen_k(kSPerMin * minutes));
  const double left_k = camera.left_per_housing_k * std::abs(*nuc.housing_change_k);
  return std::hypot(pattern_k, left_k, unseen_k(nuc.unseen_s));
}

double ExtrinsicSigmaPx(std::optional<double> reprojection_error_px) {
  return reprojection_error_px.value_or(kReprojectionError_px) / std::numbers::sqrt2;
}

}  // namespace isotherm

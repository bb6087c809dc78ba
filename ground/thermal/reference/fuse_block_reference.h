#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/testing/kernel_checks.h"
#include "ground/thermal/measurement_conditions.h"
#include "ground/thermal/thermal_kernel.h"
#include "ground/thermal/thermal_volume.h"

// These functions do what the kernel beside this folder must do, one element at a time and in
// double precision: they are its specification. Compiled for tests only.
namespace isotherm::reference {

using testing::AtLeastZero;
using testing::Both;
using testing::Tribool;

/// Holds what FuseBlock must do with one voxel.
struct VoxelFusion {
  Tribool considered = Tribool::kNo;
  Tribool assigned = Tribool::kNo;
  double code = 0.0;  ///< Code of the temperature, before rounding.
  double slack = 0.0;
  std::int32_t classes = 0;
};

/// The pixel that a voxel's centre is seen in, and where in it.
struct PixelHit {
  int index = 0;
  double du = 0.0, dv = 0.0;  ///< From the pixel's centre.
};

inline constexpr double kSinglePrecision = 1e-6;  ///< Metres, at up to a metre.
inline constexpr double kPixelError = 1e-4;       ///< Error of a projection, pixels.
inline constexpr double kStepsPerKelvin = 1.0 / 0.025;

/// kEither: too near the border of two pixels to say which.
inline Tribool FindPixel(const FusionKernelArgs& a, const Eigen::Vector3d& p, PixelHit& hit) {
  constexpr double kNearPixelBorder = 2e-3;  // Pixels.
  if (!(p.z() > 0.0)) return Tribool::kNo;
  const double u = a.fx * p.x() / p.z() + a.cx;
  const double v = a.fy * p.y() / p.z() + a.cy;
  const double column = std::floor(u + 0.5);
  const double row = std::floor(v + 0.5);
  const double to_border =
      std::min(std::abs(u + 0.5 - std::round(u + 0.5)), std::abs(v + 0.5 - std::round(v + 0.5)));
  if (to_border < kNearPixelBorder) return Tribool::kEither;
  if (!(column >= 0.0 && column < a.width && row >= 0.0 && row < a.height)) return Tribool::kNo;
  hit = {static_cast<int>(row) * a.width + static_cast<int>(column), u - column, v - row};
  return Tribool::kYes;
}

/// Returns whether the voxel lies near where its line of sight meets the plane of the pixel's
/// surface.
inline Tribool IsNearPlane(const FusionKernelArgs& a, const Eigen::Vector3d& p,
                           const PixelHit& hit) {
  const double per_u = static_cast<std::int16_t>(a.planes[hit.index] & PixelPlane::kUMask);
  const double per_v = a.planes[hit.index] >> PixelPlane::kVShift;
  const double inverse = 1.0 + (per_u * hit.du + per_v * hit.dv) / double{PixelPlane::kScale};
  const Eigen::Vector3d foot = p * (a.pixels[hit.index].depth_m / inverse / p.z());
  const double slack = kSinglePrecision + kPixelError * (std::abs(per_u) + std::abs(per_v)) /
                                              double{PixelPlane::kScale} * foot.norm() / inverse;
  return AtLeastZero(double{a.max_distance_m} - (p - foot).norm(), slack);
}

/// The temperature at the voxel, to first order between pixel centres.
inline void AssessCode(const ThermalPixel& pixel, const PixelHit& hit, VoxelFusion& result) {
  const double slope_u = static_cast<std::int16_t>(pixel.slopes & ThermalPixel::kSlopeUMask);
  const double slope_v = pixel.slopes >> ThermalPixel::kSlopeVShift;
  constexpr double kSlopeScale = ThermalPixel::kSlopeScale;
  const double celsius = pixel.celsius + (slope_u * hit.du + slope_v * hit.dv) / kSlopeScale;
  constexpr double kMin_celsius = ThermalLayout::kMin_celsius;
  result.code = std::clamp(1.0 + kStepsPerKelvin * (celsius - kMin_celsius), 1.0,
                           double{ThermalLayout::kMaxCode});
  result.slack =
      0.52 + kPixelError * kStepsPerKelvin / kSlopeScale * (std::abs(slope_u) + std::abs(slope_v)) +
      1e-6 * result.code;
}

/// Algorithm 6; kEither where the rounding of codes, which the kernel compares, decides.
inline Tribool Replaces(const VoxelFusion& fusion, ThermalVoxel old, SigmaPair sigma) {
  const ThermalVoxel conditions{static_cast<std::uint32_t>(fusion.classes)};
  const double apart = std::abs(fusion.code - static_cast<double>(ThermalLayout::Code(old.bits)));
  const auto replaces = [&](double steps_apart) {
    sigma.difference_k = steps_apart / kStepsPerKelvin;
    return ReplacesMeasurement(conditions.distance_class(), conditions.angle_class(),
                               conditions.motion_class(), old, sigma);
  };
  if (replaces(std::max(0.0, apart - fusion.slack))) return Tribool::kYes;
  return replaces(apart + fusion.slack) ? Tribool::kEither : Tribool::kNo;
}

/// Keeps the lowest of the temperatures measured under good conditions.
inline void KeepLowest(ThermalVoxel old, VoxelFusion& result) {
  const double margin = static_cast<double>(ThermalLayout::Code(old.bits)) - result.code;
  if (std::abs(margin) <= result.slack + 0.5) {
    result.assigned = result.assigned == Tribool::kNo ? Tribool::kNo : Tribool::kEither;
  } else if (margin < 0.0) {
    result.assigned = Tribool::kNo;
  }
}

inline VoxelFusion FuseVoxel(const FusionKernelArgs& a, const Eigen::Vector3d& p, TsdfVoxel voxel,
                             ThermalVoxel old, std::uint8_t old_sigma) {
  VoxelFusion result;
  if (!voxel.observed() || std::abs(TsdfLayout::TsdfCode(voxel.bits)) > a.max_tsdf_code)
    return result;
  PixelHit hit;
  const Tribool found = FindPixel(a, p, hit);
  if (found != Tribool::kYes) {
    result.considered = result.assigned = found;
    return result;
  }
  const ThermalPixel& pixel = a.pixels[hit.index];
  if ((pixel.flags & ThermalPixel::kSeen) == 0) return result;
  result.considered = IsNearPlane(a, p, hit);
  if ((pixel.flags & ThermalPixel::kAssignable) == 0) return result;
  result.assigned = result.considered;
  result.classes = pixel.flags & ThermalLayout::kConditionMask;
  AssessCode(pixel, hit, result);
  // Of temperatures under good conditions the lowest is kept, not the least uncertain.
  const bool lowest = a.keep_lowest && result.classes == static_cast<std::int32_t>(kAllGood);
  if (a.validate) {
    const SigmaPair sigma{.now = ThermalPixel::Sigma(pixel.flags), .before = old_sigma};
    const Tribool replaces = Replaces(result, old, lowest ? SigmaPair{} : sigma);
    result.assigned = Both(result.assigned, replaces);
    if (result.assigned == Tribool::kNo && replaces != Tribool::kYes) {
      result.code = result.slack = 0.0;
      return result;
    }
  }
  const ThermalVoxel conditions{static_cast<std::uint32_t>(result.classes)};
  const bool bad = conditions.distance_class() == ConditionClass::kBad ||
                   conditions.angle_class() == ConditionClass::kBad;
  if (!a.keep_bad && bad) result.code = result.slack = 0.0;
  if (lowest && (old.bits & ThermalLayout::kConditionMask) == kAllGood) KeepLowest(old, result);
  return result;
}

}  // namespace isotherm::reference

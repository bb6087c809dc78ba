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
using testing::Verdict;

/// Holds what FuseBlock must do with one voxel.
struct VoxelFusion {
  Verdict considered = Verdict::kNo;
  Verdict assigned = Verdict::kNo;
  double code = 0.0;  ///< Code of the temperature, before rounding.
  double slack = 0.0;
  std::int32_t classes = 0;
};

inline VoxelFusion FuseVoxel(const FusionKernelArgs& a, const Eigen::Vector3d& p, TsdfVoxel voxel,
                             ThermalVoxel old, std::uint8_t old_sigma) {
  constexpr double kNearPixelBorder = 2e-3;  // Pixels.
  constexpr double kSinglePrecision = 1e-6;  // Metres, at up to a metre.
  VoxelFusion result;
  if (!voxel.observed() || std::abs(TsdfLayout::TsdfCode(voxel.bits)) > a.max_tsdf_code)
    return result;
  if (!(p.z() > 0.0)) return result;
  const double u = a.fx * p.x() / p.z() + a.cx;
  const double v = a.fy * p.y() / p.z() + a.cy;
  const double column = std::floor(u + 0.5);
  const double row = std::floor(v + 0.5);
  const double to_border =
      std::min(std::abs(u + 0.5 - std::round(u + 0.5)), std::abs(v + 0.5 - std::round(v + 0.5)));
  if (to_border < kNearPixelBorder) {
    result.considered = result.assigned = Verdict::kEither;
    return result;
  }
  if (!(column >= 0.0 && column < a.width && row >= 0.0 && row < a.height)) return result;
  const auto index = static_cast<int>(row) * a.width + static_cast<int>(column);
  const ThermalPixel& pixel = a.pixels[index];
  if ((pixel.flags & ThermalPixel::kSeen) == 0) return result;
  const double per_u = static_cast<std::int16_t>(a.planes[index] & PixelPlane::kUMask);
  const double per_v = a.planes[index] >> PixelPlane::kVShift;
  const double inverse =
      1.0 + (per_u * (u - column) + per_v * (v - row)) / double{PixelPlane::kScale};
  // Where the line of sight to the voxel meets the plane of the pixel's surface.
  const Eigen::Vector3d foot = p * (pixel.depth_m / inverse / p.z());
  constexpr double kPixelError = 1e-4;  // Of a projection.
  const double slack = kSinglePrecision + kPixelError * (std::abs(per_u) + std::abs(per_v)) /
                                              double{PixelPlane::kScale} * foot.norm() / inverse;
  result.considered = AtLeastZero(double{a.max_distance_m} - (p - foot).norm(), slack);
  if ((pixel.flags & ThermalPixel::kAssignable) == 0) return result;
  result.classes = pixel.flags & ThermalLayout::kConditionMask;
  const ThermalVoxel conditions{static_cast<std::uint32_t>(result.classes)};
  const double slope_u = static_cast<std::int16_t>(pixel.slopes & ThermalPixel::kSlopeUMask);
  const double slope_v = pixel.slopes >> ThermalPixel::kSlopeVShift;
  constexpr double kSlopeScale = ThermalPixel::kSlopeScale;
  constexpr double kStepsPerKelvin = 1.0 / 0.025;
  const double celsius =
      pixel.celsius + (slope_u * (u - column) + slope_v * (v - row)) / kSlopeScale;
  result.code = std::clamp(1.0 + kStepsPerKelvin * (celsius + 100.0), 1.0, 65535.0);
  result.slack =
      0.52 + kPixelError * kStepsPerKelvin / kSlopeScale * (std::abs(slope_u) + std::abs(slope_v)) +
      1e-6 * result.code;
  SigmaPair sigma{.now = ThermalPixel::Sigma(pixel.flags), .before = old_sigma};
  // Of temperatures under good conditions the lowest is kept, not the least uncertain.
  if (a.keep_lowest && result.classes == static_cast<std::int32_t>(kAllGood)) sigma = {};
  const double apart = std::abs(result.code - static_cast<double>(ThermalLayout::Code(old.bits)));
  const auto replaces = [&](double steps_apart) {
    sigma.difference_k = steps_apart / kStepsPerKelvin;
    return ReplacesMeasurement(conditions.distance_class(), conditions.angle_class(),
                               conditions.motion_class(), old, sigma);
  };
  result.assigned = result.considered;
  // The kernel compares what voxels can hold.
  const bool surely = replaces(std::max(0.0, apart - result.slack));
  if (a.validate && !surely) {
    const bool perhaps = replaces(apart + result.slack);
    const bool either = perhaps && result.assigned != Verdict::kNo;
    result.assigned = either ? Verdict::kEither : Verdict::kNo;
    if (!either) {
      result.code = result.slack = 0.0;
      return result;
    }
  }
  const bool bad = conditions.distance_class() == ConditionClass::kBad ||
                   conditions.angle_class() == ConditionClass::kBad;
  if (!a.keep_bad && bad) result.code = result.slack = 0.0;
  if (a.keep_lowest && result.classes == static_cast<std::int32_t>(kAllGood) &&
      (old.bits & ThermalLayout::kConditionMask) == kAllGood) {
    const double margin = static_cast<double>(ThermalLayout::Code(old.bits)) - result.code;
    if (std::abs(margin) <= result.slack + 0.5) {
      result.assigned = result.assigned == Verdict::kNo ? Verdict::kNo : Verdict::kEither;
    } else if (margin < 0.0) {
      result.assigned = Verdict::kNo;
    }
  }
  return result;
}

}  // namespace isotherm::reference

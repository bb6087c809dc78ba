#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "common/testing/kernel_checks.h"
#include "ground/thermal/camera_motion.h"
#include "ground/thermal/thermal_kernel.h"
#include "ground/thermal/uncertainty_budget.h"

// These functions do what the kernel beside this folder must do, one element at a time and in
// double precision: they are its specification. Compiled for tests only.
namespace isotherm::reference {

using testing::AtLeastZero;
using testing::Both;
using testing::Tribool;

/// Rounding of a sum of a few products in single precision.
inline constexpr double kPixelPrecision = 2e-6;

/// Holds what MakePixelRow must make of a pixel.
struct Pixel {
  double depth_m = 0.0;
  double slope_u = 0.0, slope_v = 0.0;  ///< Codes.
  double plane_u = 0.0, plane_v = 0.0;  ///< Codes of PixelPlane.
  double plane_slack = 0.0;
  double smear_px = 0.0;
  double sigma_k = 0.0;
  Tribool surface = Tribool::kNo, seen = Tribool::kNo;
  Tribool occluded = Tribool::kNo, assignable = Tribool::kNo;
  Tribool sharp = Tribool::kNo, still = Tribool::kNo, even = Tribool::kNo;
  double cosine = 0.0;
  int distance_class = 0;
  int angle_class = 0;
  bool certain_angle = true;
  bool certain_distance = true;
};

/// Notes whether the row is smeared by less than its limits here.
inline void AssessSmear(const PixelRowArgs& a, int x, Pixel& result) {
  const auto vector = [](const float* v) {
    return Eigen::Map<const Eigen::Vector3f>(v).cast<double>().eval();
  };
  const CameraMotion motion{vector(a.velocity_m_s), vector(a.rate_rad_s)};
  const Eigen::Vector2d xy((x - double{a.cx}) / a.fx, a.y);
  const Eigen::Vector2d speed = ImageVelocity(motion, xy, result.depth_m);
  const double smear_px = double{a.smear_s} * std::hypot(a.fx * speed.x(), a.fy * speed.y());
  constexpr double kRelative = 1e-4;  // Of a reciprocal and differences.
  result.smear_px = smear_px;
  result.sharp = AtLeastZero(a.smear_max_px - smear_px, kRelative * (1.0 + smear_px));
  result.still = AtLeastZero(a.smear_good_px - smear_px, kRelative * (1.0 + smear_px));
}

inline Tribool Not(Tribool v) {
  if (v == Tribool::kEither) return v;
  return v == Tribool::kYes ? Tribool::kNo : Tribool::kYes;
}

inline int ConditionCode(double value, double good_low, double good_high, double low, double high) {
  if (value >= good_low && value <= good_high) return 1;
  return value >= low && value <= high ? 2 : 0;
}

inline double SlopeCode(float before, float after) {
  const double half = 0.5 * (double{after} - before) * double{ThermalPixel::kSlopeScale};
  return std::isnan(half) ? 0.0 : std::clamp(half, -32767.0, 32767.0);
}

/// The plane through the pixel's vertex.
inline void AssessPlane(const PixelRowArgs& a, const Eigen::Vector3d& p, const Eigen::Vector3d& n,
                        Pixel& result) {
  const auto vector = [](const float* v) {
    return Eigen::Map<const Eigen::Vector3f>(v).cast<double>().eval();
  };
  const double before_plane = n.dot(vector(a.position) - p);
  if (!(before_plane > 0.0)) return;
  const auto per_pixel = [&](const float* axis, double focal_px) {
    return -result.depth_m * n.dot(vector(axis)) / (focal_px * before_plane) *
           double{PixelPlane::kScale};
  };
  const auto clamp = [](double code) { return std::clamp(code, -32767.0, 32767.0); };
  result.plane_u = clamp(per_pixel(a.x_axis, a.fx));
  result.plane_v = clamp(per_pixel(a.y_axis, a.fy));
  // A plane seen nearly edge-on magnifies the rounding of its distance.
  result.plane_slack =
      kPixelPrecision * (std::abs(result.plane_u) + std::abs(result.plane_v)) / before_plane;
}

/// The standard uncertainty of the pixel's temperature.
inline double SigmaOf(const PixelRowArgs& a, int x, const Pixel& pixel) {
  const auto vector = [](const float* v) {
    return Eigen::Map<const Eigen::Vector3f>(v).cast<double>().eval();
  };
  const SigmaArgs& s = a.sigma;
  const double resolution_k2 = kUniformVariance * std::pow(double{ThermalLayout::kStep_k}, 2);
  const FrameUncertainty frame{
      .noise_k = std::sqrt(double{s.noise_k2}),
      .drift_k = std::sqrt(double{s.even_k2} - resolution_k2),
      .registration_px = std::sqrt(double{s.place_px2} - kUniformVariance),
      .time_s = std::sqrt(double{s.time_s2}),
      .voxel_m = std::sqrt(double{s.voxel_px2_m2} / kUniformVariance) / a.fx,
      .scene_influence = s.scene_influence,
      .scene_celsius = s.scene_celsius};
  const CameraMotion motion{vector(a.velocity_m_s), vector(a.rate_rad_s)};
  const Eigen::Vector2d xy((x - double{a.cx}) / a.fx, a.y);
  const Eigen::Vector2d speed = ImageVelocity(motion, xy, pixel.depth_m);
  const float* above = a.celsius + x - a.celsius_stride;
  const float* below = a.celsius + x + a.celsius_stride;
  const auto slope = [](float before, float after) {
    const double half = 0.5 * (double{after} - before);
    return std::isnan(half) ? 0.0 : half;
  };
  const auto curvature = [&](float before, float after) {
    const double second = double{before} - 2.0 * double{a.celsius[x]} + double{after};
    return std::isnan(second) ? 0.0 : second;
  };
  return BudgetOf(frame,
                  {.celsius = a.celsius[x],
                   .noise_gain = a.noise_gain[x],
                   .slope_k_px = {slope(a.celsius[x - 1], a.celsius[x + 1]), slope(*above, *below)},
                   .curvature_k_px2 = {curvature(a.celsius[x - 1], a.celsius[x + 1]),
                                       curvature(*above, *below)},
                   .speed_px_s = {a.fx * speed.x(), a.fy * speed.y()},
                   .smear_s = a.smear_s,
                   .spot_m = pixel.depth_m / a.fx})
      .Combined();
}

/// Returns whether a point lies before the depth camera and within its image.
inline Tribool SeenByDepthCamera(const PixelRowArgs& a, const Eigen::Vector3d& p) {
  const Eigen::Matrix3d R =
      Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(a.R_depth).cast<double>();
  const Eigen::Vector3d q = R * p + Eigen::Map<const Eigen::Vector3f>(a.t_depth).cast<double>();
  const double q_slack = kPixelPrecision * (p.cwiseAbs().sum() + 1.0);
  const auto in_image = [&](double along, double f, double c, double size) {
    const double pixel = f * along / q.z() + c + 0.5;
    const double slack = 1e-4 + f * q_slack * (1.0 + std::abs(along / q.z())) / std::abs(q.z());
    return Both(AtLeastZero(pixel, slack), AtLeastZero(size - pixel, slack));
  };
  return Both(AtLeastZero(q.z(), q_slack),
              Both(in_image(q.x(), a.depth_fx, a.depth_cx, double{a.depth_width}),
                   in_image(q.y(), a.depth_fy, a.depth_cy, double{a.depth_height})));
}

inline Pixel MakePixel(const PixelRowArgs& a, int x) {
  Pixel result;
  const Eigen::Vector3d p(a.vx[x], a.vy[x], a.vz[x]);
  result.slope_u = SlopeCode(a.celsius[x - 1], a.celsius[x + 1]);
  result.slope_v = SlopeCode(a.celsius[x - a.celsius_stride], a.celsius[x + a.celsius_stride]);
  const Eigen::Vector3d z_axis = Eigen::Map<const Eigen::Vector3f>(a.z_axis).cast<double>();
  result.depth_m = z_axis.dot(p) + a.z_axis[3];
  const double reach = z_axis.cwiseAbs().dot(p.cwiseAbs()) + std::abs(a.z_axis[3]);
  result.surface = AtLeastZero(result.depth_m, kPixelPrecision * reach);

  result.seen = Both(result.surface, SeenByDepthCamera(a, p));

  const double distance = a.distance_m[x];
  double nearest = distance;
  for (int row = -a.margin; row <= a.margin; ++row) {
    for (int column = -a.margin; column <= a.margin; ++column)
      nearest = std::min(nearest, double{a.distance_m[x + row * a.distance_stride + column]});
  }
  result.occluded =
      AtLeastZero(distance - nearest - double{a.occlusion_tolerance_m}, kPixelPrecision * distance);
  const Eigen::Vector3d to_camera =
      Eigen::Map<const Eigen::Vector3f>(a.position).cast<double>() - p;
  const Eigen::Vector3d n(a.nx[x], a.ny[x], a.nz[x]);
  AssessPlane(a, p, n, result);
  const double cosine = std::min(n.dot(to_camera) / distance, 1.0);
  result.cosine = cosine;
  const double resolved = cosine * a.max_footprint_m - distance / a.fx;
  result.certain_distance = std::abs(resolved) > 1e-6;
  result.distance_class = resolved < 0.0
                              ? 0
                              : ConditionCode(distance, a.distance_min_m, a.distance_good_m,
                                              a.distance_min_m, a.distance_max_m);
  result.angle_class = ConditionCode(cosine, a.cosine_good_angle, a.cosine_min_angle,
                                     a.cosine_max_angle, a.cosine_min_angle);
  for (const float limit : {a.cosine_good_angle, a.cosine_min_angle, a.cosine_max_angle})
    result.certain_angle = result.certain_angle && std::abs(cosine - double{limit}) > 1e-5;
  AssessSmear(a, x, result);
  const double slope_k = std::hypot(result.slope_u, result.slope_v) / ThermalPixel::kSlopeScale;
  // Codes stop at their limits, temperatures do not.
  const double error_k = slope_k * std::max(double{a.uncertainty_px}, result.smear_px);
  result.even =
      slope_k > 400.0 ? Tribool::kNo : AtLeastZero(a.max_error_k - error_k, 1e-4 * (1.0 + error_k));
  result.assignable = Both(result.seen, Not(result.occluded));
  result.assignable = Both(result.assignable, Both(result.sharp, result.even));
  result.assignable = Both(result.assignable, AtLeastZero(cosine, 1e-5));
  if (std::isnan(a.celsius[x])) result.assignable = Tribool::kNo;
  result.sigma_k = SigmaOf(a, x, result);
  return result;
}

}  // namespace isotherm::reference

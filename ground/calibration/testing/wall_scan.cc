#include "ground/calibration/testing/wall_scan.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>

#include "common/base/noise.h"
#include "common/radiometry/radiometry.h"

namespace isotherm::testing {
namespace {

constexpr CaptureTime kWallStart{std::chrono::seconds(100)};
constexpr int kColumns = 160, kRows = 120;
constexpr double kScan_s = 8.0, kDepthRate_hz = 30.0, kThermalRate_hz = 16.0;
constexpr double kNearSigma_px = 16.0;

/// The depth camera's true pose before a wall about one metre away.
RigidTransform RigPose(double time_s, const WallScan& scan) {
  RigidTransform pose = RigidTransform::Identity();
  const double m = scan.motion, t = scan.turns ? scan.motion : 0.0;
  pose.translation() =
      Eigen::Vector3d(0.1 * m * std::sin(2.1 * time_s), 0.07 * m * std::sin(2.9 * time_s),
                      0.2 * t * std::sin(1.1 * time_s));
  pose.linear() = (Eigen::AngleAxisd(0.35 * t * std::sin(1.6 * time_s), Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(0.12 * t * std::sin(1.9 * time_s), Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(0.1 * t * std::sin(2.3 * time_s), Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  return pose;
}

double WallCelsius(double x_m, double y_m, const WallScan& scan) {
  return 40.0 + scan.contrast_k * (std::sin(40.0 * x_m + 0.7) * std::cos(33.0 * y_m) +
                                   std::sin(9.0 * x_m) * std::cos(7.0 * y_m + 0.4));
}

/// The edge of the fold points at the rig.
Eigen::Vector3d WallPoint(double x_m, double y_m, const WallScan& scan) {
  return {x_m, y_m, 1.0 + scan.fold * std::abs(x_m)};
}

/// Where a ray first meets one of the two halves.
Eigen::Vector3d MeetWall(const Eigen::Vector3d& from, const Eigen::Vector3d& ray,
                         const WallScan& scan) {
  const double slope = scan.fold;
  for (const double side : {1.0, -1.0}) {
    // z = 1 + slope side x
    const double t =
        (1.0 + slope * side * from.x() - from.z()) / (ray.z() - slope * side * ray.x());
    const Eigen::Vector3d p = from + t * ray;
    if (t > 0.0 && side * p.x() >= 0.0) return p;
  }
  return from;
}

Eigen::Vector3d WallNormal(double x_m, const WallScan& scan) {
  return Eigen::Vector3d(scan.fold * (x_m < 0.0 ? -1.0 : 1.0), 0.0, -1.0).normalized();
}

/// Apparent temperature along a ray; radiance is taken as linear in temperature.
double SeenCelsius(const Eigen::Vector3d& p_world, const Eigen::Vector3d& ray,
                   const WallScan& scan) {
  const double own = WallCelsius(p_world.x(), p_world.y(), scan);
  if (scan.refractive_index == 1.0) return own;
  constexpr double kHotter_k = 150.0, kSurround_celsius = 20.0;
  const double cosine = -ray.normalized().dot(WallNormal(p_world.x(), scan));
  const double reflected = FresnelReflectivity(std::acos(cosine), scan.refractive_index, 0.0);
  return (1.0 - reflected) * (own + kHotter_k) + reflected * kSurround_celsius;
}

/// The mean around each pixel, weighted by a Gaussian that ends at the border.
Image<double> NearMeans(const Image<double>& celsius) {
  const auto smoothed = [&](const Image<double>& from, bool along_rows) {
    Image<double> to(kColumns, kRows);
    for (int v = 0; v < kRows; ++v) {
      for (int u = 0; u < kColumns; ++u) {
        double sum = 0.0, weights = 0.0;
        for (int i = 0; i < (along_rows ? kColumns : kRows); ++i) {
          const double off = (along_rows ? i - u : i - v) / kNearSigma_px;
          const double weight = std::exp(-0.5 * off * off);
          sum += weight * (along_rows ? from.At(i, v) : from.At(u, i));
          weights += weight;
        }
        to.At(u, v) = sum / weights;
      }
    }
    return to;
  };
  return smoothed(smoothed(celsius, true), false);
}

/// Adds what each pixel gets from others.
void AddInfluence(const WallScan& scan, Image<double>& celsius) {
  if (scan.near_fraction == 0.0 && scan.total_fraction == 0.0) return;
  const Image<double> near = NearMeans(celsius);
  double total = 0.0;
  for (const double value : celsius.pixels()) total += value / static_cast<double>(celsius.size());
  for (std::size_t i = 0; i < celsius.size(); ++i) {
    double& own = celsius.pixels()[i];
    own += scan.near_fraction * (near.pixels()[i] - own) + scan.total_fraction * (total - own);
  }
}

/// Renders by the exact line of sight of each pixel.
Image<std::uint16_t> RenderWall(double time_s, const WallScan& scan, double offset_k) {
  const ThermalPlacement placement = TruePlacement();
  const std::uint64_t stream = NoiseStream(scan.seed, 1, static_cast<std::uint64_t>(1e4 * time_s));
  Image<double> celsius(kColumns, kRows);
  for (int v = 0; v < kRows; ++v) {
    const RigidTransform T_world_thermal =
        RigPose(time_s + scan.row_readout_s * (v - 0.5 * (kRows - 1)), scan) *
        placement.T_thermal_depth.inverse();
    for (int u = 0; u < kColumns; ++u) {
      const Eigen::Vector2d normalized = Unproject(placement.camera, {1.0 * u, 1.0 * v});
      const Eigen::Vector3d p = MeetWall(T_world_thermal.translation(),
                                         T_world_thermal.linear() * normalized.homogeneous(), scan);
      celsius.At(u, v) = SeenCelsius(p, p - T_world_thermal.translation(), scan) + offset_k;
    }
  }
  AddInfluence(scan, celsius);
  Image<std::uint16_t> image(kColumns, kRows);
  for (std::size_t i = 0; i < image.size(); ++i) {
    const double kelvin = celsius.pixels()[i] + 273.15 + 0.05 * NormalNoise(stream, i);
    image.pixels()[i] = static_cast<std::uint16_t>(std::lround(100.0 * kelvin));
  }
  return image;
}

}  // namespace

ThermalPlacement TruePlacement() {
  Eigen::Matrix<double, 6, 1> twist;
  twist << 0.05, 0.03, -0.01, 0.02, -0.03, 0.04;
  ThermalPlacement placement;
  placement.camera = {.width = kColumns,
                      .height = kRows,
                      .fx = 150.0,
                      .fy = 151.0,
                      .cx = 81.0,
                      .cy = 58.0,
                      .k1 = -0.25};
  placement.T_thermal_depth = TransformFromTwist(twist);
  placement.delay_s = -0.015;
  placement.influence.near_sigma_px = kNearSigma_px;
  return placement;
}

ScanViews ScanOf(const WallScan& scan) {
  ScanViews views;
  views.pose_drift_m = 0.0001 + 2.0 * scan.drift_m;
  views.row_readout_s = scan.row_readout_s;
  Eigen::Vector3d wander_m = Eigen::Vector3d::Zero();
  for (int i = 0; i < static_cast<int>(kScan_s * kDepthRate_hz); ++i) {
    RigidTransform pose = RigPose(i / kDepthRate_hz, scan);
    const std::uint64_t stream = NoiseStream(scan.seed, 2, static_cast<std::uint64_t>(i));
    constexpr double kKept = 0.97;  // About a second.
    for (int axis = 0; axis < 3; ++axis) {
      wander_m[axis] =
          kKept * wander_m[axis] + std::sqrt(1.0 - kKept * kKept) * scan.drift_m *
                                       NormalNoise(stream, static_cast<std::uint64_t>(axis));
    }
    pose.translation() += wander_m;
    views.trajectory.push_back({kWallStart + FromSeconds(i / kDepthRate_hz), pose});
  }
  for (std::uint64_t i = 0; i < 600; ++i) {
    const double x_m = 0.9 * (UniformNoise(5, 2 * i) - 0.5);
    const double y_m = 0.7 * (UniformNoise(5, 2 * i + 1) - 0.5);
    views.points.push_back({WallPoint(x_m, y_m, scan), WallNormal(x_m, scan)});
  }
  for (int i = 2; i < static_cast<int>(kScan_s * kThermalRate_hz) - 2; ++i) {
    const double time_s = i / kThermalRate_hz;
    const bool second_half = time_s > 0.5 * kScan_s;
    views.frames.push_back({kWallStart + FromSeconds(time_s - TruePlacement().delay_s),
                            std::make_shared<const Image<std::uint16_t>>(
                                RenderWall(time_s, scan, second_half ? scan.nuc_offset_k : 0.0)),
                            kCentikelvin,
                            {},
                            static_cast<std::uint8_t>(second_half ? 1 : 0)});
  }
  return views;
}

Status Look(ScanViews& views, const ThermalPlacement& placement) {
  constexpr double kBorder_px = 5.0;
  views.thermal_camera = placement.camera;
  views.T_thermal_depth = placement.T_thermal_depth;
  views.delay_s = placement.delay_s;
  for (StampedThermal& frame : views.frames) {
    frame.visible.clear();
    const auto T_world_depth =
        InterpolatePose(views.trajectory, frame.time + FromSeconds(placement.delay_s));
    if (!T_world_depth) continue;
    const RigidTransform T_thermal_world = placement.T_thermal_depth * T_world_depth->inverse();
    for (std::size_t i = 0; i < views.points.size(); ++i) {
      const auto pixel = Project(placement.camera, T_thermal_world * views.points[i].p_world);
      if (pixel && pixel->x() > kBorder_px && pixel->y() > kBorder_px &&
          pixel->x() < kColumns - kBorder_px && pixel->y() < kRows - kBorder_px)
        frame.visible.push_back(static_cast<std::uint32_t>(i));
    }
  }
  return OkStatus();
}

}  // namespace isotherm::testing

#include "ground/calibration/rig_refinement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <vector>

#include "common/base/noise.h"
#include "common/radiometry/radiometry.h"

namespace isotherm {
namespace {

using testing::HasSubstr;

constexpr CaptureTime kWallStart{std::chrono::seconds(100)};
constexpr int kColumns = 160, kRows = 120;
constexpr double kScan_s = 8.0, kDepthRate_hz = 30.0, kThermalRate_hz = 16.0;
constexpr double kNearSigma_px = 16.0;
constexpr double kDegree = std::numbers::pi / 180.0;

/// Holds what a scan of a folded wall is like.
struct WallScan {
  std::uint64_t seed = 1;
  double fold = 0.5;  ///< Slope of the wall to both sides of its edge; 0: flat.
  double contrast_k = 6.0;
  /// Above 1: warmer by 150 K, and seen as a smooth dielectric before surroundings at 20 degrees C.
  double refractive_index = 1.0;
  double motion = 1.0;        ///< 0: the rig rests.
  bool turns = true;          ///< It turns and goes nearer and farther, beside its swing.
  double nuc_offset_k = 0.0;  ///< The second half of the scan, after a NUC, is as much warmer.
  double drift_m = 0.0;       ///< Poses wander by so much, one sigma along each axis.
  /// Fractions of what the surroundings of a pixel and the whole image add to it; the calibration
  /// does not know them.
  double near_fraction = 0.0, total_fraction = 0.0;
  double row_readout_s = 0.0;  ///< Stamps are of the middle row.
};

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

/// All that the scan offers but visibility. Stamps lack the true delay.
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

/// Both halves are in sight wherever the rig is.
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

Result<Refinement> RefineWall(const WallScan& scan, const PlacementVector& off_by,
                              const RefinementPrior& prior = {}) {
  ScanViews views = ScanOf(scan);
  ThreadPool pool(2);
  const LookAgain look_again = [&](const ThermalPlacement& placement, double,
                                   const std::function<void(double)>&) {
    return Look(views, placement);
  };
  return RefinePlacement(views, Corrected(TruePlacement(), off_by), prior, look_again, pool, {});
}

PlacementVector SomewhatOff(std::uint64_t seed) {
  PlacementVector off_by;
  for (int i = 0; i < kPlacementParameters; ++i)
    off_by[i] = NormalNoise(seed, static_cast<std::uint64_t>(i));
  off_by.head<3>() *= 0.7 * kDegree / off_by.head<3>().norm();
  off_by.segment<3>(3) *= 0.006 / off_by.segment<3>(3).norm();
  off_by[kDelay] = off_by[kDelay] < 0.0 ? -0.012 : 0.012;
  off_by.segment<2>(kPrincipalX) *= 3.0 / off_by.segment<2>(kPrincipalX).norm();
  off_by.tail<2>().setZero();
  return off_by;
}

/// The error that is left, in standard deviations as they are told.
PlacementVector Errors(const Refinement& refinement) {
  PlacementVector errors = CorrectionBetween(TruePlacement(), refinement.after);
  for (int i = 0; i < kPlacementParameters; ++i)
    errors[i] /= refinement.Sigma(static_cast<PlacementParameter>(i));
  return errors;
}

TEST(RigRefinementTest, PlacementIsFoundAgain) {
  double squares = 0.0;
  for (const std::uint64_t seed : {1, 2}) {
    const Result<Refinement> refined = RefineWall({.seed = seed}, SomewhatOff(seed));
    ASSERT_TRUE(refined.has_value()) << refined.error().message();
    const PlacementVector left = CorrectionBetween(TruePlacement(), refined->after);
    std::printf("seed %d: off by %.1f px, then %.3f degrees, %.2f mm, %.2f ms, %.2f px\n",
                static_cast<int>(seed), refined->shift.rms_px, left.head<3>().norm() / kDegree,
                1e3 * left.segment<3>(3).norm(), 1e3 * left[kDelay],
                left.segment<2>(kPrincipalX).norm());
    EXPECT_LT(left.head<3>().norm(), 0.1 * kDegree);
    EXPECT_LT(left.segment<3>(3).norm(), 0.001);
    EXPECT_LT(std::abs(left[kDelay]), 0.0005);
    EXPECT_LT(left.segment<2>(kPrincipalX).norm(), 0.3);
    // The wall's contrast is low, so that the scene's influence is hardly told.
    EXPECT_LT(left.tail<2>().norm(), 0.02);
    EXPECT_GE(refined->observed_directions, kPlacementParameters - 2);
    for (int i = 0; i < kNearInfluence; ++i)
      EXPECT_TRUE(refined->Tells(static_cast<PlacementParameter>(i)));
    EXPECT_GT(refined->shift.rms_px, 1.0);
    EXPECT_LT(refined->held_out.after_k, 0.5 * refined->held_out.before_k);
    squares += Errors(*refined).squaredNorm() / (2.0 * kPlacementParameters);
  }
  // Uncertainties are neither too small nor an excuse.
  EXPECT_LT(std::sqrt(squares), 2.0);
  EXPECT_GT(std::sqrt(squares), 0.2);
}

/// Without its two parameters the pose is 2.9 pixels off.
TEST(RigRefinementTest, InfluenceOfTheSceneIsFoundToo) {
  const Result<Refinement> refined = RefineWall(
      {.contrast_k = 40.0, .near_fraction = 0.05, .total_fraction = 0.03}, PlacementVector::Zero());
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  const SceneInfluence& found = refined->after.influence;
  const double near_sigma = refined->Sigma(kNearInfluence);
  const double total_sigma = refined->Sigma(kTotalInfluence);
  std::printf("shift %.3f px, near %.4f (%.4f), total %.4f (%.4f)\n", refined->shift.rms_px,
              found.near_fraction, near_sigma, found.total_fraction, total_sigma);
  EXPECT_NEAR(found.near_fraction, 0.05, std::max(0.008, 3.0 * near_sigma));
  EXPECT_NEAR(found.total_fraction, 0.03, 3.0 * total_sigma);
  EXPECT_LT(near_sigma, 0.01);
  EXPECT_LT(total_sigma, 0.02);
  EXPECT_LT(refined->shift.rms_px, 0.15);
}

/// In half a frame's time from the middle row to the last, points move by up to two pixels.
TEST(RigRefinementTest, RowsThatAreReadLaterAreNoDelay) {
  const WallScan scan = {.row_readout_s = 0.0002};
  const Result<Refinement> refined = RefineWall(scan, PlacementVector::Zero());
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  std::printf("shift %.3f px, delay %.2f ms\n", refined->shift.rms_px,
              1e3 * refined->correction[kDelay]);
  EXPECT_LT(refined->shift.rms_px, 0.15);
  EXPECT_NEAR(refined->correction[kDelay], 0.0, 0.0003);
}

TEST(RigRefinementTest, RightPlacementStays) {
  const Result<Refinement> refined = RefineWall({}, PlacementVector::Zero());
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  EXPECT_LT(refined->shift.rms_px, std::max(0.05, 3.0 * refined->shift.sigma_px));
  EXPECT_LT(refined->shift.sigma_px, 0.2);
  EXPECT_NEAR(refined->held_out.after_k, refined->held_out.before_k,
              0.05 * refined->held_out.before_k);
}

TEST(RigRefinementTest, OffsetAfterANucIsNoTexture) {
  const Result<Refinement> refined = RefineWall({.nuc_offset_k = 3.0}, SomewhatOff(4));
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  EXPECT_LT(Errors(*refined).cwiseAbs().maxCoeff(), 4.0);
  EXPECT_LT(refined->held_out.after_k, 0.3);
}

TEST(RigRefinementTest, WanderingPosesAreInTheUncertainty) {
  double squares = 0.0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Result<Refinement> refined =
        RefineWall({.seed = seed, .drift_m = 0.0003}, SomewhatOff(seed));
    ASSERT_TRUE(refined.has_value()) << refined.error().message();
    squares += Errors(*refined).squaredNorm() / (3.0 * kPlacementParameters);
  }
  std::printf("errors over uncertainty, root mean square: %.2f\n", std::sqrt(squares));
  EXPECT_LT(std::sqrt(squares), 2.0);
  EXPECT_GT(std::sqrt(squares), 0.3);
}

TEST(RigRefinementTest, EvenlyWarmWallTellsNothing) {
  const Result<Refinement> refined = RefineWall({.contrast_k = 0.0}, SomewhatOff(1));
  ASSERT_FALSE(refined.has_value());
  EXPECT_THAT(refined.error().message(), HasSubstr("warm and cold parts"));
}

TEST(RigRefinementTest, RestingRigChangesNothing) {
  const Result<Refinement> refined = RefineWall({.motion = 0.0}, SomewhatOff(1));
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  EXPECT_EQ(refined->observed_directions, 0);
  EXPECT_TRUE(refined->correction.isZero(1e-9));
  EXPECT_FALSE(refined->Tells(kRotationX));
}

TEST(RigRefinementTest, WhatIsToBeKeptIsKept) {
  PlacementVector off_by = SomewhatOff(3);
  off_by.segment<2>(kPrincipalX).setZero();
  const Result<Refinement> refined = RefineWall({}, off_by, {.principal_point_px = 0.0});
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  EXPECT_EQ(refined->correction[kPrincipalX], 0.0);
  EXPECT_TRUE(refined->Keeps(kPrincipalY));
  EXPECT_FALSE(refined->Keeps(kDelay));
  const PlacementVector left = CorrectionBetween(TruePlacement(), refined->after);
  EXPECT_LT(left.head<3>().norm(), 0.05 * kDegree);
  EXPECT_LT(left.segment<3>(3).norm(), 0.001);
  const Result<Refinement> delay_only =
      RefineWall({}, PlacementVector::Unit(kDelay) * 0.01,
                 {.rotation_rad = 0.0, .translation_m = 0.0, .principal_point_px = 0.0});
  ASSERT_TRUE(delay_only.has_value()) << delay_only.error().message();
  EXPECT_NEAR(delay_only->correction[kDelay], -0.01, 0.0003);
  EXPECT_TRUE(delay_only->correction.head<6>().isZero(1e-12));
}

/// Hot, and seen at changing angles: what the emission angle does must not pass for a texture.
TEST(RigRefinementTest, EmissionAngleIsNoTexture) {
  const Result<Refinement> refined =
      RefineWall({.fold = 0.8, .refractive_index = 1.4}, PlacementVector::Zero());
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  std::printf("shift %.3f px\n", refined->shift.rms_px);
  EXPECT_LT(refined->shift.rms_px, 0.2);
}

/// A texture that is shifted on a flat wall agrees with itself as well as in its place, as long as
/// the rig never turns.
TEST(RigRefinementTest, SweepAlongAFlatWallKeepsWhatItCannotTell) {
  const PlacementVector off_by = SomewhatOff(2);
  const Result<Refinement> refined = RefineWall({.fold = 0.0, .turns = false}, off_by);
  ASSERT_TRUE(refined.has_value()) << refined.error().message();
  EXPECT_LT(refined->observed_directions, kPlacementParameters);
  EXPECT_FALSE(refined->Tells(kTranslationX));
  EXPECT_FALSE(refined->Tells(kTranslationY));
  // Along what is not told, nothing has moved.
  const PlacementVector in_priors = refined->correction.cwiseQuotient(refined->prior_sigma);
  const PlacementMatrix covariance = refined->prior_sigma.cwiseInverse().asDiagonal() *
                                     refined->covariance *
                                     refined->prior_sigma.cwiseInverse().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<PlacementMatrix> axes(covariance);
  for (int i = 0; i < kPlacementParameters; ++i) {
    if (axes.eigenvalues()[i] < 0.9) continue;
    EXPECT_NEAR(axes.eigenvectors().col(i).dot(in_priors), 0.0, 0.02) << "direction " << i;
  }
  // The delay is told by the swing.
  EXPECT_TRUE(refined->Tells(kDelay));
  EXPECT_NEAR(refined->correction[kDelay], -off_by[kDelay], 0.001);
}

}  // namespace
}  // namespace isotherm

#include "ground/icp/thermal_alignment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <memory>

#include "common/base/noise.h"
#include "common/base/units.h"
#include "ground/surface/surface_maps.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kSeed = 5;
constexpr double kWall_m = 0.6;
constexpr double kNetd_k = 0.1;
// Some 2000 points with a quarter of the noise and 30 K/m: 0.05 mm; the rest is interpolation.
constexpr double kAccuracy_m = 0.0003;
constexpr double kAccuracy_rad = 0.1 * kRadPerDeg;

using Temperature = std::function<double(double x, double y)>;

double Spots(double x, double y) { return 45.0 + 4.0 * std::sin(11.0 * x) * std::cos(13.0 * y); }
double Stripes(double x, double) { return 45.0 + 4.0 * std::sin(11.0 * x); }

/// In front of a wall at z = 0.6 m, with a lens that distorts and the depth camera beside it.
class ThermalAlignmentTest : public ::testing::Test {
 protected:
  ThermalAlignmentTest() {
    std::cout << "seed " << kSeed << '\n';
    camera_ = {382, 288, 371.4, 372.1, 195.5, 150.5, -0.439, 0.29, 0.0, 0.0, -0.1};
    T_thermal_depth_ = MakeTransform(
        {0.05, 0.05, 0.01}, Eigen::Quaterniond(Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitY())));
    alignment_ = std::make_unique<ThermalAlignment>(camera_, T_thermal_depth_, 5.0, 0.02);
    constexpr int kWidth = 80;
    constexpr int kHeight = 60;
    points_.Resize(kWidth, kHeight);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        points_.vx.At(x, y) = static_cast<float>(0.6 * (x - kWidth / 2) / kWidth);
        points_.vy.At(x, y) = static_cast<float>(0.45 * (y - kHeight / 2) / kHeight);
        points_.vz.At(x, y) = static_cast<float>(kWall_m);
      }
    }
    // Along the wall and about its normal, which is the line of sight.
    motion_.scale.tail<3>().setConstant(1.0 / kWall_m);
    for (const auto& [column, row] : {std::pair{0, 0}, {1, 1}, {2, 5}, {3, 2}, {4, 3}, {5, 4}})
      motion_.axes.col(column) = Vector6::Unit(row);
    motion_.unobservable_axes = 3;
    motion_.measured = true;
    motion_.mean_depth_m = kWall_m;
  }

  static CaptureTime Time(double seconds) { return CaptureTime(FromSeconds(100.0 + seconds)); }

  std::shared_ptr<ThermalFrame> Frame(double seconds, const RigidTransform& T_map_depth,
                                      const Temperature& celsius) {
    auto frame = std::make_shared<ThermalFrame>();
    frame->header.capture_time = Time(seconds);
    frame->temperature_raw.Resize(camera_.width, camera_.height);
    const RigidTransform T_map_thermal = T_map_depth * T_thermal_depth_.inverse();
    const std::uint64_t stream = NoiseStream(kSeed, 0, ++frames_);
    for (int v = 0; v < camera_.height; ++v) {
      for (int u = 0; u < camera_.width; ++u) {
        const Eigen::Vector2d xy = Unproject(camera_, {u, v});
        const Eigen::Vector3d ray = T_map_thermal.linear() * Eigen::Vector3d(xy.x(), xy.y(), 1.0);
        const Eigen::Vector3d p = T_map_thermal.translation() +
                                  (kWall_m - T_map_thermal.translation().z()) / ray.z() * ray;
        const double noise =
            kNetd_k * NormalNoise(stream, static_cast<std::uint64_t>(v * camera_.width + u));
        frame->temperature_raw.At(u, v) = static_cast<std::uint16_t>(
            std::lround(100.0 * (celsius(p.x(), p.y()) + noise + 273.15)));
      }
    }
    frame->valid = true;
    return frame;
  }

  /// A first image at rest, then one at `truth`; the pose that is found from where it was.
  std::optional<ThermalFit> Align(const Temperature& before, const Temperature& after,
                                  const RigidTransform& truth, RigidTransform& pose) {
    pose = RigidTransform::Identity();
    alignment_->Add(Frame(0.0, pose, before));
    alignment_->End(std::nullopt, {Time(0.0), pose}, kReferenceSigma_m);
    alignment_->Add(Frame(0.033, truth, after));
    alignment_->Begin(StampedMapPose{Time(0.0), pose}, Time(0.033), pose);
    return alignment_->Align(motion_, points_, pose);
  }

  static RigidTransform Shifted(double x_m, double y_m, double rotation_deg) {
    return MakeTransform(
        {x_m, y_m, 0.0},
        Eigen::Quaterniond(Eigen::AngleAxisd(rotation_deg * kRadPerDeg, Eigen::Vector3d::UnitZ())));
  }
  static void ExpectNear(const RigidTransform& pose, const RigidTransform& truth) {
    EXPECT_LT(TranslationDistance(pose, truth), kAccuracy_m);
    EXPECT_LT(RotationAngle(pose, truth), kAccuracy_rad);
  }

  static constexpr double kReferenceSigma_m = 0.001;
  CameraModel camera_;
  RigidTransform T_thermal_depth_;
  std::unique_ptr<ThermalAlignment> alignment_;
  SurfaceMaps points_;
  Observability motion_;
  std::uint64_t frames_ = 0;
};

TEST_F(ThermalAlignmentTest, ShiftAndTurnAlongAWallAreMeasured) {
  const RigidTransform truth = Shifted(0.012, -0.008, 1.2);
  RigidTransform pose;
  const auto fit = Align(Spots, Spots, truth, pose);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->observed, 3);
  ExpectNear(pose, truth);
  EXPECT_EQ(pose.translation().z(), 0.0) << "what the geometry observes is not touched";
  for (int i = 0; i < 3; ++i) {
    EXPECT_GE(std::sqrt(fit->variance_m2(i)), kReferenceSigma_m) << "no better than the reference";
    EXPECT_LT(std::sqrt(fit->variance_m2(i)), 1.2 * kReferenceSigma_m);
  }
}

TEST_F(ThermalAlignmentTest, AnotherLevelOfAllTemperaturesIsNoMotion) {
  const RigidTransform truth = Shifted(-0.006, 0.005, 0.0);
  RigidTransform pose;
  const auto fit = Align(
      Spots, [](double x, double y) { return Spots(x, y) + 0.7; }, truth, pose);
  ASSERT_TRUE(fit);
  ExpectNear(pose, truth);
}

TEST_F(ThermalAlignmentTest, AnEquallyWarmWallTellsNothing) {
  const auto uniform = [](double, double) { return 45.0; };
  for (int i = 0; i < 5; ++i) {
    RigidTransform pose;
    EXPECT_FALSE(Align(uniform, uniform, Shifted(0.006, 0.0, 0.0), pose));
    EXPECT_TRUE(pose.isApprox(RigidTransform::Identity()));
    alignment_->Forget();
  }
}

TEST_F(ThermalAlignmentTest, StripesLeaveTheMotionAlongThemUnobservable) {
  RigidTransform pose;
  const auto fit = Align(Stripes, Stripes, Shifted(0.006, -0.008, 0.0), pose);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->observed, 2);
  EXPECT_NEAR(std::abs(fit->rotation(1, 0)), 1.0, 0.05) << "free along y";
  EXPECT_NEAR(pose.translation().x(), 0.006, kAccuracy_m);
  EXPECT_NEAR(pose.translation().y(), 0.0, 0.0005) << "as before, not as it is";
}

TEST_F(ThermalAlignmentTest, AHandInTheImageDoesNotPull) {
  const RigidTransform truth = Shifted(0.006, -0.004, 0.0);
  const auto with_hand = [](double x, double y) {
    return x > 0.12 && y > -0.05 ? 33.0 : Spots(x, y);
  };
  RigidTransform pose;
  ASSERT_TRUE(Align(Spots, with_hand, truth, pose));
  EXPECT_LT(TranslationDistance(pose, truth), 3.0 * kAccuracy_m);
}

TEST_F(ThermalAlignmentTest, AnotherImageAltogetherIsNotBelieved) {
  RigidTransform pose;
  EXPECT_FALSE(Align(
      Spots, [](double x, double y) { return Spots(9.0 * x + 3.0, 7.0 * y + 2.0); },
      Shifted(0.0, 0.0, 0.0), pose));
  EXPECT_TRUE(pose.isApprox(RigidTransform::Identity()));
}

TEST_F(ThermalAlignmentTest, PixelsWithoutAValueAreLeftOut) {
  const RigidTransform truth = Shifted(0.006, -0.004, 0.0);
  RigidTransform pose = RigidTransform::Identity();
  alignment_->Add(Frame(0.0, pose, Spots));
  alignment_->End(std::nullopt, {Time(0.0), pose}, kReferenceSigma_m);
  const auto frame = Frame(0.033, truth, Spots);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 100; ++x) frame->temperature_raw.At(x, y) = 0;
  }
  alignment_->Add(frame);
  alignment_->Begin(StampedMapPose{Time(0.0), pose}, Time(0.033), pose);
  ASSERT_TRUE(alignment_->Align(motion_, points_, pose));
  ExpectNear(pose, truth);
}

TEST_F(ThermalAlignmentTest, MotionBetweenThermalAndDepthFrameIsAccountedFor) {
  // The thermal frame was taken half way; the guess knows how fast, not from where.
  const RigidTransform last = RigidTransform::Identity();
  const RigidTransform then = Shifted(0.006, 0.0, 0.5);
  const RigidTransform truth = then * then;
  RigidTransform pose = truth * Shifted(0.002, -0.002, 0.0);
  alignment_->Add(Frame(0.0, last, Spots));
  alignment_->End(std::nullopt, {Time(0.0), last}, kReferenceSigma_m);
  alignment_->Add(Frame(0.020, then, Spots));
  alignment_->Begin(StampedMapPose{Time(0.0), last}, Time(0.040), truth);
  ASSERT_TRUE(alignment_->Align(motion_, points_, pose));
  ExpectNear(pose, truth);
}

TEST_F(ThermalAlignmentTest, OnlyAFrameSinceTheLastDepthFrameCounts) {
  RigidTransform pose = RigidTransform::Identity();
  alignment_->Add(Frame(0.0, pose, Spots));
  alignment_->End(std::nullopt, {Time(0.0), pose}, kReferenceSigma_m);
  alignment_->Begin(StampedMapPose{Time(0.0), pose}, Time(0.033), pose);
  EXPECT_FALSE(alignment_->Align(motion_, points_, pose)) << "the frame of the reference itself";
  alignment_->Add(Frame(0.05, pose, Spots));
  alignment_->Begin(StampedMapPose{Time(0.0), pose}, Time(0.033), pose);
  EXPECT_FALSE(alignment_->Align(motion_, points_, pose)) << "a frame after the depth frame";
  alignment_->Begin(std::nullopt, Time(0.066), pose);
  EXPECT_FALSE(alignment_->Align(motion_, points_, pose)) << "no depth frame before";
  alignment_->Begin(StampedMapPose{Time(0.033), pose}, Time(0.066), pose);
  EXPECT_TRUE(alignment_->Align(motion_, points_, pose));
}

TEST_F(ThermalAlignmentTest, NothingIsComparedWithWhatWasBeforeALoss) {
  RigidTransform pose;
  ASSERT_TRUE(Align(Spots, Spots, Shifted(0.002, 0.0, 0.0), pose));
  alignment_->Forget();
  alignment_->Add(Frame(0.066, pose, Spots));
  alignment_->Begin(StampedMapPose{Time(0.033), pose}, Time(0.066), pose);
  EXPECT_FALSE(alignment_->Align(motion_, points_, pose));
}

}  // namespace
}  // namespace isotherm

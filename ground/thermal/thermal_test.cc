#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/rectified_camera.h"
#include "ground/thermal/testing/ball_and_wall.h"

namespace isotherm {
namespace {

using enum ConditionClass;
using testing::ThermalCameraModel;
using ThermalFuserTest = testing::BallAndWallTest;

TEST(ThermalVoxelTest, KeepsTemperatureToHalfAStepAndBothClasses) {
  for (int i = 0; i < 219; ++i) {
    const float celsius = -100.0F + 7.3F * static_cast<float>(i);
    const ThermalVoxel voxel = ThermalVoxel::Make(celsius, kAcceptable, kGood);
    ASSERT_TRUE(voxel.measured());
    ASSERT_NEAR(voxel.celsius(), celsius, 0.5F * ThermalVoxel::kStep_k + 1e-4F);
    ASSERT_EQ(voxel.distance_class(), kAcceptable);
    ASSERT_EQ(voxel.angle_class(), kGood);
  }
  EXPECT_TRUE(std::isnan(ThermalVoxel().celsius()));
  EXPECT_EQ(ThermalVoxel::Make(20.0F, kGood, kBad).bits & 0xFFFFU, 0x10U);
  EXPECT_EQ(ThermalVoxel::Make(20.0F, kAcceptable, kGood).bits & 0xFFFFU, 0x21U);
}

TEST(ThermalVoxelTest, MotionAndDisagreementHaveFourBitsEachOfWhichZeroIsUnchecked) {
  const ThermalVoxel old{0x8000'0021U};
  EXPECT_EQ(old.motion_class(), kUnchecked);
  EXPECT_EQ(old.disagreement_class(), kUnchecked);
  EXPECT_EQ(ThermalVoxel::Make(20.0F, kAcceptable, kGood, kGood, kBad).bits & 0xFFFFU, 0x3121U);
  for (const auto motion : {kBad, kGood, kAcceptable, kUnchecked}) {
    for (const auto disagreement : {kBad, kGood, kAcceptable, kUnchecked}) {
      ThermalVoxel voxel = ThermalVoxel::Make(20.0F, kAcceptable, kGood, motion, disagreement);
      EXPECT_EQ(voxel.motion_class(), motion);
      EXPECT_EQ(voxel.disagreement_class(), disagreement);
      voxel.set_disagreement_class(kAcceptable);
      EXPECT_EQ(voxel.bits,
                ThermalVoxel::Make(20.0F, kAcceptable, kGood, motion, kAcceptable).bits);
    }
  }
}

/// From the camera's counts to the word of a voxel, closed form: half a count and half a step.
TEST(ThermalVoxelTest, HoldsTemperaturesOfTheWholeRangeWithin50Millikelvin) {
  constexpr double kLimit_k = 0.05;
  for (const double max_celsius : {382.0, 900.0, 1500.0}) {
    const RadiometricScale scale = ScaleForRange(-40.0, max_celsius).value();
    double largest_k = 0.0;
    constexpr double kStep_k = 0.0071;
    const int steps = static_cast<int>((max_celsius + 40.0) / kStep_k);
    for (int i = 0; i <= steps; ++i) {
      const double celsius = -40.0 + kStep_k * i;
      const float measured = scale.Celsius(scale.CountOf(celsius));
      const ThermalVoxel voxel = ThermalVoxel::Make(measured, kGood, kGood);
      largest_k = std::max(largest_k, std::abs(static_cast<double>(voxel.celsius()) - celsius));
    }
    EXPECT_LE(largest_k, kLimit_k) << max_celsius;
    EXPECT_LE(largest_k, 0.5 * scale.kelvin_per_count + 0.5 * 0.025 + 1e-3) << max_celsius;
    EXPECT_GT(largest_k, 0.01) << "steps are seen";
  }
}

TEST(ConditionLimitsTest, ClassesChangeAtTheLimitsOfEquation63) {
  ThermalOptions options;  // Of paint: 38.5 and 50.7 degrees.
  options.mutable_angle()->set_min_deg(15);
  const ConditionLimits limits(options, ThermalSensorModel());
  EXPECT_EQ(limits.ClassifyDistance(0.299F), kBad);
  EXPECT_EQ(limits.ClassifyDistance(0.301F), kGood);
  EXPECT_EQ(limits.ClassifyDistance(0.599F), kGood);
  EXPECT_EQ(limits.ClassifyDistance(0.601F), kAcceptable);
  EXPECT_EQ(limits.ClassifyDistance(0.899F), kAcceptable);
  EXPECT_EQ(limits.ClassifyDistance(0.901F), kBad);
  EXPECT_EQ(limits.ClassifyDistance(std::nanf("")), kBad);
  const auto angle = [&](double degrees) {
    return limits.ClassifyAngle(static_cast<float>(std::cos(degrees * M_PI / 180.0)));
  };
  EXPECT_EQ(angle(14.0), kBad);
  EXPECT_EQ(angle(16.0), kGood);
  EXPECT_EQ(angle(38.0), kGood);
  EXPECT_EQ(angle(39.0), kAcceptable);
  EXPECT_EQ(angle(50.0), kAcceptable);
  EXPECT_EQ(angle(51.0), kBad);
}

TEST(ReplacesMeasurementTest, FollowsAlgorithm6ForAllClassPairs) {
  // Algorithm 6 in its own words, with smaller numbers for better conditions.
  const auto algorithm6 = [](ConditionClass d, ConditionClass a, ConditionClass old_d,
                             ConditionClass old_a) {
    const bool old_valid = old_d != kBad && old_a != kBad;
    const bool valid = d != kBad && a != kBad;
    bool better = valid;
    if (valid && d != old_d) {
      better = d < old_d;
    } else if (valid && a != old_a) {
      better = a < old_a;
    }
    return !old_valid || better;
  };
  for (const auto d : {kBad, kGood, kAcceptable}) {
    for (const auto a : {kBad, kGood, kAcceptable}) {
      EXPECT_TRUE(ReplacesMeasurement(d, a, kGood, ThermalVoxel()))
          << "nothing was measured before";
      for (const auto old_d : {kBad, kGood, kAcceptable}) {
        for (const auto old_a : {kBad, kGood, kAcceptable}) {
          EXPECT_EQ(
              ReplacesMeasurement(d, a, kGood, ThermalVoxel::Make(20.0F, old_d, old_a, kGood)),
              algorithm6(d, a, old_d, old_a))
              << static_cast<int>(d) << static_cast<int>(a) << static_cast<int>(old_d)
              << static_cast<int>(old_a);
        }
      }
    }
  }
}

TEST(ReplacesMeasurementTest, TheUncertaintyDecidesBetweenEqualClassesOnly) {
  const ThermalVoxel old = ThermalVoxel::Make(20.0F, kGood, kAcceptable, kGood);
  const auto replaces = [&](ConditionClass angle, std::uint8_t now, std::uint8_t before) {
    return ReplacesMeasurement(kGood, angle, kGood, old, {.now = now, .before = before});
  };
  EXPECT_TRUE(replaces(kAcceptable, 9, 10));
  EXPECT_TRUE(replaces(kAcceptable, 10, 10)) << "the newer of equal ones";
  EXPECT_FALSE(replaces(kAcceptable, 11, 10));
  EXPECT_TRUE(replaces(kAcceptable, 11, 0)) << "not known";
  EXPECT_TRUE(replaces(kGood, 11, 10)) << "a better class";
  EXPECT_FALSE(replaces(kBad, 9, 10)) << "a worse one";
}

TEST(ReplacesMeasurementTest, WhereTemperaturesDoNotAgreeTheNewerStays) {
  const std::uint8_t now = SigmaCode::Of(0.4F), before = SigmaCode::Of(0.3F);
  const double allowed_k = 3.0 * std::hypot(SigmaCode::Kelvin(now), SigmaCode::Kelvin(before));
  const auto replaces = [&](double difference_k) {
    return ReplacesMeasurement(kGood, kGood, kGood, ThermalVoxel::Make(20.0F, kGood, kGood, kGood),
                               {.now = now, .before = before, .difference_k = difference_k});
  };
  EXPECT_FALSE(replaces(0.99 * allowed_k));
  EXPECT_FALSE(replaces(-0.99 * allowed_k));
  EXPECT_TRUE(replaces(1.01 * allowed_k));
  EXPECT_TRUE(replaces(-1.01 * allowed_k));
}

TEST(ReplacesMeasurementTest, MotionDecidesBetweenEqualClassesOfDistanceAndAngle) {
  const auto replaces = [](ConditionClass motion, ConditionClass old_motion) {
    return ReplacesMeasurement(kGood, kAcceptable, motion,
                               ThermalVoxel::Make(20.0F, kGood, kAcceptable, old_motion));
  };
  EXPECT_TRUE(replaces(kGood, kAcceptable));
  EXPECT_FALSE(replaces(kAcceptable, kGood));
  EXPECT_TRUE(replaces(kAcceptable, kAcceptable));
  EXPECT_TRUE(replaces(kAcceptable, kUnchecked)) << "what is known is better";
  EXPECT_FALSE(replaces(kUnchecked, kAcceptable));
  EXPECT_TRUE(ReplacesMeasurement(kGood, kGood, kAcceptable,
                                  ThermalVoxel::Make(20.0F, kGood, kAcceptable, kGood)))
      << "a better angle comes first";
  EXPECT_FALSE(ReplacesMeasurement(kGood, kGood, kBad, ThermalVoxel()))
      << "a smeared measurement is none";
}

TEST(ThermalRectifierTest, PutsEachPixelWhereAnIdealCameraSeesIt) {
  CameraModel camera = ThermalCameraModel();
  camera.k1 = -0.4;
  camera.k2 = 0.2;
  camera.p1 = 0.001;
  // A temperature that is linear in the distorted pixel survives bilinear interpolation exactly.
  const auto raw = [](double u, double v) { return 29'000.0 + 10.0 * u + 7.0 * v; };
  Image<std::uint16_t> image(camera.width, camera.height);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) image.At(u, v) = static_cast<std::uint16_t>(raw(u, v));
  }
  ThreadPool pool(1);
  Image<float> celsius;
  constexpr int kApron = 2;
  ThermalRectifier(camera, {}).Rectify(image, kCentikelvin, kApron, pool, celsius);
  EXPECT_TRUE(std::isnan(celsius.At(1, 71)));
  const CameraModel ideal_camera = RectifiedCamera(camera);
  for (const Eigen::Vector2i& ideal :
       {Eigen::Vector2i(95, 71), Eigen::Vector2i(50, 40), Eigen::Vector2i(150, 110)}) {
    const Eigen::Vector2d source =
        ProjectNormalized(camera, Unproject(ideal_camera, ideal.cast<double>()));
    EXPECT_NEAR(celsius.At(ideal.x() + kApron, ideal.y() + kApron),
                kCentikelvin.Celsius(raw(source.x(), source.y())), 0.001);
  }
  const auto middle_x = static_cast<int>(ideal_camera.cx),
             middle_y = static_cast<int>(ideal_camera.cy);
  image.At(static_cast<int>(camera.cx), static_cast<int>(camera.cy)) = 0;
  ThermalRectifier(camera, {}).Rectify(image, kCentikelvin, kApron, pool, celsius);
  EXPECT_TRUE(std::isnan(celsius.At(middle_x + kApron, middle_y + kApron)))
      << "a pixel without value stays without value";
}

TEST_F(ThermalFuserTest, ParallaxFilterKeepsTheBallsTemperatureOffTheWall) {
  const Outcome outcome = Fuse(ThermalOptions());
  EXPECT_GT(outcome.assigned, 10'000);
  EXPECT_LE(outcome.hot_on_wall, outcome.assigned / 1000) << "mixed pixels on the very silhouette";
}

TEST_F(ThermalFuserTest, Figures73And74AForegroundThatLeftTheDepthCamerasViewStillHides) {
  // Turned away, the depth camera sees the wall beside the ball only.
  constexpr double kRotation_rad = 0.42;
  T_map_depth_ = MakeTransform({0.32, 0.32, 0.0}, Eigen::Quaterniond(Eigen::AngleAxisd(
                                                      -kRotation_rad, Eigen::Vector3d::UnitY())));
  // From the right, the thermal camera sees the ball before that part of the wall.
  T_map_thermal_ = MakeTransform(
      {0.52, 0.32, 0.0}, Eigen::Quaterniond(Eigen::AngleAxisd(-0.45, Eigen::Vector3d::UnitY())));
  const Outcome outcome = Fuse(ThermalOptions());
  EXPECT_GT(outcome.assigned, 3'000);
  EXPECT_LE(outcome.hot_on_wall, outcome.assigned / 1000);
}

TEST_F(ThermalFuserTest, WithoutTheMarginTheSilhouetteIsAssigned) {
  ThermalOptions options;
  const int with_margin = Fuse(options).assigned;
  options.mutable_expert()->mutable_occlusion()->set_edge_margin_px(0);
  EXPECT_GT(Fuse(options).assigned, with_margin);
}

TEST_F(ThermalFuserTest, ClassesFollowTheThermalCamerasDistanceAndAngle) {
  ThermalOptions options;
  Fuse(options);
  const ConditionLimits limits(options, ThermalSensorModel());
  int checked = 0;
  for (std::int32_t block = 0; block < tsdf_->block_count(); ++block) {
    testing::ForEachVoxel(thermal_->voxels(block), tsdf_->grid(), tsdf_->block_coordinates(block),
                          [&](const ThermalVoxel& voxel, const Eigen::Vector3d& p) {
                            if (!voxel.measured() || p.z() < 0.58) return;
                            const Eigen::Vector3d on_wall(p.x(), p.y(), 0.60);
                            const Eigen::Vector3d ray = on_wall - T_map_thermal_.translation();
                            const auto distance = static_cast<float>(ray.norm());
                            const auto cosine = static_cast<float>(ray.z() / ray.norm());
                            constexpr float kNearLimit =
                                0.01F;  // A voxel beside the vertex it belongs to.
                            if (std::abs(distance - limits.distance_good_m) < kNearLimit) return;
                            ++checked;
                            EXPECT_EQ(voxel.distance_class(), limits.ClassifyDistance(distance));
                            EXPECT_EQ(voxel.angle_class(), limits.ClassifyAngle(cosine));
                          });
  }
  EXPECT_GT(checked, 5'000);
}

TEST_F(ThermalFuserTest, F12PixelsWithoutValueAreNotAssigned) {
  ThermalFrame frame = TakeFrame(T_map_thermal_);
  frame.temperature_raw.Fill(0);
  const FusionReport report =
      ThermalFuser(ThermalOptions(), thermal_camera_, sensor_, 0.0F)
          .Fuse({frame, T_map_thermal_, depth_camera_, T_map_depth_}, {}, *tsdf_, pool_, *thermal_);
  EXPECT_EQ(report.assigned, 0);
  EXPECT_GT(report.considered, 0);
}

TEST_F(ThermalFuserTest, APoseThatIsNoneIsTheCallersFault) {
  const ThermalFrame frame = TakeFrame(T_map_thermal_);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
    for (const bool of_thermal : {false, true}) {
      RigidTransform T_map_thermal = T_map_thermal_;
      RigidTransform T_map_depth = T_map_depth_;
      (of_thermal ? T_map_thermal : T_map_depth).matrix()(2, 2) = bad;
      ThermalFuser fuser(ThermalOptions(), thermal_camera_, sensor_, 0.0F);
      EXPECT_DEATH(fuser.Fuse({frame, T_map_thermal, depth_camera_, T_map_depth}, {}, *tsdf_, pool_,
                              *thermal_),
                   "IsRigid");
    }
  }
}

TEST_F(ThermalFuserTest, AHousingThatDriftsAndReadingsThatAreWrongAreCorrected) {
  sensor_.housing_drift = HousingDrift{4.0, 0.1};
  sensor_.radiometric_correction = {{0.0F, 100.0F}, {1.0F, 3.0F}, {0.2F, 0.2F}};
  CaptureConditions capture;
  capture.nuc = {.epoch = 0, .seconds_since = 1.0, .housing_change_k = 0.5};
  ThermalFrame frame = TakeFrame(T_map_thermal_);
  frame.temperature_raw.Fill(32'515);  // 52 °C.
  FuseFrame(ThermalOptions(), frame, capture);
  const PointMeasurement at_wall = MeasurementAt(*tsdf_, *thermal_, {0.44, 0.36, 0.60});
  EXPECT_NEAR(at_wall.voxel.celsius(), 52.0 - 4.0 * 0.5 + 2.0, 0.02);
}

}  // namespace
}  // namespace isotherm

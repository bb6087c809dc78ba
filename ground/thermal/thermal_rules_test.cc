// Rules keep temperatures out of the model, and some things are kept beside those that are in it.
#include <gtest/gtest.h>

#include <cmath>

#include "common/base/units.h"
#include "ground/thermal/measurement_recorder.h"
#include "ground/thermal/testing/ball_and_wall.h"
#include "ground/thermal/thermal_options.h"

namespace isotherm {
namespace {

using enum ConditionClass;

class ThermalRulesTest : public testing::BallAndWallTest {
 protected:
  static std::uint16_t Raw(double celsius) {
    return static_cast<std::uint16_t>(std::lround((celsius + 273.15) * 100.0));
  }
  /// The same temperature everywhere.
  ThermalFrame Even(double celsius) const {
    ThermalFrame frame;
    frame.valid = true;
    frame.temperature_raw =
        Image<std::uint16_t>(thermal_camera_.width, thermal_camera_.height, Raw(celsius));
    return frame;
  }
  static CaptureConditions Sweeping(double speed_m_s) {
    CaptureConditions capture;
    capture.motion.velocity_m_s.x() = speed_m_s;
    return capture;
  }
  static bool OnWall(const Eigen::Vector3d& p) { return p.z() > 0.58; }

  ThermalOptions options_;
};

TEST_F(ThermalRulesTest, ASweepIsGoodAcceptableOrLeftOutByItsSmear) {
  // The wall is about 0.6 m away: 186 px x v / 0.6 m in 10 ms is 3.1 px at 1 m/s.
  const auto motion_on_wall = [&](double speed_m_s) {
    FuseFrame(options_, Even(20.0), Sweeping(speed_m_s));
    ConditionClass seen = kUnchecked;
    ForEachAssessed([&](const ThermalVoxel& voxel, const Eigen::Vector3d& p) {
      if (OnWall(p)) seen = voxel.motion_class();
    });
    return seen;
  };
  const FusionReport fast = FuseFrame(options_, Even(20.0), Sweeping(1.0));
  EXPECT_EQ(fast.assigned, 0);
  EXPECT_GT(fast.smeared, 5'000);
  EXPECT_EQ(motion_on_wall(0.4), kAcceptable);
  EXPECT_EQ(motion_on_wall(0.1), kGood);
  EXPECT_EQ(motion_on_wall(0.4), kGood) << "worse does not replace better";
}

TEST_F(ThermalRulesTest, RowsReadOneAfterTheOtherAreShiftedTheMoreTheFartherFromTheMiddle) {
  sensor_.time_constant_s = 0.0;
  sensor_.row_readout_s = 1e-4;  // 7 ms from the middle row to the last: 2.2 px at 1 m/s.
  FuseFrame(options_, Even(20.0), Sweeping(1.0));
  int near_middle = 0;
  int far = 0;
  ForEachAssessed([&](const ThermalVoxel& voxel, const Eigen::Vector3d& p) {
    if (!OnWall(p)) return;
    const double row =
        std::abs(thermal_camera_.fy * (p.y() - T_map_thermal_.translation().y()) / 0.6);
    if (row < 12.0) near_middle += voxel.motion_class() == kGood ? 1 : 0;
    if (row > 68.0) ++far;
  });
  EXPECT_GT(near_middle, 500);
  EXPECT_EQ(far, 0);
}

TEST_F(ThermalRulesTest, BesideASteepStepOfTemperatureNothingIsAssigned) {
  ThermalFrame frame = Even(20.0);
  constexpr int kStepColumn = 60;
  for (int v = 0; v < thermal_camera_.height; ++v) {
    for (int u = kStepColumn; u < thermal_camera_.width; ++u)
      frame.temperature_raw.At(u, v) = Raw(60.0);
  }
  EXPECT_GT(FuseFrame(options_, frame).steep, 100);
  ForEachAssessed([&](const ThermalVoxel& voxel, const Eigen::Vector3d&) {
    if (!voxel.measured()) return;
    const double off =
        std::min(std::abs(voxel.celsius() - 20.0F), std::abs(voxel.celsius() - 60.0F));
    ASSERT_LT(off, 0.1) << "nothing in between";
  });
  // 2 K per pixel may be off by 1 K: less than is promised.
  ThermalFrame ramp = Even(20.0);
  for (int v = 0; v < thermal_camera_.height; ++v) {
    for (int u = 0; u < thermal_camera_.width; ++u)
      ramp.temperature_raw.At(u, v) = Raw(-90.0 + 2.0 * u);
  }
  EXPECT_EQ(FuseFrame(options_, ramp).steep, 0);
}

TEST_F(ThermalRulesTest, BadConditionsLeaveTheirClassesAndNoTemperature) {
  options_.mutable_distance()->set_good_m(0.35);
  options_.mutable_distance()->set_max_m(0.5);
  EXPECT_GT(FuseFrame(options_, Even(20.0)).considered, 1'000);
  int assessed = 0;
  ForEachAssessed([&](const ThermalVoxel& voxel, const Eigen::Vector3d& p) {
    if (!OnWall(p)) return;
    ++assessed;
    EXPECT_FALSE(voxel.measured());
    EXPECT_EQ(voxel.distance_class(), kBad);
    EXPECT_TRUE(std::isnan(voxel.celsius()));
  });
  EXPECT_GT(assessed, 1'000);
  options_.mutable_expert()->set_keep_bad(true);
  FuseFrame(options_, Even(20.0));
  ForEachAssessed([&](const ThermalVoxel& voxel, const Eigen::Vector3d&) {
    EXPECT_NEAR(voxel.celsius(), 20.0, 0.02);
  });
}

TEST_F(ThermalRulesTest, EachTemperatureKnowsItsDistanceAngleAndNuc) {
  CaptureConditions capture;
  capture.nuc = {7, 12.4};
  FuseFrame(options_, Even(20.0), capture);
  int checked = 0;
  for (int column = 0; column < 13; ++column) {
    for (int row = 0; row < 20; ++row) {
      const Eigen::Vector3d p(0.3 + 0.02 * column, 0.1 + 0.02 * row, 0.60);
      const PointMeasurement at = MeasurementAt(*tsdf_, *thermal_, p);
      if (!at.voxel.measured() || at.conditions.empty()) continue;
      ++checked;
      const Eigen::Vector3d to_camera = T_map_thermal_.translation() - p;
      constexpr double kVoxelSide_m = 0.004;
      EXPECT_NEAR(at.conditions.distance_m(), to_camera.norm(), 2.0 * kVoxelSide_m);
      constexpr double kBlockAngle = 0.06;  // Half a block's diagonal at 0.6 m, and the coding.
      const Eigen::Vector3d direction = DecodeDirection(at.conditions.direction).cast<double>();
      EXPECT_LT((direction - to_camera.normalized()).norm(), kBlockAngle);
      EXPECT_NEAR(at.conditions.cosine_seen(), -to_camera.z() / to_camera.norm(), 0.02);
      EXPECT_EQ(at.conditions.epoch, 7);
      EXPECT_NEAR(at.conditions.age_s(), 12.4, 0.5 * ConditionRecord::kAgeStep_s);
    }
  }
  EXPECT_GT(checked, 100);
}

TEST_F(ThermalRulesTest, OfTemperaturesUnderEqualClassesThatAgreeTheLeastUncertainStays) {
  const auto at_wall = [&] { return MeasurementAt(*tsdf_, *thermal_, {0.44, 0.36, 0.60}); };
  const auto fuse = [&](double celsius, double housing_change_k) {
    CaptureConditions capture;
    capture.nuc = {.epoch = 0, .seconds_since = 1.0, .housing_change_k = housing_change_k};
    FuseFrame(options_, Even(celsius), capture);
  };
  fuse(20.0, 0.5);
  EXPECT_NEAR(at_wall().sigma_k, std::hypot(2.0, 0.04), 0.07) << "4 K for each kelvin";
  fuse(21.0, 0.25);
  EXPECT_NEAR(at_wall().voxel.celsius(), 21.0, 0.02) << "better";
  EXPECT_NEAR(at_wall().sigma_k, 1.0, 0.035);
  fuse(22.0, 0.5);
  EXPECT_NEAR(at_wall().voxel.celsius(), 21.0, 0.02) << "worse, though later";
  fuse(23.0, 0.25);
  EXPECT_NEAR(at_wall().voxel.celsius(), 23.0, 0.02) << "as good and later";
  fuse(31.0, 0.5);
  EXPECT_NEAR(at_wall().voxel.celsius(), 31.0, 0.02) << "8 K off, sigmas of 1 and 2 K";
  fuse(24.0, 0.0);
  EXPECT_NEAR(at_wall().voxel.celsius(), 24.0, 0.02);
  EXPECT_NEAR(at_wall().sigma_k, std::hypot(CameraUncertainty().netd_k, 0.0072), 0.002);
}

TEST_F(ThermalRulesTest, WithTheLowestKeptTheUncertaintyDoesNotDecide) {
  options_.mutable_expert()->set_policy(LOWEST_GOOD);
  options_.mutable_distance()->set_good_m(0.8);
  CaptureConditions uncertain;
  uncertain.nuc = {.epoch = 0, .seconds_since = 1.0, .housing_change_k = 0.5};
  FuseFrame(options_, Even(21.0));
  FuseFrame(options_, Even(20.0), uncertain);
  EXPECT_NEAR(MeasurementAt(*tsdf_, *thermal_, {0.44, 0.36, 0.60}).voxel.celsius(), 20.0, 0.02);
}

TEST_F(ThermalRulesTest, ASlopeIsAsUncertainAsItsPlace) {
  ThermalFrame ramp = Even(20.0);
  for (int v = 0; v < thermal_camera_.height; ++v) {
    for (int u = 0; u < thermal_camera_.width; ++u) ramp.temperature_raw.At(u, v) = Raw(0.5 * u);
  }
  const auto sigma_k = [&](const CaptureConditions& capture) {
    thermal_ = std::make_unique<ThermalVolume>(tsdf_->max_blocks());
    FuseFrame(options_, ramp, capture);
    return static_cast<double>(MeasurementAt(*tsdf_, *thermal_, {0.44, 0.36, 0.60}).sigma_k);
  };
  CaptureConditions capture;
  capture.camera.error_per_housing_k = 0.0;
  // A pixel of 0.6 m / 186 and a voxel of 4 mm.
  const double footprint_px = std::hypot(1.0, 0.004 * 186.0 / 0.6) / std::sqrt(12.0);
  constexpr double kStep = 0.035;  // Of a code.
  const double even_k = std::hypot(capture.camera.netd_k, 0.5 * footprint_px);
  EXPECT_NEAR(sigma_k(capture), even_k, kStep * even_k);
  capture.registration_px = 0.8;
  capture.extrinsic_px = 0.6;
  const double moved_k = std::hypot(even_k, 0.5);
  EXPECT_NEAR(sigma_k(capture), moved_k, kStep * moved_k);
}

TEST_F(ThermalRulesTest, WithoutRecordsTheLatestOfEqualClassesStays) {
  thermal_ = std::make_unique<ThermalVolume>(tsdf_->max_blocks(), std::filesystem::path(), false);
  CaptureConditions uncertain;
  uncertain.nuc = {.epoch = 0, .seconds_since = 1.0, .housing_change_k = 0.5};
  FuseFrame(options_, Even(20.0));
  FuseFrame(options_, Even(21.0), uncertain);
  const auto at_wall = MeasurementAt(*tsdf_, *thermal_, {0.4, 0.36, 0.6});
  EXPECT_NEAR(at_wall.voxel.celsius(), 21.0, 0.02);
  EXPECT_TRUE(at_wall.conditions.empty());
}

TEST_F(ThermalRulesTest, AReflectionThatMovesDisagreesAndTheLowestCanBeKept) {
  // Half of the image shows the same 20 °C always, the other at times 8 K more.
  options_.mutable_distance()->set_good_m(0.8);
  for (const bool lowest : {false, true}) {
    thermal_ = std::make_unique<ThermalVolume>(tsdf_->max_blocks());
    if (lowest) options_.mutable_expert()->set_policy(LOWEST_GOOD);
    for (int i = 0; i < 8; ++i) {
      ThermalFrame frame = Even(20.0);
      for (int v = 0; v < thermal_camera_.height; ++v) {
        for (int u = 0; u < 40; ++u) frame.temperature_raw.At(u, v) = Raw(i % 2 == 0 ? 20.0 : 28.0);
      }
      FuseFrame(options_, frame);
    }
    int in_reflection = 0;
    int elsewhere = 0;
    ForEachAssessed([&](const ThermalVoxel& voxel, const Eigen::Vector3d& p) {
      if (!OnWall(p) || voxel.angle_class() != kGood || !voxel.measured()) return;
      const Eigen::Vector3d p_thermal = T_map_thermal_.inverse() * p;
      const double u = thermal_camera_.fx * p_thermal.x() / p_thermal.z() + thermal_camera_.cx;
      if (std::abs(u - 40.0) < 4.0) return;
      if (u < 40.0) {
        ++in_reflection;
        ASSERT_EQ(voxel.disagreement_class(), kBad);
        ASSERT_NEAR(voxel.celsius(), lowest ? 20.0 : 28.0, 0.05);
      } else {
        ++elsewhere;
        ASSERT_EQ(voxel.disagreement_class(), kGood);
      }
    });
    EXPECT_GT(in_reflection, 300);
    EXPECT_GT(elsewhere, 300);
  }
}

TEST(ClassifyDisagreementTest, NeedsEnoughMeasurementsAndARangeBeyondNoise) {
  ThermalOptions options;  // Noise 0.15 K: a range of 0.9 K says nothing.
  EXPECT_EQ(ClassifyDisagreement(options, 50.0F, 4), kUnchecked);
  EXPECT_EQ(ClassifyDisagreement(options, 1.89F, 5), kGood);
  EXPECT_EQ(ClassifyDisagreement(options, 1.91F, 5), kAcceptable);
  EXPECT_EQ(ClassifyDisagreement(options, 3.91F, 5), kBad);
}

TEST_F(ThermalRulesTest, WhatTurnsOutToBelongToAnotherFaceIsDropped) {
  FuseFrame(options_, Even(20.0));
  const Eigen::Vector3d p(0.44, 0.36, 0.60);
  const auto frontal = MeasurementAt(*tsdf_, *thermal_, p);
  ASSERT_TRUE(frontal.voxel.measured());
  const TemperatureReview review(options_, sensor_);
  const std::int32_t block =
      tsdf_->Find((tsdf_->grid().ToVoxel(p).array().round().cast<int>() / kBlockSide).matrix());
  EXPECT_EQ(review.Review(block, *tsdf_, *thermal_), 0) << "what was assessed right stays";
  // As if the camera had stood far to the side when the surface looked like facing it.
  int records = 0;
  for (int row = 0; row < ThermalRecords::kRowsPerBlock; ++row) {
    RecordRow* found = thermal_->records()->Find(block, row);
    if (found == nullptr) continue;
    for (ConditionRecord& record : found->conditions) {
      if (record.empty()) continue;
      record.direction = EncodeDirection(Eigen::Vector3f(0.94F, 0.0F, -0.34F).normalized());
      ++records;
    }
  }
  EXPECT_GT(records, 20);
  EXPECT_EQ(review.Review(block, *tsdf_, *thermal_), records);
  EXPECT_FALSE(MeasurementAt(*tsdf_, *thermal_, p).voxel.measured())
      << "and no neighbour speaks for it";
  for (int voxel = 0; voxel < kBlockVoxels; ++voxel) {
    const bool measured = thermal_->voxels(block)[static_cast<std::size_t>(voxel)].measured();
    ASSERT_EQ(thermal_->sigma_code(block, voxel) != 0, measured);
  }
  FuseFrame(options_, Even(30.0));
  EXPECT_NEAR(ThermalVoxelAt(*tsdf_, *thermal_, p).celsius(), 30.0, 0.02) << "measured anew";
}

TEST(ValidateThermalTest, RefusesContradictionsByName) {
  const auto message = [](auto change) {
    ThermalOptions options;
    change(options);
    return Validate(options).message();
  };
  EXPECT_EQ(message([](ThermalOptions&) {}), "");
  EXPECT_NE(message([](ThermalOptions& o) {
              o.mutable_expert()->mutable_motion()->set_smear_good_px(3.0);
            }).find("smear_good_px"),
            std::string::npos);
  EXPECT_NE(
      message([](ThermalOptions& o) { o.mutable_angle()->set_max_deg(91.0); }).find("max_deg"),
      std::string::npos);
  EXPECT_NE(message([](ThermalOptions& o) {
              o.mutable_distance()->set_good_m(1.0);
            }).find("thermal.distance"),
            std::string::npos);
  EXPECT_NE(message([](ThermalOptions& o) {
              o.mutable_expert()->mutable_disagreement()->set_max_k(0.5);
            }).find("thermal.expert.disagreement"),
            std::string::npos);
  EXPECT_NE(message([](ThermalOptions& o) {
              o.mutable_expert()->mutable_occlusion()->set_hole_px(0);
            }).find("hole_px"),
            std::string::npos);
}

TEST(ValidateThermalTest, AnUnknownMaterialIsRefusedWithThoseThatAreKnown) {
  ThermalOptions options;
  options.set_material("aluminum");
  const Status status = Validate(options);
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  for (const char* part : {"thermal.material", "'aluminum'", "Did you mean 'aluminium'?", "paint",
                           "steel-oxidised", "firebrick"})
    EXPECT_NE(status.message().find(part), std::string::npos) << part << ": " << status.message();
  options.set_material("");
  EXPECT_NE(Validate(options).message().find("thermal.material"), std::string::npos);
}

TEST(ValidateThermalTest, AnglesThatContradictTheMaterialSayWhichAreTheMaterials) {
  ThermalOptions options;
  options.mutable_angle()->set_max_deg(30.0);  // Less than where paint is good.
  const std::string message = Validate(options).message();
  EXPECT_NE(message.find("38.5 (of paint), 30 degrees"), std::string::npos) << message;
  options.mutable_angle()->set_good_deg(20.0);
  EXPECT_TRUE(Validate(options).ok());
}

TEST(MaterialTest, SetsTheAnglesThatOptionsDoNot) {
  ThermalOptions options;
  EXPECT_EQ(WithAnglesOfMaterial(options).angle().min_deg(), 0.0);
  EXPECT_EQ(WithAnglesOfMaterial(options).angle().good_deg(), 38.5);
  EXPECT_EQ(WithAnglesOfMaterial(options).angle().max_deg(), 50.7);
  options.mutable_angle()->set_max_deg(60.0);
  EXPECT_EQ(WithAnglesOfMaterial(options).angle().good_deg(), 38.5);
  EXPECT_EQ(WithAnglesOfMaterial(options).angle().max_deg(), 60.0);
}

TEST(MaterialTest, OnAShinySurfaceTheOperatorsMirrorImageIsBad) {
  constexpr double kFrontal_rad = 10.0 * kRadPerDeg;
  const auto cosine = static_cast<float>(std::cos(kFrontal_rad));
  ThermalOptions options;
  EXPECT_EQ(ConditionLimits(options, ThermalSensorModel()).ClassifyAngle(cosine), kGood);
  for (const char* shiny : {"aluminium", "stainless", "glass", "steel-oxidised"}) {
    options.set_material(shiny);
    EXPECT_EQ(ConditionLimits(options, ThermalSensorModel()).ClassifyAngle(cosine), kBad) << shiny;
  }
}

ThermalSensorModel SharpAtHalfAMetre() {
  ThermalSensorModel sensor;
  sensor.pixel_pitch_m = 25e-6;
  sensor.lens = LensModel{.focal_length_m = 0.01, .f_number = 1.0, .focus_m = 0.5};
  return sensor;
}

TEST(DepthOfFieldTest, NarrowsTheDistancesAsEquation220Says) {
  // c N (D - f) = 12.25e-6 m2 against f2 = 100e-6 m2.
  const ConditionLimits limits(ThermalOptions(), SharpAtHalfAMetre());
  EXPECT_NEAR(limits.distance_min_m, 0.5 * 100.0 / 112.25, 1e-6);
  EXPECT_NEAR(limits.distance_max_m, 0.5 * 100.0 / 87.75, 1e-6);
  EXPECT_LE(limits.distance_good_m, limits.distance_max_m);
}

TEST(DepthOfFieldTest, WithoutALensAllDistancesHold) {
  const ConditionLimits limits{ThermalOptions(), ThermalSensorModel()};
  EXPECT_FLOAT_EQ(limits.distance_max_m, 0.9F);
}

TEST(DepthOfFieldTest, ALensThatIsSharpNowhereInRangeIsRefused) {
  ThermalOptions options;
  EXPECT_TRUE(CheckSharpness(options, ThermalSensorModel()).ok());
  EXPECT_TRUE(CheckSharpness(options, SharpAtHalfAMetre()).ok());
  options.mutable_distance()->set_max_m(0.44);
  EXPECT_NE(
      CheckSharpness(options, SharpAtHalfAMetre()).message().find("nothing could be measured"),
      std::string::npos);
}

TEST_F(ThermalRulesTest, APixelThatCoversTooMuchIsTooFar) {
  options_.mutable_expert()->set_max_footprint_m(0.003);  // 0.6 m / 186 px is 3.2 mm.
  FuseFrame(options_, Even(20.0));
  ForEachAssessed([&](const ThermalVoxel& voxel, const Eigen::Vector3d& p) {
    if (!OnWall(p)) return;
    ASSERT_EQ(voxel.distance_class(), kBad);
  });
}

}  // namespace
}  // namespace isotherm

#include "ground/thermal/measurement_recorder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/base/units.h"

namespace isotherm {
namespace {

constexpr auto kGood = ConditionClass::kGood;
constexpr auto kAcceptable = ConditionClass::kAcceptable;
constexpr std::int32_t kBlock = 3;
constexpr double kVoxel_m = 0.002;
constexpr double kHalfStep_m = 0.5 * double{ConditionRecord::kDistanceStep_m} + 1e-6;

/// A block whose voxels' axes stand across the camera's: x of the grid is the camera's y.
class MeasurementRecorderTest : public ::testing::Test {
 protected:
  MeasurementRecorderTest() { EXPECT_TRUE(volume_.Commit(kBlock + 1)); }

  /// Adds a measurement to what the next frame records.
  void Measure(int voxel, float celsius, bool assigned, ConditionClass distance = kGood,
               std::uint8_t cosine = 200, std::uint8_t sigma = 40) {
    const int i = measured_.count++;
    measured_.voxels[i] = voxel | (assigned ? BlockMeasurements::kAssigned : 0);
    measured_.words[i] =
        static_cast<std::int32_t>(ThermalVoxel::Make(celsius, distance, kGood, kGood).bits);
    measured_.flags[i] =
        static_cast<std::int32_t>(std::uint32_t{cosine} << ThermalPixel::kCosineShift |
                                  std::uint32_t{sigma} << ThermalPixel::kSigmaShift);
  }
  void Record(const NucAge& nuc = {}) {
    MeasurementRecorder(options_, T_map_thermal_, kAxes, nuc)
        .Record(measured_, first_, kBlock, volume_);
    measured_.count = 0;
  }
  const ConditionRecord& Conditions(int voxel) {
    return volume_.records()
        ->Find(kBlock, voxel / RecordRow::kVoxels)
        ->conditions[voxel % RecordRow::kVoxels];
  }
  ConditionClass Disagreement(int voxel) {
    return volume_.voxels(kBlock)[static_cast<std::size_t>(voxel)].disagreement_class();
  }
  /// Where a place of the grid is, thermal camera coordinates.
  Eigen::Vector3d At(double x, double y, double z) const {
    return first_.cast<double>() + kVoxel_m * Eigen::Vector3d(-y, x, z);
  }

  static constexpr float kStep = static_cast<float>(kVoxel_m);
  static constexpr float kAxes[9] = {0, -kStep, 0, kStep, 0, 0, 0, 0, kStep};
  const Eigen::Vector3f first_{0.10F, -0.20F, 0.50F};
  const RigidTransform T_map_thermal_ = MakeTransform(
      {1.0, 2.0, 3.0},
      Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitY())));
  ThermalOptions options_;
  ThermalVolume volume_{16};
  BlockMeasurements measured_{};
};

TEST_F(MeasurementRecorderTest, AnAssignedTemperatureKeepsItsConditions) {
  const int voxel = BlockLayout::Element(5, 2, 7);
  Measure(voxel, 50.0F, /*assigned=*/true, kGood, /*cosine=*/204, /*sigma=*/77);
  Record({.epoch = 9, .seconds_since = 10.1});
  const ConditionRecord& record = Conditions(voxel);
  EXPECT_NEAR(record.distance_m(), At(5, 2, 7).norm(), kHalfStep_m);
  EXPECT_NEAR(record.cosine_seen(), 0.8, 1e-6);
  EXPECT_EQ(record.epoch, 9);
  EXPECT_FLOAT_EQ(record.age_s(), 10.0F) << "the nearest quarter of a second";
  EXPECT_EQ(volume_.sigma_code(kBlock, voxel), 77);
  // From the middle of the block to the camera; a turn by 90 degrees about y makes z of x.
  const Eigen::Vector3d to_camera = -At(3.5, 3.5, 3.5).normalized();
  const Eigen::Vector3d in_map(to_camera.z(), to_camera.y(), -to_camera.x());
  const Eigen::Vector3d kept = DecodeDirection(record.direction).cast<double>();
  EXPECT_LT(std::acos(std::min(1.0, kept.dot(in_map))), kRadPerDeg);
}

TEST_F(MeasurementRecorderTest, VoxelsOfOneRowAreToldApart) {
  Measure(BlockLayout::Element(0, 4, 4), 50.0F, true);
  Measure(BlockLayout::Element(7, 4, 4), 50.0F, true);
  Record();
  EXPECT_NEAR(Conditions(BlockLayout::Element(0, 4, 4)).distance_m(), At(0, 4, 4).norm(),
              kHalfStep_m);
  EXPECT_NEAR(Conditions(BlockLayout::Element(7, 4, 4)).distance_m(), At(7, 4, 4).norm(),
              kHalfStep_m);
  EXPECT_TRUE(Conditions(BlockLayout::Element(3, 4, 4)).empty());
  EXPECT_EQ(volume_.records()->Find(kBlock, 0), nullptr) << "rows exist only where they are needed";
}

TEST_F(MeasurementRecorderTest, WithoutAnAssignmentTheConditionsStay) {
  const int voxel = BlockLayout::Element(1, 1, 1);
  Measure(voxel, 50.0F, true);
  Record({.epoch = 1, .seconds_since = 4.0});
  Measure(voxel, 51.0F, /*assigned=*/false, kGood, /*cosine=*/10, /*sigma=*/11);
  Record({.epoch = 2, .seconds_since = 8.0});
  EXPECT_EQ(Conditions(voxel).epoch, 1);
  EXPECT_FLOAT_EQ(Conditions(voxel).age_s(), 4.0F);
  EXPECT_EQ(Conditions(voxel).cosine, 200);
  EXPECT_EQ(volume_.sigma_code(kBlock, voxel), 40);
  EXPECT_EQ(Conditions(voxel).good_count, 2U) << "but it counts as a measurement";
}

TEST_F(MeasurementRecorderTest, AnAgeThatIsNotKnownOrTooLongIsNotANumber) {
  const int voxel = BlockLayout::Element(0, 0, 0);
  constexpr double kMaxAge_s = 0.25 * (ConditionRecord::kNoAge - 1);
  for (const std::optional<double> age_s :
       {std::optional<double>(), std::optional(-1.0), std::optional<double>(NAN),
        std::optional(kMaxAge_s + 1.0), std::optional(1e9)}) {
    Measure(voxel, 50.0F, true);
    Record({.seconds_since = age_s});
    EXPECT_TRUE(std::isnan(Conditions(voxel).age_s())) << age_s.value_or(-99.0);
  }
  Measure(voxel, 50.0F, true);
  Record({.seconds_since = kMaxAge_s});
  EXPECT_FLOAT_EQ(Conditions(voxel).age_s(), static_cast<float>(kMaxAge_s));
}

TEST_F(MeasurementRecorderTest, MeasurementsThatAgreeWithinNoiseAreGoodOnceThereAreEnough) {
  const int voxel = BlockLayout::Element(2, 3, 4);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(Disagreement(voxel), ConditionClass::kUnchecked) << i << " are too few";
    Measure(voxel, i % 2 == 0 ? 50.0F : 50.1F, i == 0);
    Record();
  }
  EXPECT_EQ(Disagreement(voxel), kGood);
}

TEST_F(MeasurementRecorderTest, TheRangeBeyondNoiseDecidesTheDisagreement) {
  options_.mutable_expert()->mutable_disagreement()->set_noise_k(0.1);  // 0.6 K are noise.
  options_.mutable_expert()->mutable_disagreement()->set_good_k(1.0);
  options_.mutable_expert()->mutable_disagreement()->set_max_k(3.0);
  const int voxel = BlockLayout::Element(2, 3, 4);
  const auto add = [&](float celsius) {
    Measure(voxel, celsius, false);
    Record();
    return Disagreement(voxel);
  };
  for (int i = 0; i < 5; ++i) static_cast<void>(add(50.0F));
  EXPECT_EQ(add(51.5F), kGood);
  EXPECT_EQ(add(51.7F), kAcceptable);
  EXPECT_EQ(add(53.5F), kAcceptable);
  EXPECT_EQ(add(53.7F), ConditionClass::kBad);
  EXPECT_EQ(add(50.0F), ConditionClass::kBad) << "it is the range of all";
}

TEST_F(MeasurementRecorderTest, OnlyMeasurementsUnderGoodConditionsCanDisagree) {
  const int voxel = BlockLayout::Element(6, 6, 6);
  for (int i = 0; i < 10; ++i) {
    Measure(voxel, i % 2 == 0 ? 20.0F : 90.0F, true, kAcceptable);
    Record();
  }
  EXPECT_EQ(Conditions(voxel).good_count, 0U);
  EXPECT_EQ(Disagreement(voxel), ConditionClass::kUnchecked);
}

TEST_F(MeasurementRecorderTest, AnotherAssignmentForgetsNoMeasurement) {
  const int voxel = BlockLayout::Element(7, 0, 7);
  for (int i = 0; i < 100; ++i) {
    Measure(voxel, i == 0 ? 20.0F : 50.0F, true);
    Record();
  }
  EXPECT_EQ(Conditions(voxel).good_count, ConditionRecord::kMaxGoodCount) << "and there it stops";
  EXPECT_EQ(Disagreement(voxel), ConditionClass::kBad) << "the first of them is still known";
}

}  // namespace
}  // namespace isotherm

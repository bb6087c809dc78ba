#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <isotherm_frames.h>

#include <cmath>
#include <limits>
#include <vector>

#include "common/transport/conversions.h"

namespace isotherm {
namespace {

using ::testing::ElementsAre;

RigDescription SomeRig() {
  RigDescription description;
  CameraModel camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 525.0;
  camera.cx = 319.5;
  camera.cy = 239.5;
  description.rig.depth = camera;
  description.rig.depth_sensor.near_range_m = 0.5;
  description.rig.thermal_sensor.row_readout_s = 1e-4;
  return description;
}

/// Returns whether the ground refuses a rig once `change` was made to what is sent.
bool IsRefused(const RigDescription& sent, const auto& change) {
  isotherm_wire_Rig wire{};
  ToWire(sent, &wire);
  change(wire);
  RigDescription received;
  return FromWire(wire, &received).has_value();
}

TEST(ConvertRigTest, SensorsArriveAsTheyWereWritten) {
  isotherm_wire_Rig wire{};
  ToWire(SomeRig(), &wire);
  RigDescription received;
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_EQ(received.rig.depth_sensor.near_range_m, 0.5);
  EXPECT_EQ(received.rig.thermal_sensor.row_readout_s, 1e-4);
  EXPECT_FALSE(received.rig.thermal_sensor.pixel_pitch_m.has_value());
  EXPECT_FALSE(received.rig.thermal_sensor.lens.has_value());
}

/// In a sample that ends before the sensors, or within them, the rest reads as zeros.
TEST(ConvertRigTest, AnEdgeBefore22HasTheSensorsOfAnOldRigFile) {
  isotherm_wire_Rig wire{};
  ToWire(SomeRig(), &wire);
  wire.thermal_sensor = {};
  wire.has_sensors = false;
  RigDescription received;
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_EQ(received.rig.depth_sensor.near_range_m, DepthSensorModel().near_range_m);
  EXPECT_EQ(received.rig.thermal_sensor.time_constant_s, ThermalSensorModel().time_constant_s);
}

TEST(ConvertRigTest, WideLensesArriveAsTheyWereWritten) {
  RigDescription sent = SomeRig();
  sent.rig.depth->k1 = -0.1;
  sent.rig.thermal = sent.rig.depth;
  sent.rig.depth->lens = LensKind::kRational;
  sent.rig.depth->k4 = 0.7, sent.rig.depth->k5 = 0.04, sent.rig.depth->k6 = -0.01;
  sent.rig.thermal->lens = LensKind::kFisheye;
  sent.rig.thermal->k4 = 0.003;
  isotherm_wire_Rig wire{};
  ToWire(sent, &wire);
  RigDescription received;
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  const CameraModel& depth = *received.rig.depth;
  EXPECT_EQ(depth.lens, LensKind::kRational);
  EXPECT_EQ(std::vector({depth.k1, depth.k4, depth.k5, depth.k6}),
            std::vector({-0.1, 0.7, 0.04, -0.01}));
  EXPECT_EQ(received.rig.thermal->lens, LensKind::kFisheye);
  EXPECT_EQ(received.rig.thermal->k1, -0.1);
  EXPECT_EQ(received.rig.thermal->k4, 0.003);
}

/// An earlier ground reads no further than it knows.
TEST(ConvertRigTest, WithoutWhatAWideLensHasBesideItsCameraIsRefused) {
  RigDescription sent = SomeRig();
  sent.rig.depth->lens = LensKind::kFisheye;
  sent.rig.depth->k4 = 0.003;
  EXPECT_FALSE(IsRefused(sent, [](isotherm_wire_Rig&) {}));
  EXPECT_TRUE(IsRefused(sent, [](isotherm_wire_Rig& wire) { wire.depth_wide_lens = {}; }));
  EXPECT_TRUE(IsRefused(sent, [](isotherm_wire_Rig& wire) { wire.depth_wide_lens.kind = 3; }));
  EXPECT_TRUE(IsRefused(sent, [](isotherm_wire_Rig& wire) { wire.thermal_wide_lens.kind = 255; }));
  EXPECT_TRUE(IsRefused(sent, [](isotherm_wire_Rig& wire) { wire.depth_wide_lens.k4 = NAN; }));
}

TEST(ConvertRigTest, AnEdgeBefore23HasThermalFramesInCentikelvin) {
  isotherm_wire_Rig wire{};
  RigDescription sent = SomeRig();
  sent.rig.thermal_scale = {0.02, 0.0};
  ToWire(sent, &wire);
  RigDescription received;
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_EQ(received.rig.thermal_scale, sent.rig.thermal_scale);
  wire.thermal_scale = wire.thermal_offset = 0.0;
  wire.has_thermal_scale = false;
  received = RigDescription();
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_EQ(received.rig.thermal_scale, kCentikelvin);
}

TEST(ConvertRigTest, AnEdgeBefore24KnowsOfNoSceneInfluence) {
  isotherm_wire_Rig wire{};
  RigDescription sent = SomeRig();
  sent.rig.thermal_sensor.scene_influence = {0.04, 35.0, 0.03};
  ToWire(sent, &wire);
  RigDescription received;
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_EQ(received.rig.thermal_sensor.scene_influence.near_fraction, 0.04);
  EXPECT_EQ(received.rig.thermal_sensor.scene_influence.near_sigma_px, 35.0);
  EXPECT_EQ(received.rig.thermal_sensor.scene_influence.total_fraction, 0.03);
  wire.scene_near_fraction = wire.scene_near_sigma_px = wire.scene_total_fraction = 0.0;
  wire.has_scene_influence = false;
  received = RigDescription();
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_EQ(received.rig.thermal_sensor.scene_influence.Total(), 0.0);
}

TEST(ConvertRigTest, AnEdgeThatSendsNoneKnowsOfNoDepthBias) {
  isotherm_wire_Rig wire{};
  RigDescription sent = SomeRig();
  sent.rig.depth_sensor.bias = {
      2, 2, {0.5F, 1.0F}, {1.0F, 1.1F, 1.2F, 1.0F, 1.0F, 1.0F, 0.9F, 1.0F}};
  ToWire(sent, &wire);
  RigDescription received;
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_EQ(received.rig.depth_sensor.bias.columns, 2);
  EXPECT_EQ(received.rig.depth_sensor.bias.distances_m, sent.rig.depth_sensor.bias.distances_m);
  EXPECT_EQ(received.rig.depth_sensor.bias.multipliers, sent.rig.depth_sensor.bias.multipliers);
  wire.depth_bias_columns = wire.depth_bias_rows = 0;
  wire.depth_bias_distances_m = {};
  wire.depth_bias_multipliers = {};
  received = RigDescription();
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_TRUE(received.rig.depth_sensor.bias.empty());
}

/// Such samples end within it, or come from a hostile peer.
TEST(ConvertRigTest, ADepthBiasThatCannotBeIsRefused) {
  RigDescription sent = SomeRig();
  sent.rig.depth_sensor.bias = {2, 2, {0.5F}, {1.0F, 1.1F, 1.2F, 1.0F}};
  const auto refuses = [&](const auto& change) { return IsRefused(sent, change); };
  EXPECT_FALSE(refuses([](isotherm_wire_Rig&) {}));
  EXPECT_TRUE(refuses([](isotherm_wire_Rig& rig) { rig.depth_bias_multipliers = {}; }));
  EXPECT_TRUE(refuses([](isotherm_wire_Rig& rig) { rig.depth_bias_multipliers._length = 3; }));
  EXPECT_TRUE(refuses([](isotherm_wire_Rig& rig) { rig.depth_bias_columns = 255; }));
  EXPECT_TRUE(refuses([](isotherm_wire_Rig& rig) { rig.depth_bias_distances_m = {}; }));
  sent.rig.depth.reset();
  EXPECT_TRUE(refuses([](isotherm_wire_Rig& rig) { rig.depth_bias_columns = 255; }))
      << "nor without cameras";
  sent = SomeRig();
  sent.rig.depth_sensor.bias = {2, 2, {0.5F}, {1.0F, 7.0F, 1.2F, 1.0F}};
  EXPECT_TRUE(refuses([](isotherm_wire_Rig&) {}));
}

TEST(ConvertRigTest, AnEdgeThatSendsNoneKnowsOfNoRadiometricCorrection) {
  isotherm_wire_Rig wire{};
  RigDescription sent = SomeRig();
  sent.rig.thermal_sensor.radiometric_correction = {{20.0F, 120.0F}, {0.5F, -1.2F}, {0.1F, 0.2F}};
  ToWire(sent, &wire);
  RigDescription received;
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  const RadiometricCorrection& correction = received.rig.thermal_sensor.radiometric_correction;
  EXPECT_THAT(correction.readings_celsius, ElementsAre(20.0F, 120.0F));
  EXPECT_THAT(correction.corrections_k, ElementsAre(0.5F, -1.2F));
  EXPECT_THAT(correction.sigmas_k, ElementsAre(0.1F, 0.2F));
  wire.radiometric_readings_celsius = {};
  wire.radiometric_corrections_k = {};
  wire.radiometric_sigmas_k = {};
  received = RigDescription();
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_TRUE(received.rig.thermal_sensor.radiometric_correction.empty());
}

TEST(ConvertRigTest, AnEdgeThatSendsNoneKnowsOfNoHousingDrift) {
  isotherm_wire_Rig wire{};
  RigDescription sent = SomeRig();
  sent.rig.thermal_sensor.housing_drift = HousingDrift{4.0, 0.5};
  ToWire(sent, &wire);
  RigDescription received;
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  ASSERT_TRUE(received.rig.thermal_sensor.housing_drift);
  EXPECT_EQ(received.rig.thermal_sensor.housing_drift->error_per_kelvin, 4.0);
  EXPECT_EQ(received.rig.thermal_sensor.housing_drift->sigma, 0.5);
  wire.housing_error_per_kelvin = 1e9;
  EXPECT_EQ(FromWire(wire, &received), RefusalCause::kOutOfRange);
  wire.has_housing_drift = false;
  received = RigDescription();
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_FALSE(received.rig.thermal_sensor.housing_drift);
}

TEST(ConvertRigTest, ARadiometricCorrectionThatCannotBeIsRefused) {
  RigDescription sent = SomeRig();
  sent.rig.thermal_sensor.radiometric_correction = {{20.0F, 120.0F}, {0.5F, -1.2F}, {0.1F, 0.2F}};
  const auto refuses = [&](const auto& change) { return IsRefused(sent, change); };
  EXPECT_FALSE(refuses([](isotherm_wire_Rig&) {}));
  // The sample ends within it.
  EXPECT_TRUE(refuses([](isotherm_wire_Rig& rig) { rig.radiometric_sigmas_k = {}; }));
  EXPECT_TRUE(refuses([](isotherm_wire_Rig& rig) { rig.radiometric_corrections_k._length = 1; }));
  sent.rig.thermal_sensor.radiometric_correction.corrections_k[1] = 1e9F;
  EXPECT_TRUE(refuses([](isotherm_wire_Rig&) {}));
  sent.rig.depth.reset();
  sent.rig.thermal.reset();
  EXPECT_TRUE(refuses([](isotherm_wire_Rig&) {})) << "nor without cameras";
}

TEST(ConvertRigTest, ASceneInfluenceThatCannotBeIsRefused) {
  for (const double fraction : {-0.1, 0.9, std::numeric_limits<double>::quiet_NaN()}) {
    isotherm_wire_Rig wire{};
    ToWire(SomeRig(), &wire);
    wire.scene_total_fraction = fraction;
    RigDescription received;
    EXPECT_NE(FromWire(wire, &received), std::nullopt) << fraction;
  }
}

TEST(ConvertRigTest, AThermalScaleThatCannotBeIsRefused) {
  for (const double scale : {0.0, -0.01, std::numeric_limits<double>::quiet_NaN()}) {
    isotherm_wire_Rig wire{};
    ToWire(SomeRig(), &wire);
    wire.thermal_scale = scale;
    RigDescription received;
    EXPECT_NE(FromWire(wire, &received), std::nullopt) << scale;
  }
}

/// In a sample that ends before the scale, or within it, the rest reads as zeros: nobody knows what
/// its counts mean.
TEST(ConvertThermalFrameTest, AScaledImageWithoutItsScaleIsRefused) {
  EncodedThermalFrame sent;
  sent.image = {Encoding::kScaledRaw16, 2, 1, {1, 2, 3, 4}};
  sent.scale = {0.02, 0.0};
  isotherm_wire_ThermalFrame wire{};
  ToWire(sent, &wire);
  EncodedThermalFrame received;
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_EQ(received.scale, sent.scale);
  for (const double scale : {0.0, -0.02}) {
    wire.kelvin_per_count = scale;
    EXPECT_EQ(FromWire(wire, &received), RefusalCause::kOutOfRange) << scale;
  }
  wire.offset_kelvin = std::numeric_limits<double>::infinity();
  EXPECT_EQ(FromWire(wire, &received), RefusalCause::kNotFinite);
  wire.has_scale = false;
  EXPECT_EQ(FromWire(wire, &received), RefusalCause::kOutOfRange);
  // Without a scaled image no scale is asked for, and none is believed.
  wire.image.encoding = static_cast<std::uint8_t>(Encoding::kRaw16);
  received = EncodedThermalFrame();
  ASSERT_EQ(FromWire(wire, &received), std::nullopt);
  EXPECT_EQ(received.scale, kCentikelvin);
}

TEST(ConvertRigTest, SensorsThatCannotBeAreRefused) {
  isotherm_wire_Rig wire{};
  ToWire(SomeRig(), &wire);
  wire.depth_sensor.noise_at_1m_m = -1.0;
  RigDescription received;
  EXPECT_EQ(FromWire(wire, &received), RefusalCause::kOutOfRange);
}

}  // namespace
}  // namespace isotherm

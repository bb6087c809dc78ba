#include "common/rig/rig_calibration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "common/rig/rig_calibration.pb.h"
#include "common/rig/testing/rig_text.h"

namespace isotherm {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string ReplaceFirst(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

std::string RigError(const std::string& text) {
  const Result<Rig> rig = ParseRigCalibration(text, "rig.textproto");
  return rig ? std::string("accepted") : rig.error().message();
}

TEST(RigCalibrationTest, ReadsEveryFieldAndConverts) {
  const Result<Rig> rig = ParseRigCalibration(kRigText, "rig.textproto");
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_EQ(rig->depth->width, 640);
  EXPECT_DOUBLE_EQ(rig->depth->fy, 567.5);
  EXPECT_DOUBLE_EQ(rig->thermal->k1, -0.439);
  EXPECT_DOUBLE_EQ(rig->thermal->k3, 0.0);
  EXPECT_DOUBLE_EQ(rig->thermal_delay_s, 0.0125);
  EXPECT_EQ(rig->serial, "PI-450");
  // (0, 0.6, 0, 0.8) turns about y by 2 atan2(0.6, 0.8): x' of the unit x is 1 - 2 * 0.36.
  EXPECT_NEAR(rig->T_thermal_depth->linear()(0, 0), 0.28, 1e-12);
  EXPECT_NEAR(rig->T_thermal_depth->translation().y(), 0.0533, 1e-12);
  EXPECT_FALSE(rig->reprojection_error_px.has_value());
}

TEST(RigCalibrationTest, TextRoundTripKeepsTheRig) {
  const Rig rig = ParseRigCalibration(kRigText, "first").value();
  const Result<Rig> again = ParseRigCalibration(ToText(rig), "second");
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_EQ(again->thermal->fx, rig.thermal->fx);
  EXPECT_EQ(again->depth->cx, rig.depth->cx);
  EXPECT_TRUE(again->T_thermal_depth->isApprox(*rig.T_thermal_depth, 1e-12));
  EXPECT_EQ(again->thermal_delay_s, rig.thermal_delay_s);
}

TEST(RigCalibrationTest, AWideLensIsReadAndWrittenBack) {
  const std::string rational =
      ReplaceFirst(kRigText, "k2: 0.29", "k2: 0.29 lens: RATIONAL k4: 0.7 k5: 0.04 k6: -0.01");
  const Result<Rig> rig = ParseRigCalibration(rational, "rig");
  ASSERT_TRUE(rig.has_value()) << rig.error().message();
  EXPECT_EQ(rig->thermal->lens, LensKind::kRational);
  EXPECT_EQ(rig->thermal->k6, -0.01);
  const Result<Rig> back = ParseRigCalibration(ToText(*rig), "rig");
  ASSERT_TRUE(back.has_value()) << back.error().message();
  EXPECT_EQ(back->thermal->lens, LensKind::kRational);
  EXPECT_EQ(back->thermal->k4, 0.7);
  EXPECT_EQ(back->thermal->k5, 0.04);

  const std::string fisheye =
      ReplaceFirst(kRigText, "k2: 0.29", "k2: 0.29 lens: FISHEYE k3: 0.02 k4: 0.003");
  const Result<Rig> wide = ParseRigCalibration(fisheye, "rig");
  ASSERT_TRUE(wide.has_value()) << wide.error().message();
  EXPECT_EQ(ParseRigCalibration(ToText(*wide), "rig")->thermal->lens, LensKind::kFisheye);
  EXPECT_EQ(ParseRigCalibration(ToText(*wide), "rig")->thermal->k4, 0.003);
}

TEST(RigCalibrationTest, CoefficientsOfAnotherLensAreRefused) {
  const auto error = [](const char* given) {
    return RigError(ReplaceFirst(kRigText, "k2: 0.29", given));
  };
  EXPECT_THAT(error("k2: 0.29 k4: 0.1"), HasSubstr("thermal: k4 k5 k6 are those of a wide lens"));
  EXPECT_THAT(error("lens: FISHEYE k5: 0.1"), HasSubstr("thermal: a FISHEYE lens has k1 k2 k3 k4"));
  EXPECT_THAT(error("lens: FISHEYE p1: 0.1"), HasSubstr("FISHEYE"));
  EXPECT_THAT(error("lens: RATIONAL k6: nan"), HasSubstr("distortion"));
  EXPECT_THAT(error("lens: PLUMB_BOB"), HasSubstr("lens"));
}

TEST(RigCalibrationTest, AbsentPartsStayAbsent) {
  Rig rig;
  rig.thermal = ParseRigCalibration(kRigText, "first").value().thermal;
  const Result<Rig> again = ParseRigCalibration(ToText(rig), "second");
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_FALSE(again->depth.has_value());
  EXPECT_FALSE(again->T_thermal_depth.has_value());
}

constexpr char kSensorText[] = R"(
depth_sensor { near_range_m: 0.5 min_depth_m: 0.4 max_depth_m: 6 noise_at_1m_m: 0.01 }
thermal_sensor {
  time_constant_s: 0.012 row_readout_s: 0.0001 pixel_pitch_um: 17
  lens { focal_length_mm: 13 f_number: 1.25 focus_m: 0.6 }
  scene_influence { near_fraction: 0.04 near_sigma_px: 35 total_fraction: 0.03 }
})";

TEST(RigCalibrationTest, SensorsAreReadInMetresAndWrittenBack) {
  const Result<Rig> first = ParseRigCalibration(std::string(kRigText) + kSensorText, "first");
  ASSERT_TRUE(first) << first.error().message();
  for (const Result<Rig>& rig : {first, ParseRigCalibration(ToText(*first), "second")}) {
    ASSERT_TRUE(rig) << rig.error().message();
    EXPECT_EQ(rig->depth_sensor.near_range_m, 0.5);
    EXPECT_EQ(rig->depth_sensor.min_depth_m, 0.4);
    EXPECT_EQ(rig->depth_sensor.max_depth_m, 6.0);
    EXPECT_EQ(rig->depth_sensor.noise_at_1m_m, 0.01);
    EXPECT_EQ(rig->thermal_sensor.time_constant_s, 0.012);
    EXPECT_EQ(rig->thermal_sensor.row_readout_s, 0.0001);
    EXPECT_NEAR(rig->thermal_sensor.pixel_pitch_m.value(), 17e-6, 1e-12);
    ASSERT_TRUE(rig->thermal_sensor.lens.has_value());
    EXPECT_NEAR(rig->thermal_sensor.lens->focal_length_m, 0.013, 1e-9);
    EXPECT_EQ(rig->thermal_sensor.lens->f_number, 1.25);
    EXPECT_EQ(rig->thermal_sensor.lens->focus_m, 0.6);
    EXPECT_EQ(rig->thermal_sensor.scene_influence.near_fraction, 0.04);
    EXPECT_EQ(rig->thermal_sensor.scene_influence.near_sigma_px, 35.0);
    EXPECT_EQ(rig->thermal_sensor.scene_influence.total_fraction, 0.03);
  }
}

TEST(RigCalibrationTest, ADepthBiasIsReadAndWrittenBack) {
  const std::string text = std::string(kRigText) + R"(
depth_sensor { bias { columns: 2 rows: 2 distance_m: 0.5 multiplier: [1.0, 1.01, 0.99, 1.02] } })";
  const Result<Rig> rig = ParseRigCalibration(text, "rig.textproto");
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_NEAR(rig->depth_sensor.bias.At(1.0, 0.0, 0.7), 1.01, 1e-6);
  const Result<Rig> again = ParseRigCalibration(ToText(*rig), "second");
  ASSERT_TRUE(again) << again.error().message();
  EXPECT_EQ(again->depth_sensor.bias.multipliers, rig->depth_sensor.bias.multipliers);
  EXPECT_EQ(again->depth_sensor.bias.distances_m, rig->depth_sensor.bias.distances_m);
  EXPECT_THAT(RigError(ReplaceFirst(text, "1.02]", "1.02, 1.0]")),
              AllOf(HasSubstr("rig.textproto"), HasSubstr("depth_sensor.bias.multiplier")));
}

TEST(RigCalibrationTest, ARadiometricCorrectionIsReadAndWrittenBack) {
  const std::string text = std::string(kRigText) + R"(
thermal_sensor { radiometric_correction { reading_celsius: [20, 100] correction_k: [0.5, -1] sigma_k: [0.1, 0.2] }
                 housing_drift { error_per_kelvin: 4 sigma: 0.3 } })";
  const Result<Rig> rig = ParseRigCalibration(text, "rig.textproto");
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_NEAR(rig->thermal_sensor.radiometric_correction.At(60.0), -0.25, 1e-6);
  const Result<Rig> again = ParseRigCalibration(ToText(*rig), "second");
  ASSERT_TRUE(again) << again.error().message();
  const RadiometricCorrection& first = rig->thermal_sensor.radiometric_correction;
  const RadiometricCorrection& second = again->thermal_sensor.radiometric_correction;
  EXPECT_EQ(second.readings_celsius, first.readings_celsius);
  EXPECT_EQ(second.corrections_k, first.corrections_k);
  EXPECT_EQ(second.sigmas_k, first.sigmas_k);
  ASSERT_TRUE(again->thermal_sensor.housing_drift);
  EXPECT_EQ(again->thermal_sensor.housing_drift->error_per_kelvin, 4.0);
  EXPECT_EQ(again->thermal_sensor.housing_drift->sigma, 0.3);
  for (const char* wrong : {"sigma: -1", ""}) {
    EXPECT_THAT(RigError(ReplaceFirst(text, "sigma: 0.3", wrong)), HasSubstr("housing_drift"));
  }
  EXPECT_THAT(RigError(ReplaceFirst(text, "0.2]", "0.2, 1.0]")),
              AllOf(HasSubstr("rig.textproto"), HasSubstr("radiometric_correction")));
}

/// A file from before these fields existed means what the options' defaults were then.
TEST(RigCalibrationTest, ARigFileWithoutSensorsHasThoseOfBefore) {
  const Rig rig = ParseRigCalibration(kRigText, "rig").value();
  EXPECT_EQ(rig.depth_sensor.near_range_m, 0.35);
  EXPECT_EQ(rig.depth_sensor.min_depth_m, 0.3);
  EXPECT_EQ(rig.depth_sensor.max_depth_m, 4.0);
  EXPECT_EQ(rig.depth_sensor.noise_at_1m_m, 0.006);
  EXPECT_EQ(rig.thermal_sensor.time_constant_s, 0.010);
  EXPECT_EQ(rig.thermal_sensor.row_readout_s, 0.0);
  EXPECT_FALSE(rig.thermal_sensor.pixel_pitch_m.has_value());
  EXPECT_FALSE(rig.thermal_sensor.lens.has_value());
  EXPECT_EQ(rig.thermal_sensor.scene_influence.Total(), 0.0);
  const Rig by_default;
  EXPECT_EQ(ToText(by_default), ToText(FromProto(RigCalibration())));
}

TEST(RigCalibrationTest, ImpossibleSensorsAreRefusedWithTheField) {
  const auto error = [](const std::string& from, const std::string& to) {
    return RigError(ReplaceFirst(std::string(kRigText) + kSensorText, from, to));
  };
  EXPECT_THAT(error("near_range_m: 0.5", "near_range_m: -1"), HasSubstr("near_range_m"));
  EXPECT_THAT(error("max_depth_m: 6", "max_depth_m: 0.4"), HasSubstr("min_depth_m < max_depth_m"));
  EXPECT_THAT(error("noise_at_1m_m: 0.01", "noise_at_1m_m: 0"), HasSubstr("noise_at_1m_m"));
  EXPECT_THAT(error("time_constant_s: 0.012", "time_constant_s: nan"),
              HasSubstr("time_constant_s"));
  EXPECT_THAT(error("row_readout_s: 0.0001", "row_readout_s: 1"), HasSubstr("row_readout_s"));
  EXPECT_THAT(error("pixel_pitch_um: 17", "pixel_pitch_um: -17"), HasSubstr("pixel_pitch_um"));
  EXPECT_THAT(error("pixel_pitch_um: 17", ""), HasSubstr("thermal_sensor.lens"));
  EXPECT_THAT(error("f_number: 1.25", "f_number: 0"), HasSubstr("thermal_sensor.lens"));
  EXPECT_THAT(error("focus_m: 0.6", "focus_m: 0.01"), HasSubstr("beyond the focal length"));
  EXPECT_THAT(error("focus_m: 0.6", ""), HasSubstr("lens.focus_m' is missing"));
  EXPECT_THAT(error("near_fraction: 0.04", "near_fraction: -0.1"), HasSubstr("near_fraction"));
  EXPECT_THAT(error("total_fraction: 0.03", "total_fraction: 0.5"), HasSubstr("total_fraction"));
  EXPECT_THAT(error("near_sigma_px: 35", "near_sigma_px: nan"), HasSubstr("near_sigma_px"));
}

TEST(RigCalibrationTest, TheThermalScaleIsCentikelvinUnlessTheFileSaysOtherwise) {
  EXPECT_EQ(ParseRigCalibration(kRigText, "rig.textproto")->thermal_scale, kCentikelvin);
  const auto rig = ParseRigCalibration(
      kRigText + std::string("\nthermal_scale: 0.02\nthermal_offset: 100\n"), "rig.textproto");
  ASSERT_TRUE(rig.has_value());
  EXPECT_EQ(rig->thermal_scale, (RadiometricScale{0.02, 100.0}));
  const auto again = ParseRigCalibration(ToText(*rig), "again");
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(again->thermal_scale, rig->thermal_scale);
}

TEST(RigCalibrationTest, F57AnImpossibleThermalScaleIsRefusedWithFieldAndFile) {
  const auto error = [](const std::string& line) {
    return RigError(std::string(kRigText) + "\n" + line + "\n");
  };
  for (const char* scale : {"0", "-0.01", "nan", "inf", "50"}) {
    EXPECT_THAT(error(std::string("thermal_scale: ") + scale),
                AllOf(HasSubstr("rig.textproto"), HasSubstr("thermal_scale")))
        << scale;
  }
  for (const char* offset : {"nan", "-inf", "1e9"}) {
    EXPECT_THAT(error(std::string("thermal_offset: ") + offset),
                AllOf(HasSubstr("rig.textproto"), HasSubstr("thermal_offset")))
        << offset;
  }
  EXPECT_THAT(error("thermal_scale: 0.0001"), HasSubstr("16 bits reach from -273.1 to -266.6 °C"));
  EXPECT_THAT(error("thermal_offset: 2000"), HasSubstr("no thermal camera measures"));
}

TEST(RigCalibrationTest, F57RigWithoutIntrinsicsIsRejected) {
  EXPECT_THAT(RigError("depth_scale: 1000\n"), HasSubstr("neither depth nor thermal intrinsics"));
  const std::string error = RigError("depth { width: 640 height: 480 }\n");
  EXPECT_THAT(error, HasSubstr("rig.textproto:1:1: required field 'depth.fx' is missing"));
  EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 3) << error;  // fx fy cx cy
}

TEST(RigCalibrationTest, F57NonPhysicalValuesAreRejectedWithTheField) {
  EXPECT_THAT(RigError(ReplaceFirst(kRigText, "fx: 567.7", "fx: -567.7")), HasSubstr("depth: fx"));
  EXPECT_THAT(RigError(ReplaceFirst(kRigText, "fx: 567.7", "fx: nan")), HasSubstr("depth: fx"));
  EXPECT_THAT(RigError(ReplaceFirst(kRigText, "width: 382", "width: 0")),
              HasSubstr("thermal: width"));
  EXPECT_THAT(RigError(ReplaceFirst(kRigText, "cx: 205.5", "cx: 1e9")),
              HasSubstr("principal point"));
  EXPECT_THAT(RigError(ReplaceFirst(kRigText, "k1: -0.439", "k1: inf")), HasSubstr("distortion"));
  EXPECT_THAT(RigError(ReplaceFirst(kRigText, "depth_scale: 1000", "depth_scale: 0")),
              HasSubstr("depth_scale"));
  EXPECT_THAT(RigError(ReplaceFirst(kRigText, "qw: 0.8", "qw: 8")), HasSubstr("unit quaternion"));
  EXPECT_THAT(RigError(ReplaceFirst(kRigText, "qw: 0.8", "qw: nan")), HasSubstr("unit quaternion"));
  EXPECT_THAT(RigError(ReplaceFirst(kRigText, "tx: 0.0485", "tx: inf")),
              HasSubstr("T_thermal_depth"));
  EXPECT_THAT(RigError(ReplaceFirst(kRigText, "thermal_delay_s: 0.0125", "thermal_delay_s: 99")),
              HasSubstr("thermal_delay_s"));
}

}  // namespace
}  // namespace isotherm

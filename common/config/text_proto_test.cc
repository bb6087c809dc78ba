#include "common/config/text_proto.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <clocale>
#include <filesystem>
#include <fstream>
#include <locale>

#include "common/config/nearest_name.h"
#include "common/config/rig_calibration.h"
#include "common/config/rig_calibration.pb.h"

namespace isotherm {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr char kRigText[] = R"(# A rig.
depth { width: 640 height: 480 fx: 567.7 fy: 567.5 cx: 321.3 cy: 242.4 }
depth_scale: 1000
thermal { width: 382 height: 288 fx: 371.4 fy: 372.1 cx: 205.5 cy: 150.5 k1: -0.439 k2: 0.29 }
T_thermal_depth { tx: 0.0485 ty: 0.0533 tz: 0.0115 qx: 0 qy: 0.6 qz: 0 qw: 0.8 }
thermal_delay_s: 0.0125
serial: "PI-450"
)";

int CountLines(const std::string& text) {
  return text.empty() ? 0 : 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

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
  }
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
  EXPECT_EQ(CountLines(error), 4) << error;  // fx fy cx cy
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

TEST(TextProtoTest, F59AllErrorsAreListedWithLineAndColumn) {
  RigCalibration rig;
  const Status status = ParseTextProto(
      "depth { width: 640 hieght: 480\n"
      "  fx: fast fy: 1 cx: 1 cy: 1 }\n"
      "depth_scale: \"many\"\n"
      "colour { width: 3 }\n"
      "serial: 17\n"
      "depth_scale: 5 depth_scale: 6\n",
      "rig.textproto", rig);
  ASSERT_EQ(status.code(), StatusCode::kInvalidArgument);
  const std::string& text = status.message();
  EXPECT_THAT(text,
              HasSubstr("rig.textproto:1:20: unknown field 'hieght'. Did you mean 'height'?"));
  EXPECT_THAT(text, HasSubstr("rig.textproto:2:7: Expected double, got: fast"));
  EXPECT_THAT(text, HasSubstr("rig.textproto:3:14: Expected double"));
  EXPECT_THAT(text, HasSubstr("rig.textproto:4:1: unknown field 'colour'"));
  EXPECT_THAT(text, HasSubstr("rig.textproto:5:9: Expected string, got: 17"));
  EXPECT_THAT(text, HasSubstr("rig.textproto:6:1: Non-repeated field \"depth_scale\""));
}

TEST(TextProtoTest, F59DuplicateFieldIsAnErrorOfItsOwn) {
  RigCalibration rig;
  const Status status = ParseTextProto("serial: 'a'\n  serial: 'b'\n", "rig", rig);
  EXPECT_THAT(status.message(), HasSubstr("rig:2:3: Non-repeated field \"serial\""));
  EXPECT_EQ(CountLines(status.message()), 1) << status.message();
}

TEST(TextProtoTest, F59GarbageAndEveryTruncationAreErrorsNotCrashes) {
  const std::string text = ReplaceFirst(kRigText, "# A rig.\n", "");
  for (std::size_t length = 0; length < text.size(); ++length) {
    RigCalibration rig;
    const Status status = ParseTextProto(text.substr(0, length), "rig", rig);
    if (!status.ok()) {
      EXPECT_THAT(status.message(), HasSubstr("rig:")) << length;
    }
  }
  RigCalibration rig;
  EXPECT_FALSE(ParseTextProto("}{ : ] \x01\xff \"", "rig", rig).ok());
  EXPECT_FALSE(ParseTextProto(std::string(300, '{'), "rig", rig).ok());
  EXPECT_FALSE(ParseTextProto("\tserial:\t5", "rig", rig).ok());
}

/// Processor time of this thread, which other programs do not touch.
double ProcessorSeconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double SecondsToRefuse(const std::string& unit, std::size_t bytes) {
  std::string text;
  while (text.size() + unit.size() < bytes) text += unit;
  const double before = ProcessorSeconds();
  RigCalibration rig;
  EXPECT_EQ(ParseTextProto(text, "rig", rig).code(), StatusCode::kInvalidArgument);
  return ProcessorSeconds() - before;
}

TEST(TextProtoTest, F65AFileOfOneLineCostsNoMoreThanItsSize) {
  // A cost that grows with the square of the size would grow 256 times from one to the other.
  constexpr std::size_t kSmallBytes = 60'000, kLargeBytes = 16 * kSmallBytes;
  constexpr double kMaxGrowth = 48.0;  // Three times the growth of the size: machines are busy.
  for (const std::string unit : {"depth_scale: x ", "colour: 1 ", "\x01 ", "} ", "depth { "}) {
    const double small_s = SecondsToRefuse(unit, kSmallBytes);
    const double large_s = SecondsToRefuse(unit, kLargeBytes);
    EXPECT_LT(large_s, kMaxGrowth * std::max(small_s, 0.01)) << unit;
  }
}

TEST(TextProtoTest, F65TooLargeAndBinaryFilesAreRefusedInWords) {
  RigCalibration rig;
  EXPECT_THAT(ParseTextProto(std::string((1U << 20) + 1, ' '), "rig", rig).message(),
              HasSubstr("too many for a text file"));
  EXPECT_THAT(ParseTextProto(std::string("serial: 'a'\0", 12), "rig", rig).message(),
              HasSubstr("rig: not a text file: byte 11 is zero"));
  const std::string long_name(100'000, 'x');
  EXPECT_LT(ParseTextProto(long_name + ": 1", "rig", rig).message().size(), 1000U);
}

TEST(TextProtoTest, EmptyTextGivesDefaults) {
  RigCalibration rig;
  EXPECT_TRUE(ParseTextProto("", "rig", rig).ok());
  EXPECT_EQ(rig.depth_scale(), 1000.0);
}

TEST(TextProtoTest, PrintedTextShowsDefaultsAndParsesBack) {
  RigCalibration rig;
  rig.set_serial("x");
  const std::string text = ToTextProto(rig);
  EXPECT_THAT(text, HasSubstr("depth_scale: 1000"));
  EXPECT_THAT(text, Not(HasSubstr("depth {")));
  RigCalibration again;
  EXPECT_TRUE(ParseTextProto(text, "again", again).ok());
}

TEST(TextProtoTest, MissingFileAndFolderAreSaidInWords) {
  RigCalibration rig;
  EXPECT_EQ(LoadTextProto("/nonexistent/rig.textproto", rig).code(), StatusCode::kNotFound);
  EXPECT_THAT(LoadTextProto(testing::TempDir(), rig).message(), HasSubstr("is a folder"));
  EXPECT_THAT(LoadTextProto("/dev/zero", rig).message(),
              HasSubstr("/dev/zero: is a pipe or a device"));
}

TEST(TextProtoTest, F65AFileThatIsTooLargeIsAnotherOneThanMeant) {
  const std::filesystem::path large = std::filesystem::path(testing::TempDir()) / "large.textproto";
  std::ofstream(large) << "serial: 'a'";
  std::filesystem::resize_file(large, (1U << 20) + 1);
  RigCalibration rig;
  const Status refused = LoadTextProto(large, rig);
  EXPECT_EQ(refused.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(refused.message(), HasSubstr("more than are read (1048576 at most)"));
  std::filesystem::remove(large);
}

TEST(OverrideTest, SetsNestedNumbersAndStrings) {
  RigCalibration rig;
  ASSERT_TRUE(ApplyOverride("depth.width=320", rig).ok());
  ASSERT_TRUE(ApplyOverride("depth_scale=5e3", rig).ok());
  ASSERT_TRUE(ApplyOverride("serial=a = \"b\"", rig).ok());
  ASSERT_TRUE(ApplyOverride("method='quoted'", rig).ok());
  EXPECT_EQ(rig.depth().width(), 320);
  EXPECT_EQ(rig.depth_scale(), 5000.0);
  EXPECT_EQ(rig.serial(), "a = \"b\"");
  EXPECT_EQ(rig.method(), "quoted");
}

TEST(OverrideTest, RefusesWhatDoesNotExistAndNamesWhatDoes) {
  RigCalibration rig;
  EXPECT_THAT(ApplyOverride("depht.width=1", rig).message(), HasSubstr("Did you mean 'depth'?"));
  EXPECT_THAT(
      ApplyOverride("depth.widht=1", rig).message(),
      HasSubstr("no option 'widht' in 'depth'. Did you mean 'width'? Known: width, height, fx"));
  EXPECT_THAT(ApplyOverride("depth=1", rig).message(), HasSubstr("name one of its fields: width"));
  EXPECT_THAT(ApplyOverride("depth_scale.x=1", rig).message(), HasSubstr("single value"));
  EXPECT_THAT(ApplyOverride("depth_scale", rig).message(), HasSubstr("stage.field=value"));
  EXPECT_THAT(ApplyOverride("=1", rig).message(), HasSubstr("stage.field=value"));
  EXPECT_THAT(ApplyOverride(".=1", rig).message(), HasSubstr("no stage"));
}

TEST(OverrideTest, RefusesValuesOfTheWrongKindOrRange) {
  RigCalibration rig;
  EXPECT_THAT(ApplyOverride("depth.width=99999999999", rig).message(), HasSubstr("out of range"));
  EXPECT_THAT(ApplyOverride("depth.width=1.5", rig).message(), HasSubstr("not an integer"));
  EXPECT_THAT(ApplyOverride("depth_scale=1,5", rig).message(), HasSubstr("not a number"));
  EXPECT_THAT(ApplyOverride("depth_scale=", rig).message(), HasSubstr("not a number"));
  EXPECT_FALSE(rig.has_depth_scale());
}

TEST(NearestNameTest, FindsTypingErrorsOnly) {
  const std::vector<std::string> names{"depth.txt", "thermal.txt", "rig.textproto"};
  EXPECT_EQ(NearestName("dpeth.txt", names), "depth.txt");
  EXPECT_EQ(NearestName("Depth.TXT", names), "depth.txt");
  EXPECT_EQ(NearestName("velocity", names), "");
  EXPECT_EQ(NearestName("", names), "");
}

// Digits grouped with dots and a comma as the decimal sign, as in German.
class CommaDecimal final : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

class LocaleTest : public testing::Test {
 protected:
  LocaleTest() {
    const char* c_locale = nullptr;
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "de_DE", "tr_TR.UTF-8"}) {
      if (c_locale == nullptr) c_locale = std::setlocale(LC_ALL, name);
    }
    RecordProperty("c_locale", c_locale == nullptr ? "none installed" : c_locale);
    std::locale::global(std::locale(std::locale(), new CommaDecimal));
  }
  ~LocaleTest() override {
    std::locale::global(std::locale::classic());
    std::setlocale(LC_ALL, "C");
  }
};

TEST_F(LocaleTest, F70NumbersAreReadAndWrittenTheSameInAnyLocale) {
  const Result<Rig> rig = ParseRigCalibration(kRigText, "rig");
  ASSERT_TRUE(rig) << rig.error().message();
  EXPECT_DOUBLE_EQ(rig->depth->fx, 567.7);
  const std::string in_comma_locale = ToText(*rig);
  RigCalibration calibration;
  ASSERT_TRUE(ApplyOverride("depth_scale=1234.5", calibration).ok());
  const std::string scale = ToTextProto(calibration);
  std::locale::global(std::locale::classic());
  std::setlocale(LC_ALL, "C");
  EXPECT_EQ(in_comma_locale, ToText(*rig));
  EXPECT_EQ(scale, ToTextProto(calibration));
  EXPECT_THAT(scale, HasSubstr("depth_scale: 1234.5"));
}

TEST_F(LocaleTest, F70FileNamesWithSpacesUmlautsAndBytesOutsideUtf8Work) {
  for (const std::string name :
       {"mit leer zeichen.textproto", "ofent\xc3\xbcr.textproto", "latin1-\xfc.textproto"}) {
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / name;
    std::ofstream(path) << kRigText;
    const Result<Rig> rig = LoadRigCalibration(path);
    EXPECT_TRUE(rig) << rig.error().message();
    std::filesystem::remove(path);
    EXPECT_THAT(LoadRigCalibration(path).error().message(), HasSubstr(name));
  }
}

}  // namespace
}  // namespace isotherm

#include "common/options/text_proto.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <time.h>

#include <algorithm>
#include <clocale>
#include <filesystem>
#include <fstream>
#include <locale>

#include "common/options/override.h"
#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"
#include "common/rig/testing/rig_text.h"

namespace isotherm {
namespace {

using testing::HasSubstr;
using testing::Not;

int CountLines(const std::string& text) {
  return text.empty() ? 0 : 1 + static_cast<int>(std::count(text.begin(), text.end(), '\n'));
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
  const std::string text = kRigText;
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

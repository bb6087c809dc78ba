#include "common/transport/sample_validator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "common/transport/bounded_text.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinityF = std::numeric_limits<float>::infinity();

FrameFields GoodFrame() {
  return {.frame_number = 5,
          .capture_time_ns = 1'700'000'000'000'000'000,
          .capture_sigma_ns = 1000,
          .encoding = static_cast<std::uint8_t>(Encoding::kDepthRans),
          .width = 640,
          .height = 480,
          .payload_bytes = 130'000};
}

/// A good frame with one field changed by `change`.
template <typename Change>
std::optional<RefusalCause> CheckChanged(Change change) {
  FrameFields fields = GoodFrame();
  change(fields);
  return CheckFrame(fields);
}

TEST(SampleValidatorTest, F60GoodFrameIsAccepted) {
  EXPECT_EQ(CheckFrame(GoodFrame()), std::nullopt);
  EXPECT_EQ(CheckChanged([](auto& f) { f.capture_time_ns = 0; }), std::nullopt);
  EXPECT_EQ(CheckChanged([](auto& f) { f.width = f.height = 1, f.payload_bytes = 2; }),
            std::nullopt);
}

TEST(SampleValidatorTest, F60ImpossibleSizesAreRefused) {
  for (const std::uint32_t size : {0U, 16385U, 0xFFFFFFFFU}) {
    EXPECT_EQ(CheckChanged([=](auto& f) { f.width = size; }), RefusalCause::kImpossibleSize);
    EXPECT_EQ(CheckChanged([=](auto& f) { f.height = size; }), RefusalCause::kImpossibleSize);
  }
  // Each edge possible, the area not.
  EXPECT_EQ(CheckChanged([](auto& f) { f.width = 16384, f.height = 257; }),
            RefusalCause::kImpossibleSize);
  EXPECT_EQ(CheckChanged([](auto& f) { f.width = 16384, f.height = 256; }), std::nullopt);
}

TEST(SampleValidatorTest, F60PayloadsThatCannotBeAreRefused) {
  EXPECT_EQ(CheckChanged([](auto& f) { f.payload_bytes = 0; }), RefusalCause::kEmptyPayload);
  EXPECT_EQ(CheckChanged([](auto& f) { f.payload_bytes = kMaxPayloadBytes + 1; }),
            RefusalCause::kOversizePayload);
  constexpr std::size_t kMax = 640 * 480 * 4 + 4096;
  EXPECT_EQ(CheckChanged([](auto& f) { f.payload_bytes = kMax; }), std::nullopt);
  EXPECT_EQ(CheckChanged([](auto& f) { f.payload_bytes = kMax + 1; }),
            RefusalCause::kOversizePayload);
}

TEST(SampleValidatorTest, F60UnknownEncodingIsRefused) {
  const int next = static_cast<int>(kLastEncoding) + 1;
  EXPECT_EQ(CheckChanged([&](auto& f) { f.encoding = static_cast<std::uint8_t>(next); }),
            RefusalCause::kUnknownEncoding);
  EXPECT_EQ(CheckChanged([](auto& f) { f.encoding = 255; }), RefusalCause::kUnknownEncoding);
}

TEST(SampleValidatorTest, F60NegativeTimesAreRefused) {
  EXPECT_EQ(CheckChanged([](auto& f) { f.capture_time_ns = -1; }), RefusalCause::kNegativeTime);
  EXPECT_EQ(CheckChanged([](auto& f) { f.capture_sigma_ns = -1; }), RefusalCause::kNegativeTime);
}

TEST(SampleValidatorTest, F60ImpossibleFrameNumberIsRefused) {
  EXPECT_EQ(CheckChanged([](auto& f) { f.frame_number = kMaxFrameNumber + 1; }),
            RefusalCause::kImpossibleNumber);
  EXPECT_EQ(CheckChanged([](auto& f) { f.frame_number = ~0ULL; }), RefusalCause::kImpossibleNumber);
}

TEST(SampleValidatorTest, F60DepthScaleMustBeANumberThatCanBe) {
  EXPECT_EQ(CheckDepthScale(1000.0), std::nullopt);
  EXPECT_EQ(CheckDepthScale(kNan), RefusalCause::kNotFinite);
  EXPECT_EQ(CheckDepthScale(kInfinity), RefusalCause::kNotFinite);
  EXPECT_EQ(CheckDepthScale(0.0), RefusalCause::kOutOfRange);
  EXPECT_EQ(CheckDepthScale(-1.0), RefusalCause::kOutOfRange);
}

TEST(SampleValidatorTest, F60ThermalHousekeeping) {
  EXPECT_EQ(CheckThermal({}), std::nullopt);
  EXPECT_EQ(CheckThermal({.nuc_state = 8}), RefusalCause::kUnknownValue);
  EXPECT_EQ(CheckThermal({.nuc_source = 5}), RefusalCause::kUnknownValue);
  EXPECT_EQ(CheckThermal({.has_seconds_since_nuc = true, .seconds_since_nuc = kNan}),
            RefusalCause::kNotFinite);
  EXPECT_EQ(CheckThermal({.has_seconds_since_nuc = false, .seconds_since_nuc = kNan}),
            std::nullopt);
  EXPECT_EQ(CheckThermal({.has_seconds_since_nuc = true, .seconds_since_nuc = -0.1}),
            RefusalCause::kOutOfRange);
  EXPECT_EQ(CheckThermal({.fpa_celsius = kNanF}), std::nullopt);  // The camera does not say.
  EXPECT_EQ(CheckThermal({.fpa_celsius = kInfinityF}), RefusalCause::kNotFinite);
  EXPECT_EQ(CheckThermal({.housing_celsius = -kInfinityF}), RefusalCause::kNotFinite);
  EXPECT_EQ(CheckThermal({.shutter_celsius = -274.0F}), RefusalCause::kOutOfRange);
}

TEST(SampleValidatorTest, F56ARigWithoutCalibrationMayBeAnnounced) {
  Rig rig;
  EXPECT_EQ(CheckRig(rig), std::nullopt);
  rig.thermal_delay_s = kNan;
  EXPECT_EQ(CheckRig(rig), RefusalCause::kNotFinite);
  rig = {};
  rig.depth.emplace();  // Intrinsics are NaN until they are given.
  EXPECT_EQ(CheckRig(rig), RefusalCause::kOutOfRange);
}

TEST(SampleValidatorTest, F60ReceiptMustFitTogether) {
  const StreamReceipt good{.next = 10, .handled = 10, .received = 7, .holes = {{2, 3}, {5, 5}}};
  EXPECT_EQ(CheckStreamReceipt(good), std::nullopt);
  StreamReceipt bad = good;
  bad.handled = 11;
  EXPECT_EQ(CheckStreamReceipt(bad), RefusalCause::kImpossibleNumber);
  bad = good;
  bad.holes = {{5, 5}, {2, 3}};
  EXPECT_EQ(CheckStreamReceipt(bad), RefusalCause::kImpossibleNumber);
  bad.holes = {{3, 2}};
  EXPECT_EQ(CheckStreamReceipt(bad), RefusalCause::kImpossibleNumber);
  bad.holes = {{9, 10}};
  EXPECT_EQ(CheckStreamReceipt(bad), RefusalCause::kImpossibleNumber);
}

TEST(SampleValidatorTest, F60FeedbackMustBeFinite) {
  Feedback feedback;
  EXPECT_EQ(CheckFeedback(feedback), std::nullopt);
  feedback.view.good = 1.5F;
  EXPECT_EQ(CheckFeedback(feedback), RefusalCause::kOutOfRange);
  feedback = {};
  feedback.covered_area_m2 = kNan;
  EXPECT_EQ(CheckFeedback(feedback), RefusalCause::kNotFinite);
  feedback = {};
  feedback.capture_time = CaptureTimeFromNanoseconds(-5);
  EXPECT_EQ(CheckFeedback(feedback), RefusalCause::kNegativeTime);
  feedback = {};
  feedback.pose_covariance = PoseCovariance::Identity();
  EXPECT_EQ(CheckFeedback(feedback), std::nullopt);
  (*feedback.pose_covariance)(4, 4) = kNan;
  EXPECT_EQ(CheckFeedback(feedback), RefusalCause::kNotFinite);
  (*feedback.pose_covariance)(4, 4) = -1.0;
  EXPECT_EQ(CheckFeedback(feedback), RefusalCause::kOutOfRange);
}

TEST(RefusalCounterTest, F60EachCauseIsCountedAndLoggedWithALimit) {
  RefusalCounter counter;
  ::testing::internal::CaptureStderr();
  for (int i = 0; i < 100; ++i) counter.Add(RefusalCause::kNegativeTime, "frame_number=1");
  counter.Add(RefusalCause::kNotFinite, "frame_number=2");
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(counter.count(RefusalCause::kNegativeTime), 100U);
  EXPECT_EQ(counter.total(), 101U);
  EXPECT_EQ(std::ranges::count(log, '\n'), 2);
  EXPECT_THAT(log, HasSubstr("negative time (frame_number=1)"));
}

TEST(RefusalCounterTest, AStreamsCounterAddsToTheWhole) {
  RefusalCounter all;
  RefusalCounter depth(&all);
  RefusalCounter thermal(&all);
  depth.Add(RefusalCause::kNegativeTime, "");
  thermal.Add(RefusalCause::kNegativeTime, "");
  EXPECT_EQ(depth.count(RefusalCause::kNegativeTime), 1U);
  EXPECT_EQ(all.count(RefusalCause::kNegativeTime), 2U);
}

TEST(BoundedTextTest, TextIsCutBetweenCharacters) {
  EXPECT_EQ(CutText("abc", 3), "abc");
  EXPECT_EQ(CutText("abcd", 3), "abc");
  EXPECT_EQ(CutText("a\u00e9", 2), "a");  // The two bytes of é do not fit.
  EXPECT_EQ(CutText("\u20ac", 2), "");
}

TEST(BoundedTextTest, ControlCharactersOfAPeerDoNotReachTheLog) {
  char text[16] = "a\nb\x1b[2J";
  EXPECT_EQ(ReadText(text), "a?b?[2J");
  char full[3] = {'a', 'b', 'c'};  // Without an end.
  EXPECT_EQ(ReadText(full), "abc");
}

TEST(HelloTest, AMajorDifferenceNamesTheSideToUpdate) {
  const Hello ground{
      .role = Role::kGround, .wire_major = 2, .software_version = "2.0", .host = "desk"};
  const Hello edge{
      .role = Role::kEdge, .wire_major = 1, .software_version = "1.4", .host = "drone"};
  const Status status = CheckCompatible(ground, edge);
  EXPECT_EQ(status.code(), StatusCode::kFailedPrecondition);
  EXPECT_THAT(status.message(), HasSubstr("update the edge"));
  EXPECT_THAT(status.message(), HasSubstr("drone"));
  EXPECT_EQ(CheckCompatible(edge, ground).message().ends_with("update the edge"), true);
}

TEST(HelloTest, AMinorDifferenceIsFine) {
  EXPECT_TRUE(CheckCompatible({.wire_minor = 0}, {.wire_minor = 7}).ok());
}

}  // namespace
}  // namespace isotherm

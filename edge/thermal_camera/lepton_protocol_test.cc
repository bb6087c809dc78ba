#include "edge/thermal_camera/lepton_protocol.h"

#include <gtest/gtest.h>

#include <vector>

namespace isotherm {
namespace {

constexpr int kWidth = 160;
constexpr int kHeight = 120;

/// A frame with words set by their row and number, as the datasheet names them.
class LeptonFrameData {
 public:
  LeptonFrameData() : bytes_(2 * kWidth * (kHeight + 2)) {}
  void Word(char row, int number, std::uint16_t value) {
    const int index = kWidth * kHeight + 80 * (row - 'A') + number;
    PutLe16(bytes_, 2 * static_cast<std::size_t>(index), value);
  }
  void Pixel(int x, int y, std::uint16_t value) {
    PutLe16(bytes_, 2 * static_cast<std::size_t>(y * kWidth + x), value);
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  std::vector<std::uint8_t> bytes_;
};

TEST(LeptonProtocolTest, ReadsTheWordsOfTheDatasheet) {
  LeptonFrameData data;
  data.Pixel(0, 0, 29'815);
  data.Pixel(159, 119, 31'000);
  data.Word('A', 1, 0x5678);  // Uptime, low word first.
  data.Word('A', 2, 0x1234);
  data.Word('A', 3, 0x8038);  // Status: FFC desired, state 3, shutter locked out.
  data.Word('A', 20, 7);
  data.Word('A', 21, 1);
  data.Word('A', 24, 30'815);
  data.Word('A', 26, 30'315);
  data.Word('A', 30, 0x0001);
  data.Word('A', 31, 0x1234);
  data.Word('C', 48, 1);
  data.Word('C', 49, 1);
  const Result<LeptonFrame> frame = ParseLeptonFrame(data.bytes(), kWidth, kHeight);
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->counts.At(0, 0), 29'815);
  EXPECT_EQ(frame->counts.At(159, 119), 31'000);
  EXPECT_EQ(frame->telemetry.uptime_ms, 0x12345678U);
  EXPECT_EQ(frame->telemetry.uptime_at_ffc_ms, 0x12340001U);
  EXPECT_EQ(frame->telemetry.frame_counter, 65'543U);
  EXPECT_EQ(frame->telemetry.fpa_centikelvin, 30'815);
  EXPECT_EQ(frame->telemetry.housing_centikelvin, 30'315);
  EXPECT_TRUE(frame->telemetry.ffc_desired);
  EXPECT_EQ(frame->telemetry.ffc_state, 3);
  EXPECT_TRUE(frame->telemetry.shutter_locked_out);
}

TEST(LeptonProtocolTest, EveryOtherSizeIsRefused) {
  const LeptonFrameData data;
  for (std::size_t length = 0; length < data.bytes().size(); ++length) {
    ASSERT_FALSE(ParseLeptonFrame(Bytes(data.bytes()).first(length), kWidth, kHeight).has_value());
  }
}

TEST(LeptonProtocolTest, SmallLeptonHasThreeRowsOfTelemetry) {
  std::vector<std::uint8_t> bytes(2 * 80 * 63);
  PutLe16(bytes, 2 * (80 * 60 + 24), 30'000);
  const Result<LeptonFrame> frame = ParseLeptonFrame(bytes, 80, 60);
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->telemetry.fpa_centikelvin, 30'000);
}

TEST(LeptonProtocolTest, EncodingFollowsTheTelemetry) {
  LeptonTelemetry telemetry;
  EXPECT_FALSE(LeptonEncoding(telemetry).radiometric);
  telemetry.tlinear = true;
  EXPECT_EQ(LeptonEncoding(telemetry).kelvin_per_count, 0.1);
  telemetry.fine_resolution = true;
  EXPECT_EQ(LeptonEncoding(telemetry).kelvin_per_count, 0.01);
}

TEST(LeptonProtocolTest, StatesOfCorrection) {
  LeptonTelemetry telemetry;
  telemetry.uptime_ms = 5'000;
  telemetry.uptime_at_ffc_ms = 2'000;
  const auto state = [&telemetry](int ffc_state) {
    telemetry.ffc_state = static_cast<std::uint8_t>(ffc_state);
    return LeptonNuc(telemetry).state;
  };
  EXPECT_EQ(state(0), NucState::kUnknown);
  EXPECT_EQ(state(1), NucState::kImminent);
  EXPECT_EQ(state(2), NucState::kInProgress);
  EXPECT_EQ(state(3), NucState::kIdle);
  EXPECT_EQ(LeptonNuc(telemetry).source, NucSource::kInBand);
  EXPECT_DOUBLE_EQ(*LeptonNuc(telemetry).seconds_since, 3.0);
  telemetry.ffc_desired = true;
  EXPECT_EQ(state(3), NucState::kDesired);
  telemetry.shutter_locked_out = true;
  EXPECT_EQ(state(3), NucState::kBlocked);
}

}  // namespace
}  // namespace isotherm

#include "edge/thermal_camera/infiray_protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using testing::ElementsAre;

constexpr std::size_t kFrameBytes = 256 * 384 * 2;

TEST(P2ProProtocolTest, TemperaturesAreTheLowerHalf) {
  std::vector<std::uint8_t> bytes(kFrameBytes, 0xEE);
  PutLe16(bytes, 2 * 256 * 192, 19'082);
  PutLe16(bytes, kFrameBytes - 2, 20'000);
  const auto counts = ParseP2ProFrame(bytes);
  ASSERT_TRUE(counts.has_value());
  EXPECT_EQ(counts->width(), 256);
  EXPECT_EQ(counts->height(), 192);
  EXPECT_EQ(counts->At(0, 0), 19'082);
  EXPECT_EQ(counts->At(255, 191), 20'000);
  // 19082 / 64 K = 25.006 degrees Celsius.
  EXPECT_NEAR(kInfirayEncoding.kelvin_per_count * 19'082, 298.156, 0.001);
}

TEST(P2ProProtocolTest, EveryTruncationIsRefused) {
  const std::vector<std::uint8_t> bytes(kFrameBytes);
  for (std::size_t length = 0; length < kFrameBytes; ++length) {
    ASSERT_FALSE(ParseP2ProFrame(Bytes(bytes).first(length)).has_value()) << length;
  }
}

TEST(P2ProProtocolTest, ColdStartIsUniform) {
  Image<std::uint16_t> counts(256, 192, 0x8000);
  EXPECT_TRUE(IsP2ProColdStart(counts));
  counts.At(3, 3) = 0x8001;
  EXPECT_FALSE(IsP2ProColdStart(counts));
}

TEST(P2ProProtocolTest, CommandsHaveTheLayoutOfTheViewer) {
  EXPECT_THAT(PackP2ProCommand(0x8405, 0x01020304, 8), ElementsAre(0x05, 0x84, 1, 2, 3, 4, 0, 8));
  const P2ProLongCommand command = PackP2ProLongCommand(0xC514, 3, 127);
  EXPECT_THAT(command.first, ElementsAre(0x14, 0xC5, 0, 3, 0, 0, 0, 127));
  EXPECT_THAT(command.second, ElementsAre(0, 0, 0, 0, 0, 0, 0, 0));
}

TEST(P2ProProtocolTest, QuestionsHaveTheLayoutOfTheViewerAndTwoBytesOfAnswer) {
  const P2ProLongCommand question = PackP2ProQuestion(0x8514, 5);
  EXPECT_THAT(question.first, ElementsAre(0x14, 0x85, 0, 5, 0, 0, 0, 0));
  EXPECT_THAT(question.second, ElementsAre(0, 0, 0, 0, 0, 0, 0, 2));
  const std::vector<std::uint8_t> answer = {0x01, 0x02};
  EXPECT_EQ(*ParseP2ProAnswer(answer), 0x0102);
  EXPECT_FALSE(ParseP2ProAnswer(Bytes(answer).first(1)).has_value());
  EXPECT_FALSE(ParseP2ProAnswer({}).has_value());
}

TEST(P2ProProtocolTest, StatusByte) {
  EXPECT_EQ(ParseP2ProStatus(0x00), P2ProStatus::kReady);
  EXPECT_EQ(ParseP2ProStatus(0x01), P2ProStatus::kBusy);
  EXPECT_EQ(ParseP2ProStatus(0x02), P2ProStatus::kBusy);
  EXPECT_EQ(ParseP2ProStatus(0x05), P2ProStatus::kError);
}

TEST(PolledShutterTest, SaysWhatItKnowsAndHow) {
  const SteadyTime start{};
  PolledShutter shutter;
  EXPECT_FALSE(shutter.At(start).has_value());
  shutter.NoteOrder(start);
  EXPECT_EQ(shutter.At(start + milliseconds(500))->source, NucSource::kCommanded);
  EXPECT_EQ(shutter.At(start + milliseconds(500))->state, NucState::kInProgress);
  EXPECT_FALSE(shutter.At(start + milliseconds(1500)).has_value());
  shutter.NoteState(true, start + milliseconds(1500));
  EXPECT_EQ(shutter.At(start + milliseconds(1600))->source, NucSource::kPolled);
  EXPECT_EQ(shutter.At(start + milliseconds(1600))->state, NucState::kInProgress);
  shutter.NoteState(false, start + milliseconds(2000));
  EXPECT_EQ(shutter.At(start + milliseconds(2500))->state, NucState::kIdle);
  EXPECT_DOUBLE_EQ(*shutter.At(start + milliseconds(2500))->seconds_since, 1.0);
  shutter.ForgetState();
  EXPECT_FALSE(shutter.At(start + milliseconds(2500)).has_value());
}

}  // namespace
}  // namespace isotherm

#include "edge/thermal_camera/seek_protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace isotherm {
namespace {

using Data = std::vector<std::uint8_t>;
using testing::ElementsAre;
using testing::HasSubstr;

/// A frame whose words are their own index, but for those that say what it is.
Data FrameOf(const SeekModel& model, std::uint16_t id, std::uint16_t counter) {
  Data bytes(model.frame_bytes());
  for (std::size_t i = 0; i < model.words(); ++i) {
    PutLe16(bytes, 2 * i, static_cast<std::uint16_t>(i));
  }
  PutLe16(bytes, 2 * model.id_word, id);
  PutLe16(bytes, 2 * model.counter_word, counter);
  return bytes;
}

TEST(SeekProtocolTest, FramesAreWholeMultiplesOfReads) {
  EXPECT_EQ(kSeekCompact.frame_bytes(), 4U * 16'224U);
  EXPECT_EQ(kSeekCompactPro.frame_bytes(), 13U * 13'680U);
}

TEST(SeekProtocolTest, ImageOfACompactBeginsInTheSecondRow) {
  const auto frame = ParseSeekFrame(FrameOf(kSeekCompact, 3, 777), kSeekCompact);
  ASSERT_TRUE(frame.has_value()) << frame.error().message();
  EXPECT_EQ(frame->kind, SeekFrameKind::kImage);
  EXPECT_EQ(frame->counter, 777);
  EXPECT_EQ(frame->raw.width(), 207);
  EXPECT_EQ(frame->raw.height(), 154);
  EXPECT_EQ(frame->raw.At(0, 0), 208);
  EXPECT_EQ(frame->raw.At(206, 153), 208 * 154 + 206);
}

TEST(SeekProtocolTest, ImageOfACompactProLiesWithinMargins) {
  const auto frame = ParseSeekFrame(FrameOf(kSeekCompactPro, 4, 1), kSeekCompactPro);
  ASSERT_TRUE(frame.has_value()) << frame.error().message();
  EXPECT_EQ(frame->kind, SeekFrameKind::kFirst);
  EXPECT_EQ(frame->raw.width(), 320);
  EXPECT_EQ(frame->raw.height(), 240);
  EXPECT_EQ(frame->raw.At(0, 0), 4 * 342 + 1);
  // 83426 does not fit 16 bits.
  EXPECT_EQ(frame->raw.At(319, 239), (243 * 342 + 320) & 0xFFFF);
}

TEST(SeekProtocolTest, KindsFollowFromTheId) {
  const auto kind = [](int id) {
    const Data bytes = FrameOf(kSeekCompact, static_cast<std::uint16_t>(id), 0);
    return ParseSeekFrame(bytes, kSeekCompact)->kind;
  };
  EXPECT_EQ(kind(1), SeekFrameKind::kShutter);
  for (const int id : {0, 2, 5, 6, 8, 0x55, 0x0301}) {
    EXPECT_EQ(kind(id), SeekFrameKind::kOther) << id;
  }
}

TEST(SeekProtocolTest, EveryTruncationIsRefused) {
  const Data bytes = FrameOf(kSeekCompact, 3, 1);
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    ASSERT_FALSE(ParseSeekFrame(Bytes(bytes).first(length), kSeekCompact).has_value()) << length;
  }
  const Data longer(bytes.size() + 1);
  EXPECT_THAT(ParseSeekFrame(longer, kSeekCompact).error().message(),
              HasSubstr("64897 bytes instead of 64896"));
}

TEST(SeekProtocolTest, StartOfACompactIsAsPublished) {
  const std::vector<SeekRequest> requests = SeekStartRequests(kSeekCompact);
  const std::vector<SeekRequest> expected = {{60, {0, 0}, 0}, {78, {}, 4},
                                             {54, {}, 12},    {86, {0x20, 0, 0x30, 0, 0, 0}, 0},
                                             {88, {}, 64},    {86, {0x20, 0, 0x50, 0, 0, 0}, 0},
                                             {88, {}, 64},    {86, {0x0C, 0, 0x70, 0, 0, 0}, 0},
                                             {88, {}, 24},    {86, {6, 0, 8, 0, 0, 0}, 0},
                                             {88, {}, 12},    {62, {8, 0}, 0},
                                             {61, {}, 2},     {62, {8, 0}, 0},
                                             {60, {1, 0}, 0}, {61, {}, 2}};
  EXPECT_EQ(requests, expected);
  EXPECT_EQ(SeekWakeRequest(), (SeekRequest{84, {1}, 0}));
  EXPECT_EQ(SeekSleepRequest(), (SeekRequest{60, {0, 0}, 0}));
}

TEST(SeekProtocolTest, StartOfACompactProReadsItsFactorySettings) {
  const std::vector<SeekRequest> requests = SeekStartRequests(kSeekCompactPro);
  const auto settings = std::count_if(requests.begin(), requests.end(), [](const auto& request) {
    return request.opcode == 88 && request.answer_bytes == 64;
  });
  EXPECT_EQ(settings, 80);                                     // 0 to 2560 in steps of 32.
  const SeekRequest last{86, {0x20, 0, 0xE0, 0x09, 0, 0}, 0};  // 2528.
  EXPECT_NE(std::find(requests.begin(), requests.end(), last), requests.end());
  const SeekRequest features{85, {0x17, 0}, 0};
  EXPECT_NE(std::find(requests.begin(), requests.end(), features), requests.end());
  EXPECT_EQ(requests.back(), (SeekRequest{60, {1, 0}, 0}));
}

TEST(SeekProtocolTest, FramesAreAskedForInWords) {
  EXPECT_EQ(SeekFrameRequest(kSeekCompact).opcode, 83);
  EXPECT_THAT(SeekFrameRequest(kSeekCompact).data, ElementsAre(0xC0, 0x7E, 0, 0));     // 32448.
  EXPECT_THAT(SeekFrameRequest(kSeekCompactPro).data, ElementsAre(0x58, 0x5B, 1, 0));  // 88920.
}

TEST(SeekAssemblerTest, JoinsReadsOfAnySizeAndStampsTheFirst) {
  const auto at = [](int ms) {
    return HostStamp{CaptureTime(std::chrono::milliseconds(ms)),
                     SteadyTime(std::chrono::milliseconds(ms))};
  };
  SeekAssembler assembler(kSeekCompact);
  assembler.Add({}, at(1));
  EXPECT_EQ(assembler.wanted_bytes(), 16'224U);
  const Data bytes = FrameOf(kSeekCompact, 3, 9);
  assembler.Add(Bytes(bytes).first(100), at(2));
  EXPECT_EQ(assembler.wanted_bytes(), 16'224U);
  assembler.Add(Bytes(bytes).subspan(100, 60'000), at(3));
  EXPECT_EQ(assembler.wanted_bytes(), 64'896U - 60'100U);
  assembler.Add(Bytes(bytes).subspan(60'100), at(4));
  EXPECT_EQ(assembler.wanted_bytes(), 0U);
  EXPECT_EQ(assembler.first_stamp().steady, at(2).steady);
  EXPECT_TRUE(std::ranges::equal(assembler.bytes(), bytes));
  assembler.Begin();
  EXPECT_TRUE(assembler.is_empty());
  EXPECT_EQ(assembler.wanted_bytes(), 16'224U);
}

/// 6 x 5 detectors that see 1000 counts, but for those that a test darkens.
class SeekImageMakerTest : public testing::Test {
 protected:
  SeekRawFrame Frame(SeekFrameKind kind, std::uint16_t value) const {
    SeekRawFrame frame;
    frame.kind = kind;
    frame.counter = 42;
    frame.raw = Image<std::uint16_t>(6, 5, value);
    return frame;
  }
  std::optional<SeekImage> Process(SeekRawFrame frame) {
    const Result<std::optional<SeekImage>> image = maker_.Process(std::move(frame));
    EXPECT_TRUE(image.has_value()) << image.error().message();
    return image ? *image : std::nullopt;
  }
  SeekImageMaker maker_;
};

TEST_F(SeekImageMakerTest, RenderingsAreMeasuredAgainstTheLastFrameOfTheShutter) {
  EXPECT_FALSE(Process(Frame(SeekFrameKind::kFirst, 1'000)).has_value());
  EXPECT_FALSE(Process(Frame(SeekFrameKind::kOther, 900)).has_value());
  EXPECT_FALSE(Process(Frame(SeekFrameKind::kImage, 900)).has_value());  // Against what?
  const auto shutter = Process(Frame(SeekFrameKind::kShutter, 800));
  ASSERT_TRUE(shutter.has_value());
  EXPECT_TRUE(shutter->shutter_closed);
  EXPECT_EQ(shutter->counts.At(2, 2), 0x4000);
  SeekRawFrame warm = Frame(SeekFrameKind::kImage, 800);
  warm.raw.At(3, 1) = 850;
  warm.raw.At(4, 1) = 790;
  const auto image = Process(std::move(warm));
  ASSERT_TRUE(image.has_value());
  EXPECT_FALSE(image->shutter_closed);
  EXPECT_EQ(image->counter, 42);
  EXPECT_EQ(image->counts.At(0, 0), 0x4000);
  EXPECT_EQ(image->counts.At(3, 1), 0x4000 + 50);
  EXPECT_EQ(image->counts.At(4, 1), 0x4000 - 10);
  // The shutter has become warmer: shown against the one before, and used from now on.
  EXPECT_EQ(Process(Frame(SeekFrameKind::kShutter, 810))->counts.At(2, 2), 0x4000 + 10);
  EXPECT_EQ(Process(Frame(SeekFrameKind::kImage, 810))->counts.At(2, 2), 0x4000);
}

TEST_F(SeekImageMakerTest, CountsStayWithinSixteenBitsAndZeroIsNoValue) {
  Process(Frame(SeekFrameKind::kFirst, 1'000));
  Process(Frame(SeekFrameKind::kShutter, 40'000));
  EXPECT_EQ(Process(Frame(SeekFrameKind::kImage, 100))->counts.At(0, 0), 1);
  Process(Frame(SeekFrameKind::kShutter, 100));
  EXPECT_EQ(Process(Frame(SeekFrameKind::kImage, 65'000))->counts.At(0, 0), 0xFFFF);
}

TEST_F(SeekImageMakerTest, DeadDetectorsShowTheMeanOfTheirNeighbours) {
  SeekRawFrame first = Frame(SeekFrameKind::kFirst, 1'000);
  first.raw.At(5, 0) = 1'030;  // The largest: 30 above the most frequent value, ...
  first.raw.At(2, 3) = 969;    // ... so that more than 30 below it is dead.
  first.raw.At(4, 3) = 970;
  Process(std::move(first));
  Process(Frame(SeekFrameKind::kShutter, 0));
  SeekRawFrame image = Frame(SeekFrameKind::kImage, 5'000);
  image.raw.At(1, 3) = 10;
  image.raw.At(3, 3) = 20;
  image.raw.At(2, 2) = 30;
  image.raw.At(2, 4) = 40;
  const auto counts = Process(std::move(image))->counts;
  EXPECT_EQ(counts.At(2, 3), 0x4000 + 25);
  EXPECT_EQ(counts.At(4, 3), 0x4000 + 5'000);
}

TEST_F(SeekImageMakerTest, DeadDetectorsAmidOthersAreFilledFromTheOutside) {
  SeekRawFrame first = Frame(SeekFrameKind::kFirst, 1'000);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 3; ++x) first.raw.At(x, y) = 0;
  }
  Process(std::move(first));
  Process(Frame(SeekFrameKind::kShutter, 0));
  SeekRawFrame image = Frame(SeekFrameKind::kImage, 100);
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 3; ++x) image.raw.At(x, y) = 9'999;
  }
  const auto counts = Process(std::move(image))->counts;
  for (const std::uint16_t count : counts.pixels()) EXPECT_EQ(count, 0x4000 + 100);
}

TEST_F(SeekImageMakerTest, WithoutAFirstFrameThereAreNoImages) {
  const auto refused = maker_.Process(Frame(SeekFrameKind::kImage, 900));
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().code(), StatusCode::kDataLoss);
  // Mostly dark: that is not what the camera's first frame looks like.
  SeekRawFrame dark = Frame(SeekFrameKind::kFirst, 0);
  dark.raw.At(1, 1) = 1'000;
  EXPECT_THAT(maker_.Process(std::move(dark)).error().message(), HasSubstr("29 of 30"));
}

}  // namespace
}  // namespace isotherm

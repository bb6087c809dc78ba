#include "edge/source/replay_source.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <vector>

#include "common/codec/codec.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr CaptureTime kRecordedStart{seconds(1'600'000'000)};
constexpr CaptureTime kNow{seconds(1'700'000'000)};
constexpr Nanoseconds kNoPause{0};
/// The camera's counter said this at kRecordedStart, and a frame took this long to arrive.
constexpr microseconds kTicksAtStart{5'000'000};
constexpr milliseconds kTransport{40};

std::filesystem::path NewPath() {
  static int count = 0;
  const std::string name =
      "isotherm_replay_" + std::to_string(getpid()) + "_" + std::to_string(count++);
  return std::filesystem::path(testing::TempDir()) / (name + ".mcap");
}

class ReplaySourceTest : public testing::Test {
 protected:
  ReplaySourceTest() {
    options_.set_rate(0);
    auto writer = RecordingWriter::Create(path_, {});
    EXPECT_TRUE(writer.has_value());
    writer_ = std::move(*writer);
  }
  ~ReplaySourceTest() override { std::filesystem::remove(path_); }

  FrameHeader Header(Nanoseconds time, bool stamped_by_edge) {
    FrameHeader header;
    header.capture_time = kRecordedStart + time;
    if (stamped_by_edge) {
      header.device_ticks = DeviceTicks(kTicksAtStart + std::chrono::floor<microseconds>(time));
    }
    return header;
  }
  std::optional<CaptureTime> Arrival(Nanoseconds time, bool stamped_by_edge) {
    if (!stamped_by_edge) return std::nullopt;
    return kRecordedStart + time + kTransport;
  }
  void WriteDepth(Nanoseconds time, bool stamped_by_edge = true) {
    EncodedDepthFrame frame;
    frame.header = Header(time, stamped_by_edge);
    frame.image = DepthEncoder().Encode(Image<std::uint16_t>(8, 6, 700));
    frame.depth_scale = 5000.0;
    ASSERT_TRUE(writer_->Write(frame, Arrival(time, stamped_by_edge)).ok());
  }
  void WriteThermal(Nanoseconds time, NucState state = NucState::kUnknown) {
    EncodedThermalFrame frame;
    frame.header = Header(time, true);
    frame.image = ThermalEncoder().Encode(Image<std::uint16_t>(6, 4, 29'815), kCentikelvin);
    frame.nuc_state = state;
    frame.housekeeping.housing_celsius = 31.5F;
    ASSERT_TRUE(writer_->Write(frame, Arrival(time, true)).ok());
  }

  /// Opens the finished recording.
  ReplaySource& Open() {
    EXPECT_TRUE(writer_->Close().ok());
    source_ = std::make_unique<ReplaySource>(options_, path_, clock_, kNoPause);
    const Status opened = source_->Open();
    EXPECT_TRUE(opened.ok()) << opened.message();
    return *source_;
  }
  /// All frames to the end, without pacing.
  std::vector<RawFrame> ReadAll() {
    std::vector<RawFrame> frames;
    while (true) {
      Result<SourceItem> item = source_->Read({});
      EXPECT_TRUE(item.has_value());
      if (!item || std::holds_alternative<EndOfStream>(*item)) return frames;
      if (auto* frame = std::get_if<RawFrame>(&*item)) frames.push_back(std::move(*frame));
    }
  }
  bool FrameIsDue() {
    const Result<SourceItem> item = source_->Read({});
    return item && std::holds_alternative<RawFrame>(*item);
  }

  const std::filesystem::path path_ = NewPath();
  SourceOptions options_;
  FakeClock clock_{kNow};
  std::unique_ptr<RecordingWriter> writer_;
  std::unique_ptr<ReplaySource> source_;
};

TEST_F(ReplaySourceTest, F65TimesThatNoScanHasAreLeftOut) {
  WriteDepth(milliseconds(0), /*stamped_by_edge=*/false);
  WriteDepth(std::chrono::hours(24 * 365 * 60), /*stamped_by_edge=*/false);
  WriteDepth(milliseconds(33), /*stamped_by_edge=*/false);
  options_.set_loops(3);
  Open();
  EXPECT_EQ(ReadAll().size(), 6U) << "two of three frames, three times";
}

TEST_F(ReplaySourceTest, OdometryPosesComeBetweenFramesOnTheirTimeLine) {
  options_.set_rate(1);
  const auto write = [&](Nanoseconds time) {
    ExternalOdometry pose;
    pose.source = "vio";
    pose.time = kRecordedStart + time;
    pose.translation_m.x() = ToSeconds(time);
    ASSERT_TRUE(writer_->Write(pose).ok());
  };
  WriteDepth(milliseconds(0), /*stamped_by_edge=*/false);
  write(milliseconds(10));
  write(milliseconds(20));
  WriteDepth(milliseconds(33), /*stamped_by_edge=*/false);
  Open();
  std::vector<std::pair<char, CaptureTime>> seen;
  for (int i = 0; i < 40; ++i) {
    const Result<SourceItem> item = source_->Read({});
    ASSERT_TRUE(item.has_value());
    if (const auto* frame = std::get_if<RawFrame>(&*item))
      seen.emplace_back('f', frame->arrival_wall);
    if (const auto* pose = std::get_if<ExternalOdometry>(&*item)) {
      EXPECT_EQ(pose->source, "vio");
      seen.emplace_back('p', pose->time);
    }
    clock_.Advance(milliseconds(1));
  }
  const std::vector<std::pair<char, CaptureTime>> expected = {{'f', kNow},
                                                              {'p', kNow + milliseconds(10)},
                                                              {'p', kNow + milliseconds(20)},
                                                              {'f', kNow + milliseconds(33)}};
  EXPECT_EQ(seen, expected) << "rebased as the frames are";
}

TEST_F(ReplaySourceTest, DeliversBothSensorsInOrderAsTheyWereRecorded) {
  WriteDepth(milliseconds(0));
  WriteThermal(milliseconds(7));
  WriteDepth(milliseconds(33));
  Open();
  const std::vector<RawFrame> frames = ReadAll();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].sensor, Sensor::kDepth);
  EXPECT_EQ(frames[0].pixels, Image<std::uint16_t>(8, 6, 700));
  EXPECT_EQ(frames[0].depth_scale, 5000.0);
  EXPECT_EQ(frames[1].sensor, Sensor::kThermal);
  EXPECT_EQ(frames[1].pixels, Image<std::uint16_t>(6, 4, 29'815));
  EXPECT_EQ(frames[1].housekeeping.housing_celsius, 31.5F);
  EXPECT_EQ(frames[1].frame_number, 0U) << "each sensor counts its own frames";
  EXPECT_EQ(frames[2].frame_number, 1U);
}

TEST_F(ReplaySourceTest, CountsAreNotPlayedAsTemperatures) {
  WriteDepth(milliseconds(0));
  EncodedThermalFrame counts;
  counts.header = Header(milliseconds(7), true);
  counts.image = PackCounts(Image<std::uint16_t>(6, 4, 16'384));
  ASSERT_TRUE(writer_->Write(counts, Arrival(milliseconds(7), true)).ok());
  WriteDepth(milliseconds(33));
  Open();
  const std::vector<RawFrame> frames = ReadAll();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].sensor, Sensor::kDepth);
  EXPECT_EQ(frames[1].sensor, Sensor::kDepth);
}

TEST_F(ReplaySourceTest, TicksAndArrivalAreThoseRecorded) {
  WriteDepth(milliseconds(0));
  WriteDepth(milliseconds(33));
  Open();
  const std::vector<RawFrame> frames = ReadAll();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[1].device_ticks, DeviceTicks(kTicksAtStart + milliseconds(33)));
  EXPECT_EQ(frames[1].arrival_wall, kRecordedStart + milliseconds(33) + kTransport);
}

TEST_F(ReplaySourceTest, FramesWithoutArrivalGetTicksAndArrivalEqualToTheirCaptureTime) {
  constexpr bool kImported = false;
  WriteDepth(Nanoseconds(33'333'777), kImported);
  Open();
  const std::vector<RawFrame> frames = ReadAll();
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].arrival_wall, kRecordedStart + microseconds(33'333));
  EXPECT_EQ(frames[0].arrival_wall.time_since_epoch(), frames[0].device_ticks.time_since_epoch());
}

TEST_F(ReplaySourceTest, RealTimeWaitsForTheClock) {
  options_.set_rate(1);
  WriteDepth(milliseconds(0));
  WriteDepth(milliseconds(33));
  Open();
  EXPECT_TRUE(FrameIsDue());
  EXPECT_FALSE(FrameIsDue());
  clock_.Advance(milliseconds(32));
  EXPECT_FALSE(FrameIsDue());
  clock_.Advance(milliseconds(1));
  EXPECT_TRUE(FrameIsDue());
}

TEST_F(ReplaySourceTest, TwiceTheRateWaitsHalfAsLong) {
  options_.set_rate(2);
  WriteDepth(milliseconds(0));
  WriteDepth(milliseconds(40));
  Open();
  EXPECT_TRUE(FrameIsDue());
  clock_.Advance(milliseconds(19));
  EXPECT_FALSE(FrameIsDue());
  clock_.Advance(milliseconds(1));
  EXPECT_TRUE(FrameIsDue());
}

TEST_F(ReplaySourceTest, RebasedArrivalsStartNow) {
  options_.set_rate(1);
  WriteDepth(milliseconds(0));
  WriteThermal(milliseconds(7));
  Open();
  clock_.Advance(seconds(1));
  const Result<SourceItem> first = source_->Read({});
  EXPECT_EQ(std::get<RawFrame>(*first).arrival_wall, kNow + seconds(1));
  EXPECT_EQ(std::get<RawFrame>(*first).device_ticks, DeviceTicks(kTicksAtStart))
      << "the camera's own";
  clock_.Advance(milliseconds(7));
  const Result<SourceItem> second = source_->Read({});
  EXPECT_EQ(std::get<RawFrame>(*second).arrival_wall, kNow + seconds(1) + milliseconds(7));
}

TEST_F(ReplaySourceTest, WithoutRebaseTheRecordingsTimeBaseIsKept) {
  options_.set_rate(1);
  options_.mutable_expert()->set_rebase(false);
  WriteDepth(milliseconds(0));
  Open();
  const Result<SourceItem> first = source_->Read({});
  EXPECT_EQ(std::get<RawFrame>(*first).arrival_wall, kRecordedStart + kTransport);
}

TEST_F(ReplaySourceTest, LoopsContinueTimesAndNumbers) {
  options_.set_loops(3);
  for (int i = 0; i < 4; ++i) WriteDepth(i * milliseconds(33));
  Open();
  const std::vector<RawFrame> frames = ReadAll();
  ASSERT_EQ(frames.size(), 12U);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].frame_number, i);
    EXPECT_EQ(frames[i].arrival_wall - frames[i - 1].arrival_wall, milliseconds(33)) << i;
    EXPECT_EQ(frames[i].device_ticks - frames[i - 1].device_ticks, milliseconds(33)) << i;
  }
}

TEST_F(ReplaySourceTest, AnEmptyRecordingEndsEvenWhenLoopedForever) {
  options_.set_loops(0);
  Open();
  EXPECT_TRUE(ReadAll().empty());
}

TEST_F(ReplaySourceTest, ShutterFlagComesFromTheFramesState) {
  WriteThermal(milliseconds(0), NucState::kIdle);
  WriteThermal(milliseconds(25), NucState::kInProgress);
  WriteThermal(milliseconds(50), NucState::kSettling);
  Open();
  const std::vector<RawFrame> frames = ReadAll();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_FALSE(frames[0].shutter_closed);
  EXPECT_TRUE(frames[1].shutter_closed);
  EXPECT_FALSE(frames[2].shutter_closed);
}

TEST_F(ReplaySourceTest, F11AFrameThatCannotBeDecodedIsDeliveredWithoutPixels) {
  EncodedDepthFrame garbage;
  garbage.header = Header(milliseconds(0), true);
  garbage.image = DepthEncoder().Encode(Image<std::uint16_t>(8, 6, 700));
  garbage.image.payload.resize(garbage.image.payload.size() / 2);
  ASSERT_TRUE(writer_->Write(garbage, kRecordedStart).ok());
  WriteDepth(milliseconds(33));
  Open();
  const std::vector<RawFrame> frames = ReadAll();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_TRUE(frames[0].pixels.empty());
  EXPECT_FALSE(frames[1].pixels.empty());
}

TEST_F(ReplaySourceTest, OpeningAgainGoesOnBehindTheLastFrame) {
  WriteDepth(milliseconds(0));
  WriteDepth(milliseconds(33));
  Open();
  EXPECT_TRUE(FrameIsDue());
  source_->Close();
  ASSERT_TRUE(source_->Open().ok());
  const std::vector<RawFrame> rest = ReadAll();
  ASSERT_EQ(rest.size(), 1U);
  EXPECT_EQ(rest[0].frame_number, 1U);
}

TEST_F(ReplaySourceTest, DelaysThatTheRecorderKnewAreInTheArrivals) {
  ASSERT_TRUE(
      writer_->WriteMetadata("timing", {{"depth_delay_s", "-0.04"}, {"thermal_delay_s", "0.0427"}})
          .ok());
  WriteDepth(milliseconds(0));
  WriteThermal(milliseconds(7));
  Open();
  const std::vector<RawFrame> frames = ReadAll();
  ASSERT_EQ(frames.size(), 2U);
  EXPECT_EQ(frames[0].arrival_wall, kRecordedStart + kTransport - milliseconds(40));
  EXPECT_EQ(frames[1].arrival_wall,
            kRecordedStart + milliseconds(7) + kTransport + microseconds(42'700));
}

TEST_F(ReplaySourceTest, KnownDelaysDoNotConcernFramesWithoutArrival) {
  constexpr bool kImported = false;
  ASSERT_TRUE(writer_->WriteMetadata("timing", {{"depth_delay_s", "-0.04"}}).ok());
  WriteDepth(milliseconds(0), kImported);
  Open();
  EXPECT_EQ(ReadAll().at(0).arrival_wall, kRecordedStart);
}

TEST_F(ReplaySourceTest, AnAbsurdKnownDelayIsNotBelieved) {
  ASSERT_TRUE(writer_->WriteMetadata("timing", {{"depth_delay_s", "1e300"}}).ok());
  WriteDepth(milliseconds(0));
  Open();
  EXPECT_EQ(ReadAll().at(0).arrival_wall, kRecordedStart + kTransport);
}

TEST(ReplaySourceOpenTest, AMissingRecordingIsNamed) {
  FakeClock clock;
  ReplaySource source(SourceOptions(), "/nowhere/scan.mcap", clock, kNoPause);
  const Status status = source.Open();
  EXPECT_EQ(status.code(), StatusCode::kNotFound);
  EXPECT_NE(status.message().find("/nowhere/scan.mcap"), std::string::npos);
}

}  // namespace
}  // namespace isotherm

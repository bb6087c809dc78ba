// `isotherm merge-recordings` on recordings with holes, damage and torn ends, as a user runs it.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "tests/tool/recording_tool_run.h"

namespace isotherm::testing {
namespace {

constexpr std::uint64_t kHoleBegin = 2, kHoleEnd = 5;

class MergeRecordingsToolTest : public RecordingToolRun {
 protected:
  /// Changes a frame's header and image; false: the frame is left out.
  using Change = std::function<bool(FrameHeader&, EncodedImage&)>;

  /// Writes those frames of scan.mcap that `change` keeps, and its rig.
  void Copy(const std::string& name, const Change& change) const {
    auto reader = RecordingReader::Open(folder_ / "scan.mcap");
    ASSERT_TRUE(reader) << reader.error().message();
    auto writer = RecordingWriter::Create(folder_ / name, {});
    ASSERT_TRUE(writer) << writer.error().message();
    ASSERT_TRUE((*writer)->Write((*reader)->ReadRig().value()).ok());
    while (true) {
      auto item = (*reader)->Next();
      ASSERT_TRUE(item) << item.error().message();
      if (!*item) break;
      const auto write = [&](auto& recorded) {
        if (!change(recorded.frame.header, recorded.frame.image)) return;
        ASSERT_TRUE((*writer)->Write(recorded.frame, recorded.arrival).ok());
      };
      if (auto* depth = std::get_if<RecordedDepth>(&**item)) write(*depth);
      if (auto* thermal = std::get_if<RecordedThermal>(&**item)) write(*thermal);
    }
    ASSERT_TRUE((*writer)->Close().ok());
  }
  CaptureTime TimeOfFirstFrame() const {
    Content scan;
    Read("scan.mcap", scan);
    return CaptureTimeFromNanoseconds(scan.frames.at(0).second);
  }
  static bool IsInHole(const FrameHeader& header) {
    return header.frame_number >= kHoleBegin && header.frame_number < kHoleEnd;
  }
  void ExpectFramesOfTheScan(const std::string& name) const {
    Content scan, other;
    Read("scan.mcap", scan);
    Read(name, other);
    ASSERT_GT(scan.frames.size(), 10U);
    EXPECT_EQ(other.frames, scan.frames);
    EXPECT_EQ(other.pixels, scan.pixels);
    EXPECT_EQ(other.rig, scan.rig);
    EXPECT_TRUE(other.info.complete);
  }
};

TEST_F(MergeRecordingsToolTest, AHoleIsFilledFromTheOtherRecording) {
  Simulate();
  Copy("ground.mcap", [](FrameHeader& header, EncodedImage&) { return !IsInHole(header); });
  Copy("rig.mcap", [](FrameHeader& header, EncodedImage&) { return header.frame_number < 6; });
  const Outcome outcome = Run("merge-recordings ground.mcap rig.mcap -o whole.mcap");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("from     rig.mcap: 3 depth and 3 thermal frames"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("missing")));
  ExpectFramesOfTheScan("whole.mcap");
}

TEST_F(MergeRecordingsToolTest, AFrameThatIsDamagedIsTakenFromTheOtherRecording) {
  Simulate();
  Copy("ground.mcap", [](FrameHeader& header, EncodedImage& image) {
    if (IsInHole(header)) image.payload.resize(image.payload.size() / 2);
    return true;
  });
  Copy("rig.mcap", [](FrameHeader&, EncodedImage&) { return true; });
  const Outcome outcome = Run("merge-recordings ground.mcap rig.mcap -o whole.mcap");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("; 6 damaged messages"));
  EXPECT_THAT(outcome.err, HasSubstr("ground.mcap: not read:"));
  ExpectFramesOfTheScan("whole.mcap");
}

TEST_F(MergeRecordingsToolTest, WhatNoneOfThemHasIsCounted) {
  Simulate();
  for (const char* name : {"a.mcap", "b.mcap"})
    Copy(name, [](FrameHeader& header, EncodedImage&) { return !IsInHole(header); });
  const Outcome outcome = Run("merge-recordings a.mcap b.mcap -o whole.mcap");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("missing  6 frames, which none of these recordings has"));
}

TEST_F(MergeRecordingsToolTest, RecordingsOfDifferentScansAreRefused) {
  Simulate();
  Copy("later.mcap", [](FrameHeader& header, EncodedImage&) {
    header.capture_time += std::chrono::seconds(60);
    return true;
  });
  const Outcome outcome = Run("merge-recordings scan.mcap later.mcap -o whole.mcap");
  EXPECT_EQ(outcome.status, kData);
  EXPECT_THAT(outcome.err, HasSubstr("not of one scan: depth frame 0 was taken 60.000000 s apart"));
  EXPECT_FALSE(fs::exists(folder_ / "whole.mcap"));
  EXPECT_EQ(Run("merge-recordings scan.mcap nowhere.mcap -o whole.mcap").status, kNoInput);
  EXPECT_EQ(Run("merge-recordings -o whole.mcap").status, kUsage);
}

TEST_F(MergeRecordingsToolTest, EventsOfBothAreInItOnce) {
  Simulate();
  const CaptureTime begin = TimeOfFirstFrame();
  using std::chrono::milliseconds;
  const auto write = [&](const std::string& name, milliseconds noted, const std::string& text) {
    auto writer = RecordingWriter::Create(folder_ / name, {});
    ASSERT_TRUE(writer) << writer.error().message();
    ASSERT_TRUE((*writer)->WriteLog(begin, "info", "of both").ok());
    ASSERT_TRUE((*writer)->WriteLog(begin, "info", text).ok());
    // Each notes the same step of the clock when it hears of it.
    ASSERT_TRUE(
        (*writer)->Write(ClockStep{begin + noted, milliseconds(250), milliseconds(250)}).ok());
    ASSERT_TRUE((*writer)->Close().ok());
  };
  write("rig.mcap", milliseconds(20), "of the rig");
  write("ground.mcap", milliseconds(50), "of the ground");
  RunWell("merge-recordings scan.mcap rig.mcap ground.mcap -o whole.mcap");
  ExpectFramesOfTheScan("whole.mcap");
  auto reader = RecordingReader::Open(folder_ / "whole.mcap");
  std::vector<std::string> texts;
  std::vector<ClockStep> steps;
  while (auto item = (*reader)->Next().value()) {
    if (const auto* log = std::get_if<RecordedLog>(&*item)) texts.push_back(log->text);
    if (const auto* step = std::get_if<ClockStep>(&*item)) steps.push_back(*step);
  }
  EXPECT_THAT(texts, ::testing::UnorderedElementsAre("of both", "of the rig", "of the ground"));
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_EQ(steps[0].step, milliseconds(250));
  EXPECT_EQ(steps[0].time, begin + milliseconds(20));
}

TEST_F(MergeRecordingsToolTest, PartsOfAnotherSessionAreRefused) {
  Simulate();
  Copy("first.mcap", [](FrameHeader& header, EncodedImage&) { return header.frame_number < 3; });
  Copy("other.mcap", [](FrameHeader& header, EncodedImage&) {
    header.session = 99;
    return header.frame_number >= 3;
  });
  const Outcome outcome = Run("merge-recordings first.mcap other.mcap -o whole.mcap");
  EXPECT_EQ(outcome.status, kData);
  EXPECT_THAT(outcome.err, HasSubstr("other.mcap has frames of session 99"));
}

TEST_F(MergeRecordingsToolTest, ATornRecordingIsMadeWhole) {
  Simulate();
  const std::string bytes = ReadAll(folder_ / "scan.mcap");
  Write("torn.mcap", bytes.substr(0, bytes.size() - 100));
  Content torn;
  Read("torn.mcap", torn);
  ASSERT_FALSE(torn.info.complete);
  EXPECT_THAT(Run("inspect torn.mcap").out, HasSubstr("isotherm merge-recordings torn.mcap -o"));
  RunWell("merge-recordings torn.mcap -o whole.mcap");
  EXPECT_THAT(Run("inspect whole.mcap").out, Not(HasSubstr("merge-recordings")));
  Content whole;
  Read("whole.mcap", whole);
  EXPECT_TRUE(whole.info.complete);
  EXPECT_EQ(whole.frames, torn.frames);
  EXPECT_EQ(whole.pixels, torn.pixels);
  EXPECT_GT(whole.frames.size(), 0U);
}

}  // namespace
}  // namespace isotherm::testing

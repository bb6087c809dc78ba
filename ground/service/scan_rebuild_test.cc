#include "ground/service/scan_rebuild.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <sstream>

#include "common/codec/codec.h"
#include "common/recording/recording.h"
#include "ground/service/scan_completion.h"
#include "ground/service/testing/reconstruction_loop_fixture.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A loop that begins with what an earlier process has recorded.
class ScanRebuildTest : public ReconstructionLoopTest {
 protected:
  /// Records the same frames, as a process that was killed leaves them. Returns the file.
  std::filesystem::path RecordFrames(std::uint64_t session, int first, int last) {
    const std::filesystem::path path =
        folder_.path() / ("earlier-" + std::to_string(session) + "-" + std::to_string(first));
    auto writer = RecordingWriter::Create(path, {});
    EXPECT_TRUE(writer.has_value());
    EXPECT_TRUE((*writer)->Write(MakeRig()).ok());
    DepthEncoder depth_encoder;
    ThermalEncoder thermal_encoder;
    for (int i = first; i <= last; ++i) {
      if (i > 0) {
        const ThermalFramePtr frame = MakeThermal(session, i);
        EncodedThermalFrame encoded;
        encoded.header = frame->header;
        encoded.image = thermal_encoder.Encode(frame->temperature_raw, encoded.scale);
        encoded.valid = true;
        EXPECT_TRUE((*writer)->Write(encoded, std::nullopt).ok());
      }
      const DepthFramePtr frame = MakeDepth(session, i);
      EncodedDepthFrame encoded;
      encoded.header = frame->header;
      encoded.depth_scale = frame->depth_scale;
      encoded.image = depth_encoder.Encode(frame->depth_raw);
      EXPECT_TRUE((*writer)->Write(encoded, std::nullopt).ok());
    }
    EXPECT_TRUE((*writer)->Close().ok());
    return path;
  }
  /// Begins a session of which an earlier process has recorded these files.
  std::shared_ptr<RecordingTracker> GoOn(std::uint64_t session,
                                         std::vector<std::filesystem::path> files,
                                         bool waits_for_ground = false) {
    SessionStart start;
    start.rig.waits_for_ground = waits_for_ground;
    start.rig.session = session;
    start.rig.rig = MakeRig();
    start.folder = Folder(session);
    start.earlier_files = std::move(files);
    start.recording = std::make_shared<RecordingTracker>();
    start.recording->Update([](RecordingProgress& progress) { progress.closed = true; });
    queue_.Push(start, {});
    return start.recording;
  }
  /// Waits until all that was recorded is in the model.
  void AwaitRebuild(const RecordingTracker& recording) {
    // The test's own time limit is the bound. What comes from here on comes behind it.
    while (!recording.Get().is_earlier_in_model || board_.rebuilt_fraction.Get())
      std::this_thread::yield();
  }
  std::string Text(std::uint64_t session, const char* name) const {
    std::ostringstream text;
    text << std::ifstream(Folder(session) / name).rdbuf();
    return text.str();
  }
};

TEST_F(ScanRebuildTest, F32WhatAnEarlierProcessHasRecordedIsInTheModelAsIfItHadComeNow) {
  Start(1);
  FramesBetween(0, 11, 0ns, 1);
  Close(1);
  // Of two files that overlap.
  const auto recording = GoOn(2, {RecordFrames(2, 0, 5), RecordFrames(2, 4, 7)});
  Run();
  AwaitRebuild(*recording);
  FramesBetween(8, 11, 0ns, 2);
  Close(2);
  AwaitResults(2);
  End();
  EXPECT_EQ(Stats(2)["frames"]["depth"]["tracked"], 12);
  EXPECT_EQ(Stats(2)["frames"]["thermal"]["fused"], Stats(1)["frames"]["thermal"]["fused"]);
  EXPECT_GT(Text(1, "trajectory.txt").size(), 100U);
  EXPECT_EQ(Text(2, "trajectory.txt"), Text(1, "trajectory.txt"));
  EXPECT_EQ(Stats(2)["link"]["rebuild"]["frames"], 8 + 7);
  EXPECT_EQ(Stats(2)["link"]["rebuild"]["finished"], true);
  std::map<Sensor, std::set<std::uint64_t>> told;
  for (const RecordedNumbers& recorded : subscriber_.recorded) {
    EXPECT_EQ(recorded.session, 2U);
    for (const auto& [number, time] : recorded.frames) {
      told[recorded.sensor].insert(number);
      EXPECT_EQ(time, Time(static_cast<double>(number) -
                           (recorded.sensor == Sensor::kThermal ? 0.5 : 0.0)));
    }
  }
  EXPECT_THAT(told[Sensor::kDepth], ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_THAT(told[Sensor::kThermal], ElementsAre(1, 2, 3, 4, 5, 6, 7));
}

TEST_F(ScanRebuildTest, F32AScanThatEndsBeforeItsModelIsMadeAnewStillHasItsParts) {
  const auto recording = GoOn(2, {RecordFrames(2, 0, 7)});
  FramesBetween(8, 9, 0ns, 2);
  Close(2);
  Run();
  AwaitResults(1);
  End();
  EXPECT_EQ(Stats(2)["frames"]["depth"]["in"], 0) << "the scan has ended before";
  const RecordingProgress progress = recording->Get();
  EXPECT_EQ(progress.earlier_files.size(), 1U) << "its recording is made of both all the same";
  EXPECT_FALSE(progress.is_earlier_in_model);
}

TEST_F(ScanRebuildTest, F32RecordingsOfOtherScansAndBrokenOnesAreLeftAlone) {
  const std::filesystem::path broken = folder_.path() / "broken";
  std::ofstream(broken) << "no recording";
  const std::filesystem::path other = RecordFrames(99, 20, 23);
  const auto recording = GoOn(2, {broken, other, RecordFrames(2, 0, 7)});
  Run();
  AwaitRebuild(*recording);
  FramesBetween(8, 9, 0ns, 2);
  Close(2);
  AwaitResults(1);
  End();
  EXPECT_EQ(Stats(2)["frames"]["depth"]["tracked"], 10);
  EXPECT_EQ(recording->Get().earlier_files.size(), 1U);
  EXPECT_TRUE(std::filesystem::exists(broken) && std::filesystem::exists(other));
  for (const RecordedNumbers& recorded : subscriber_.recorded) {
    for (const auto& [number, time] : recorded.frames) EXPECT_LT(number, 8U);
  }
}

TEST_F(ScanRebuildTest, F32OfAScanThatIsCompleteTheRigIsToldAndNothingIsMade) {
  SessionStart start;
  start.rig.session = 2;
  start.rig.rig = MakeRig();
  start.folder = Folder(2);
  start.earlier_files = {RecordFrames(2, 0, 7)};
  start.is_complete = true;
  start.recording = std::make_shared<RecordingTracker>();
  start.recording->Update([](RecordingProgress& progress) { progress.closed = true; });
  queue_.Push(start, {});
  Run();
  while (subscriber_.told < 15) std::this_thread::yield();
  FramesBetween(8, 9, 0ns, 2);
  Close(2);
  AwaitResults(1);
  End();
  EXPECT_FALSE(std::filesystem::exists(Folder(2) / "stats.json"));
}

TEST_F(ScanRebuildTest, F32ARecordingOfAnotherScanCostsNoFrame) {
  const auto recording = GoOn(2, {RecordFrames(99, 20, 23)});
  FramesBetween(0, 5, 0ns, 2);  // They wait already.
  Close(2);
  Run();
  AwaitResults(1);
  End();
  EXPECT_EQ(Stats(2)["frames"]["depth"]["tracked"], 6);
  EXPECT_TRUE(recording->Get().earlier_files.empty());
  EXPECT_FALSE(Stats(2)["link"].contains("rebuild"));
}

TEST_F(ScanRebuildTest, F32PartsOfWhichNotAllCanBeReadBackStayAsTheyAre) {
  RecordingProgress recording;
  recording.closed = true;
  recording.earlier_files = {RecordFrames(2, 0, 3)};
  recording.files = {RecordFrames(2, 4, 7)};
  CompletionRequest request{.options = options_,
                            .folder = Folder(2),
                            .recording = recording,
                            .depth_frames = 9,
                            .thermal_frames = 7,
                            .describe = {},
                            .go_on = [] {},
                            .stop = {}};
  const Result<std::string> refused = CompleteScan(request);
  ASSERT_FALSE(refused.has_value());
  EXPECT_THAT(refused.error().message(), HasSubstr("only 15 of 16 frames can be read back"));
  EXPECT_TRUE(std::filesystem::exists(recording.files.front()));
  request.depth_frames = 8;
  const Result<std::string> completed = CompleteScan(request);
  ASSERT_TRUE(completed.has_value()) << completed.error().message();
  EXPECT_FALSE(std::filesystem::exists(recording.files.front()));
  const auto whole = RecordingReader::Open(recording.earlier_files.front());
  ASSERT_TRUE(whole.has_value());
  EXPECT_EQ((*whole)->info().messages_by_topic.at("/depth"), 8U);
}

TEST_F(ScanRebuildTest, F32AReplayThatWaitsForTheGroundLosesNoFrameToTheModelThatIsMadeAnew) {
  const auto recording = GoOn(2, {RecordFrames(2, 0, 7)}, /*waits_for_ground=*/true);
  FramesBetween(8, 11, 0ns, 2);
  Close(2);
  Run();
  AwaitResults(1);
  End();
  EXPECT_EQ(Stats(2)["frames"]["depth"]["tracked"], 12);
  EXPECT_EQ(Stats(2)["link"]["rebuild"]["left_out_meanwhile"], 0);
}

}  // namespace
}  // namespace isotherm

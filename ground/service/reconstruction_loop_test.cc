#include "ground/service/reconstruction_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <thread>

#include "common/codec/codec.h"
#include "common/recording/recording.h"
#include "common/testing/temporary_directory.h"
#include "ground/options/option_geometry.h"
#include "ground/service/scan_completion.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/surface/testing/small_volume.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Keeps the feedback that goes to the rig.
class FakeSubscriber final : public Subscriber {
 public:
  void Run(std::stop_token /*stop*/) override {}
  bool Leave(const std::function<bool()>& /*go_on*/) override { return true; }
  Status Join(const Participant& /*participant*/) override { return OkStatus(); }
  Status Publish(const Feedback& feedback) override {
    published.push_back(feedback);
    if (on_publish) on_publish();
    return works ? OkStatus() : Unavailable("no link");
  }
  Result<std::uint64_t> Send(Command /*command*/) override { return 0; }
  void AddRecorded(RecordedNumbers numbers) override {
    told += numbers.frames.size();
    recorded.push_back(std::move(numbers));
  }
  SubscriberStats stats() const override { return {}; }
  SessionCounters counters(std::uint64_t session) const override {
    SessionCounters counters;
    counters.session = session;
    return counters;
  }
  const RefusalCounter& refusals() const override { return refusals_; }

  bool works = true;
  std::function<void()> on_publish;  ///< On the loop's thread.
  std::vector<Feedback> published;   ///< Not while the loop runs.
  std::vector<RecordedNumbers> recorded;
  std::atomic<std::size_t> told{0};  ///< Frames of these.

 private:
  RefusalCounter refusals_;
};

/// A loop on a thread of its own, and behind it a thread that writes results.
class ReconstructionLoopTest : public ::testing::Test {
 protected:
  ReconstructionLoopTest() {
    VolumeOptions& volume = *options_.mutable_volume();
    volume = testing::SmallVolume();
    *volume.mutable_expert()->mutable_initial_pose() = ToOptions(testing::FirstPose());
    options_.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(
        testing::kSmallTruncation_m);
    options_.mutable_calibration_check()->mutable_expert()->set_enabled(false);
    options_.mutable_live()->set_output_dir(folder_.path().string());
    options_.set_threads(1);
  }
  ~ReconstructionLoopTest() override { End(); }

  std::filesystem::path Folder(std::uint64_t session) const {
    return folder_.path() / std::to_string(session);
  }
  static Rig MakeRig() {
    Rig rig;
    rig.depth = testing::SmallDepthCamera();
    rig.thermal = rig.depth;
    rig.T_thermal_depth = MakeTransform({0.02, 0.0, 0.0}, Eigen::Quaterniond::Identity());
    return rig;
  }
  void Start(std::uint64_t session, const Rig& rig = MakeRig()) {
    SessionStart start;
    start.rig.session = session;
    start.rig.rig = rig;
    start.folder = Folder(session);
    start.recording = std::make_shared<RecordingTracker>();
    start.recording->Update([](RecordingProgress& progress) { progress.closed = true; });
    queue_.Push(start, {});
  }
  void Close(std::uint64_t session) {
    SessionCounters counters;
    counters.session = session;
    queue_.Push(counters, {});
  }
  static CaptureTime Time(double frame) { return CaptureTime(FromSeconds(100.0 + frame / 30.0)); }
  static DepthFramePtr MakeDepth(std::uint64_t session, int i) {
    auto depth = std::make_shared<DepthFrame>(testing::RenderDepth(
        testing::BallInCorner, *MakeRig().depth,
        testing::FirstPose() *
            MakeTransform({0.003 * i, 0.0015 * i, 0.0}, Eigen::Quaterniond::Identity())));
    depth->header = {
        .session = session, .frame_number = static_cast<std::uint64_t>(i), .capture_time = Time(i)};
    return depth;
  }
  static ThermalFramePtr MakeThermal(std::uint64_t session, int i) {
    auto thermal = std::make_shared<ThermalFrame>();
    thermal->header = {.session = session,
                       .frame_number = static_cast<std::uint64_t>(i),
                       .capture_time = Time(i - 0.5)};
    thermal->temperature_raw =
        Image<std::uint16_t>(MakeRig().thermal->width, MakeRig().thermal->height, 32'315);
    thermal->valid = true;
    return thermal;
  }
  /// Frames `first` .. `last` of a moving rig that have waited for `queued`, a thermal frame before
  /// each but the first of all.
  void FramesBetween(int first, int last, Nanoseconds queued = 0ns, std::uint64_t session = 0) {
    const CaptureTime arrival = clock_.Now() - queued;
    for (int i = first; i <= last; ++i) {
      if (i > 0)
        queue_.Push(ReceivedThermal{MakeThermal(session, i), nullptr, arrival, arrival}, {});
      queue_.Push(ReceivedDepth{MakeDepth(session, i), nullptr, arrival, arrival}, {});
    }
  }
  void Frames(int count, Nanoseconds queued = 0ns) { FramesBetween(0, count - 1, queued); }

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
  void Run() {
    loop_thread_ = std::jthread([this](const std::stop_token& stop) { loop_.Run(queue_, stop); });
    result_thread_ = std::jthread([this](const std::stop_token& stop) { results_.Run(stop); });
  }
  /// The test's own time limit is the bound.
  void AwaitResults(int scans) {
    while (written_ < scans) std::this_thread::yield();
  }
  void End() {
    loop_thread_.request_stop();
    if (loop_thread_.joinable()) loop_thread_.join();
    result_thread_.request_stop();
    if (result_thread_.joinable()) result_thread_.join();
  }
  nlohmann::json Stats(std::uint64_t session) const {
    return nlohmann::json::parse(std::ifstream(Folder(session) / "stats.json"), nullptr, false);
  }
  /// Feedback that went to the recording.
  std::vector<Feedback> Recorded() {
    std::vector<Feedback> recorded;
    std::optional<SessionItem> item;
    while (recording_.Pop(0ns, {}, item) == RecordingQueue::Outcome::kItem)
      recorded.push_back(std::get<Feedback>(*item));
    return recorded;
  }

  const testing::TemporaryDirectory folder_;
  FakeClock clock_{CaptureTime(FromSeconds(1000.0))};
  GroundOptions options_;
  FakeSubscriber subscriber_;
  RecordingQueue recording_{{.items = 1000, .bytes = 1U << 20}};
  ScanBoard board_;
  ThreadProgress progress_, reading_, result_progress_;
  std::atomic<int> written_{0};
  ResultWriter results_{
      options_,
      clock_,
      [this](std::uint64_t session) { return subscriber_.counters(session); },
      board_,
      result_progress_,
      {.written = [this](const std::unique_ptr<LiveScan>&) { ++written_; }, .completed = {}}};
  SessionQueue queue_{1000, OverflowPolicy::kBlock};
  ReconstructionLoop loop_{
      options_, clock_, {subscriber_, recording_, results_, board_, progress_, reading_}};
  std::jthread loop_thread_, result_thread_;
};

TEST_F(ReconstructionLoopTest, ASessionGivesFeedbackOnTheWayAndResultsAtItsEnd) {
  Start(5);
  Frames(4);
  Close(5);
  Run();
  AwaitResults(1);
  End();
  EXPECT_TRUE(loop_.status().ok());
  EXPECT_EQ(Stats(5)["frames"]["depth"]["tracked"], 4);
  EXPECT_EQ(Stats(5)["frames"]["thermal"]["fused"], 3);
  ASSERT_FALSE(subscriber_.published.empty());
  for (const Feedback& feedback : subscriber_.published) EXPECT_EQ(feedback.session, 5U);
  const std::vector<Feedback> recorded = Recorded();
  ASSERT_EQ(recorded.size(), subscriber_.published.size()) << "what was sent is recorded";
  EXPECT_EQ(recorded.back().frame_number, subscriber_.published.back().frame_number);
  EXPECT_FALSE(board_.feedback.Take().has_value()) << "nothing of a scan that is over";
}

TEST_F(ReconstructionLoopTest, RoomOnTheDiskIsAskedForAsTheModelGrows) {
  std::vector<std::uint64_t> asked;
  subscriber_.on_publish = [&] { asked.push_back(board_.result_bytes); };
  Start(1);
  Frames(10);
  Close(1);
  Run();
  AwaitResults(1);
  End();
  // Each feedback comes before the estimate with it.
  ASSERT_GE(asked.size(), 3U);
  EXPECT_EQ(asked[0], 0U);
  std::uint64_t bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(Folder(1)))
    bytes += entry.is_regular_file() ? entry.file_size() : 0;
  EXPECT_GT(asked.back(), bytes / 2) << "it has to do with what the results take";
  EXPECT_LT(asked.back(), 20 * bytes);
}

TEST_F(ReconstructionLoopTest, F39WhoIsStuckAtAFrameIsSeenToBe) {
  std::vector<Nanoseconds> at_it;
  subscriber_.on_publish = [&] { at_it.push_back(progress_.AtItFor(clock_.SteadyNow() + 11s)); };
  Start(1);
  Frames(4);
  Close(1);
  Run();
  AwaitResults(1);
  End();
  EXPECT_FALSE(at_it.empty());
  EXPECT_THAT(at_it, Each(Nanoseconds(11s)));
  EXPECT_EQ(progress_.AtItFor(clock_.SteadyNow() + 1h), 0ns);
}

TEST_F(ReconstructionLoopTest, ANewSessionEndsTheOneBefore) {
  Start(1);
  Frames(2);
  Start(2);
  Frames(3);
  Close(2);
  Run();
  AwaitResults(2);
  End();
  EXPECT_EQ(Stats(1)["frames"]["depth"]["in"], 2);
  EXPECT_EQ(Stats(2)["frames"]["depth"]["in"], 3);
}

TEST_F(ReconstructionLoopTest, F38FramesThatWaitAtTheStopAreCountedAndTheScanIsWritten) {
  Start(1);
  Frames(3);
  std::stop_source stopped;
  stopped.request_stop();
  loop_.Run(queue_, stopped.get_token());
  results_.Run(stopped.get_token());
  EXPECT_EQ(Stats(1)["frames"]["depth"]["in"], 0);
  EXPECT_EQ(Stats(1)["link"]["not_processed_at_stop"], 5) << "three depth, two thermal frames";
  EXPECT_THAT(subscriber_.published, IsEmpty());
}

TEST_F(ReconstructionLoopTest, ASessionThatCannotBeReconstructedEndsNothing) {
  Start(1, Rig());
  Frames(2);
  Close(1);
  Start(2);
  Frames(2);
  Close(2);
  Run();
  AwaitResults(2);
  End();
  EXPECT_FALSE(loop_.status().ok());
  EXPECT_EQ(Stats(2)["frames"]["depth"]["tracked"], 2);
  for (const Feedback& feedback : subscriber_.published) EXPECT_EQ(feedback.session, 2U);
}

TEST_F(ReconstructionLoopTest, WithoutALinkTheScanGoesOnAndItsFeedbackIsRecorded) {
  subscriber_.works = false;
  Start(1);
  Frames(3);
  Close(1);
  Run();
  AwaitResults(1);
  End();
  EXPECT_EQ(Stats(1)["frames"]["depth"]["tracked"], 3);
  EXPECT_FALSE(Recorded().empty());
  EXPECT_TRUE(loop_.status().ok());
}

TEST_F(ReconstructionLoopTest, TheRigsOperatorIsToldWhatWasLeftOutToKeepUp) {
  options_.mutable_live()->mutable_expert()->set_max_wait_s(0.1);
  Start(1);
  Frames(12, 150ms);
  Close(1);
  Run();
  AwaitResults(1);
  End();
  ASSERT_GE(subscriber_.published.size(), 2U);
  EXPECT_GT(subscriber_.published.back().frames_left_out, 0U);
}

TEST_F(ReconstructionLoopTest, F32WhatAnEarlierProcessHasRecordedIsInTheModelAsIfItHadComeNow) {
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

TEST_F(ReconstructionLoopTest, F32AScanThatEndsBeforeItsModelIsMadeAnewStillHasItsParts) {
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

TEST_F(ReconstructionLoopTest, F32RecordingsOfOtherScansAndBrokenOnesAreLeftAlone) {
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

TEST_F(ReconstructionLoopTest, F32OfAScanThatIsCompleteTheRigIsToldAndNothingIsMade) {
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

TEST_F(ReconstructionLoopTest, F32ARecordingOfAnotherScanCostsNoFrame) {
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

TEST_F(ReconstructionLoopTest,
       F32AReplayThatWaitsForTheGroundLosesNoFrameToTheModelThatIsMadeAnew) {
  const auto recording = GoOn(2, {RecordFrames(2, 0, 7)}, /*waits_for_ground=*/true);
  FramesBetween(8, 11, 0ns, 2);
  Close(2);
  Run();
  AwaitResults(1);
  End();
  EXPECT_EQ(Stats(2)["frames"]["depth"]["tracked"], 12);
  EXPECT_EQ(Stats(2)["link"]["rebuild"]["left_out_meanwhile"], 0);
}

TEST_F(ReconstructionLoopTest, F32PartsOfWhichNotAllCanBeReadBackStayAsTheyAre) {
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

}  // namespace
}  // namespace isotherm

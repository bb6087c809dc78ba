#include "ground/service/recording_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>
#include <thread>

#include "common/recording/testing/recording_data.h"
#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kScanStart;

constexpr std::uint64_t kSession = 42;
/// Longer than the loop waits between two looks at the disk.
constexpr Nanoseconds kNextLook = 250ms;
/// The loop is told this of the disk, whatever this computer's is like.
constexpr std::uint64_t kFreeBytes = 10ULL << 30;

/// A loop on a thread of its own that writes to a real disk, and is told how much is free there.
class RecordingLoopTest : public ::testing::Test {
 protected:
  ~RecordingLoopTest() override { End(); }

  void Run() {
    thread_ = std::jthread([this](const std::stop_token& stop) { loop_.Run(queue_, stop); });
  }
  /// All that was offered is recorded or counted, and the files are closed.
  void End() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
  }
  std::filesystem::path Folder(std::uint64_t session) const {
    return folder_.path() / std::to_string(session);
  }
  /// Returns what becomes of the session's recording.
  std::shared_ptr<RecordingTracker> Start(std::uint64_t session = kSession) {
    SessionStart start;
    start.rig.session = session;
    start.rig.rig = testing::MakeRig();
    start.folder = Folder(session);
    start.recording = std::make_shared<RecordingTracker>();
    tracker_ = start.recording;
    queue_.Push(start);
    return tracker_;
  }
  void Depths(int count) {
    for (int i = 0; i < count; ++i) {
      auto frame = std::make_shared<EncodedDepthFrame>(testing::MakeDepth(
          number_, kScanStart + static_cast<int>(number_) * Nanoseconds(33'333'333)));
      ++number_;
      queue_.Push(ReceivedDepth{nullptr, std::move(frame), clock_.Now()});
    }
  }
  /// The loop is done with all frames so far. The test's own time limit is the bound.
  RecordingProgress Await() {
    const auto seen = [this] {
      const RecordingProgress progress = tracker_->Get();
      return progress.depth_frames + progress.left_out();
    };
    while (seen() < number_) std::this_thread::yield();
    while (progress_.AtItFor(clock_.SteadyNow() + 1h) > 0ns) std::this_thread::yield();
    return tracker_->Get();
  }
  /// A frame at the disk's next look.
  RecordingProgress FrameAtNextLook() {
    clock_.Advance(kNextLook);
    Depths(1);
    return Await();
  }
  static std::multiset<std::uint64_t> NumbersIn(const std::filesystem::path& file) {
    std::multiset<std::uint64_t> numbers;
    const auto reader = RecordingReader::Open(file);
    EXPECT_TRUE(reader) << reader.error().message();
    EXPECT_TRUE((*reader)->info().complete) << file;
    for (const RecordedDepth& depth : testing::ReadAll(**reader).All<RecordedDepth>())
      numbers.insert(depth.frame.header.frame_number);
    return numbers;
  }
  static bool HasFeedback(const std::filesystem::path& file) {
    const auto reader = RecordingReader::Open(file);
    EXPECT_TRUE(reader) << reader.error().message();
    return (*reader)->info().messages_by_topic.contains("/feedback");
  }

  const testing::TemporaryDirectory folder_;
  FakeClock clock_{kScanStart};
  GroundOptions options_;
  ScanBoard board_;
  ThreadProgress progress_;
  RecordingQueue queue_{{.items = 1000, .bytes = 1U << 30}};
  /// At each look at the disk, a minute later; not while it runs.
  std::vector<Nanoseconds> at_it_;
  RecordingLoop loop_{options_, clock_, board_, progress_, [this](const std::filesystem::path&) {
                        at_it_.push_back(progress_.AtItFor(clock_.SteadyNow() + 60s));
                        return std::filesystem::space_info{.capacity = 4 * kFreeBytes,
                                                           .free = kFreeBytes,
                                                           .available = kFreeBytes};
                      }};
  std::shared_ptr<RecordingTracker> tracker_;
  std::uint64_t number_ = 0;
  std::jthread thread_;
};

TEST_F(RecordingLoopTest, FramesOfASessionAreInItsFileAndCounted) {
  Start();
  Depths(5);
  Run();
  End();
  const RecordingProgress progress = tracker_->Get();
  EXPECT_THAT(progress.files, ElementsAre(Folder(kSession) / "scan.mcap"));
  EXPECT_EQ(progress.depth_frames, 5U);
  EXPECT_EQ(progress.left_out(), 0U);
  EXPECT_TRUE(progress.closed);
  EXPECT_TRUE(loop_.status().ok());
  EXPECT_EQ(NumbersIn(progress.path), (std::multiset<std::uint64_t>{0, 1, 2, 3, 4}));
}

TEST_F(RecordingLoopTest, ANewSessionEndsTheOneBeforeAndItsEndClosesIt) {
  const auto first = Start(1);
  Depths(2);
  const auto second = Start(2);
  Depths(3);
  Run();
  while (second->Get().depth_frames < 3) std::this_thread::yield();
  EXPECT_TRUE(first->Get().closed);
  EXPECT_FALSE(second->Get().closed);
  queue_.Push(SessionCounters{});
  EXPECT_TRUE(second->WaitUntilClosed(60s).closed);
  EXPECT_EQ(NumbersIn(Folder(1) / "scan.mcap"), (std::multiset<std::uint64_t>{0, 1}));
  EXPECT_EQ(NumbersIn(Folder(2) / "scan.mcap"), (std::multiset<std::uint64_t>{2, 3, 4}));
}

TEST_F(RecordingLoopTest, F43WhatIsKeptForTheResultsIsNotTakenByFrames) {
  Run();
  Start();
  EXPECT_EQ(FrameAtNextLook().left_out(), 0U);
  board_.result_bytes = 2 * kFreeBytes;
  RecordingProgress progress = FrameAtNextLook();
  EXPECT_TRUE(progress.paused);
  EXPECT_THAT(progress.status.message(), HasSubstr("are kept for the results"));
  Depths(2);
  EXPECT_EQ(Await().left_out(NotRecorded::kDiskNearlyFull), 3U);
  // Half as much again as the results are expected to take is kept, and to go on twice that.
  board_.result_bytes = kFreeBytes / 2;
  EXPECT_TRUE(FrameAtNextLook().paused) << "it must not begin and end all the time";
  board_.result_bytes = 0;
  progress = FrameAtNextLook();
  EXPECT_FALSE(progress.paused);
  End();
  progress = tracker_->Get();
  EXPECT_THAT(progress.files,
              ElementsAre(Folder(kSession) / "scan.mcap", Folder(kSession) / "scan-2.mcap"));
  EXPECT_EQ(NumbersIn(progress.files[0]), (std::multiset<std::uint64_t>{0}));
  EXPECT_EQ(NumbersIn(progress.files[1]), (std::multiset<std::uint64_t>{5}));
  EXPECT_EQ(progress.depth_frames, 2U);
  EXPECT_EQ(progress.left_out(NotRecorded::kDiskNearlyFull), 4U);
  EXPECT_EQ(loop_.status().code(), StatusCode::kResourceExhausted) << "the recording has a hole";
}

TEST_F(RecordingLoopTest, F41AtTheEndOfTheQuotaTheRecordingEnds) {
  options_.mutable_live()->set_output_dir(folder_.path());
  options_.mutable_live()->set_quota_gb(0.02);
  std::ofstream(folder_.path() / "older") << std::string(9'000'000, 'x');
  Run();
  Start();
  EXPECT_EQ(FrameAtNextLook().depth_frames, 1U);
  // Five megabytes are kept for the end of the file.
  std::ofstream(folder_.path() / "results") << std::string(7'000'000, 'x');
  clock_.Advance(11s);
  RecordingProgress progress = FrameAtNextLook();
  EXPECT_TRUE(progress.paused);
  EXPECT_EQ(progress.left_out(NotRecorded::kDiskNearlyFull), 1U);
  EXPECT_THAT(std::string(progress.status.message()), HasSubstr("live.quota_gb"));
}

TEST_F(RecordingLoopTest, HalfOfTheDiskIsRoomEnoughToBeginWith) {
  board_.result_bytes = kFreeBytes / 2;
  Run();
  Start();
  EXPECT_EQ(FrameAtNextLook().left_out(), 0U);
}

TEST_F(RecordingLoopTest, ACameraThatComesLateIsRecorded) {
  Start();
  Depths(1);
  RigDescription anew;
  anew.session = kSession;
  anew.rig = testing::MakeRig();
  anew.rig.thermal_scale = {0.02, 0.0};
  queue_.Push(anew);
  Depths(1);
  Run();
  End();
  const auto reader = RecordingReader::Open(Folder(kSession) / "scan.mcap");
  ASSERT_TRUE(reader.has_value());
  EXPECT_EQ((*reader)->ReadRig()->thermal_scale, anew.rig.thermal_scale);
}

TEST_F(RecordingLoopTest, FeedbackOnTheSessionBeforeIsNotRecorded) {
  Feedback late;
  late.session = 1;
  Feedback own;
  own.session = 2;
  Start(1);
  Depths(1);
  queue_.Push(late);
  Start(2);
  Depths(1);
  queue_.Push(late);
  Start(3);
  Depths(1);
  queue_.Push(own);
  Run();
  End();
  EXPECT_TRUE(HasFeedback(Folder(1) / "scan.mcap"));
  EXPECT_FALSE(HasFeedback(Folder(2) / "scan.mcap"));
  EXPECT_FALSE(HasFeedback(Folder(3) / "scan.mcap"));
}

TEST_F(RecordingLoopTest, F39WhoIsStuckAtTheDiskIsSeenToBe) {
  Start();
  Depths(1);
  Run();
  Await();
  End();
  EXPECT_FALSE(at_it_.empty());
  EXPECT_THAT(at_it_, Each(Nanoseconds(60s)));
  EXPECT_EQ(progress_.AtItFor(clock_.SteadyNow() + 1h), 0ns);
}

TEST_F(RecordingLoopTest, F37WhatIsCollectedGoesToTheDiskWhenFramesStop) {
  Start();
  Depths(1);
  Run();
  Await();
  const auto has_frame = [this] {
    const auto reader = RecordingReader::Open(Folder(kSession) / "scan.mcap");
    return reader && (*reader)->info().messages_by_topic.contains("/depth");
  };
  // Only a failure waits this long.
  const auto deadline = std::chrono::steady_clock::now() + 10s;
  while (!has_frame() && std::chrono::steady_clock::now() < deadline) std::this_thread::yield();
  EXPECT_TRUE(has_frame()) << "a power cut would cost it";
}

TEST_F(RecordingLoopTest, WithoutARecordingTheFolderIsThereForTheResults) {
  options_.mutable_live()->set_record(false);
  Start();
  Depths(3);
  Run();
  EXPECT_TRUE((queue_.Push(SessionCounters{}), tracker_->WaitUntilClosed(60s).closed));
  EXPECT_TRUE(std::filesystem::is_directory(Folder(kSession)));
  EXPECT_FALSE(std::filesystem::exists(Folder(kSession) / "scan.mcap"));
  EXPECT_TRUE(tracker_->Get().path.empty());
}

TEST_F(RecordingLoopTest, F22WhatComesLateHasAFileOfItsOwn) {
  Run();
  Start();
  Depths(4);
  for (const std::uint64_t number : {101, 102, 103}) {
    auto frame = std::make_shared<EncodedDepthFrame>(testing::MakeDepth(number, kScanStart - 10s));
    queue_.Push(ReceivedDepth{nullptr, std::move(frame), clock_.Now(), {}, /*is_late=*/true});
  }
  Depths(2);
  End();
  const RecordingProgress progress = tracker_->Get();
  EXPECT_EQ(progress.depth_frames, 9U);
  EXPECT_EQ(progress.late_frames, 3U);
  ASSERT_THAT(progress.late_files, ElementsAre(Folder(kSession) / "scan-late.mcap"));
  EXPECT_THAT(progress.files, ElementsAre(Folder(kSession) / "scan.mcap"));
  EXPECT_THAT(NumbersIn(progress.late_files.front()), ElementsAre(101, 102, 103));
  EXPECT_THAT(NumbersIn(progress.files.front()), ElementsAre(0, 1, 2, 3, 4, 5));
  const auto reader = RecordingReader::Open(progress.late_files.front());
  ASSERT_TRUE(reader);
  EXPECT_TRUE((*reader)->ReadRig().has_value()) << "each file has the whole beginning";
}

}  // namespace
}  // namespace isotherm

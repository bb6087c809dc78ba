#include "ground/service/result_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "common/testing/temporary_directory.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr auto kPatience = 60s;

/// A writer of results that stays in the first scan until the test lets it go on.
class ResultWriterTest : public ::testing::Test {
 protected:
  ResultWriterTest() {
    options_.mutable_volume()->set_size_x_m(0.16);
    options_.mutable_volume()->set_size_y_m(0.16);
    options_.mutable_volume()->set_size_z_m(0.16);
    options_.mutable_live()->set_output_dir(folder_.path().string());
    options_.set_threads(1);
    thread_ = std::jthread([this](const std::stop_token& stop) { writer_.Run(stop); });
  }
  ~ResultWriterTest() override { Release(); }

  /// Nothing is stuck any more.
  void Release() {
    if (!std::exchange(released_, true)) release_.set_value();
  }
  void WriteAll() {
    Release();
    thread_.request_stop();
    thread_.join();
  }
  std::filesystem::path Folder(std::uint64_t session) const {
    return folder_.path() / std::to_string(session);
  }
  EndedScan Scan(std::uint64_t session, bool replay = false) {
    EndedScan ended;
    ended.start.rig.session = session;
    ended.start.rig.waits_for_ground = replay;
    ended.start.rig.rig.depth = CameraModel{64, 48, 57.0, 57.0, 32.0, 24.0};
    ended.start.folder = Folder(session);
    ended.start.recording = std::make_shared<RecordingTracker>();
    ended.start.recording->Update([&](RecordingProgress& counters) {
      counters.path = Folder(session) / "scan.mcap";
      counters.closed = true;
    });
    ended.scan = LiveScan::Create(clock_, options_, ended.start.rig).value();
    return ended;
  }
  /// Hands the scan over on another thread.
  std::future<void> Hand(EndedScan ended) {
    return std::async(std::launch::async, [this, ended = std::move(ended)]() mutable {
      writer_.Enqueue(std::move(ended), stop_.get_token());
    });
  }
  /// Results of one scan are stuck, another one waits.
  void FillUp() {
    writer_.Enqueue(Scan(1), stop_.get_token());
    ASSERT_EQ(reached_.get_future().wait_for(kPatience), std::future_status::ready);
    ASSERT_EQ(Hand(Scan(2)).wait_for(kPatience), std::future_status::ready);
  }
  bool HasResults(std::uint64_t session) const {
    return std::filesystem::exists(Folder(session) / "stats.json");
  }

  const testing::TemporaryDirectory folder_;
  const FakeClock clock_{CaptureTime(1000s)};
  GroundOptions options_;
  ScanBoard board_;
  ThreadProgress progress_;
  std::stop_source stop_;
  std::promise<void> reached_, release_;
  std::shared_future<void> go_on_ = release_.get_future().share();
  bool released_ = false;
  ResultWriter writer_{options_,
                       clock_,
                       [this](std::uint64_t session) {
                         if (session == 1) reached_.set_value();
                         go_on_.wait();
                         SessionCounters counters;
                         counters.session = session;
                         return counters;
                       },
                       board_,
                       progress_,
                       {.written = [](const std::unique_ptr<LiveScan>&) {}, .completed = {}}};
  std::jthread thread_;
};

TEST_F(ResultWriterTest, F42AThirdScanBehindStuckResultsHoldsNothingUpAndItsLossIsSaid) {
  FillUp();
  const std::future<void> third = Hand(Scan(3));
  EXPECT_EQ(third.wait_for(kPatience), std::future_status::ready) << "reception waits behind it";
  EXPECT_EQ(board_.scans_given_up, 1);
  EXPECT_EQ(board_.scans_being_written, 2);
  WriteAll();
  EXPECT_EQ(board_.scans_being_written, 0);
  EXPECT_TRUE(HasResults(1));
  EXPECT_TRUE(HasResults(2));
  EXPECT_FALSE(HasResults(3));
  EXPECT_EQ(writer_.status().code(), StatusCode::kResourceExhausted);
  EXPECT_THAT(writer_.status().message(), HasSubstr("session=3"));
  EXPECT_THAT(writer_.status().message(),
              HasSubstr("isotherm reconstruct " + (Folder(3) / "scan.mcap").string()));
}

TEST_F(ResultWriterTest, WhoWasAskedToStopWaitsForRoom) {
  FillUp();
  stop_.request_stop();
  const std::future<void> third = Hand(Scan(3));
  EXPECT_EQ(third.wait_for(100ms), std::future_status::timeout);
  Release();
  EXPECT_EQ(third.wait_for(kPatience), std::future_status::ready);
  WriteAll();
  EXPECT_EQ(board_.scans_given_up, 0);
  EXPECT_TRUE(HasResults(3));
  EXPECT_TRUE(writer_.status().ok()) << writer_.status().message();
}

TEST_F(ResultWriterTest, AReplayWaitsForRoom) {
  FillUp();
  const std::future<void> third = Hand(Scan(3, true));
  Release();
  EXPECT_EQ(third.wait_for(kPatience), std::future_status::ready);
  WriteAll();
  EXPECT_EQ(board_.scans_given_up, 0);
  EXPECT_TRUE(HasResults(3));
}

}  // namespace
}  // namespace isotherm

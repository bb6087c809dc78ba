// These tests show what a disk that is slow to make chunks safe costs.
#include <gtest/gtest.h>

#include <memory>

#include "common/recording/recording.h"
#include "common/recording/testing/recording_data.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

/// A disk in memory of which each sync takes the same time, until it fails.
class SlowSink final : public ByteSink {
 public:
  struct Disk {
    FakeClock clock;
    Nanoseconds sync_time{};
    bool sync_fails = false;
    int syncs = 0;
  };
  explicit SlowSink(Disk& disk) : disk_(disk) {}
  Status Write(std::span<const std::uint8_t> /*bytes*/) override { return OkStatus(); }
  Status Sync() override {
    disk_.clock.Advance(disk_.sync_time);
    ++disk_.syncs;
    return disk_.sync_fails ? IoError("input/output error") : OkStatus();
  }
  Status Close() override { return OkStatus(); }

 private:
  Disk& disk_;
};

class RecordingSyncTest : public ::testing::Test {
 protected:
  void Begin(Nanoseconds sync_time) {
    disk_.sync_time = sync_time;
    const RecordingOptions options{.flush_interval = 60ms, .clock = &disk_.clock};
    writer_ = MakeRecordingWriter(std::make_unique<SlowSink>(disk_), options).value();
  }
  void Write() {
    ASSERT_TRUE(writer_->Write(testing::MakeDepth(next_++, testing::kScanStart), {}).ok());
  }
  void WriteChunk() {
    Write();
    ASSERT_TRUE(writer_->Flush().ok());
  }

  SlowSink::Disk disk_;
  std::unique_ptr<RecordingWriter> writer_;
  std::uint64_t next_ = 0;
};

TEST_F(RecordingSyncTest, F42ADiskThatSyncsSlowlyGetsAsMuchTimeWithout) {
  // A second for the sync, and three chunks until the next one; or each chunk is synced.
  for (const auto& [sync_time, syncs] : {std::pair(50ms, 40), std::pair(1000ms, 9)}) {
    disk_.syncs = 0;
    Begin(sync_time);
    // Twenty seconds in which the disk is written to at the frames' rate, but for its syncs.
    const SteadyTime begin = disk_.clock.SteadyNow();
    while (disk_.clock.SteadyNow() < begin + 20s) {
      WriteChunk();
      disk_.clock.Advance(450ms);
    }
    EXPECT_NEAR(disk_.syncs, syncs, 1);
    const int before_close = disk_.syncs;
    ASSERT_TRUE(writer_->Close().ok());
    EXPECT_GT(disk_.syncs, before_close) << "in the end all is safe";
  }
}

TEST_F(RecordingSyncTest, F42ADiskThatStoodStillOnceIsSoonAskedAgain) {
  Begin(60s);
  WriteChunk();
  disk_.sync_time = 1ms;
  WriteChunk();
  EXPECT_EQ(disk_.syncs, 1);
  disk_.clock.Advance(5s);
  WriteChunk();
  EXPECT_EQ(disk_.syncs, 2);
}

TEST_F(RecordingSyncTest, F43ChunksThatWaitedForTheirSyncCountAsUnsyncedWhenItFails) {
  Begin(1s);
  for (int i = 0; i < 3; ++i) WriteChunk();
  EXPECT_EQ(disk_.syncs, 1);
  EXPECT_EQ(writer_->stats().depth_frames, 3U);
  disk_.sync_fails = true;
  ASSERT_TRUE(writer_->Flush().ok()) << "not yet";
  disk_.clock.Advance(1s);
  EXPECT_EQ(writer_->Flush().code(), StatusCode::kIoError) << "without a new frame, too";
  EXPECT_EQ(writer_->stats().depth_frames, 1U);
  EXPECT_EQ(writer_->stats().failed, 2U);
  EXPECT_EQ(writer_->stats().unsynced, 2U);
}

TEST_F(RecordingSyncTest, F43ASyncThatFailsAtTheEndIsCountedToo) {
  Begin(1s);
  for (int i = 0; i < 2; ++i) WriteChunk();
  Write();
  disk_.sync_fails = true;
  EXPECT_EQ(writer_->Close().code(), StatusCode::kIoError);
  EXPECT_EQ(writer_->stats().depth_frames, 1U);
  EXPECT_EQ(writer_->stats().unsynced, 2U);
}

}  // namespace
}  // namespace isotherm

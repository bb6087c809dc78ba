// isotherm-edge as a process, when the disk of its recording fails, fills up or is taken away.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mount.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/system/edge_failure.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST_F(EdgeFailureTest, F40TwoScansOfOneSecondGetAFileEach) {
  std::filesystem::create_directory(disk_);
  const std::vector<std::string> arguments = {"--recording", scan_, "--record",     disk_,
                                              "--rate",      "0",   "--exit-at-end"};
  Process one(Edge(arguments));
  Process two(Edge(arguments));
  EXPECT_EQ(one.WaitForExit(kPatience), 0) << one.output();
  EXPECT_EQ(two.WaitForExit(kPatience), 0) << two.output();
  const auto files = FilesIn(disk_);
  ASSERT_EQ(files.size(), 2U);
  for (const auto& file : files) EXPECT_EQ(ReadRecording(file).depth.size(), 30U) << file;
}

TEST_F(EdgeFailureTest, F37AKilledEdgeLeavesAReadableFileAndTheNextOneItsOwn) {
  RecordingContent before;
  {
    Process edge(Replay({"--record", file_}));
    ASSERT_TRUE(WaitForSize(edge, file_, 100'000)) << edge.output();
    before = ReadRecording(file_);
    edge.Signal(SIGKILL);
    edge.WaitForExit(kPatience);
  }
  const RecordingContent after = ReadRecording(file_);
  EXPECT_FALSE(after.complete);
  ASSERT_GE(after.depth.size(), before.depth.size());
  EXPECT_THAT(before.depth, Not(IsEmpty()));
  const std::uintmax_t size = std::filesystem::file_size(file_);
  const Finished next = RunToEnd(
      Edge({"--recording", scan_, "--record", file_, "--rate", "0", "--exit-at-end"}), kPatience);
  EXPECT_EQ(next.status, 0) << next.output;
  EXPECT_EQ(std::filesystem::file_size(file_), size) << "the first one is left alone";
  EXPECT_EQ(ReadRecording(disk_ / "copy-2.mcap").depth.size(), 30U);
}

/// errno of what a failing disk answers to fdatasync.
class F43SyncErrorTest : public EdgeFailureTest, public ::testing::WithParamInterface<int> {};

TEST_P(F43SyncErrorTest, TheFileIsLeftANewOneBegunAndEachFrameIsAccountedFor) {
  const std::filesystem::path failing = folder_.path() / "failing";
  Command command = Replay({"--record", file_});
  command.environment.push_back("LD_PRELOAD=" FAILING_DISK);
  command.environment.push_back("FAILING_DISK=" + failing.string());
  Process edge(command);
  ASSERT_TRUE(WaitForSize(edge, file_, 50'000)) << edge.output();
  const std::filesystem::path next = failing.string() + ".next";
  std::ofstream(next) << GetParam();
  std::filesystem::rename(next, failing);
  ASSERT_TRUE(edge.WaitForOutput("recording ended early", kPatience)) << edge.output();
  EXPECT_TRUE(manager_.WaitForText("STATUS=not recording: cannot sync", kPatience));
  EXPECT_TRUE(edge.WaitForOutput("recording to", kPatience, 2)) << "it is tried again";
  std::filesystem::remove(failing);
  ASSERT_TRUE(edge.WaitForOutput("the disk works again", kPatience)) << edge.output();
  ExpectToLeave(edge, 73);
  EXPECT_EQ(Count(edge.output(), "recording ended early"), 1) << edge.output();

  const FrameCountersText counters = CountersOf(edge.output(), Sensor::kDepth, "recorded");
  EXPECT_TRUE(counters.Closes()) << edge.output();
  EXPECT_GT(counters.failed, 0);
  long found = 0;
  const auto files = FilesIn(disk_);
  ASSERT_EQ(files.size(), 2U) << "the suspect one and the next; none without a frame";
  for (const auto& file : files) found += static_cast<long>(ReadRecording(file).depth.size());
  // Frames that were not synced count as lost, and may be there all the same.
  EXPECT_GE(found, counters.done);
  EXPECT_LE(found, counters.done + counters.failed);
}

INSTANTIATE_TEST_SUITE_P(Errors, F43SyncErrorTest, ::testing::Values(EIO, EROFS, ENOSPC));

TEST_F(EdgeFailureTest, F43ADiskThatIsTakenAwayAndComesBackGetsTheNextFile) {
  const std::filesystem::path away = folder_.path() / "away";
  Command command = Replay({"--record", file_});
  command.environment.push_back("LD_PRELOAD=" FAILING_DISK);
  command.environment.push_back("FAILING_DISK=" + away.string());
  command.environment.push_back("FAILING_DISK_FOLDER=" + disk_.string());
  Process edge(command);
  ASSERT_TRUE(WaitForSize(edge, file_, 50'000)) << edge.output();
  const std::filesystem::path next = away.string() + ".next";
  std::ofstream(next) << ENODEV;
  std::filesystem::rename(next, away);
  ASSERT_TRUE(edge.WaitForOutput("recording ended early", kPatience)) << edge.output();
  EXPECT_TRUE(manager_.WaitForText("STATUS=not recording: cannot create", kPatience))
      << edge.output();
  std::filesystem::remove(away);
  ASSERT_TRUE(edge.WaitForOutput("the disk works again", kPatience)) << edge.output();
  ExpectToLeave(edge, 73);
  const FrameCountersText recorded = CountersOf(edge.output(), Sensor::kDepth, "recorded");
  EXPECT_TRUE(recorded.Closes()) << edge.output();
  EXPECT_GT(recorded.failed, 0);
  const FrameCountersText published = CountersOf(edge.output(), Sensor::kDepth, "published");
  EXPECT_EQ(published.done, published.captured) << "the link does not need the disk";
  const auto files = FilesIn(disk_);
  ASSERT_EQ(files.size(), 2U);
  long found = 0;
  for (const auto& file : files) found += static_cast<long>(ReadRecording(file).depth.size());
  EXPECT_GE(found, recorded.done);
  EXPECT_LE(found, recorded.done + recorded.failed);
}

/// A disk of which each sync takes a second, twice the time in which a chunk is captured.
class F42SlowDiskTest : public EdgeFailureTest {
 protected:
  /// Records until `bytes` more are there, ends the edge, and returns what it said. The file has
  /// what is counted as recorded.
  std::string Record(std::vector<std::string> more, std::uintmax_t bytes) {
    const std::filesystem::path slow = folder_.path() / "slow";
    more.insert(more.end(), {"--record", file_});
    Command command = Replay(std::move(more));
    command.environment.insert(command.environment.end(),
                               {"LD_PRELOAD=" STUCK_DISK, "STUCK_DISK_WHILE=" + slow.string(),
                                "STUCK_DISK_NAME=copy.mcap"});
    Process edge(command);
    EXPECT_TRUE(WaitForSize(edge, file_, 20'000)) << edge.output();
    const std::filesystem::path next = slow.string() + ".next";
    std::ofstream(next) << 1000;
    std::filesystem::rename(next, slow);
    EXPECT_TRUE(WaitForSize(edge, file_, std::filesystem::file_size(file_) + bytes))
        << edge.output();
    ExpectToLeave(edge, 0, kTimeToLeave + kForTheDisk);
    const FrameCountersText recorded = CountersOf(edge.output(), Sensor::kDepth, "recorded");
    EXPECT_TRUE(recorded.Closes()) << edge.output();
    const RecordingContent content = ReadRecording(file_);
    EXPECT_TRUE(content.complete);
    EXPECT_EQ(static_cast<long>(content.depth.size()), recorded.done);
    return edge.output();
  }
};

TEST_F(F42SlowDiskTest, ItLosesNothing) {
  const std::string output = Record({}, 250'000);
  const FrameCountersText recorded = CountersOf(output, Sensor::kDepth, "recorded");
  EXPECT_EQ(recorded.done, recorded.captured) << output;
}

TEST_F(F42SlowDiskTest, WhatFindsNoRoomBeforeItIsCountedAndPublished) {
  // A third of a second may wait.
  const std::string output = Record({"--set", "spool.expert.queue_frames=20"}, 100'000);
  EXPECT_GT(CountersOf(output, Sensor::kDepth, "recorded").queue_full, 0) << output;
  const FrameCountersText published = CountersOf(output, Sensor::kDepth, "published");
  EXPECT_EQ(published.done, published.captured) << output;
}

/// A file system of its own, which takes root.
class SmallDiskTest : public EdgeFailureTest {
 protected:
  void Mount(int megabytes) {
    std::filesystem::create_directory(disk_);
    const std::string size = "size=" + std::to_string(megabytes) + "m";
    if (mount("none", disk_.c_str(), "tmpfs", 0, size.c_str()) != 0)
      GTEST_SKIP() << "no file system of its own: mounting takes root";
    mounted_ = true;
  }
  ~SmallDiskTest() override {
    if (mounted_) umount2(disk_.c_str(), MNT_DETACH);
  }

 private:
  bool mounted_ = false;
};

TEST_F(SmallDiskTest, F41AFullDiskIsWaitedForAndNoFrameIsLostUncounted) {
  Mount(4);
  if (IsSkipped()) return;
  const std::filesystem::path ballast = disk_ / "ballast";
  {
    std::ofstream other(ballast);
    other << std::string(4'180'000, 'x');
  }
  // Without a reserve the disk itself says no.
  Process edge(Replay({"--record", file_, "--set", "spool.expert.reserve_mb=0", "--set",
                       "spool.expert.reserve_s=0"}));
  ASSERT_TRUE(edge.WaitForOutput("recording ended early", kPatience)) << edge.output();
  EXPECT_TRUE(manager_.WaitForText("STATUS=not recording: cannot write", kPatience))
      << edge.output();
  std::filesystem::remove(ballast);
  ASSERT_TRUE(edge.WaitForOutput("the disk works again", kPatience)) << edge.output();
  ExpectToLeave(edge, 73);
  const FrameCountersText counters = CountersOf(edge.output(), Sensor::kDepth, "recorded");
  EXPECT_TRUE(counters.Closes()) << edge.output();
  long found = 0;
  for (const auto& file : FilesIn(disk_)) {
    EXPECT_GT(std::filesystem::file_size(file), 0U);
    found += static_cast<long>(ReadRecording(file).depth.size());
  }
  EXPECT_EQ(found, counters.done);
}

TEST_F(SmallDiskTest, F41AtTheReserveTheRecordingIsCompleteAndPublishingGoesOn) {
  Mount(64);
  if (IsSkipped()) return;
  // As soon as the rate is known, the reserve is all that this disk has but for 0.1 MB.
  Process edge(Replay({"--record", file_, "--set", "spool.expert.reserve_s=86400", "--set",
                       "spool.expert.reserve_mb=67"}));
  ASSERT_TRUE(edge.WaitForOutput("the disk is full but for its reserve", kPatience))
      << edge.output();
  const RecordingContent content = ReadRecording(file_);
  EXPECT_TRUE(content.complete);
  EXPECT_THAT(content.depth, Not(IsEmpty()));
  EXPECT_TRUE(manager_.WaitForText("STATUS=not recording: the disk is full", kPatience));
  ExpectToLeave(edge, 73);
  const FrameCountersText published = CountersOf(edge.output(), Sensor::kDepth, "published");
  EXPECT_EQ(published.done, published.captured);
  EXPECT_GT(published.done, static_cast<long>(content.depth.size()));
}

TEST_F(SmallDiskTest, F41AScanThatIsToBeRecordedWholeIsStoppedAtTheReserveAndAnotherCanBegin) {
  Mount(64);
  if (IsSkipped()) return;
  Process edge(Replay({"--record", file_, "--set", "spool.expert.reserve_s=86400", "--set",
                       "spool.expert.reserve_mb=67", "--set", "spool.when_full=STOP_SCAN"}));
  // The manager must be read from meanwhile.
  EXPECT_TRUE(manager_.WaitForText("STATUS=not recording: the disk is full", kPatience));
  ASSERT_TRUE(edge.WaitForOutput("the scan has ended as ordered", kPatience)) << edge.output();
  EXPECT_THAT(edge.output(), HasSubstr("the scan is stopped (spool.when_full=STOP_SCAN)"));
  const RecordingContent content = ReadRecording(file_);
  EXPECT_TRUE(content.complete);
  EXPECT_THAT(content.depth, Not(IsEmpty()));
  EXPECT_FALSE(edge.HasEnded(Seconds(0))) << "it waits for the order to start another one";
  ExpectToLeave(edge, 73);
  const FrameCountersText recorded = CountersOf(edge.output(), Sensor::kDepth, "recorded");
  EXPECT_TRUE(recorded.Closes()) << edge.output();
  // Some come while it is noticed.
  EXPECT_LT(recorded.captured - recorded.done, 200) << edge.output();
}

}  // namespace
}  // namespace isotherm::system_test

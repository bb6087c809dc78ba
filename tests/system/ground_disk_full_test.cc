// The ground on a disk that fails or is full, and works again or has room again.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <set>
#include <system_error>
#include <thread>

#include "tests/support/programs.h"
#include "tests/system/ground_disk.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Returns the numbers of the depth frames of all recordings in `folder`. Each file must be
/// readable.
std::multiset<std::uint64_t> DepthNumbersIn(const std::filesystem::path& folder) {
  std::multiset<std::uint64_t> numbers;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".mcap") continue;
    for (const auto& depth : ReadRecording(entry.path()).depth) numbers.insert(depth.frame_number);
  }
  return numbers;
}

/// Waits until this much of a recording is on the disk.
bool WaitForSize(const std::filesystem::path& path, std::uintmax_t bytes) {
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  std::error_code error;
  for (;;) {
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (!error && size >= bytes) return true;
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
}

/// errno of what a failing disk answers to fdatasync.
class F43GroundDiskTest : public GroundDiskTest, public ::testing::WithParamInterface<int> {};

TEST_P(F43GroundDiskTest, AfterAWriteErrorASecondFileIsBegunAndEachFrameIsAccountedFor) {
  const std::filesystem::path failing = Path("failing");
  Command command = Ground({"--once"});
  command.environment = {"LD_PRELOAD=" FAILING_DISK, "FAILING_DISK=" + failing.string()};
  Process ground(command);
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process edge(Edge(0));
  ASSERT_TRUE(WaitForSize(Path("ground/scan.mcap"), 200'000)) << edge.output() << ground.output();
  const std::filesystem::path next = failing.string() + ".next";
  std::ofstream(next) << GetParam();
  std::filesystem::rename(next, failing);
  ASSERT_TRUE(ground.WaitForOutput("the recording stops here", kPatience)) << ground.output();
  std::filesystem::remove(failing);
  ASSERT_TRUE(ground.WaitForOutput("the disk works again", kPatience)) << ground.output();
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  EXPECT_EQ(ground.WaitForExit(kPatience), GetParam() == ENOSPC ? kDiskFull : kDiskStuck)
      << ground.output();
  EXPECT_THAT(ground.output(), HasSubstr("frames are not in the recording, because the disk"));
  EXPECT_THAT(ground.output(), HasSubstr("the recording has 2 files"));

  const auto stats = ReadStats(Path("ground"));
  ExpectEachFrameAccountedFor(stats, "depth");
  ExpectEachFrameAccountedFor(stats, "thermal");
  const double lost = NumberAt(stats, {"link", "depth", "not_recorded_by_reason", "disk_failed"});
  EXPECT_GT(lost, 0);
  const std::multiset<std::uint64_t> numbers = DepthNumbersIn(Path("ground"));
  // Frames that were not synced count as lost, and may be there all the same.
  const double recorded = NumberAt(stats, {"link", "depth", "recorded"});
  EXPECT_GE(static_cast<double>(numbers.size()), recorded);
  EXPECT_LE(static_cast<double>(numbers.size()), recorded + lost);
  if (HasFailure()) std::cout << "edge:\n" << edge.output() << "ground:\n" << ground.output();
}

INSTANTIATE_TEST_SUITE_P(Errors, F43GroundDiskTest, ::testing::Values(EIO, EROFS, ENOSPC));

TEST_F(GroundDiskTest, F43ADiskThatIsTakenAwayAndComesBackGetsTheNextFile) {
  const std::filesystem::path away = Path("away");
  Command command = Ground({"--once"});
  command.environment = {"LD_PRELOAD=" FAILING_DISK, "FAILING_DISK=" + away.string(),
                         "FAILING_DISK_FOLDER=" + Path("ground").string()};
  Process ground(command);
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process edge(Edge(0, "1"));
  ASSERT_TRUE(WaitForSize(Path("ground/scan.mcap"), 200'000)) << edge.output() << ground.output();
  const std::filesystem::path next = away.string() + ".next";
  std::ofstream(next) << ENODEV;
  std::filesystem::rename(next, away);
  ASSERT_TRUE(ground.WaitForOutput("the recording stops here", kPatience)) << ground.output();
  ASSERT_TRUE(ground.WaitForOutput("NOT RECORDING", kPatience)) << ground.output();
  EXPECT_FALSE(std::filesystem::exists(Path("ground/scan-2.mcap")));
  std::filesystem::remove(away);
  ASSERT_TRUE(ground.WaitForOutput("the disk works again", kPatience)) << ground.output();
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  EXPECT_EQ(ground.WaitForExit(kPatience), kDiskStuck) << ground.output();
  const auto stats = ReadStats(Path("ground"));
  ExpectEachFrameAccountedFor(stats, "depth");
  ExpectEachFrameAccountedFor(stats, "thermal");
  EXPECT_EQ(NumberAt(stats, {"link", "depth", "received"}),
            NumberAt(stats, {"link", "depth", "published"}))
      << "the link goes on without the disk";
  EXPECT_TRUE(std::filesystem::exists(Path("ground/scan-2.mcap")));
  if (HasFailure()) std::cout << "edge:\n" << edge.output() << "ground:\n" << ground.output();
}

/// A ground for one scan with a small file system as its output folder, whose content is in
/// Path("kept") afterwards.
class SmallDiskTest : public GroundDiskTest {
 protected:
  static Command Unshared(const std::string& script) {
    return {"/usr/bin/unshare", {"--map-root-user", "--mount", "/bin/sh", "-c", script}, {}};
  }

  /// Starts it, with `before` done on the file system first; null if this computer does not allow
  /// that.
  std::unique_ptr<Process> StartGround(const std::string& size, const std::string& before = ":") {
    const std::string disk = Path("ground").string();
    std::filesystem::create_directories(disk);
    std::filesystem::create_directories(Path("elsewhere"));
    const std::string mount = "mount -t tmpfs -o size=" + size + " none '" + disk + "'";
    if (!std::filesystem::exists("/usr/bin/unshare") ||
        RunToEnd(Unshared(mount), kPatience).status != 0)
      return nullptr;
    std::string program = "'" + GroundService().string() + "'";
    for (const std::string& argument : Ground({"--once"}).arguments)
      program += " '" + argument + "'";
    Command command =
        Unshared(mount + " && " + before + "\n" + program + "; status=$?; cp -r '" + disk + "' '" +
                 Path("kept").string() + "'; df -k '" + disk + "'; exit $status");
    command.environment = {"TMPDIR=" + Path("elsewhere").string()};
    return std::make_unique<Process>(command);
  }
  std::optional<Finished> RunGround(const std::string& size, int loops) {
    const std::unique_ptr<Process> started = StartGround(size);
    if (!started) return std::nullopt;
    Process& ground = *started;
    EXPECT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
    const Finished edge = RunToEnd(Edge(loops), kPatience);
    EXPECT_EQ(edge.status, 0) << edge.output;
    Finished finished;
    finished.status = ground.WaitForExit(kPatience).value_or(-1);
    finished.output = ground.output();
    return finished;
  }
};

TEST_F(SmallDiskTest, F41AFullDiskCostsTheRecordingsEndNotTheResults) {
  const std::optional<Finished> ground = RunGround("30m", 6);
  if (!ground) GTEST_SKIP() << "mounting a small file system is not allowed here";
  EXPECT_EQ(ground->status, kDiskFull) << ground->output;
  EXPECT_THAT(ground->output, HasSubstr("are kept for the results"));
  EXPECT_THAT(ground->output, HasSubstr("what was left of the disk was kept for the results"));
  for (const char* name : {"model.iso", "cloud.ply", "mesh.ply", "trajectory.txt"})
    EXPECT_TRUE(std::filesystem::exists(Path("kept") / name)) << name << "\n" << ground->output;
  const auto stats = ReadStats(Path("kept"));
  ExpectWholeCounters(stats, "depth");
  ExpectWholeCounters(stats, "thermal");
  EXPECT_GT(NumberAt(stats, {"link", "depth", "not_recorded_by_reason", "disk_nearly_full"}), 0);
  const RecordingContent recording = ReadRecording(Path("kept/scan.mcap"));
  EXPECT_TRUE(recording.complete) << "it ends in order";
  EXPECT_EQ(static_cast<double>(recording.depth.size()),
            NumberAt(stats, {"link", "depth", "recorded"}));
  EXPECT_THAT(recording.depth, Not(IsEmpty()));
  if (HasFailure()) std::cout << ground->output;
}

TEST_F(SmallDiskTest, F41WhenThereIsRoomAgainASecondFileHasTheFramesFromThereOn) {
  const std::string ballast = "'" + Path("ground/ballast").string() + "'";
  const std::filesystem::path room = Path("room");
  const std::unique_ptr<Process> ground =
      StartGround("200m", "head -c 150000000 /dev/zero > " + ballast + "; (while [ ! -e '" +
                              room.string() + "' ]; do sleep 0.1; done; rm " + ballast + ") &");
  if (!ground) GTEST_SKIP() << "mounting a small file system is not allowed here";
  ASSERT_TRUE(ground->WaitForOutput("ready", kPatience)) << ground->output();
  Process edge(Edge(0));
  ASSERT_TRUE(ground->WaitForOutput("are kept for the results", kPatience)) << ground->output();
  std::ofstream(room).put('x');
  ASSERT_TRUE(ground->WaitForOutput("there is room on the disk again", kPatience))
      << ground->output();
  ASSERT_TRUE(ground->WaitForOutput("recording to", kPatience)) << ground->output();
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  EXPECT_EQ(ground->WaitForExit(kPatience), kDiskFull) << ground->output();
  const auto stats = ReadStats(Path("kept"));
  ExpectEachFrameAccountedFor(stats, "depth");
  ExpectEachFrameAccountedFor(stats, "thermal");
  for (const char* name : {"kept/scan.mcap", "kept/scan-2.mcap"}) {
    const RecordingContent recording = ReadRecording(Path(name));
    EXPECT_TRUE(recording.complete) << name;
    EXPECT_THAT(recording.depth, Not(IsEmpty())) << name;
  }
  // Each published frame is in one of both files, or was counted as left out.
  const std::multiset<std::uint64_t> numbers = DepthNumbersIn(Path("kept"));
  EXPECT_EQ(std::set<std::uint64_t>(numbers.begin(), numbers.end()).size(), numbers.size());
  EXPECT_EQ(static_cast<double>(numbers.size()), NumberAt(stats, {"link", "depth", "recorded"}));
  if (HasFailure()) std::cout << "edge:\n" << edge.output() << ground->output();
}

TEST_F(SmallDiskTest, F41ResultsThatFindNoRoomGoElsewhereAndItIsSaid) {
  const std::optional<Finished> ground = RunGround("1m", 1);
  if (!ground) GTEST_SKIP() << "mounting a small file system is not allowed here";
  EXPECT_EQ(ground->status, kDiskFull) << ground->output;
  const std::filesystem::path elsewhere = Path("elsewhere/isotherm-ground");
  EXPECT_THAT(ground->output, HasSubstr("the results are in " + elsewhere.string()));
  for (const char* name : {"model.iso", "cloud.ply", "mesh.ply", "trajectory.txt", "stats.json"})
    EXPECT_TRUE(std::filesystem::exists(elsewhere / name)) << name << "\n" << ground->output;
  const auto stats = ReadStats(elsewhere);
  ExpectWholeCounters(stats, "depth");
  ExpectWholeCounters(stats, "thermal");
  if (HasFailure()) std::cout << ground->output;
}

}  // namespace
}  // namespace isotherm::system_test

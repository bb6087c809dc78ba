// The installed units when something fails: killed, stopped, without what they need, and while
// results take long.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/system/units.h"

namespace isotherm::system_test {
namespace {

using ::testing::IsEmpty;
using ::testing::Not;

/// The main process of a service that runs; empty while it does not.
std::string MainPid(const Container& container, const std::string& unit) {
  const std::string shown = container.Output("systemctl show --property SubState,MainPID " + unit);
  const std::size_t pid = shown.find("MainPID=");
  if (shown.find("SubState=running") == std::string::npos || pid == std::string::npos) return "";
  return shown.substr(pid, shown.find('\n', pid) - pid);
}

/// Returns whether `unit` runs, has not been started again, and says `reason` in its status.
bool RunsAndSays(const Container& container, const std::string& unit, const std::string& reason) {
  const std::string shown =
      container.Output("systemctl show --property SubState,NRestarts,StatusText " + unit);
  return shown.find("SubState=running") != std::string::npos &&
         shown.find("NRestarts=0") != std::string::npos && shown.find(reason) != std::string::npos;
}

TEST_F(UnitsTest, F37F40StartedAgainAtOnceHoweverOftenItIsKilled) {
  for (const std::string& unit : {kGround, kEdge}) {
    ASSERT_EQ(Run({"systemctl", "start", unit}).status, 0);
    constexpr int kKills = 7;  // Systemd by itself gives up after five starts in ten seconds.
    for (int kill = 1; kill <= kKills; ++kill) {
      const std::string pid = MainPid(*container_, unit);
      ASSERT_THAT(pid, Not(IsEmpty())) << unit;
      Run({"systemctl", "kill", "--kill-who", "main", "--signal", "KILL", unit});
      ASSERT_TRUE(Until(kPatience,
                        [&] {
                          const std::string now = MainPid(*container_, unit);
                          return !now.empty() && now != pid;
                        }))
          << unit << ' ' << Property(unit, "Result");
      // As the service manager's clock has it.
      const double ended = std::stod(Property(unit, "InactiveEnterTimestampMonotonic"));
      const double started = std::stod(Property(unit, "ExecMainStartTimestampMonotonic"));
      EXPECT_LT((started - ended) * 1e-6, 2.0) << unit << " kill " << kill;
    }
    EXPECT_EQ(Property(unit, "NRestarts"), std::to_string(kKills)) << unit;
  }
}

TEST_F(UnitsScanTest, F33AnEdgeThatIsKilledGoesOnWithItsScan) {
  Prepare(2, Plays::kForEver);
  ASSERT_EQ(Run({"systemctl", "start", kGround, kEdge}).status, 0);
  const std::filesystem::path recordings = root() / "var/lib/isotherm/edge";
  const auto files = [&recordings] {
    std::vector<std::filesystem::path> found;
    for (const auto& entry : std::filesystem::directory_iterator(recordings))
      found.push_back(entry);
    return found;
  };
  constexpr std::uintmax_t kSomeFrames_bytes = 500'000;
  ASSERT_TRUE(Until(kPatience, [&] {
    return JournalHas("first depth frame") && !files().empty() &&
           std::filesystem::file_size(files().front()) > kSomeFrames_bytes;
  }));
  Run({"systemctl", "kill", "--kill-who", "main", "--signal", "KILL", kEdge});
  ASSERT_TRUE(Until(kPatience, [&] { return JournalHas("was interrupted, and goes on"); }));
  ASSERT_TRUE(Until(kPatience, [&] { return files().size() == 2; }));
  ASSERT_TRUE(Until(kPatience, [&] {
    return std::filesystem::file_size(files()[0]) > kSomeFrames_bytes &&
           std::filesystem::file_size(files()[1]) > kSomeFrames_bytes;
  }));
  EXPECT_EQ(Run({"systemctl", "stop", kEdge}).status, 0);
  ASSERT_TRUE(Until(kPatience, [&] { return JournalHas("results  "); }));
  const auto stats = ReadStats(OnlyScan());
  EXPECT_GT(NumberAt(stats, {"link", "depth", "dropped_by_rig", "lost_by_a_restart"}), 0.0);
  EXPECT_EQ(NumberAt(stats, {"link", "depth", "missing"}), 0.0);
}

/// The results take longer than the service manager waits by itself: a disk that hangs for a while.
TEST_F(UnitsScanTest, F38AServiceWhoseResultsTakeLongIsNotKilledAndTheyAreWhole) {
  std::filesystem::copy_file(STUCK_DISK, root() / "usr/lib/stuck_disk.so",
                             std::filesystem::copy_options::overwrite_existing);
  AddToUnit(kGround,
            "TimeoutStopSec=2\n"
            "Environment=LD_PRELOAD=/usr/lib/stuck_disk.so STUCK_DISK_NAME=cloud.ply "
            "STUCK_DISK_WHILE=/run/isotherm-ground/stuck\n");
  Prepare(2, Plays::kOnce);
  ASSERT_EQ(Run({"systemctl", "start", kGround}).status, 0);
  container_->Output("touch /run/isotherm-ground/stuck");
  ASSERT_EQ(Run({"systemctl", "start", kEdge}).status, 0);
  ASSERT_TRUE(Until(kPatience, [&] {
    return Run({"test", "-e", "/run/isotherm-ground/stuck.reached"}).status == 0;
  }));
  ASSERT_EQ(Run({"systemctl", "stop", "--no-block", kGround}).status, 0);
  const auto is_leaving = [] { return Property(kGround, "ActiveState") == "deactivating"; };
  ASSERT_TRUE(Until(kPatience, is_leaving));
  EXPECT_FALSE(Until(Seconds(8), [&] { return !is_leaving(); })) << "four times its time to stop";
  container_->Output("rm /run/isotherm-ground/stuck");
  EXPECT_TRUE(Until(kPatience, [] { return Property(kGround, "ActiveState") == "inactive"; }));
  EXPECT_EQ(Property(kGround, "Result"), "success");
  EXPECT_TRUE(std::filesystem::exists(OnlyScan() / "cloud.ply"));
}

TEST_F(UnitsScanTest, F39ADaemonThatIsStoppedIsKilledByTheWatchdogAndComesBack) {
  Prepare(1, Plays::kForEver);
  ASSERT_EQ(Run({"systemctl", "start", kGround, kEdge}).status, 0);
  std::map<std::string, std::string> stopped;
  for (const std::string& unit : {kEdge, kGround}) {
    ExpectWatched(unit);
    stopped[unit] = MainPid(*container_, unit);
    ASSERT_THAT(stopped[unit], Not(IsEmpty())) << unit;
    Run({"systemctl", "kill", "--kill-who", "main", "--signal", "STOP", unit});
  }
  for (const std::string& unit : {kEdge, kGround}) {
    ASSERT_TRUE(Until(kPatience, [&] {
      const std::string now = MainPid(*container_, unit);
      return !now.empty() && now != stopped[unit];
    })) << container_->Output("systemctl status " + unit);
    EXPECT_TRUE(JournalHas(unit + ": Failed with result 'watchdog'")) << unit;
    EXPECT_EQ(Property(unit, "NRestarts"), "1") << unit;
    EXPECT_EQ(Property(unit, "Result"), "success") << unit;
    ExpectWatched(unit);
  }
  // As healthy as before: the edge captures, and the ground follows it.
  EXPECT_TRUE(Until(kPatience, [&] {
    return container_->Output("systemctl show --value --property StatusText " + kGround)
               .find("depth") != std::string::npos;
  })) << container_->Output("systemctl status " + kGround);
  EXPECT_EQ(container_->Output("systemctl --failed --no-legend"), "");
}

TEST_F(UnitsTest, F01TheEdgeAsShippedWaitsForItsCamera) {
  ASSERT_EQ(Run({"systemctl", "start", kEdge}).status, 0);
  EXPECT_TRUE(Until(kPatience, [&] {
    return RunsAndSays(*container_, kEdge, "waiting for a camera");
  })) << container_->Output("systemctl status " + kEdge);
}

TEST_F(UnitsScanTest, F31BothWaitForAnInterfaceThatIsMissing) {
  Prepare(1, Plays::kForEver);
  Configure("network.env",
            "CYCLONEDDS_URI=<General><Interfaces><NetworkInterface name=\"wlan9\"/></Interfaces>"
            "</General>\n");
  for (const std::string& unit : {kEdge, kGround}) {
    ASSERT_EQ(Run({"systemctl", "start", unit}).status, 0) << unit;
    EXPECT_TRUE(Until(kPatience, [&] { return RunsAndSays(*container_, unit, "cannot join"); }))
        << container_->Output("systemctl status " + unit);
  }
}

TEST_F(UnitsScanTest, F41ADiskThatIsFullAtTheStartDoesNotEndTheEdge) {
  Prepare(1, Plays::kForEver);
  container_->Output(
      "mkdir -p /var/lib/isotherm/edge; mount -t tmpfs -o size=16k full /var/lib/isotherm/edge; "
      "head -c 100000 /dev/zero >/var/lib/isotherm/edge/full");
  ASSERT_EQ(Run({"systemctl", "start", kEdge}).status, 0);
  EXPECT_TRUE(Until(kPatience, [&] { return RunsAndSays(*container_, kEdge, "not recording"); }))
      << container_->Output("systemctl status " + kEdge);
  Run({"systemctl", "stop", kEdge});
  container_->Output("umount /var/lib/isotherm/edge");
}

}  // namespace
}  // namespace isotherm::system_test

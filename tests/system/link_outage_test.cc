// Both daemons on a network that carries nothing for a while, or loses packets. Takes root, for
// network namespaces.

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/small_scan.h"
#include "tests/system/two_hosts.h"

namespace isotherm::system_test {
namespace {

/// The small scan is played as a camera would.
constexpr double kRate_hz = 30.0;
/// The edge holds this by itself: a queue of 2 s for both streams, and the middleware's history.
constexpr double kHeld_s = 3.0;
/// Frames that may be under way where the numbers are looked at.
constexpr double kUnderWay = 10.0;
/// An edge, and a ground that has nobody to listen to. Buffers that are full once come late.
constexpr long kMaxGrowth_kB = 24 * 1024;

class LinkOutageTest : public TwoHostsTest {
 protected:
  void SetUp() override {
    TwoHostsTest::SetUp();
    if (!IsSkipped()) WriteSmallScan(scan_);
  }
  /// Both daemons, once frames arrive.
  void Start(const std::string& edge_profile, const std::string& ground_profile) {
    Connect();
    ground_process_.emplace(
        On(ground_, ground_profile, GroundService(), {"--output", folder_.path() / "ground"}));
    ASSERT_TRUE(ground().WaitForOutput("ready", kPatience)) << ground().output();
    edge_process_.emplace(On(edge_, edge_profile, EdgeDaemon(),
                             {"--recording", scan_, "--set", "source.loops=0", "--record", copy_}));
    ASSERT_TRUE(ground().WaitForOutput("scan started", kPatience))
        << ground().output() << edge().output();
    Pass(Seconds(2));
  }
  /// Time passes, and frames with it.
  static void Pass(Seconds duration) { std::this_thread::sleep_for(duration); }
  /// Ends both and reads what became of the scan.
  google::protobuf::Struct End() {
    edge().Signal(SIGTERM);
    EXPECT_EQ(edge().WaitForExit(kPatience), 0) << edge().output();
    EXPECT_TRUE(ground().WaitForOutput("scan ended", kPatience)) << ground().output();
    ground().Signal(SIGTERM);
    EXPECT_EQ(ground().WaitForExit(kPatience), 0) << ground().output();
    std::filesystem::path scan;
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path() / "ground")) {
      if (std::filesystem::exists(entry.path() / "stats.json")) scan = entry.path();
    }
    return ReadStats(scan);
  }
  void ExpectTheEdgeHasRecordedAll() {
    const RecordingContent content = ReadRecording(copy_);
    EXPECT_TRUE(content.complete);
    const FrameCountersText counters = CountersOf(edge().output(), Sensor::kDepth, "recorded");
    EXPECT_EQ(counters.done, counters.captured) << edge().output();
    EXPECT_EQ(static_cast<long>(content.depth.size()), counters.done);
    EXPECT_TRUE(CountersOf(edge().output(), Sensor::kDepth, "published").Closes());
  }
  /// All that was captured has arrived.
  void ExpectNothingIsLost(const google::protobuf::Struct& stats) {
    for (const auto& [sensor, name] :
         {std::pair(Sensor::kDepth, "depth"), std::pair(Sensor::kThermal, "thermal")}) {
      const FrameCountersText counters = CountersOf(edge().output(), sensor, "published");
      EXPECT_GT(counters.captured, 60) << name;
      EXPECT_EQ(NumberAt(stats, {"link", name, "received"}), static_cast<double>(counters.captured))
          << edge().output();
      EXPECT_EQ(NumberAt(stats, {"link", name, "missing"}), 0) << name;
    }
  }
  static long MemoryOf_kB(pid_t pid) {
    std::ifstream statm("/proc/" + std::to_string(pid) + "/statm");
    long size = 0;
    long resident = 0;
    statm >> size >> resident;
    return resident * (sysconf(_SC_PAGESIZE) / 1024);
  }
  static long Lines(const std::string& text, const std::string& words) {
    long count = 0;
    for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1))
      ++count;
    return count;
  }
  Process& edge() { return *edge_process_; }
  Process& ground() { return *ground_process_; }

  std::optional<Process> ground_process_;
  std::optional<Process> edge_process_;
};

TEST_F(LinkOutageTest, F24AnOutageOfASecondLosesNothing) {
  ASSERT_NO_FATAL_FAILURE(Start(LanProfile(edge_), LanProfile(ground_)));
  CarryNothing();
  Pass(Seconds(1));
  CarryAgain();
  Pass(Seconds(3));
  ExpectNothingIsLost(End());
  ExpectTheEdgeHasRecordedAll();
}

TEST_F(LinkOutageTest, F25F26F64ALongOutageCostsWhatIsNotHeldAndIsCountedAndSaidInFewLines) {
  ASSERT_NO_FATAL_FAILURE(Start(LanProfile(edge_), LanProfile(ground_)));
  constexpr Seconds kOutage{15};
  const long edge_before_kB = MemoryOf_kB(edge().pid());
  const long ground_before_kB = MemoryOf_kB(ground().pid());
  Set(edge_, "down");
  Set(ground_, "down");
  Pass(kOutage);
  EXPECT_LT(MemoryOf_kB(edge().pid()) - edge_before_kB, kMaxGrowth_kB);
  EXPECT_LT(MemoryOf_kB(ground().pid()) - ground_before_kB, kMaxGrowth_kB);
  Set(edge_, "up");
  Set(ground_, "up");
  ASSERT_TRUE(edge().WaitForOutput("ground station found", kPatience, 2)) << edge().output();
  Pass(Seconds(3));
  const auto stats = End();
  ExpectTheEdgeHasRecordedAll();
  for (const auto& [sensor, name] :
       {std::pair(Sensor::kDepth, "depth"), std::pair(Sensor::kThermal, "thermal")}) {
    const FrameCountersText counters = CountersOf(edge().output(), sensor, "published");
    const auto captured = static_cast<double>(counters.captured);
    const double received = NumberAt(stats, {"link", name, "received"});
    EXPECT_EQ(NumberAt(stats, {"link", name, "published"}),
              received + NumberAt(stats, {"link", name, "missing"}));
    EXPECT_LE(captured - received, kRate_hz * kOutage.count() + kRate_hz * kHeld_s) << name;
    EXPECT_GE(captured - received, kRate_hz * (kOutage.count() - kHeld_s) - kUnderWay) << name;
    // The drops of the rig's queue are known on the ground.
    const double dropped = static_cast<double>(counters.queue_full);
    EXPECT_EQ(NumberAt(stats, {"link", name, "captured_by_rig"}), captured) << name;
    EXPECT_EQ(NumberAt(stats, {"link", name, "dropped_by_rig", "queue_full"}), dropped) << name;
  }
  // In each direction something fails ten times a second and more.
  EXPECT_LE(Lines(edge().output(), "Dds: "), 10) << edge().output();
  EXPECT_LE(Lines(ground().output(), "Dds: "), 10) << ground().output();
}

/// As `profile` with so many of a thousand packets lost on the way out.
std::string Losing(std::string profile, int per_mille) {
  const std::string what = "<Internal>";
  return profile.replace(
      profile.find(what), what.size(),
      what + "<Test><XmitLossiness>" + std::to_string(per_mille) + "</XmitLossiness></Test>");
}

TEST_F(LinkOutageTest, F27ATenthOfAllPacketsLostOnALocalNetworkCostsNoFrame) {
  constexpr int kLost = 100;
  ASSERT_NO_FATAL_FAILURE(
      Start(Losing(LanProfile(edge_), kLost), Losing(LanProfile(ground_), kLost)));
  Pass(Seconds(5));
  ExpectNothingIsLost(End());
}

TEST_F(LinkOutageTest, F27AFifthOfAllPacketsLostOnARadioCostsNoFrame) {
  // The addresses are those of the shipped file.
  const std::string profile = Losing(Shipped("cyclonedds-radio.xml"), 200);
  ASSERT_NO_FATAL_FAILURE(Start(profile, profile));
  Pass(Seconds(5));
  ExpectNothingIsLost(End());
}

}  // namespace
}  // namespace isotherm::system_test

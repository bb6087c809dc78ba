// Edge and ground as two processes over DDS on loopback.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <fstream>
#include <iostream>
#include <memory>
#include <sstream>

#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::TemporaryDirectory;

/// A program must be gone this soon after SIGTERM.
constexpr Seconds kLeaveLimit{2};
/// Length of the simulated scan: long enough to be tracked, integrated and fused.
constexpr double kScan_s = 2.0;

std::vector<std::string> Joined(std::vector<std::string> a, const std::vector<std::string>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

class DaemonsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = std::make_unique<TemporaryDirectory>();
    SimulateScan(Source(), kScan_s);
  }
  static void TearDownTestSuite() { shared_.reset(); }
  static std::filesystem::path Source() { return shared_->path() / "source.mcap"; }

  std::filesystem::path Path(const std::string& name) const { return folder_.path() / name; }

  /// As fast as the ground takes it, so that the test needs no more time than the work does.
  Command Edge(const std::vector<std::string>& more = {}) const {
    return {EdgeDaemon(),
            Joined({"--recording", Source(), "--domain", std::to_string(OwnDomain()), "--record",
                    Path("edge.mcap")},
                   more),
            {}};
  }
  Command UnpacedEdge() const {
    return Edge({"--rate", "0", "--wait-for-ground", "--exit-at-end"});
  }

  Command Ground(const std::vector<std::string>& more = {}) const {
    return {
        GroundService(),
        Joined(Joined({"--domain", std::to_string(OwnDomain()), "--output", Path("ground")}, more),
               QuickModel()),
        {}};
  }

  void ExpectCountersAreExact(const char* sensor, std::size_t frames) const {
    const auto stats = ReadStats(Path("ground"));
    const auto count = [&](const char* what) { return NumberAt(stats, {"link", sensor, what}); };
    EXPECT_EQ(count("published"), static_cast<double>(frames)) << sensor;
    EXPECT_EQ(count("received"), count("published")) << sensor;
    EXPECT_EQ(count("recorded"), count("published")) << sensor;
    EXPECT_EQ(count("missing"), 0) << sensor;
    EXPECT_EQ(NumberAt(stats, {"frames", sensor, "in"}), count("published")) << sensor;
  }

  void ExpectNothingWasLost() const {
    const RecordingContent source = ReadRecording(Source());
    const RecordingContent edge = ReadRecording(Path("edge.mcap"));
    const RecordingContent ground = ReadRecording(Path("ground/scan.mcap"));
    EXPECT_TRUE(edge.complete);
    EXPECT_TRUE(ground.complete);
    ASSERT_THAT(source.depth, Not(IsEmpty()));
    ASSERT_THAT(source.thermal, Not(IsEmpty()));
    EXPECT_EQ(edge.depth.size(), source.depth.size());
    EXPECT_EQ(edge.thermal.size(), source.thermal.size());
    EXPECT_TRUE(ground.depth == edge.depth) << ground.depth.size() << " of " << edge.depth.size();
    EXPECT_TRUE(ground.thermal == edge.thermal)
        << ground.thermal.size() << " of " << edge.thermal.size();
    ExpectCountersAreExact("depth", source.depth.size());
    ExpectCountersAreExact("thermal", source.thermal.size());
  }

  static std::unique_ptr<TemporaryDirectory> shared_;
  TemporaryDirectory folder_;
};

std::unique_ptr<TemporaryDirectory> DaemonsTest::shared_;

TEST_F(DaemonsTest, NothingIsLostWhenTheGroundStartsFirst) {
  Process ground(Ground({"--once"}));
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  const Finished edge = RunToEnd(UnpacedEdge(), kPatience);
  EXPECT_EQ(edge.status, 0) << edge.output;
  EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();
  ExpectNothingWasLost();
  if (HasFailure()) std::cout << "edge:\n" << edge.output << "ground:\n" << ground.output();
}

TEST_F(DaemonsTest, NothingIsLostWhenTheEdgeStartsFirst) {
  Process edge(UnpacedEdge());
  ASSERT_TRUE(edge.WaitForOutput("waiting for a ground station", kPatience)) << edge.output();
  Process ground(Ground({"--once"}));
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();
  ExpectNothingWasLost();
  if (HasFailure()) std::cout << "edge:\n" << edge.output() << "ground:\n" << ground.output();
}

std::string ReadAll(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// Both drivers run the same stages on the same frames. A live scan has no second pass.
TEST_F(DaemonsTest, TheLiveResultEqualsTheReconstructionOfTheGroundsRecording) {
  Process ground(Ground({"--once"}));
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  ASSERT_EQ(RunToEnd(UnpacedEdge(), kPatience).status, 0);
  ASSERT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();

  const Finished inline_run =
      RunToEnd({Tool(),
                Joined({"reconstruct", Path("ground/scan.mcap"), "-o", Path("inline"), "--set",
                        "thermal.expert.finishing_pass=false"},
                       QuickModel()),
                {}},
               kPatience);
  ASSERT_EQ(inline_run.status, 0) << inline_run.output;

  const auto stats = ReadStats(Path("ground"));
  const auto inline_stats = ReadStats(Path("inline"));
  for (const auto& path : std::vector<std::vector<std::string>>{{"frames", "depth", "tracked"},
                                                                {"frames", "depth", "integrated"},
                                                                {"frames", "thermal", "fused"},
                                                                {"volume", "blocks"}}) {
    EXPECT_EQ(NumberAt(stats, path), NumberAt(inline_stats, path)) << path.back();
  }
  for (const char* name : {"cloud.ply", "mesh.ply", "model.iso", "trajectory.txt"}) {
    const std::string file = ReadAll(Path("ground") / name);
    EXPECT_GT(file.size(), 1000U) << name;
    EXPECT_TRUE(file == ReadAll(Path("inline") / name)) << name << " is not the same, bit for bit";
  }
}

TEST_F(DaemonsTest, F38SigtermEndsBothSoonWithEverythingFlushed) {
  Process ground(Ground());
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process edge(Edge({"--set", "source.loops=0"}));
  ASSERT_TRUE(ground.WaitForOutput("scan started", kPatience)) << ground.output() << edge.output();
  // In the middle of the scan: the edge has spoken to the ground for a while.
  EXPECT_EQ(edge.WaitForExit(Seconds(1.5)), std::nullopt) << edge.output();

  edge.Signal(SIGTERM);
  edge.Signal(SIGTERM);  // A second one must not tear anything down.
  EXPECT_EQ(edge.WaitForExit(kLeaveLimit), 0) << edge.output();
  ground.Signal(SIGTERM);
  ground.Signal(SIGTERM);
  EXPECT_EQ(ground.WaitForExit(kLeaveLimit), 0) << ground.output();

  const RecordingContent sent = ReadRecording(Path("edge.mcap"));
  EXPECT_TRUE(sent.complete);
  EXPECT_THAT(sent.depth, Not(IsEmpty()));
  std::filesystem::path scan;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(Path("ground"))) {
    if (entry.path().filename() == "scan.mcap") scan = entry.path();
  }
  ASSERT_FALSE(scan.empty()) << ground.output();
  EXPECT_TRUE(std::filesystem::exists(scan.parent_path() / "stats.json"));
  EXPECT_TRUE(std::filesystem::exists(scan.parent_path() / "cloud.ply"));
  const RecordingContent received = ReadRecording(scan);
  EXPECT_TRUE(received.complete);
  EXPECT_TRUE(received.depth == sent.depth) << received.depth.size() << " of " << sent.depth.size();
  EXPECT_TRUE(received.thermal == sent.thermal)
      << received.thermal.size() << " of " << sent.thermal.size();
}

/// Messages of a topic in a recording.
std::uint64_t Messages(const std::filesystem::path& recording, const std::string& topic) {
  const auto reader = RecordingReader::Open(recording);
  if (!reader) return 0;
  const auto& counts = (*reader)->info().messages_by_topic;
  return counts.contains(topic) ? counts.at(topic) : 0;
}

TEST_F(DaemonsTest, FeedbackReachesTheEdgeAndItsAgeIsKnown) {
  Process ground(Ground({"--once"}));
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  const Finished edge = RunToEnd(Edge({"--wait-for-ground", "--exit-at-end", "--set",
                                       "display.image_file=" + Path("confidence.png").string()}),
                                 kPatience);
  EXPECT_EQ(edge.status, 0) << edge.output;
  EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();

  // Two seconds at 10 Hz; a computer that is busy with other things may skip some.
  constexpr double kMinMessages = 5;
  // Anything above is not an age, but another clock.
  constexpr double kMaxAge_ms = 3000;
  const auto stats = ReadStats(Path("ground"));
  const double received = NumberAt(stats, {"link", "feedback", "received_by_edge"});
  EXPECT_GE(received, kMinMessages) << edge.output;
  EXPECT_LE(received, NumberAt(stats, {"feedback", "messages"}));
  const double p50_ms = NumberAt(stats, {"link", "feedback", "latency_p50_ms"});
  const double p99_ms = NumberAt(stats, {"link", "feedback", "latency_p99_ms"});
  EXPECT_GT(p50_ms, 0.0);
  EXPECT_GE(p99_ms, p50_ms);
  EXPECT_LT(p99_ms, kMaxAge_ms);
  std::cout << "feedback: " << received << " messages, p50 " << p50_ms << " ms, p99 " << p99_ms
            << " ms\n";
  EXPECT_THAT(edge.output, HasSubstr("depth capture to arrival p50"));
  EXPECT_THAT(edge.output, ContainsRegex("ground: .*tracked"))
      << "a change of state, in the journal";
  EXPECT_EQ(static_cast<double>(Messages(Path("edge.mcap"), "/feedback")), received);
  EXPECT_GE(static_cast<double>(Messages(Path("ground/scan.mcap"), "/feedback")), received);
  ASSERT_TRUE(std::filesystem::exists(Path("confidence.png")));
  EXPECT_LE(std::filesystem::file_size(Path("confidence.png")), 20'000U);
}

TEST_F(DaemonsTest, TheEdgeRecordsEverythingWithoutAGround) {
  const Finished edge = RunToEnd(
      Edge({"--rate", "4", "--exit-at-end", "--set", "link.expert.linger_s=0"}), kPatience);
  EXPECT_EQ(edge.status, 0) << edge.output;
  const RecordingContent source = ReadRecording(Source());
  const RecordingContent recorded = ReadRecording(Path("edge.mcap"));
  EXPECT_TRUE(recorded.complete);
  EXPECT_EQ(recorded.depth.size(), source.depth.size()) << edge.output;
  EXPECT_EQ(recorded.thermal.size(), source.thermal.size()) << edge.output;
}

TEST_F(DaemonsTest, BothTellTheServiceManager) {
  const std::vector<Command> daemons = {Edge({"--set", "source.loops=0"}), Ground()};
  for (Command daemon : daemons) {
    const TemporaryDirectory folder;
    NotifySocket manager(folder.path());
    daemon.environment = {manager.environment(), "WATCHDOG_USEC=1000000"};
    Process process(daemon);
    EXPECT_TRUE(manager.WaitFor("READY=1", kPatience)) << process.output();
    EXPECT_TRUE(manager.WaitFor("WATCHDOG=1", kPatience)) << process.output();
    process.Signal(SIGTERM);
    EXPECT_TRUE(manager.WaitFor("STOPPING=1", kPatience)) << process.output();
    EXPECT_EQ(process.WaitForExit(kPatience), 0) << process.output();
  }
}

}  // namespace
}  // namespace isotherm::system_test

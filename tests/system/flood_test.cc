// Rows F62 and F64 with the daemons as they ship: a peer that goes by ever new names, or sends
// packets that are none, makes neither them nor their logs grow.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "common/testing/resident_memory.h"
#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;
using testing::ResidentMemory_kb;

/// Once so many names have come, all is mapped in that is mapped once (buffers of the receive
/// threads, 7 MB).
constexpr int kFirstNames = 20'000;
constexpr int kNames = 30'000;
/// Unbounded they took 0.6 kB per name and topic, 18 MB each; bounded, 0.1 to 1.3 MB in all.
constexpr long kMaxGrowth_kb = 4 * 1024;

/// A scan goes on meanwhile, whose model grows; 200 bytes kept of each packet would be 40 MB.
constexpr long kMaxGrowthInAScan_kb = 24 * 1024;

/// The UDP ports at which a process listens.
std::vector<std::uint16_t> PortsOf(pid_t pid) {
  std::set<std::string> sockets;
  const std::string folder = "/proc/" + std::to_string(pid) + "/fd";
  for (const auto& descriptor : std::filesystem::directory_iterator(folder)) {
    std::error_code gone;
    const std::string target = std::filesystem::read_symlink(descriptor.path(), gone).string();
    if (target.starts_with("socket:[")) sockets.insert(target.substr(8, target.size() - 9));
  }
  std::vector<std::uint16_t> ports;
  std::ifstream table("/proc/net/udp");
  std::string line;
  std::getline(table, line);  // The heads of the columns.
  while (std::getline(table, line)) {
    std::istringstream columns(line);
    std::string number, local, skipped, inode;
    columns >> number >> local;
    for (int column = 2; column < 9; ++column) columns >> skipped;
    columns >> inode;
    if (!sockets.contains(inode)) continue;
    ports.push_back(
        static_cast<std::uint16_t>(std::stoul(local.substr(local.find(':') + 1), nullptr, 16)));
  }
  return ports;
}

/// Sends what begins as a packet of the middleware's protocol and ends in the middle of a message.
class MalformedPackets {
 public:
  MalformedPackets() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  ~MalformedPackets() { close(socket_); }
  MalformedPackets(const MalformedPackets&) = delete;
  MalformedPackets& operator=(const MalformedPackets&) = delete;

  void Send(const std::vector<std::uint16_t>& ports, int packets) const {
    // "RTPS", version 2.1, a vendor, a sender, then a DATA submessage of 8 bytes instead of 24.
    std::array<std::uint8_t, 32> packet = {'R', 'T', 'P', 'S', 2, 1, 1, 16, 9,    9, 9, 9,
                                           9,   9,   9,   9,   9, 9, 9, 9,  0x15, 5, 8, 0};
    for (int i = 0; i < packets; ++i) {
      packet[8] = static_cast<std::uint8_t>(i);
      for (const std::uint16_t port : ports) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        to.sin_port = htons(port);
        sendto(socket_, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to),
               sizeof(to));
      }
    }
  }

 private:
  const int socket_;
};

int Count(const std::string& text, const std::string& words) {
  int count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1))
    ++count;
  return count;
}

TEST(FloodTest, F64MalformedPacketsLeaveALineInTenSecondsWithTheirNumberAndNothingElse) {
  const testing::TemporaryDirectory folder;
  const std::string domain = std::to_string(OwnDomain());
  SimulateScan(folder.path() / "source.mcap", 0.2);
  Process edge({EdgeDaemon(),
                {"--recording", folder.path() / "source.mcap", "--domain", domain, "--record",
                 "off", "--set", "source.loops=0"},
                {}});
  Process ground({GroundService(), {"--domain", domain, "--output", folder.path() / "ground"}, {}});
  ASSERT_TRUE(ground.WaitForOutput("scan started", kPatience)) << ground.output() << edge.output();
  const MalformedPackets packets;
  for (Process* daemon : {&edge, &ground}) {
    const std::vector<std::uint16_t> ports = PortsOf(daemon->pid());
    ASSERT_FALSE(ports.empty());
    packets.Send(ports, 1000);
    ASSERT_TRUE(daemon->WaitForOutput("malformed packet", kPatience)) << daemon->output();
    const auto first_line = std::chrono::steady_clock::now();
    const long before_kb = ResidentMemory_kb(daemon->pid());
    packets.Send(ports, 200'000);
    EXPECT_LT(ResidentMemory_kb(daemon->pid()) - before_kb, kMaxGrowthInAScan_kb);
    while (!daemon->WaitForOutput("more since the last such line", Seconds(0.1))) {
      ASSERT_LT(Seconds(std::chrono::steady_clock::now() - first_line), kPatience);
      packets.Send(ports, 10);
    }
    const Seconds passed = std::chrono::steady_clock::now() - first_line;
    EXPECT_GT(passed.count(), 9.0);
    EXPECT_LE(Count(daemon->output(), "Dds: malformed packet"), 2 + passed.count() / 10.0);
    EXPECT_EQ(daemon->WaitForExit(Seconds(0)), std::nullopt) << daemon->output();
  }
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  ASSERT_TRUE(ground.WaitForOutput("scan ended", kPatience)) << "it still listens";
}

/// Holds how much more memory both daemons had at least than at a scan's beginning, the edge from
/// the peers' end to its own, the ground behind the scan.
struct ScanGrowth {
  long edge_kb = 0, ground_kb = 0;
};

/// Returns what a daemon holds at least until it ends, or until `limit`. Every ten seconds it gives
/// back what it has freed: frames that had to wait for a moment are gone then.
long LeastMemory_kb(Process& daemon, Seconds limit) {
  long least_kb = ResidentMemory_kb(daemon.pid());
  const auto start = std::chrono::steady_clock::now();
  while (!daemon.HasEnded(Seconds(0.1)) && std::chrono::steady_clock::now() - start < limit) {
    // Of a process that ends in between there is none.
    if (const long now_kb = ResidentMemory_kb(daemon.pid()); now_kb > 0)
      least_kb = std::min(least_kb, now_kb);
  }
  return least_kb;
}

/// Carries a scan of some seconds, with hostile peers beside or without, and expects that no frame
/// is lost.
ScanGrowth CarryScan(const std::filesystem::path& folder, bool is_hostile) {
  const std::string domain = std::to_string(OwnDomain());
  const std::filesystem::path copy = folder / "copy.mcap", results = folder / "ground";
  std::vector<std::string> arguments = {"--domain", domain, "--output", results};
  const std::vector<std::string> quick = QuickScan();
  arguments.insert(arguments.end(), quick.begin(), quick.end());
  SimulateScan(folder / "source.mcap", 2.0);
  Process ground({GroundService(), arguments, {}});
  Process edge({EdgeDaemon(),
                {"--recording", folder / "source.mcap", "--domain", domain, "--record", copy,
                 "--exit-at-end", "--wait-for-ground", "--set", "source.loops=6", "--set",
                 "link.expert.linger_s=30"},
                {}});
  EXPECT_TRUE(ground.WaitForOutput("scan started", kPatience)) << ground.output();
  const long edge_kb = ResidentMemory_kb(edge.pid()), ground_kb = ResidentMemory_kb(ground.pid());
  std::vector<std::unique_ptr<Process>> peers;
  if (is_hostile) {
    // Ever new names, the same taken back, and types that end too early under the rig's name.
    constexpr const char* kFlood = "5000";
    for (const Command& peer :
         {Command{FLOOD_PEER, {domain, kFlood}, {}},
          Command{FLOOD_PEER, {domain, kFlood, "take-back"}, {}},
          Command{SHORT_PEER, {domain, "edge"}, {}}, Command{SHORT_PEER, {domain, "edge"}, {}}})
      peers.push_back(std::make_unique<Process>(peer));
    const MalformedPackets packets;
    for (const Process* daemon : {&edge, &ground}) packets.Send(PortsOf(daemon->pid()), 10'000);
    EXPECT_TRUE(peers.back()->WaitForOutput("delivered", kPatience)) << peers.back()->output();
    EXPECT_FALSE(edge.HasEnded(Seconds(0))) << "the scan was too short";
  }
  ScanGrowth growth;
  growth.edge_kb = LeastMemory_kb(edge, kPatience) - edge_kb;
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  EXPECT_TRUE(ground.WaitForOutput("results  /", kPatience)) << ground.output();
  growth.ground_kb = LeastMemory_kb(ground, Seconds(11.0)) - ground_kb;
  ground.Signal(SIGTERM);
  EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();
  const RecordingContent sent = ReadRecording(copy);
  const std::filesystem::path scan = std::filesystem::directory_iterator(results)->path();
  const RecordingContent received = ReadRecording(scan / "scan.mcap");
  EXPECT_GT(sent.depth.size(), 100U);
  EXPECT_TRUE(received.depth == sent.depth)
      << received.depth.size() << " of " << sent.depth.size() << "\n"
      << edge.output() << ground.output();
  EXPECT_TRUE(received.thermal == sent.thermal);
  EXPECT_EQ(NumberAt(ReadStats(scan), {"link", "refused_samples"}) > 0, is_hostile);
  return growth;
}

TEST(FloodTest, FourHostilePeersAtOnceCostNoFrameAndNoMemory) {
  const testing::TemporaryDirectory alone, beside_peers;
  const ScanGrowth usual = CarryScan(alone.path(), false);
  const ScanGrowth hostile = CarryScan(beside_peers.path(), true);
  std::cout << "edge " << hostile.edge_kb << " kB more, alone " << usual.edge_kb << "; ground "
            << hostile.ground_kb << " and " << usual.ground_kb << "\n";
  EXPECT_LT(hostile.edge_kb - usual.edge_kb, kMaxGrowthInAScan_kb);
  EXPECT_LT(hostile.ground_kb - usual.ground_kb, kMaxGrowthInAScan_kb);
}

/// Names come with samples, or are only taken back.
class NameFloodTest : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Names, NameFloodTest, ::testing::Bool(), [](const auto& test) {
  return test.param ? "ThatAreTakenBack" : "WithSamples";
});

TEST_P(NameFloodTest, F62EverNewNamesDoNotMakeEitherDaemonGrow) {
  const testing::TemporaryDirectory folder;
  const auto path = [&](const char* name) { return folder.path() / name; };
  const std::string domain = std::to_string(OwnDomain());
  SimulateScan(path("source.mcap"), 0.2);
  // Both wait: the ground for this rig, the edge for a ground that follows it.
  Process edge({EdgeDaemon(),
                {"--recording", path("source.mcap"), "--domain", domain, "--record", "off",
                 "--wait-for-ground", "--set", "link.edge_id=rig"},
                {}});
  Process ground({GroundService(), {"--domain", domain, "--output", path("ground")}, {}});
  ASSERT_TRUE(edge.WaitForOutput("waiting for a ground station", kPatience)) << edge.output();
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  const auto flood = [&](int names) {
    std::vector<std::string> arguments = {domain, std::to_string(names)};
    if (GetParam()) arguments.emplace_back("take-back");
    auto peer = std::make_unique<Process>(Command{FLOOD_PEER, arguments, {}});
    EXPECT_TRUE(peer->WaitForOutput("flooded", kPatience));
    return peer;  // As long as it lives, the middleware keeps what it knows of its names.
  };
  const auto first = flood(kFirstNames);
  const long edge_before_kb = ResidentMemory_kb(edge.pid());
  const long ground_before_kb = ResidentMemory_kb(ground.pid());
  ASSERT_GT(edge_before_kb, 0);
  ASSERT_GT(ground_before_kb, 0);
  const auto second = flood(kNames);
  const long edge_growth_kb = ResidentMemory_kb(edge.pid()) - edge_before_kb;
  const long ground_growth_kb = ResidentMemory_kb(ground.pid()) - ground_before_kb;
  std::cout << kNames << " names on each topic: edge " << edge_growth_kb << " kB, ground "
            << ground_growth_kb << " kB more\n";
  EXPECT_LT(edge_growth_kb, kMaxGrowth_kb);
  EXPECT_LT(ground_growth_kb, kMaxGrowth_kb);
  EXPECT_EQ(edge.WaitForExit(Seconds(0)), std::nullopt) << edge.output();
  EXPECT_EQ(ground.WaitForExit(Seconds(0)), std::nullopt) << ground.output();
  EXPECT_THAT(edge.output(), HasSubstr("too many names"));
  EXPECT_THAT(ground.output(), HasSubstr("too many names"));
}

}  // namespace
}  // namespace isotherm::system_test

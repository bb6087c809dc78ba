// Row F62 with the daemons as they ship: a peer that goes by ever new names does not make them
// grow.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <iostream>
#include <memory>

#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;

constexpr int kNames = 50'000;
/// Unbounded they took 0.6 kB per name and topic, 30 MB each. Memory that is only mapped in late
/// (buffers of the receive threads) is a few megabytes.
constexpr long kMaxGrowth_kB = 8 * 1024;

/// Resident memory.
long MemoryOf_kB(pid_t pid) {
  std::ifstream statm("/proc/" + std::to_string(pid) + "/statm");
  long size = 0;
  long resident = 0;
  statm >> size >> resident;
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

TEST(FloodTest, F62EverNewNamesDoNotMakeEitherDaemonGrow) {
  const testing::TemporaryDirectory folder;
  const auto path = [&](const char* name) { return folder.path() / name; };
  const std::string domain = std::to_string(TestDomain());
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
    auto peer = std::make_unique<Process>(Command{FLOOD_PEER, {domain, std::to_string(names)}, {}});
    EXPECT_TRUE(peer->WaitForOutput("flooded", kPatience));
    return peer;  // As long as it lives, the middleware keeps what it knows of its names.
  };
  const auto first = flood(1000);  // So that whatever is made once is there.
  const long edge_before_kB = MemoryOf_kB(edge.pid());
  const long ground_before_kB = MemoryOf_kB(ground.pid());
  ASSERT_GT(edge_before_kB, 0);
  ASSERT_GT(ground_before_kB, 0);
  const auto second = flood(kNames);
  const long edge_growth_kB = MemoryOf_kB(edge.pid()) - edge_before_kB;
  const long ground_growth_kB = MemoryOf_kB(ground.pid()) - ground_before_kB;
  std::cout << kNames << " names on each topic: edge " << edge_growth_kB << " kB, ground "
            << ground_growth_kB << " kB more\n";
  EXPECT_LT(edge_growth_kB, kMaxGrowth_kB);
  EXPECT_LT(ground_growth_kB, kMaxGrowth_kB);
  EXPECT_EQ(edge.WaitForExit(Seconds(0)), std::nullopt) << edge.output();
  EXPECT_EQ(ground.WaitForExit(Seconds(0)), std::nullopt) << ground.output();
  EXPECT_THAT(edge.output(), HasSubstr("too many names"));
  EXPECT_THAT(ground.output(), HasSubstr("too many names"));
}

}  // namespace
}  // namespace isotherm::system_test

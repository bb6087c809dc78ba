// A radio link of which one direction is dead: the side that notices says which.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "tests/support/emulated_link.h"
#include "tests/support/programs.h"
#include "tests/support/small_scan.h"

namespace isotherm::system_test {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr PathProperties kGood{.delay = 5ms};
constexpr PathProperties kDead{.loss = 1.0};

TEST(OneWayTest, F29WhichDirectionIsDeadIsSaid) {
  const auto link = EmulatedLink::Create(3);
  if (!link) GTEST_SKIP() << "no network of its own: " << link.error().message();
  EmulatedNetwork& network = (*link)->network();
  network.SetBoth(kGood);
  // The operator's firewall, for instance.
  network.Set(NetworkEnd::kGround, kDead);
  const testing::TemporaryDirectory folder;
  const std::filesystem::path scan = folder.path() / "source.mcap";
  const std::filesystem::path rig = folder.path() / "rig.textproto";
  WriteSmallScan(scan);
  WriteSmallRig(rig);

  std::vector<std::string> arguments = {"--output", folder.path() / "ground"};
  const std::vector<std::string> quick = QuickScan();
  arguments.insert(arguments.end(), quick.begin(), quick.end());
  Process ground((*link)->On(NetworkEnd::kGround, GroundService(), arguments));
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process edge((*link)->On(NetworkEnd::kEdge, EdgeDaemon(),
                           {"--recording", scan, "--rig", rig, "--set", "source.loops=600"}));

  EXPECT_TRUE(ground.WaitForOutput("announces itself, and nothing else of it arrives", kPatience))
      << ground.output();
  EXPECT_THAT(edge.output(), Not(HasSubstr("direction only"))) << "it hears nothing";
  network.SetBoth(kGood);
  ASSERT_TRUE(ground.WaitForOutput("first depth frame", kPatience)) << ground.output();
  ASSERT_TRUE(edge.WaitForOutput("ground station found", kPatience)) << edge.output();

  network.Set(NetworkEnd::kEdge, kDead);
  EXPECT_TRUE(edge.WaitForOutput("nothing that this rig sends arrives there", kPatience))
      << edge.output();
  network.SetBoth(kGood);
  ASSERT_TRUE(edge.WaitForOutput("from the ground station pass again", kPatience)) << edge.output();
  ASSERT_THAT(ground.output(), Not(HasSubstr("DOES NOT HEAR")));

  network.Set(NetworkEnd::kGround, kDead);
  EXPECT_TRUE(ground.WaitForOutput("THE RIG DOES NOT HEAR", kPatience)) << ground.output();
  network.SetBoth(kGood);
  EXPECT_TRUE(ground.WaitForOutput("from the rig pass again", kPatience)) << ground.output();
}

}  // namespace
}  // namespace isotherm::system_test

// Frames in pieces over a radio that loses some: they arrive without being sent again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
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

constexpr int kScan_s = 8;
constexpr PathProperties kFar{.delay = 20ms, .loss = 0.1};

class LivePiecesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto link = EmulatedLink::Create(5);
    if (!link) GTEST_SKIP() << "no network of its own: " << link.error().message();
    link_ = std::move(*link);
    WriteSmallScan(scan_, 3);  // Frames of several packets.
    WriteSmallRig(rig_, 3);
  }

  /// Returns the counters of the link in the ground's stats.json, of a scan. Sets `edge_log_`.
  nlohmann::json Scan(const std::string& pieces, const std::string& policy = "LIVE",
                      const std::filesystem::path& scan = {}) {
    link_->network().SetBoth(kFar);
    const std::filesystem::path output = folder_.path() / ("ground-" + pieces);
    std::vector<std::string> arguments = {"--output", output, "--once"};
    const std::vector<std::string> quick = QuickScan();
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    Process ground(link_->On(NetworkEnd::kGround, GroundService(), arguments));
    EXPECT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
    Process edge(link_->On(
        NetworkEnd::kEdge, EdgeDaemon(),
        {"--recording", scan.empty() ? scan_ : scan, "--rig", rig_, "--record",
         folder_.path() / ("edge-" + pieces + ".mcap"), "--wait-for-ground", "--exit-at-end",
         "--rate", "1", "--set", "source.loops=" + std::to_string(kScan_s), "--set",
         "link.policy=" + policy, "--set", "link.expert.pieces=" + pieces}));
    EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
    edge_log_ = edge.output();
    EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();
    return nlohmann::json::parse(std::ifstream(output / "stats.json")).at("link");
  }

  const testing::TemporaryDirectory folder_;
  const std::filesystem::path scan_ = folder_.path() / "source.mcap";
  const std::filesystem::path rig_ = folder_.path() / "rig.textproto";
  std::unique_ptr<EmulatedLink> link_;
  std::string edge_log_;
};

TEST_F(LivePiecesTest, F27WhatGetsLostOfAFrameIsThereAtOnce) {
  const nlohmann::json pieces = Scan("true");
  EXPECT_THAT(edge_log_, HasSubstr("frames go in pieces"));
  for (const char* stream : {"depth", "thermal"}) {
    const nlohmann::json& counters = pieces.at(stream);
    EXPECT_EQ(counters.at("missing"), 0) << counters;
    EXPECT_EQ(counters.at("refused"), 0) << counters;
    const double late = counters.at("late").get<double>() / counters.at("received").get<double>();
    // One in a thousand, and the first ones, when nothing is known of the link.
    EXPECT_LE(late, 0.05) << counters;
  }
}

TEST_F(LivePiecesTest, WholeFramesGoOnRequest) {
  const nlohmann::json whole = Scan("false");
  EXPECT_THAT(edge_log_, Not(HasSubstr("frames go in pieces")));
  for (const char* stream : {"depth", "thermal"}) EXPECT_EQ(whole.at(stream).at("missing"), 0);
}

TEST_F(LivePiecesTest, F27WhereRepairsHoldFramesUpALosslessRigSendsPiecesToo) {
  // Too large to be whole at the first try.
  const std::filesystem::path large = folder_.path() / "large.mcap";
  WriteSmallScan(large, 6);
  WriteSmallRig(rig_, 6);
  const nlohmann::json found = Scan("true", "LOSSLESS", large);
  EXPECT_THAT(edge_log_, HasSubstr("the link loses too much for whole frames"));
  for (const char* stream : {"depth", "thermal"}) EXPECT_EQ(found.at(stream).at("missing"), 0);
}

}  // namespace
}  // namespace isotherm::system_test

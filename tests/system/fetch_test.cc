// isotherm fetch, from a rig that has scanned: over the link, broken off and gone on with.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"
#include "tests/support/small_scan.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::TemporaryDirectory;

std::string Get(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class FetchTest : public ::testing::Test {
 protected:
  void SetUp() override {
    WriteSmallScan(scan_, 4);
    WriteSmallRig(rig_, 4);
  }

  /// A rig that scans for `seconds` and then stays.
  Command Edge(int seconds, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"--recording", scan_,
                                          "--rig",       rig_,
                                          "--domain",    std::to_string(OwnDomain()),
                                          "--record",    recordings_.path().string() + "/",
                                          "--set",       "source.loops=" + std::to_string(seconds)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {EdgeDaemon(), arguments, {}};
  }
  Command Fetch(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {"fetch", "--domain", std::to_string(OwnDomain()), "-o",
                                          here_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {Tool(), arguments, {}};
  }
  /// Returns the only recording of the rig.
  std::filesystem::path Recording() const {
    std::filesystem::path only;
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(recordings_.path())) {
      if (entry.path().extension() != ".mcap") continue;  // A note that it was fetched.
      only = entry.path();
      ++files;
    }
    EXPECT_EQ(files, 1);
    return only;
  }

  const TemporaryDirectory folder_;
  const TemporaryDirectory recordings_;
  const std::filesystem::path scan_ = folder_.path() / "source.mcap";
  const std::filesystem::path rig_ = folder_.path() / "rig.textproto";
  const std::filesystem::path here_ = folder_.path() / "here";
};

TEST_F(FetchTest, ARecordingIsListedWaitedForAndFetchedWhole) {
  Process edge(Edge(4));
  ASSERT_TRUE(edge.WaitForOutput("recording to", kPatience)) << edge.output();
  const Finished list = RunToEnd(Fetch({}), kPatience);
  EXPECT_EQ(list.status, 0) << list.output;
  EXPECT_THAT(list.output, HasSubstr("being written"));
  const std::string name = Recording().filename();
  EXPECT_EQ(RunToEnd(Fetch({name}), kPatience).status, 65) << "the scan goes on";
  ASSERT_TRUE(edge.WaitForOutput("waiting for the order to start", kPatience)) << edge.output();

  const Finished fetched = RunToEnd(Fetch({"--newest"}), kPatience);
  EXPECT_EQ(fetched.status, 0) << fetched.output;
  EXPECT_THAT(fetched.output, HasSubstr(name));
  EXPECT_TRUE(Get(here_ / name) == Get(Recording()));
  EXPECT_TRUE(ReadRecording(here_ / name).complete);
  EXPECT_THAT(RunToEnd(Fetch({}), kPatience).output, HasSubstr("here"));
  EXPECT_EQ(RunToEnd(Fetch({"no-such.mcap"}), kPatience).status, 66);
}

TEST_F(FetchTest, AnAttemptThatIsKilledIsGoneOnWith) {
  // Two seconds for what there is.
  Process edge(Edge(4, {"--set", "link.expert.fetch_mb_per_s=0.6"}));
  ASSERT_TRUE(edge.WaitForOutput("waiting for the order to start", kPatience)) << edge.output();
  const std::filesystem::path whole = Recording();
  const std::filesystem::path part = here_ / (whole.filename().string() + ".part");
  {
    Process killed(Fetch({"--all"}));
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    std::error_code missing;
    const auto size = [&] {
      const auto bytes = std::filesystem::file_size(part, missing);
      return missing ? 0 : bytes;
    };
    while (size() < std::filesystem::file_size(whole) / 3) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline) << killed.output();
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    killed.Signal(SIGKILL);
    EXPECT_EQ(killed.WaitForExit(kPatience), 128 + SIGKILL);
  }
  ASSERT_TRUE(std::filesystem::exists(part));
  EXPECT_THAT(RunToEnd(Fetch({}), kPatience).output, HasSubstr("partly here"));
  const Finished again = RunToEnd(Fetch({"--all"}), kPatience);
  EXPECT_EQ(again.status, 0) << again.output;
  EXPECT_TRUE(Get(here_ / whole.filename()) == Get(whole));
  EXPECT_FALSE(std::filesystem::exists(part));
}

TEST_F(FetchTest, AGroundThatIsGoneAndLacksFramesKeepsNothingBack) {
  std::vector<std::string> arguments = {"--domain", std::to_string(OwnDomain()), "--output",
                                        folder_.path() / "ground"};
  const std::vector<std::string> quick = QuickScan();
  arguments.insert(arguments.end(), quick.begin(), quick.end());
  Process ground({GroundService(), arguments, {}});
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process edge(Edge(4, {"--set", "link.wait_for_ground=true"}));
  // By its feedback the edge has heard the ground: only of such a one it knows what it lacks.
  ASSERT_TRUE(edge.WaitForOutput("view 0 % good", kPatience)) << edge.output();
  ground.Signal(SIGKILL);
  ASSERT_TRUE(edge.WaitForOutput("the recording is closed", kPatience)) << edge.output();
  EXPECT_THAT(edge.output(), Not(HasSubstr("waiting for the order to start")))
      << "the edge still waits for the ground";
  const Finished fetched = RunToEnd(Fetch({"--newest"}), kPatience);
  EXPECT_EQ(fetched.status, 0) << fetched.output;
  EXPECT_TRUE(Get(here_ / Recording().filename()) == Get(Recording()));
}

TEST_F(FetchTest, ARigThatGivesNothingAwayIsNotWaitedForForEver) {
  Process edge(Edge(1, {"--set", "link.expert.fetch_mb_per_s=0"}));
  ASSERT_TRUE(edge.WaitForOutput("waiting for the order to start", kPatience)) << edge.output();
  const Finished list = RunToEnd(Fetch({}), kPatience);
  EXPECT_EQ(list.status, 69) << list.output;
  EXPECT_THAT(list.output, HasSubstr("has not answered"));
}

TEST_F(FetchTest, OfARecordingThatKeepsTheNewestAllFilesThatAreLeftAreFetched) {
  Process edge(Edge(10, {"--set", "spool.when_full=KEEP_NEWEST", "--set", "spool.quota_gb=0.001"}));
  ASSERT_TRUE(edge.WaitForOutput("waiting for the order to start", kPatience)) << edge.output();
  std::set<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator(recordings_.path()))
    left.insert(entry.path().filename());
  ASSERT_GT(left.size(), 1U);
  EXPECT_FALSE(std::ranges::any_of(left, [](const std::string& name) {
    return name.size() == std::string("edge-00000000-000000-ffffffff.mcap").size();
  })) << "the first one is deleted";
  const Finished fetched = RunToEnd(Fetch({"--newest"}), kPatience);
  EXPECT_EQ(fetched.status, 0) << fetched.output;
  std::set<std::string> here;
  for (const auto& entry : std::filesystem::directory_iterator(here_))
    here.insert(entry.path().filename());
  EXPECT_EQ(here, left);
}

TEST_F(FetchTest, F41WhatWasFetchedMakesRoom) {
  std::vector<std::filesystem::path> recordings;
  const auto record = [&](int seconds, const std::vector<std::string>& more, bool fetches) {
    Process edge(Edge(seconds, more));
    ASSERT_TRUE(edge.WaitForOutput("waiting for the order to start", kPatience)) << edge.output();
    EXPECT_THAT(edge.output(), Not(HasSubstr("NOT RECORDING")));
    for (const auto& entry : std::filesystem::directory_iterator(recordings_.path())) {
      const bool is_new = std::ranges::find(recordings, entry.path()) == recordings.end();
      if (is_new && entry.path().extension() == ".mcap") recordings.push_back(entry.path());
    }
    if (!fetches) return;
    EXPECT_EQ(RunToEnd(Fetch({"--newest"}), kPatience).status, 0);
  };
  ASSERT_NO_FATAL_FAILURE(record(1, {}, false));
  ASSERT_NO_FATAL_FAILURE(record(4, {}, true));
  ASSERT_EQ(recordings.size(), 2U);
  // Room for these two and a second more.
  const auto size = static_cast<double>(std::filesystem::file_size(recordings[1]));
  const std::string quota = fmt::format("spool.quota_gb={}", 1.6e-9 * size);
  ASSERT_NO_FATAL_FAILURE(
      record(4, {"--set", "spool.when_full=DELETE_FETCHED", "--set", quota}, false));
  ASSERT_EQ(recordings.size(), 3U) << "one file, and no part of it";
  EXPECT_TRUE(std::filesystem::exists(recordings[0])) << "nobody has fetched it";
  EXPECT_FALSE(std::filesystem::exists(recordings[1]));
  EXPECT_TRUE(Get(here_ / recordings[1].filename()).size() == static_cast<std::size_t>(size));
}

}  // namespace
}  // namespace isotherm::system_test

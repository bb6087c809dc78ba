// The operator's orders to stop a scan and to start the next one: isotherm scan -> DDS ->
// isotherm-edge, whose recordings and whose ground's results are then one per scan.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using ::testing::HasSubstr;
using testing::TemporaryDirectory;

constexpr int kRefused = 69;  // EX_UNAVAILABLE of sysexits.h.

class ScanOrdersTest : public ::testing::Test {
 protected:
  std::string Path(const std::string& name) const { return folder_.path() / name; }
  static std::string Domain() { return std::to_string(OwnDomain()); }

  /// A rig that plays a simulated scan again and again in real time.
  Command Edge() const {
    std::filesystem::create_directory(Path("recordings"));
    return {EdgeDaemon(),
            {"--recording", Path("source.mcap"), "--domain", Domain(), "--record",
             Path("recordings"), "--set", "source.loops=0"},
            {}};
  }
  Command Ground() const {
    std::vector<std::string> arguments = {"--domain", Domain(), "--output", Path("ground")};
    const std::vector<std::string> quick = QuickScan();
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    return {GroundService(), arguments, {}};
  }
  static Finished Scan(std::vector<std::string> order) {
    order.insert(order.begin(), {"scan", "--domain", Domain(), "--timeout", "60"});
    return RunToEnd({Tool(), std::move(order), {}}, kPatience);
  }
  /// Returns what the recordings below `folder` hold, the shortest first.
  static std::vector<RecordingContent> Recordings(const std::filesystem::path& folder) {
    std::vector<RecordingContent> all;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() == ".mcap") all.push_back(ReadRecording(entry.path()));
    }
    std::ranges::sort(all, {}, [](const RecordingContent& one) { return one.depth.size(); });
    return all;
  }

  /// Returns of how many recordings below `folder` isotherm inspect says this.
  static int FilesThatSay(const std::filesystem::path& folder, const std::string& text) {
    int files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().extension() != ".mcap") continue;
      const Finished inspected = RunToEnd({Tool(), {"inspect", entry.path()}, {}}, kPatience);
      files += inspected.output.find(text) == std::string::npos ? 0 : 1;
    }
    return files;
  }
  /// Returns all that the results below `folder` say.
  static std::string Results(const std::filesystem::path& folder) {
    std::string text;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      if (entry.path().filename() != "stats.json") continue;
      std::ifstream file(entry.path());
      text.append(std::istreambuf_iterator<char>(file), {});
    }
    return text;
  }

  TemporaryDirectory folder_;
};

TEST_F(ScanOrdersTest, AScanIsStoppedAndTheNextIsAScanOfItsOwn) {
  SimulateScan(Path("source.mcap"), 2.0);
  Process ground(Ground());
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process edge(Edge());
  ASSERT_TRUE(ground.WaitForOutput("scan started", kPatience)) << ground.output();

  const Finished early = Scan({"--start"});
  EXPECT_EQ(early.status, kRefused);
  EXPECT_THAT(early.output, HasSubstr("a scan is under way; stop it first"));
  const Finished marked = Scan({"--mark", "left burner"});
  EXPECT_EQ(marked.status, 0) << marked.output;
  EXPECT_THAT(marked.output, HasSubstr("marked at the capture time"));
  const Finished stopped = Scan({"--stop"});
  EXPECT_EQ(stopped.status, 0) << stopped.output;
  EXPECT_THAT(stopped.output, HasSubstr("the scan ends"));
  EXPECT_TRUE(edge.WaitForOutput("the recording is closed", kPatience)) << edge.output();
  EXPECT_TRUE(ground.WaitForOutput("results  /", kPatience)) << ground.output();
  EXPECT_THAT(Scan({}).output, HasSubstr("scan          ended"));
  EXPECT_EQ(Scan({"--stop"}).status, kRefused);
  EXPECT_EQ(Scan({"--mark", "too late"}).status, kRefused);

  const Finished started = Scan({"--start"});
  EXPECT_EQ(started.status, 0) << started.output;
  EXPECT_TRUE(ground.WaitForOutput("scan started", kPatience, 2)) << ground.output();
  EXPECT_TRUE(edge.WaitForOutput("ground received", kPatience)) << "a summary of each scan";
  EXPECT_EQ(Scan({"--stop"}).status, 0);
  EXPECT_TRUE(ground.WaitForOutput("results  /", kPatience, 2)) << ground.output();
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  ground.Signal(SIGTERM);
  EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();

  const std::vector<RecordingContent> sent = Recordings(Path("recordings"));
  const std::vector<RecordingContent> received = Recordings(Path("ground"));
  ASSERT_EQ(sent.size(), 2U);
  ASSERT_EQ(received.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_TRUE(sent[i].complete);
    ASSERT_FALSE(sent[i].depth.empty());
    EXPECT_EQ(sent[i].depth.front().frame_number, 0U) << "each scan counts its own frames";
    EXPECT_TRUE(received[i].depth == sent[i].depth)
        << received[i].depth.size() << " of " << sent[i].depth.size();
    EXPECT_TRUE(received[i].thermal == sent[i].thermal)
        << received[i].thermal.size() << " of " << sent[i].thermal.size();
  }
  for (const char* folder : {"recordings", "ground"}) {
    EXPECT_EQ(FilesThatSay(Path(folder), "mark: left burner"), 1) << folder;
  }
  EXPECT_THAT(Results(Path("ground")), HasSubstr("\"text\": \"left burner\""));
  if (HasFailure()) std::cout << "edge:\n" << edge.output() << "ground:\n" << ground.output();
}

TEST_F(ScanOrdersTest, ARigThatWaitsForItsOrderHasItsCamerasClosedUntilThen) {
  SimulateScan(Path("source.mcap"), 2.0);
  Process ground(Ground());
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Command waiting = Edge();
  waiting.arguments.emplace_back("--wait-for-order");
  Process edge(waiting);
  ASSERT_TRUE(edge.WaitForOutput("waiting for the order to start one", kPatience)) << edge.output();
  EXPECT_TRUE(ground.WaitForOutput("rig found", kPatience)) << ground.output();
  EXPECT_THAT(Scan({}).output, HasSubstr("scan          none yet"));
  EXPECT_EQ(Scan({"--stop"}).status, kRefused);
  EXPECT_TRUE(std::filesystem::is_empty(Path("recordings")));
  const Finished started = Scan({"--start"});
  EXPECT_EQ(started.status, 0) << started.output;
  EXPECT_TRUE(ground.WaitForOutput("scan started", kPatience)) << ground.output();
  EXPECT_EQ(Scan({"--stop"}).status, 0);
  EXPECT_TRUE(ground.WaitForOutput("results  /", kPatience)) << ground.output();
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  ASSERT_EQ(Recordings(Path("recordings")).size(), 1U);
  EXPECT_TRUE(Recordings(Path("ground")).at(0).depth == Recordings(Path("recordings")).at(0).depth);
  EXPECT_EQ(ground.output().find("scan started", ground.output().find("scan started") + 1),
            std::string::npos)
      << "no scan of a rig that waits";
}

TEST_F(ScanOrdersTest, F32AScanThatIsCompleteIsNotMadeAgainByAGroundThatIsStartedWhileTheRigRests) {
  SimulateScan(Path("source.mcap"), 2.0);
  std::optional<Process> ground(Ground());
  ASSERT_TRUE(ground->WaitForOutput("ready", kPatience)) << ground->output();
  Process edge(Edge());
  ASSERT_TRUE(ground->WaitForOutput("scan started", kPatience)) << ground->output();
  EXPECT_EQ(Scan({"--stop"}).status, 0);
  EXPECT_TRUE(ground->WaitForOutput("results  /", kPatience)) << ground->output();
  EXPECT_TRUE(edge.WaitForOutput("waiting for the order to start another", kPatience))
      << edge.output();
  ground->Signal(SIGTERM);
  EXPECT_EQ(ground->WaitForExit(kPatience), 0) << ground->output();
  const std::string before = Results(Path("ground"));
  ground.emplace(Ground());
  ASSERT_TRUE(ground->WaitForOutput("is complete already", kPatience)) << ground->output();
  EXPECT_EQ(Scan({"--start"}).status, 0);
  ASSERT_TRUE(ground->WaitForOutput("scan started", kPatience)) << ground->output();
  EXPECT_EQ(Scan({"--stop"}).status, 0);
  EXPECT_TRUE(ground->WaitForOutput("results  /", kPatience)) << ground->output();
  ground->Signal(SIGTERM);
  EXPECT_EQ(ground->WaitForExit(kPatience), 0) << ground->output();
  edge.Signal(SIGTERM);
  EXPECT_EQ(edge.WaitForExit(kPatience), 0) << edge.output();
  EXPECT_EQ(Recordings(Path("ground")).size(), 2U) << "one for each scan, each in one file";
  EXPECT_THAT(Results(Path("ground")), HasSubstr(before)) << "its results are as they were";
}

}  // namespace
}  // namespace isotherm::system_test

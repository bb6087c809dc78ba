#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/small_scan.h"
#include "tests/system/two_hosts.h"

namespace isotherm::system_test {

inline constexpr std::array<std::pair<Sensor, const char*>, 2> kStreams = {
    std::pair(Sensor::kDepth, "depth"), std::pair(Sensor::kThermal, "thermal")};
/// Frames that were on their way at the cut are lost with those of the outage, and so are some
/// while both find each other: no more than the edge's queue (2 s) and the middleware's history
/// hold.
inline constexpr Seconds kMaxOnTheWay{3.0};

inline bool ByNumber(const StoredFrame& a, const StoredFrame& b) {
  return a.frame_number < b.frame_number;
}

/// Holds what became of a scan, by the files that both sides wrote and by what they said.
struct Outcome {
  RecordingContent edge, ground;
  google::protobuf::Struct stats;

  double Number(const char* stream, const char* name) const {
    return NumberAt(stats, {"link", stream, name});
  }
  /// Returns the sum over all reasons.
  double DroppedByRig(const std::string& stream) const {
    double sum = 0.0;
    const auto& counters = stats.fields().at("link").struct_value().fields().at(stream);
    const auto reasons = counters.struct_value().fields().find("dropped_by_rig");
    if (reasons == counters.struct_value().fields().end()) return 0.0;
    for (const auto& [reason, frames] : reasons->second.struct_value().fields())
      sum += frames.number_value();
    return sum;
  }
  static const std::vector<StoredFrame>& Of(Sensor sensor, const RecordingContent& content) {
    return sensor == Sensor::kDepth ? content.depth : content.thermal;
  }
  /// Returns the frames that the edge has and the ground has not.
  std::vector<StoredFrame> Lost(Sensor sensor) const {
    std::vector<StoredFrame> lost;
    std::ranges::set_difference(Of(sensor, edge), Of(sensor, ground), std::back_inserter(lost),
                                ByNumber);
    return lost;
  }
};

class LinkOutageTest : public TwoHostsTest {
 protected:
  void SetUp() override {
    TwoHostsTest::SetUp();
    if (IsSkipped()) return;
    WriteScan(1);
    Connect();
  }

  /// Writes the small scan and its rig, with images that are `scale` times as wide and high.
  void WriteScan(int scale) const {
    std::filesystem::remove(scan_);
    WriteSmallScan(scan_, scale);
    WriteSmallRig(rig_, scale);
  }

  void StartGround(const std::string& profile) {
    std::vector<std::string> arguments = {"--output", results_};
    const std::vector<std::string> quick = QuickScan();
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    ground_process_.emplace(On(ground_, profile, GroundService(), arguments));
    ASSERT_TRUE(ground().WaitForOutput("ready", kPatience)) << ground().output();
  }
  /// Plays a scan of `seconds`: the small scan is a second long. At its end the edge waits until
  /// all is confirmed.
  void StartEdge(int seconds, const std::string& profile, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"--recording",
                                          scan_,
                                          "--rig",
                                          rig_,
                                          "--record",
                                          copy_,
                                          "--exit-at-end",
                                          "--set",
                                          "source.loops=" + std::to_string(seconds),
                                          "--set",
                                          "link.expert.linger_s=30"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    edge_process_.emplace(On(edge_, profile, EdgeDaemon(), arguments));
  }
  /// Starts both daemons. Returns when frames have arrived.
  void Start(int seconds, const std::string& edge_profile, const std::string& ground_profile,
             std::vector<std::string> more = {}) {
    ASSERT_NO_FATAL_FAILURE(StartGround(ground_profile));
    more.emplace_back("--wait-for-ground");
    StartEdge(seconds, edge_profile, more);
    ASSERT_TRUE(ground().WaitForOutput("scan started", kPatience)) << Said();
    ASSERT_TRUE(AwaitGroundFolder()) << Said();
    ASSERT_TRUE(HasMore(GroundFile(), Seconds(1))) << Said();
  }
  void Start(int seconds, std::vector<std::string> more = {}) {
    Start(seconds, LanProfile(edge_), LanProfile(ground_), std::move(more));
  }
  static std::vector<std::string> WithoutBackfill() {
    return {"--set", "link.expert.backfill_hz=0"};
  }

  /// Waits until `recording` has so much more of the scan.
  bool HasMore(const std::filesystem::path& recording, Seconds more) const {
    const auto size = [&] {
      std::error_code missing;
      const auto bytes = std::filesystem::file_size(recording, missing);
      return missing ? 0.0 : static_cast<double>(bytes);
    };
    const double enough =
        size() + more.count() * static_cast<double>(std::filesystem::file_size(scan_));
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (size() < enough) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
  }
  /// The folder is made after the beginning of the scan is said.
  bool AwaitGroundFolder() const {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (!std::filesystem::exists(results_) || !HasFolder()) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
  }
  bool HasFolder() const {
    for (const auto& entry : std::filesystem::directory_iterator(results_)) {
      if (entry.is_directory()) return true;
    }
    return false;
  }
  /// Returns the folder of the only scan.
  std::filesystem::path GroundFolder() const {
    std::vector<std::filesystem::path> folders;
    for (const auto& entry : std::filesystem::directory_iterator(results_)) {
      // Beside it is now and then a file with which the ground tries whether it can write.
      if (entry.is_directory()) folders.push_back(entry.path());
    }
    EXPECT_EQ(folders.size(), 1U);
    return folders.empty() ? results_ : folders.front();
  }
  std::filesystem::path GroundFile() const { return GroundFolder() / "scan.mcap"; }

  /// Waits until the scan is over and ends both. Reads what became of the scan.
  Outcome End() {
    return EndAfter([] {});
  }
  /// The same once the ground has brought in what came late.
  Outcome EndCompleted() {
    return EndAfter(
        [this] { EXPECT_TRUE(ground().WaitForOutput("complete ", kPatience)) << Said(); });
  }
  Outcome EndAfter(const std::function<void()>& wait) {
    EXPECT_EQ(edge().WaitForExit(kPatience), 0) << edge().output();
    EXPECT_TRUE(ground().WaitForOutput("scan ended", kPatience)) << ground().output();
    wait();
    ground().Signal(SIGTERM);
    EXPECT_EQ(ground().WaitForExit(kPatience), 0) << ground().output();
    EXPECT_EQ(Count(ground().output(), "scan started"), 1) << "another session";
    Outcome outcome{ReadRecording(copy_), ReadRecording(GroundFile()), ReadStats(GroundFolder())};
    for (const auto& [sensor, name] : kStreams) {
      std::cout << name << ": captured " << Outcome::Of(sensor, outcome.edge).size()
                << ", received " << outcome.Number(name, "received") << ", missing "
                << outcome.Number(name, "missing") << ", dropped by the rig "
                << outcome.DroppedByRig(name) << "\n";
    }
    return outcome;
  }

  /// The edge has recorded every frame, and each of them is on the ground or in one counter.
  void ExpectEachFrameAccountedFor(const Outcome& outcome) {
    EXPECT_TRUE(outcome.edge.complete);
    EXPECT_TRUE(outcome.ground.complete);
    for (const auto& [sensor, name] : kStreams) {
      SCOPED_TRACE(name);
      const std::vector<StoredFrame>& sent = Outcome::Of(sensor, outcome.edge);
      const std::vector<StoredFrame>& got = Outcome::Of(sensor, outcome.ground);
      const auto captured = static_cast<double>(sent.size());
      EXPECT_GT(captured, 3 * kSmallScanFrames);
      const FrameCountersText recorded = CountersOf(edge().output(), sensor, "recorded");
      EXPECT_EQ(recorded.captured, static_cast<long>(captured)) << edge().output();
      EXPECT_EQ(recorded.done, recorded.captured) << edge().output();
      EXPECT_TRUE(std::ranges::includes(sent, got, ByNumber)) << "frames that nobody sent";

      const FrameCountersText published = CountersOf(edge().output(), sensor, "published");
      EXPECT_TRUE(published.Closes()) << edge().output();
      EXPECT_EQ(published.captured, recorded.captured);
      EXPECT_EQ(outcome.Number(name, "captured_by_rig"), captured);
      EXPECT_EQ(outcome.Number(name, "published"), static_cast<double>(published.done));
      EXPECT_EQ(outcome.DroppedByRig(name),
                static_cast<double>(published.rejected + published.queue_full + published.failed));
      EXPECT_EQ(outcome.Number(name, "published"),
                outcome.Number(name, "received") + outcome.Number(name, "missing"));
      EXPECT_EQ(outcome.Number(name, "received"), static_cast<double>(got.size()));
      EXPECT_THAT(edge().output(),
                  ::testing::HasSubstr("ground received " + std::to_string(got.size()) + " of " +
                                       std::to_string(published.done) + " published"));
      EXPECT_EQ(static_cast<double>(outcome.Lost(sensor).size()),
                outcome.Number(name, "missing") + outcome.DroppedByRig(name));
    }
    if (HasFailure()) std::cout << Said();
  }
  static void ExpectNothingIsLost(const Outcome& outcome) {
    EXPECT_TRUE(outcome.ground.depth == outcome.edge.depth);
    EXPECT_TRUE(outcome.ground.thermal == outcome.edge.thermal);
    for (const auto& [sensor, name] : kStreams) {
      EXPECT_EQ(outcome.Number(name, "missing"), 0) << name;
      EXPECT_EQ(outcome.DroppedByRig(name), 0) << name;
    }
  }

  /// Gives a computer another address.
  static bool Move(const Host& host, const std::string& address) {
    return In(host, {"addr", "flush", "dev", host.interface}) &&
           In(host, {"addr", "add", address + "/24", "dev", host.interface});
  }
  /// Both have found each other again: the scan goes on, and in its end nothing is missing.
  void ExpectToGoOnWithoutLoss() {
    EXPECT_TRUE(HasMore(GroundFile(), Seconds(1))) << Said();
    EXPECT_FALSE(edge().HasEnded(Seconds(0))) << "the scan was too short";
    const Outcome outcome = EndCompleted();
    ExpectEachFrameAccountedFor(outcome);
    ExpectNothingIsLost(outcome);
  }
  /// The results are those that the rig's own recording gives, byte for byte.
  void ExpectResultsOfTheWholeScan() const {
    const std::filesystem::path whole = folder_.path() / "whole";
    std::vector<std::string> arguments = {"reconstruct", copy_, "-o", whole};
    const std::vector<std::string> quick = QuickScan();
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    const Finished made = RunToEnd({Tool(), arguments, {}}, kPatience);
    ASSERT_EQ(made.status, 0) << made.output;
    const auto content = [](const std::filesystem::path& file) {
      std::ostringstream text;
      text << std::ifstream(file).rdbuf();
      return text.str();
    };
    for (const char* name : {"trajectory.txt", "cloud.ply"}) {
      EXPECT_GT(std::filesystem::file_size(whole / name), 100U) << name;
      EXPECT_TRUE(content(GroundFolder() / name) == content(whole / name)) << name;
    }
  }

  /// Otherwise the others show nothing.
  void ExpectThatPacketsWereLost() const {
    const long at_ground = Lost(ground_), at_edge = Lost(edge_);
    std::cout << "packets lost at the ground " << at_ground << ", at the edge " << at_edge << "\n";
    EXPECT_GT(at_ground, 10);
    EXPECT_GT(at_edge, 10);
  }
  static void ExpectLostBetween(const Outcome& outcome, CaptureTime down, CaptureTime back) {
    for (const auto& [sensor, name] : kStreams) {
      const std::vector<StoredFrame> lost = outcome.Lost(sensor);
      ASSERT_FALSE(lost.empty()) << "there was no outage";
      const CaptureTime first = lost.front().capture_time, last = lost.back().capture_time;
      std::cout << name << ": lost from " << Seconds(first - down).count() << " s after the cut to "
                << Seconds(back - last).count() << " s before all was back\n";
      EXPECT_GT(first, down - kMaxOnTheWay) << name;
      EXPECT_LT(last, back + kMaxOnTheWay) << name;
    }
  }

  static long Count(const std::string& text, const std::string& part) {
    long count = 0;
    for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
  }
  std::string Said() { return "ground:\n" + ground().output() + "edge:\n" + edge().output(); }
  Process& edge() { return *edge_process_; }
  Process& ground() { return *ground_process_; }

  const std::filesystem::path rig_ = folder_.path() / "rig.textproto";
  std::filesystem::path results_ = folder_.path() / "ground";
  std::optional<Process> ground_process_;
  std::optional<Process> edge_process_;
};

}  // namespace isotherm::system_test

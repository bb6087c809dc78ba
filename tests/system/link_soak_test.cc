// Both daemons over a radio link that is never quite good, with outages, and killed again and
// again: at the end the ground has every frame that any of the edge's processes has recorded. A
// minute; deploy/soak.sh has it run for hours.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "common/recording/recording_parts.h"
#include "common/testing/temporary_directory.h"
#include "tests/support/emulated_link.h"
#include "tests/support/programs.h"
#include "tests/support/small_scan.h"

namespace isotherm::system_test {
namespace {

using namespace std::chrono_literals;

/// Both ways: 20 ms, and every fiftieth packet lost.
constexpr PathProperties kUsual{.delay = 20ms, .loss = 0.02};
constexpr double kMemorySamples_s = 5.0;
/// A process is in its beginning for so long; what it takes then is no growth.
constexpr double kWarmUp_s = 60.0;
/// More may lack, and the model be larger, than in the first minute. A leak is many times that in
/// an hour.
constexpr double kMaxGrowth = 0.5;

double FromEnvironment(const char* name, double otherwise) {
  const char* const text = std::getenv(name);
  return text != nullptr ? std::strtod(text, nullptr) : otherwise;
}

std::string TextFromEnvironment(const char* name) {
  const char* const text = std::getenv(name);
  return text != nullptr ? text : "";
}

bool ByNumber(const StoredFrame& a, const StoredFrame& b) {
  return a.frame_number < b.frame_number;
}

std::size_t CountWithout(const std::vector<StoredFrame>& a, const std::vector<StoredFrame>& b) {
  std::vector<StoredFrame> missing;
  std::ranges::set_difference(a, b, std::back_inserter(missing), ByNumber);
  return missing.size();
}

/// Resident memory of a process, kB; 0 if it is gone.
long ResidentMemory_kb(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string word; status >> word;) {
    long number_kb = 0;
    if (word == "VmRSS:" && status >> number_kb) return number_kb;
  }
  return 0;
}

/// The memory of one side's processes: how much any of them has grown after its first minute.
/// Thread-compatible.
class MemoryWatch {
 public:
  void Look(pid_t pid, double now_s) {
    if (pid != pid_) {
      pid_ = pid;
      begin_s_ = now_s;
      early_kb_ = 0;
    }
    const long now_kb = ResidentMemory_kb(pid);
    largest_kb_ = std::max(largest_kb_, now_kb);
    if (now_s - begin_s_ < kWarmUp_s) {
      early_kb_ = std::max(early_kb_, now_kb);
    } else if (early_kb_ > 0) {
      const auto growth = static_cast<double>(now_kb - early_kb_) / static_cast<double>(early_kb_);
      growth_ = std::max(growth_, growth);
    }
  }
  long largest_kb() const { return largest_kb_; }
  double growth() const { return growth_; }

 private:
  pid_t pid_ = -1;
  double begin_s_ = 0.0;
  long early_kb_ = 0, largest_kb_ = 0;
  double growth_ = 0.0;
};

class LinkSoakTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto link = EmulatedLink::Create(seed_);
    if (!link) GTEST_SKIP() << "no network of its own: " << link.error().message();
    link_ = std::move(*link);
    link_->network().SetBoth(kUsual);
    WriteSmallScan(scan_);
    WriteSmallRig(rig_);
  }

  /// A ground that is started again mostly finds what the one before has recorded, and goes on
  /// with it.
  void StartGround() {
    constexpr int kOneInLosesItsDisk = 4;
    if (grounds_ % kOneInLosesItsDisk == 0)
      results_ = folder_.path() / ("ground-" + std::to_string(grounds_));
    ++grounds_;
    std::vector<std::string> arguments = {"--once", "--output", results_};
    const std::vector<std::string> quick = QuickScan();
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    ground_.emplace(link_->On(NetworkEnd::kGround, GroundService(), arguments));
    ASSERT_TRUE(ground_->WaitForOutput("ready", kPatience)) << ground_->output();
  }
  void StartEdge(int loops) {
    ++edges_;
    edge_.emplace(
        link_->On(NetworkEnd::kEdge, EdgeDaemon(),
                  {"--recording", scan_, "--rig", rig_, "--record", record_, "--exit-at-end",
                   "--set", "link.expert.linger_s=120", "--set",
                   // One process waits for the ground, the next one leaves frames for later; which
                   // is first depends on the seed.
                   (edges_ + seed_) % 2 == 0 ? "link.policy=LOSSLESS" : "link.policy=LIVE", "--set",
                   "source.loops=" + std::to_string(loops)}));
    ASSERT_TRUE(edge_->WaitForOutput("recording to", kPatience)) << edge_->output();
  }
  void Kill(Process& process) {
    process.Signal(SIGKILL);
    EXPECT_EQ(process.WaitForExit(kPatience), 128 + SIGKILL) << process.output();
  }

  double Uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double Elapsed_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  /// Lets time pass, watching memory.
  void Pass(double seconds) {
    const double end_s = Elapsed_s() + seconds;
    while (Elapsed_s() < end_s) {
      edge_memory_.Look(edge_->pid(), Elapsed_s());
      ground_memory_.Look(ground_->pid(), Elapsed_s());
      std::this_thread::sleep_for(Seconds(std::min(kMemorySamples_s, end_s - Elapsed_s())));
    }
  }
  /// Does one thing that happens to a link, and to those at its ends.
  void Happen() {
    struct Event {
      const char* name;
      PathProperties path;
      double longest_s;
      bool kills_edge, kills_ground;
    };
    constexpr double kNarrow_bit_s = 0.6e6;  // Half of what the small scan takes.
    const std::array<Event, 8> events = {{
        {"outage", {.loss = 1.0}, longest_outage_s_, false, false},
        {"a fifth lost", {.delay = 20ms, .loss = 0.2}, 10.0, false, false},
        {"bursts", {.delay = 20ms, .loss = 0.1, .burst = 200ms}, 10.0, false, false},
        {"reordered and doubled",
         {.delay = 20ms, .jitter = 30ms, .loss = 0.02, .doubled = 0.1},
         10.0,
         false,
         false},
        {"narrow", {.delay = 20ms, .loss = 0.02, .rate_bit_s = kNarrow_bit_s}, 10.0, false, false},
        {"edge killed", kUsual, 1.0, true, false},
        {"ground killed", kUsual, 1.0, false, true},
        {"both killed", kUsual, 1.0, true, true},
    }};
    // Each before one comes again, so that a short run has them all.
    if (to_come_.empty()) {
      for (std::size_t i = 0; i < events.size(); ++i) {
        const bool kills = events.at(i).kills_edge || events.at(i).kills_ground;
        if (only_.empty() || only_ == (kills ? "kills" : "link")) to_come_.push_back(i);
      }
      std::ranges::shuffle(to_come_, random_);
    }
    ASSERT_FALSE(to_come_.empty()) << "ISOTHERM_SOAK_ONLY is neither link nor kills";
    const Event& event = events.at(to_come_.back());
    to_come_.pop_back();
    const double duration_s = Uniform(1.0, std::max(1.0, event.longest_s));
    kills_ += event.kills_edge + event.kills_ground;
    std::cout << static_cast<int>(Elapsed_s()) << " s: " << event.name << " for "
              << static_cast<int>(duration_s) << " s" << std::endl;
    link_->network().SetBoth(event.path);
    if (event.kills_edge) Kill(*edge_);
    if (event.kills_ground) {
      Kill(*ground_);
      ASSERT_NO_FATAL_FAILURE(StartGround());
    }
    if (event.kills_edge) {
      ASSERT_NO_FATAL_FAILURE(StartEdge(kEndless));
    }
    Pass(duration_s);
    link_->network().SetBoth(kUsual);
  }

  /// Compares what is recorded on both sides, and tells.
  void ExpectEverything() {
    RecordingContent recorded;
    for (int part = 1; part <= edges_; ++part) {
      if (!std::filesystem::exists(PartPath(record_, part))) continue;
      const RecordingContent content = ReadRecording(PartPath(record_, part));
      std::ranges::copy(content.depth, std::back_inserter(recorded.depth));
      std::ranges::copy(content.thermal, std::back_inserter(recorded.thermal));
    }
    const RecordingContent received = ReadRecording(results_ / "scan.mcap");
    EXPECT_TRUE(received.complete);
    const auto stats = ReadStats(results_);
    std::cout << "camera   recorded  received  missing  only there  late\n";
    for (const auto& [name, sent, got] :
         {std::tuple("depth", &recorded.depth, &received.depth),
          std::tuple("thermal", &recorded.thermal, &received.thermal)}) {
      const std::size_t missing = CountWithout(*sent, *got), only_there = CountWithout(*got, *sent);
      std::printf("%-8s %8zu  %8zu  %7zu  %10zu  %4.0f\n", name, sent->size(), got->size(), missing,
                  only_there, NumberAt(stats, {"link", name, "late"}));
      EXPECT_GT(sent->size(), 100U);
      EXPECT_EQ(missing, 0U) << name;
      EXPECT_TRUE(std::ranges::adjacent_find(*got, {}, &StoredFrame::frame_number) == got->end());
      EXPECT_EQ(NumberAt(stats, {"link", name, "missing"}), 0.0);
    }
    std::printf("killed %d times\n", kills_);
    std::printf("edge: %d processes, at most %.0f MB, +%.1f %% after its first minute\n", edges_,
                1e-3 * static_cast<double>(edge_memory_.largest_kb()), 100 * edge_memory_.growth());
    std::printf("ground: %d processes, at most %.0f MB, +%.1f %% after its first minute\n",
                grounds_, 1e-3 * static_cast<double>(ground_memory_.largest_kb()),
                100 * ground_memory_.growth());
    EXPECT_LE(edge_memory_.growth(), kMaxGrowth);
    EXPECT_LE(ground_memory_.growth(), kMaxGrowth);
  }

  /// The source never ends by itself.
  static constexpr int kEndless = 1'000'000;

  const double duration_s_ = FromEnvironment("ISOTHERM_SOAK_S", 60.0);
  const double longest_outage_s_ = FromEnvironment("ISOTHERM_SOAK_OUTAGE_S", 12.0);
  /// "kills" or "link": which events there are; empty: all.
  const std::string only_ = TextFromEnvironment("ISOTHERM_SOAK_ONLY");
  const std::uint64_t seed_ =
      static_cast<std::uint64_t>(FromEnvironment("ISOTHERM_SOAK_SEED", 1.0));
  std::mt19937_64 random_{seed_};
  const testing::TemporaryDirectory folder_;
  const std::filesystem::path scan_ = folder_.path() / "source.mcap";
  const std::filesystem::path rig_ = folder_.path() / "rig.textproto";
  const std::filesystem::path record_ = folder_.path() / "scan.mcap";
  std::filesystem::path results_;
  std::unique_ptr<EmulatedLink> link_;
  std::optional<Process> edge_, ground_;
  int edges_ = 0, grounds_ = 0, kills_ = 0;
  std::vector<std::size_t> to_come_;
  MemoryWatch edge_memory_, ground_memory_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

TEST_F(LinkSoakTest, F24ToF37NothingIsLostOverAPoorLinkWithBothSidesKilled) {
  std::cout << "seed " << seed_ << " (ISOTHERM_SOAK_SEED), " << duration_s_ << " s" << std::endl;
  ASSERT_NO_FATAL_FAILURE(StartGround());
  ASSERT_NO_FATAL_FAILURE(StartEdge(kEndless));
  Pass(Uniform(3.0, 5.0));
  while (Elapsed_s() < duration_s_) {
    ASSERT_NO_FATAL_FAILURE(Happen());
    if (HasFailure()) break;
    Pass(Uniform(1.0, 5.0));
  }
  // The last process's source ends, and what is missing comes.
  Kill(*edge_);
  constexpr int kLast_s = 3;
  ASSERT_NO_FATAL_FAILURE(StartEdge(kLast_s));
  // What a long run lacks takes its time, and so do the results.
  const Seconds patience(240.0 + duration_s_);
  EXPECT_EQ(edge_->WaitForExit(patience), 0) << edge_->output();
  EXPECT_EQ(ground_->WaitForExit(patience), 0) << ground_->output();
  ExpectEverything();
  if (HasFailure()) std::cout << "ground:\n" << ground_->output() << "edge:\n" << edge_->output();
}

}  // namespace
}  // namespace isotherm::system_test

#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/container.h"
#include "tests/support/machine_load.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {

inline const std::string kEdge = "isotherm-edge.service";
inline const std::string kGround = "isotherm-ground.service";

/// Warnings that belong to the place, not to the services.
inline const std::vector<std::string> kExplained = {
    "clock is not synchronised",  // Nothing here sets it.
    "IP firewall",                // Control groups of version 1 cannot filter addresses.
    // The first receipt of a ground overtook its hello, which is on another topic.
    "not from a ground station (topic=isotherm/3/receipt depth.next=0 thermal.next=0)",
};
/// This one belongs to a computer that others keep busy, or that paused for a moment, as each does
/// now and then.
inline constexpr const char* kBehind = " ms for its turn: work is left out to keep up";
inline constexpr double kMoment_ms = 250.0;

/// Returns for how long a frame has waited by a line of the journal, milliseconds; nullopt: it is
/// about something else.
inline std::optional<double> Waited_ms(const std::string& line) {
  const std::size_t end = line.find(kBehind);
  const std::size_t begin = line.rfind(' ', end == std::string::npos ? end : end - 1);
  if (end == std::string::npos || begin == std::string::npos) return std::nullopt;
  return std::stod(line.substr(begin));
}

inline std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

class UnitsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    container_ =
        std::make_unique<Container>(std::filesystem::path(ISOTHERM_BINARY_DIR) / "tests/container");
    obstacle_ = container_->Boot();
    if (!obstacle_) InstallAsTheReadmeSays();
  }
  static void TearDownTestSuite() { container_.reset(); }

  void SetUp() override {
    if (obstacle_) GTEST_SKIP() << *obstacle_;
    since_ = Now();
  }
  void TearDown() override {
    if (obstacle_) return;
    Run({"systemctl", "stop", kEdge, kGround, "isotherm-ground@*.service"});
    if (HasFailure()) std::printf("%s\n", Journal("").c_str());
    for (const std::string& unit : {kEdge, kGround}) {
      std::filesystem::remove_all(root() / "etc/systemd/system" / (unit + ".d"));
    }
    container_->Output(
        "rm -rf /var/lib/isotherm/*/* /etc/isotherm/ground-*.env ; cp -a /etc/isotherm.shipped/. "
        "/etc/isotherm/");
    Run({"systemctl", "daemon-reload"});
    Run({"systemctl", "reset-failed"});
  }

  static std::string Now() { return container_->Output("date '+%F %T.%N'"); }
  static std::filesystem::path root() { return container_->root(); }
  static Finished Run(const std::vector<std::string>& command) {
    return container_->Run(command, kPatience);
  }
  static std::string Property(const std::string& unit, const std::string& name) {
    return container_->Output("systemctl show --value --property " + name + ' ' + unit);
  }
  /// Messages of and about both units since this test began.
  std::string Journal(const std::string& options) const {
    return container_->Output(
        fmt::format("journalctl --no-pager --quiet --output cat --unit {} --unit {} --unit "
                    "'isotherm-ground@*' --since '{}' {}",
                    kEdge, kGround, since_, options));
  }
  bool JournalHas(const std::string& text) const {
    return Journal("").find(text) != std::string::npos;
  }
  /// Polls for what happens inside.
  static bool Until(Seconds patience, const std::function<bool()>& happened) {
    const auto limit = std::chrono::steady_clock::now() + patience;
    while (!happened()) {
      if (std::chrono::steady_clock::now() > limit) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return true;
  }
  static void Configure(const std::string& name, const std::string& text) {
    std::ofstream(root() / "etc/isotherm" / name, std::ios::trunc) << text;
  }
  static void AddToUnit(const std::string& unit, const std::string& lines) {
    const std::filesystem::path folder = root() / "etc/systemd/system" / (unit + ".d");
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "test.conf") << "[Service]\n" << lines;
    Run({"systemctl", "daemon-reload"});
  }

  static void InstallAsTheReadmeSays() {
    const Finished install =
        RunToEnd({ISOTHERM_CMAKE,
                  {"--install", ISOTHERM_BINARY_DIR, "--prefix", "/usr", "--strip"},
                  {"DESTDIR=" + root().string()}},
                 kPatience);
    ASSERT_EQ(install.status, 0) << install.output;
    for (const char* line : {"systemd-sysusers", "systemctl daemon-reload"}) {
      const Finished done = Run({"/bin/sh", "-c", line});
      ASSERT_EQ(done.status, 0) << line << ": " << done.output;
    }
    container_->Output("cp -a /etc/isotherm /etc/isotherm.shipped");
  }

  static inline std::unique_ptr<Container> container_;
  static inline std::optional<std::string> obstacle_;
  std::string since_;
  const MachineLoad load_;
};

class UnitsScanTest : public UnitsTest {
 protected:
  enum class Plays { kOnce, kForEver };
  /// The edge plays a simulated scan as if it were its cameras; everything else is as shipped, but
  /// for a coarser model.
  static void Prepare(int duration_s, Plays plays) {
    const bool once = plays == Plays::kOnce;
    Configure("edge.textproto",
              fmt::format("source {{ kind: SYNTHETIC loops: {} simulation {{ duration_s: {}\n"
                          "  scene {{ scene: CORNER_SPHERE }}\n"
                          "  depth {{ rate_hz: 10 }} thermal {{ rate_hz: 10 }} }} }}\n"
                          "spool {{ record: \"/var/lib/isotherm/edge/\" }}\n"
                          "link {{ edge_id: \"\" wait_for_ground: {} }}\n",
                          once ? 1 : 0, duration_s, once));
    container_->Output(
        "sed -i s/voxel_size_m:.*/voxel_size_m:0.006/ /etc/isotherm/ground.textproto; "
        "echo 'tsdf { expert { truncation_distance_m: 0.024 } }' >>/etc/isotherm/ground.textproto");
  }

  void ExpectHealthy() const {
    for (const std::string& unit : {kEdge, kGround}) {
      EXPECT_EQ(Property(unit, "ActiveState"), "active") << unit;
      EXPECT_EQ(Property(unit, "NRestarts"), "0") << unit;
      EXPECT_THAT(Property(unit, "StatusText"), ::testing::Not(::testing::IsEmpty())) << unit;
      // It has run for twice as long as the watchdog is patient, so it was fed.
      ExpectWatched(unit);
    }
    EXPECT_EQ(container_->Output("systemctl --failed --no-legend"), "");
  }

  /// The service manager waits for signs of life, and has had one.
  static void ExpectWatched(const std::string& unit) {
    EXPECT_EQ(Property(unit, "WatchdogUSec"), "10s") << unit;
    EXPECT_EQ(Property(unit, "NotifyAccess"), "main") << unit;
    EXPECT_NE(Property(unit, "WatchdogTimestampMonotonic"), "0") << unit;
  }

  void ExpectNoUnexplainedWarning() const {
    for (const std::string& line : LinesOf(Journal("--priority warning"))) {
      const bool explained = std::any_of(
          kExplained.begin(), kExplained.end(),
          [&](const std::string& known) { return line.find(known) != std::string::npos; });
      const std::optional<double> waited_ms = Waited_ms(line);
      const bool busy = waited_ms && (*waited_ms < kMoment_ms || load_.is_busy());
      EXPECT_TRUE(explained || busy) << line << '\n' << load_.ToText();
    }
  }

  /// All that the edge captured is recorded there, and what it published is on the ground.
  void ExpectTheCountersBalance() const {
    const std::string journal = Journal("--identifier isotherm-edge") + '\n';
    const auto stats = ReadStats(OnlyScan());
    for (const auto& [sensor, name] :
         {std::pair{Sensor::kDepth, "depth"}, std::pair{Sensor::kThermal, "thermal"}}) {
      const FrameCountersText recorded = CountersOf(journal, sensor, "recorded");
      const FrameCountersText published = CountersOf(journal, sensor, "published");
      EXPECT_TRUE(recorded.Closes() && published.Closes()) << journal;
      EXPECT_EQ(recorded.captured, 200) << name;
      EXPECT_EQ(recorded.done, recorded.captured) << name;
      const auto count = [&stats, stream = name](const char* what) {
        return NumberAt(stats, {"link", stream, what});
      };
      EXPECT_EQ(count("published"), static_cast<double>(published.done)) << name;
      EXPECT_EQ(count("received"), count("published")) << name;
      EXPECT_EQ(count("recorded"), count("published")) << name;
      EXPECT_EQ(count("missing"), 0) << name;
    }
  }

  /// The folder of the one scan that has results; fails the test if there is not exactly one.
  static std::filesystem::path OnlyScan() {
    std::vector<std::filesystem::path> scans;
    for (const auto& entry :
         std::filesystem::directory_iterator(root() / "var/lib/isotherm/ground")) {
      if (std::filesystem::exists(entry.path() / "stats.json")) scans.push_back(entry.path());
    }
    EXPECT_THAT(scans, ::testing::SizeIs(1)) << container_->Output("ls -lR /var/lib/isotherm");
    return scans.empty() ? std::filesystem::path() : scans[0];
  }

  void ExpectReadableByTheGroupOnly() const {
    const std::string results = "/var/lib/isotherm/ground/*/stats.json";
    const std::string recordings = "/var/lib/isotherm/edge/*.mcap";
    const auto read_as = [&](const std::string& groups) {
      return Run({"setpriv", "--reuid", "nobody", "--regid", "nogroup", groups, "/bin/sh", "-c",
                  "cat " + results + " " + recordings + " >/dev/null"})
          .status;
    };
    EXPECT_EQ(read_as("--groups=isotherm"), 0);
    EXPECT_NE(read_as("--clear-groups"), 0);
  }
};

}  // namespace isotherm::system_test

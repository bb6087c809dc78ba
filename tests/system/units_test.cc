// The installed programs under the installed units, started by a real systemd.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <thread>

#ifdef RECORDS_ONI
#include "common/testing/temporary_directory.h"
#include "edge/openni/testing/fake_depth_camera.h"
#include "edge/openni/testing/record_oni.h"
#endif
#include "tests/support/container.h"
#include "tests/support/programs.h"

namespace isotherm::system_test {
namespace {

using std::filesystem::path;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

const std::string kEdge = "isotherm-edge.service";
const std::string kGround = "isotherm-ground.service";

/// Warnings that belong to the place, not to the services.
const std::vector<std::string> kExplained = {
    "clock is not synchronised",  // Nothing here sets it.
    "IP firewall",                // Control groups of version 1 cannot filter addresses.
    "for its turn: work is left out to keep up",  // A busy computer.
};

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

class UnitsTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    container_ = std::make_unique<Container>(path(ISOTHERM_BINARY_DIR) / "tests/container");
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
    Run({"systemctl", "stop", kEdge, kGround});
    if (HasFailure()) std::printf("%s\n", Journal("").c_str());
    for (const std::string& unit : {kEdge, kGround}) {
      std::filesystem::remove_all(root() / "etc/systemd/system" / (unit + ".d"));
    }
    container_->Output(
        "rm -rf /var/lib/isotherm/*/* ; cp -a /etc/isotherm.shipped/. /etc/isotherm/");
    Run({"systemctl", "daemon-reload"});
    Run({"systemctl", "reset-failed"});
  }

  static std::string Now() { return container_->Output("date '+%F %T.%N'"); }
  static path root() { return container_->root(); }
  static Finished Run(const std::vector<std::string>& command) {
    return container_->Run(command, kPatience);
  }
  static std::string Property(const std::string& unit, const std::string& name) {
    return container_->Output("systemctl show --value --property " + name + ' ' + unit);
  }
  /// Messages of and about both units since this test began.
  std::string Journal(const std::string& options) const {
    return container_->Output(fmt::format(
        "journalctl --no-pager --quiet --output cat --unit {} --unit {} --since '{}' {}", kEdge,
        kGround, since_, options));
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
    const path folder = root() / "etc/systemd/system" / (unit + ".d");
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

  static std::unique_ptr<Container> container_;
  static std::optional<std::string> obstacle_;
  std::string since_;
};

std::unique_ptr<Container> UnitsTest::container_;
std::optional<std::string> UnitsTest::obstacle_;

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
        "echo 'tsdf { truncation_distance_m: 0.024 }' >>/etc/isotherm/ground.textproto");
  }

  void ExpectHealthy() const {
    for (const std::string& unit : {kEdge, kGround}) {
      EXPECT_EQ(Property(unit, "ActiveState"), "active") << unit;
      EXPECT_EQ(Property(unit, "NRestarts"), "0") << unit;
      EXPECT_THAT(Property(unit, "StatusText"), Not(IsEmpty())) << unit;
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
      EXPECT_TRUE(explained) << line;
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
  static path OnlyScan() {
    std::vector<path> scans;
    for (const auto& entry :
         std::filesystem::directory_iterator(root() / "var/lib/isotherm/ground")) {
      if (std::filesystem::exists(entry.path() / "stats.json")) scans.push_back(entry.path());
    }
    EXPECT_THAT(scans, SizeIs(1)) << container_->Output("ls -lR /var/lib/isotherm");
    return scans.empty() ? path() : scans[0];
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

TEST_F(UnitsScanTest, AScanBetweenTheTwoServices) {
  Prepare(20, Plays::kOnce);
  const Finished started = Run({"systemctl", "start", kGround, kEdge});
  ASSERT_EQ(started.status, 0) << started.output;
  ASSERT_TRUE(Until(kPatience, [&] { return JournalHas("the source has ended"); }));
  ExpectHealthy();
  for (const std::string& unit : {kEdge, kGround}) {
    EXPECT_EQ(Run({"systemctl", "stop", unit}).status, 0) << unit;
    EXPECT_EQ(Property(unit, "Result"), "success") << unit;
    EXPECT_EQ(Property(unit, "ExecMainStatus"), "0") << unit;
  }
  ExpectNoUnexplainedWarning();
  for (const char* file : {"scan.mcap", "cloud.ply", "mesh.ply", "model.iso", "trajectory.txt"}) {
    EXPECT_TRUE(std::filesystem::exists(OnlyScan() / file)) << file;
  }
  ExpectTheCountersBalance();
  ExpectReadableByTheGroupOnly();
}

/// The main process of a service that runs; empty while it does not.
std::string MainPid(const Container& container, const std::string& unit) {
  const std::string shown = container.Output("systemctl show --property SubState,MainPID " + unit);
  const std::size_t pid = shown.find("MainPID=");
  if (shown.find("SubState=running") == std::string::npos || pid == std::string::npos) return "";
  return shown.substr(pid, shown.find('\n', pid) - pid);
}

TEST_F(UnitsTest, F37F40StartedAgainAtOnceHoweverOftenItIsKilled) {
  ASSERT_EQ(Run({"systemctl", "start", kGround}).status, 0);
  constexpr int kKills = 7;  // Systemd by itself gives up after five starts in ten seconds.
  for (int kill = 1; kill <= kKills; ++kill) {
    const std::string pid = MainPid(*container_, kGround);
    ASSERT_THAT(pid, Not(IsEmpty()));
    Run({"systemctl", "kill", "--kill-who", "main", "--signal", "KILL", kGround});
    ASSERT_TRUE(Until(kPatience, [&] {
      const std::string now = MainPid(*container_, kGround);
      return !now.empty() && now != pid;
    })) << Property(kGround, "Result");
    // As the service manager's clock has it.
    const double ended = std::stod(Property(kGround, "InactiveEnterTimestampMonotonic"));
    const double started = std::stod(Property(kGround, "ExecMainStartTimestampMonotonic"));
    EXPECT_LT((started - ended) * 1e-6, 2.0) << "kill " << kill;
  }
  EXPECT_EQ(Property(kGround, "NRestarts"), std::to_string(kKills));
}

TEST_F(UnitsScanTest, F39ADaemonThatIsStoppedIsKilledByTheWatchdogAndComesBack) {
  Prepare(1, Plays::kForEver);
  ASSERT_EQ(Run({"systemctl", "start", kGround, kEdge}).status, 0);
  std::map<std::string, std::string> stopped;
  for (const std::string& unit : {kEdge, kGround}) {
    ExpectWatched(unit);
    stopped[unit] = MainPid(*container_, unit);
    ASSERT_THAT(stopped[unit], Not(IsEmpty())) << unit;
    Run({"systemctl", "kill", "--kill-who", "main", "--signal", "STOP", unit});
  }
  for (const std::string& unit : {kEdge, kGround}) {
    ASSERT_TRUE(Until(kPatience, [&] {
      const std::string now = MainPid(*container_, unit);
      return !now.empty() && now != stopped[unit];
    })) << container_->Output("systemctl status " + unit);
    EXPECT_TRUE(JournalHas(unit + ": Failed with result 'watchdog'")) << unit;
    EXPECT_EQ(Property(unit, "NRestarts"), "1") << unit;
    EXPECT_EQ(Property(unit, "Result"), "success") << unit;
    ExpectWatched(unit);
  }
  // As healthy as before: the edge captures, and the ground follows it.
  EXPECT_TRUE(Until(kPatience, [&] {
    return container_->Output("systemctl show --value --property StatusText " + kGround)
               .find("depth") != std::string::npos;
  })) << container_->Output("systemctl status " + kGround);
  EXPECT_EQ(container_->Output("systemctl --failed --no-legend"), "");
}

#ifdef RECORDS_ONI
// The library of the camera locks itself in (system calls, files) under what the unit forbids
// already; a played file takes the same way as a camera.
TEST_F(UnitsTest, F14TheCamerasProcessConfinesItselfUnderTheUnitAndItsFramesArrive) {
  constexpr int kFrames = 40;
  const ::isotherm::testing::TemporaryDirectory folder;
  const FakeDepthCamera camera{};
  const Status recorded = RecordOni(folder.path() / "scan.oni", kFrames);
  ASSERT_TRUE(recorded.ok()) << recorded.message();
  std::filesystem::copy_file(folder.path() / "scan.oni", root() / "srv/scan.oni",
                             std::filesystem::copy_options::overwrite_existing);
  // The shipped configuration, but for the name of the camera.
  container_->Output(
      "chmod 0644 /srv/scan.oni; sed -i 's|kind: CAMERAS|& depth_camera { uri: "
      "\"/srv/scan.oni\" } thermal_camera { enabled: false }|' "
      "/etc/isotherm/edge.textproto");
  ASSERT_EQ(Run({"systemctl", "start", kEdge}).status, 0);
  EXPECT_TRUE(Until(kPatience, [&] { return JournalHas("is confined to its camera"); }));
  EXPECT_TRUE(Until(kPatience, [&] { return JournalHas("the source has ended"); }));
  EXPECT_EQ(Run({"systemctl", "stop", kEdge}).status, 0);
  EXPECT_EQ(Property(kEdge, "Result"), "success");
  const std::string journal = Journal("--identifier isotherm-edge") + '\n';
  EXPECT_THAT(journal, Not(HasSubstr("not confined")));
  const FrameCountersText counters = CountersOf(journal, Sensor::kDepth, "recorded");
  EXPECT_TRUE(counters.Closes()) << journal;
  EXPECT_GE(counters.done, kFrames) << journal;
}
#endif

TEST_F(UnitsTest, TheSandboxAllowsWhatIsNeededAndNoMore) {
  std::filesystem::copy_file(UNIT_PROBE, root() / "usr/bin/unit_probe",
                             std::filesystem::copy_options::overwrite_existing);
  container_->Output("touch /srv/camera; chown root:plugdev /srv/camera; chmod 0660 /srv/camera");
  const std::map<std::string, std::vector<std::string>> allowed = {
      {kEdge, {"reads-clock", "cameras", "landlock"}}, {kGround, {"reads-clock", "cameras"}}};
  for (const auto& [unit, words] : allowed) {
    since_ = Now();
    AddToUnit(unit, "Type=oneshot\nRestart=no\nExecStart=\nExecStart=/usr/bin/unit_probe\n");
    const Finished probed = Run({"systemctl", "start", unit});
    EXPECT_EQ(probed.status, 0) << probed.output;
    Run({"journalctl", "--sync"});
    EXPECT_EQ(LinesOf(Journal("--identifier unit_probe")), words) << unit;
  }
}

/// Returns whether `unit` runs, has not been started again, and says `reason` in its status.
bool RunsAndSays(const Container& container, const std::string& unit, const std::string& reason) {
  const std::string shown =
      container.Output("systemctl show --property SubState,NRestarts,StatusText " + unit);
  return shown.find("SubState=running") != std::string::npos &&
         shown.find("NRestarts=0") != std::string::npos && shown.find(reason) != std::string::npos;
}

TEST_F(UnitsTest, F01TheEdgeAsShippedWaitsForItsCamera) {
  ASSERT_EQ(Run({"systemctl", "start", kEdge}).status, 0);
  EXPECT_TRUE(Until(kPatience, [&] {
    return RunsAndSays(*container_, kEdge, "waiting for a camera");
  })) << container_->Output("systemctl status " + kEdge);
}

TEST_F(UnitsScanTest, F31BothWaitForAnInterfaceThatIsMissing) {
  Prepare(1, Plays::kForEver);
  Configure("network.env",
            "CYCLONEDDS_URI=<General><Interfaces><NetworkInterface name=\"wlan9\"/></Interfaces>"
            "</General>\n");
  for (const std::string& unit : {kEdge, kGround}) {
    ASSERT_EQ(Run({"systemctl", "start", unit}).status, 0) << unit;
    EXPECT_TRUE(Until(kPatience, [&] { return RunsAndSays(*container_, unit, "cannot join"); }))
        << container_->Output("systemctl status " + unit);
  }
}

TEST_F(UnitsScanTest, F41ADiskThatIsFullAtTheStartDoesNotEndTheEdge) {
  Prepare(1, Plays::kForEver);
  container_->Output(
      "mkdir -p /var/lib/isotherm/edge; mount -t tmpfs -o size=16k full /var/lib/isotherm/edge; "
      "head -c 100000 /dev/zero >/var/lib/isotherm/edge/full");
  ASSERT_EQ(Run({"systemctl", "start", kEdge}).status, 0);
  EXPECT_TRUE(Until(kPatience, [&] { return RunsAndSays(*container_, kEdge, "not recording"); }))
      << container_->Output("systemctl status " + kEdge);
  Run({"systemctl", "stop", kEdge});
  container_->Output("umount /var/lib/isotherm/edge");
}

}  // namespace
}  // namespace isotherm::system_test

// The ground when whoever reads its messages stops or is gone, when its output folder comes late,
// and when it cannot have a console. Edge and ground as two processes over DDS on loopback.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/departure.h"
#include "tests/support/small_scan.h"
#include "tests/system/ground_disk.h"
#include "tests/system/output_pipe.h"

namespace isotherm::system_test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

class GroundOutputTest : public GroundDiskTest {
 protected:
  /// The folders of scans that have their results; stats.json is the last of them.
  std::vector<std::filesystem::path> Finished() const {
    std::vector<std::filesystem::path> scans;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(Path("ground"), missing)) {
      if (std::filesystem::exists(entry.path() / "stats.json")) scans.push_back(entry.path());
    }
    return scans;
  }
  bool WaitForScans(std::size_t scans) const {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (Finished().size() < scans) {
      if (std::chrono::steady_clock::now() > deadline) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return true;
  }
  /// Two scans one after the other, as fast as the ground takes them, and the end.
  void ExpectTwoScansAndALeave(Process& ground) {
    for (std::size_t scan = 1; scan <= 2; ++scan) {
      const auto edge = RunToEnd(Edge(1), kPatience);
      EXPECT_EQ(edge.status, 0) << edge.output;
      ASSERT_TRUE(WaitForScans(scan)) << ground.output();
    }
    ExpectToLeave(ground, SIGTERM);
    for (const std::filesystem::path& scan : Finished()) {
      const auto stats = ReadStats(scan);
      ExpectWholeCounters(stats, "depth");
      ExpectWholeCounters(stats, "thermal");
      EXPECT_TRUE(ReadRecording(scan / "scan.mcap").complete);
    }
  }
  static void ExpectToLeave(Process& ground, int signal, ExitStatus status = 0) {
    const Departure departure = Leave(ground, signal, kPatience);
    EXPECT_EQ(departure.status, status) << ground.output();
    EXPECT_LT(departure.own(), kTimeToLeave) << departure.ToText() << ground.output();
  }
};

TEST_F(GroundOutputTest, F38ATerminalThatIsGoneLeavesResultsAndACompleteRecording) {
  Process ground(Ground());
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  Process edge(EndlessEdge());
  ASSERT_TRUE(edge.WaitForOutput("tracked", kPatience)) << edge.output() << ground.output();
  ExpectToLeave(ground, SIGHUP);
  ASSERT_THAT(Finished(), SizeIs(1)) << ground.output();
  EXPECT_TRUE(std::filesystem::exists(Finished()[0] / "cloud.ply"));
  EXPECT_TRUE(ReadRecording(Finished()[0] / "scan.mcap").complete);
}

TEST_F(GroundOutputTest, F38AReaderOfItsMessagesThatIsGoneEndsNoScan) {
  OutputPipe pipe(folder_.path());
  std::optional<NotifySocket> manager(std::in_place, folder_.path());
  Command command = pipe.From(Ground({"--log-level", "debug"}));
  command.environment.push_back(manager->environment());
  Process ground(command);
  ASSERT_TRUE(manager->WaitFor("READY=1", kPatience));
  manager.reset();  // One that does not read would hold the ground up.
  pipe.CloseAll();
  ExpectTwoScansAndALeave(ground);
}

TEST_F(GroundOutputTest, F39AFullPipeOfMessagesThatNobodyReadsHoldsUpNothing) {
  const OutputPipe pipe(folder_.path());
  pipe.Fill();
  Process ground(pipe.From(Ground({"--log-level", "debug"})));
  ExpectTwoScansAndALeave(ground);
}

/// The summaries of scans go to standard output.
TEST_F(GroundOutputTest, F39AFullPipeOfSummariesThatNobodyReadsIsNoStuckDisk) {
  const OutputPipe pipe(folder_.path());
  pipe.Fill();
  Process ground(pipe.From(Ground(), "1"));
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  ExpectTwoScansAndALeave(ground);
  EXPECT_THAT(ground.output(), Not(HasSubstr("stuck")));
}

/// A port of this computer that somebody else listens on.
class TakenPort {
 public:
  TakenPort() : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(bind(socket_, generic, size), 0);
    EXPECT_EQ(listen(socket_, 1), 0);
    EXPECT_EQ(getsockname(socket_, generic, &size), 0);
    port_ = ntohs(address.sin_port);
  }
  ~TakenPort() { close(socket_); }
  TakenPort(const TakenPort&) = delete;
  TakenPort& operator=(const TakenPort&) = delete;

  std::string port() const { return std::to_string(port_); }

 private:
  const int socket_;
  int port_ = 0;
};

TEST_F(GroundOutputTest, F75AConsoleWhosePortIsTakenCostsNoScan) {
  const TakenPort taken;
  Process ground(Ground({"--set", "console.port=" + taken.port()}));
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  ExpectTwoScansAndALeave(ground);
  EXPECT_THAT(ground.output(), AllOf(HasSubstr("there is no console"), HasSubstr(taken.port()),
                                     HasSubstr("console.port sets another port")));
}

TEST_F(GroundOutputTest, F75ACertificateThatCannotBeReadCostsNoScan) {
  const std::string certificate = Path("missing.pem").string();
  Process ground(Ground({"--set", "console.address=\"0.0.0.0\"", "--set",
                         "console.state_dir=\"" + Path("state").string() + "\"", "--set",
                         "console.certificate_file=\"" + certificate + "\"", "--set",
                         "console.key_file=\"" + certificate + "\""}));
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  ExpectTwoScansAndALeave(ground);
  EXPECT_THAT(ground.output(), AllOf(HasSubstr("there is no console"), HasSubstr(certificate)));
}

TEST_F(GroundOutputTest, F31AnOutputFolderThatIsMissingIsWaitedForAndHasTheScanFromThereOn) {
  std::optional<NotifySocket> manager(std::in_place, folder_.path());
  // Where a file is, not even root can make a folder.
  std::ofstream(Path("ground")).put('x');
  Command command = Ground();
  command.environment.push_back(manager->environment());
  Process ground(command);
  ASSERT_TRUE(manager->WaitFor("READY=1", kPatience)) << ground.output();
  EXPECT_TRUE(manager->WaitForText("NO OUTPUT FOLDER", kPatience)) << ground.output();
  manager.reset();  // One that does not read would hold the ground up.
  Process edge(EndlessEdge());
  ASSERT_TRUE(edge.WaitForOutput("tracked", kPatience)) << "its operator is guided all the same";
  std::filesystem::remove(Path("ground"));
  ASSERT_TRUE(ground.WaitForOutput("the output folder can be used", kPatience)) << ground.output();
  ASSERT_TRUE(ground.WaitForOutput("the disk works again", kPatience)) << ground.output();
  ExpectToLeave(ground, SIGTERM, kDiskStuck);
  ASSERT_THAT(Finished(), SizeIs(1)) << ground.output();
  const auto stats = ReadStats(Finished()[0]);
  for (const char* sensor : {"depth", "thermal"}) {
    ExpectEachFrameAccountedFor(stats, sensor);
    EXPECT_GT(NumberAt(stats, {"link", sensor, "not_recorded_by_reason", "disk_failed"}), 0);
    EXPECT_GT(NumberAt(stats, {"link", sensor, "recorded"}), 0);
  }
  EXPECT_TRUE(ReadRecording(Finished()[0] / "scan.mcap").complete);
}

/// The ground's operator reads the ground's log, not the rig's.
TEST_F(GroundOutputTest, F57ACalibrationThatCannotBeRightIsAWarningOfTheGroundToo) {
  const std::filesystem::path scan = Path("small.mcap");
  WriteSmallScan(scan);
  std::ofstream(Path("rig.textproto"))
      << "depth { width: 64 height: 48 fx: 60 fy: 60 cx: 31.5 cy: 23.5 }\n"
         "thermal { width: 38 height: 28 fx: 40 fy: 40 cx: 18.5 cy: 13.5 }\n"
         "T_thermal_depth { tx: 48.5 ty: 0 tz: 0 qx: 0 qy: 0 qz: 0 qw: 1 }\n";
  Process ground(Ground({"--once"}));
  ASSERT_TRUE(ground.WaitForOutput("ready", kPatience)) << ground.output();
  const auto edge =
      RunToEnd({EdgeDaemon(),
                {"--recording", scan, "--rig", Path("rig.textproto"), "--domain",
                 std::to_string(OwnDomain()), "--rate", "0", "--wait-for-ground", "--exit-at-end"},
                {}},
               kPatience);
  EXPECT_EQ(edge.status, 0) << edge.output;
  EXPECT_EQ(ground.WaitForExit(kPatience), 0) << ground.output();
  EXPECT_THAT(ground.output(), ContainsRegex("warning: Ground: .*48[.]5.*millimetres"));
}

TEST_F(GroundOutputTest, F31WhoWaitsForOneScanIsToldAtOnceThatThereIsNoFolder) {
  std::ofstream(Path("ground")).put('x');
  const auto ground = RunToEnd(Ground({"--once"}), kPatience);
  EXPECT_EQ(ground.status, kDiskStuck) << ground.output;
  EXPECT_THAT(ground.output, HasSubstr("output folder"));
}

}  // namespace
}  // namespace isotherm::system_test

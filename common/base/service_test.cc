#include "common/base/service.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <string>

#include "common/base/pause.h"

namespace isotherm {
namespace {

void WaitForStop(const std::stop_token& stop) { Pause(stop, std::chrono::hours(1)); }

TEST(StopSignalTest, F38SigtermBecomesAStopRequestAndASecondOneIsHarmless) {
  StopSignal signal;
  EXPECT_FALSE(signal.token().stop_requested());
  ASSERT_EQ(kill(getpid(), SIGTERM), 0);
  WaitForStop(signal.token());  // The test's own time limit is the bound.
  EXPECT_TRUE(signal.token().stop_requested());
  ASSERT_EQ(kill(getpid(), SIGTERM), 0);
  ASSERT_EQ(kill(getpid(), SIGINT), 0);
}

TEST(StopSignalTest, F38ATerminalThatIsGoneStopsToo) {
  StopSignal signal;
  ASSERT_EQ(kill(getpid(), SIGHUP), 0);
  WaitForStop(signal.token());
  EXPECT_TRUE(signal.token().stop_requested());
}

TEST(StopSignalTest, UnderNohupTheTerminalDoesNotMatter) {
  ASSERT_NE(::signal(SIGHUP, SIG_IGN), SIG_ERR);
  {
    testing::internal::CaptureStderr();
    StopSignal signal;
    ASSERT_EQ(kill(getpid(), SIGHUP), 0);
    ASSERT_EQ(kill(getpid(), SIGTERM), 0);
    WaitForStop(signal.token());
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "Service: asked to stop, leaving\n");
  ASSERT_NE(::signal(SIGHUP, SIG_DFL), SIG_ERR);
}

TEST(StopSignalTest, ABrokenPipeDoesNotEndTheProcess) {
  const StopSignal signal;
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  close(ends[0]);
  EXPECT_EQ(write(ends[1], "x", 1), -1);
  EXPECT_EQ(errno, EPIPE);
  close(ends[1]);
}

TEST(StopSignalTest, EndsWithoutASignal) {
  const StopSignal signal;
  EXPECT_FALSE(signal.token().stop_requested());
}

TEST(ServiceTest, TellsTheServiceManager) {
  const std::string path = testing::TempDir() + "isotherm_notify_" + std::to_string(getpid());
  const int socket_fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  ASSERT_GE(socket_fd, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  ASSERT_LT(path.copy(address.sun_path, sizeof(address.sun_path) - 1), sizeof(address.sun_path));
  ASSERT_EQ(bind(socket_fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  setenv("NOTIFY_SOCKET", path.c_str(), 1);

  NotifyReady("capturing");
  char received[256] = {};
  ASSERT_GT(recv(socket_fd, received, sizeof(received) - 1, 0), 0);
  EXPECT_STREQ(received, "READY=1\nSTATUS=capturing");

  unsetenv("NOTIFY_SOCKET");
  close(socket_fd);
  unlink(path.c_str());
}

TEST(ServiceTest, WatchdogIntervalIsHalfOfTheUnits) {
  EXPECT_EQ(WatchdogInterval(), std::nullopt);
  setenv("WATCHDOG_USEC", "10000000", 1);
  EXPECT_EQ(WatchdogInterval(), std::chrono::seconds(5));
  unsetenv("WATCHDOG_USEC");
}

}  // namespace
}  // namespace isotherm

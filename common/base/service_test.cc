#include "common/base/service.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <string>

namespace isotherm {
namespace {

void WaitForStop(const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any changed;
  std::unique_lock lock(mutex);
  changed.wait(lock, stop, [] { return false; });
}

TEST(StopSignalTest, F38SigtermBecomesAStopRequestAndASecondOneIsHarmless) {
  StopSignal signal;
  EXPECT_FALSE(signal.token().stop_requested());
  ASSERT_EQ(kill(getpid(), SIGTERM), 0);
  WaitForStop(signal.token());  // The test's own time limit is the bound.
  EXPECT_TRUE(signal.token().stop_requested());
  ASSERT_EQ(kill(getpid(), SIGTERM), 0);
  ASSERT_EQ(kill(getpid(), SIGINT), 0);
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

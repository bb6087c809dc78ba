#include "common/base/service.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstddef>
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

/// A service manager that reads when the test says so; its socket has a path or an abstract name.
class ServiceManagerTest : public ::testing::TestWithParam<bool> {
 protected:
  ServiceManagerTest() {
    const std::string name =
        (GetParam() ? "@" : testing::TempDir()) + "isotherm_notify_" + std::to_string(getpid());
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    name.copy(address.sun_path, sizeof(address.sun_path) - 1);
    if (GetParam()) address.sun_path[0] = '\0';
    if (!GetParam()) path_ = name;
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&address), size), 0);
    setenv("NOTIFY_SOCKET", name.c_str(), 1);
  }
  ~ServiceManagerTest() override {
    unsetenv("NOTIFY_SOCKET");
    close(socket_);
    if (!path_.empty()) unlink(path_.c_str());
  }
  std::string Read() const {
    char received[256] = {};
    const ssize_t size = recv(socket_, received, sizeof(received), MSG_DONTWAIT);
    return size < 0 ? "" : std::string(received, static_cast<std::size_t>(size));
  }

 private:
  const int socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  std::string path_;
};
INSTANTIATE_TEST_SUITE_P(Sockets, ServiceManagerTest, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "Abstract" : "WithPath"; });

TEST_P(ServiceManagerTest, IsToldTheState) {
  NotifyReady("capturing");
  EXPECT_EQ(Read(), "READY=1\nSTATUS=capturing");
  NotifyStatus("tracked");
  EXPECT_EQ(Read(), "STATUS=tracked");
  NotifyWatchdog();
  EXPECT_EQ(Read(), "WATCHDOG=1");
  NotifyStopping();
  EXPECT_EQ(Read(), "STOPPING=1");
}

TEST_P(ServiceManagerTest, F39OneThatDoesNotReadHoldsNobodyUp) {
  // The test's own time limit is the bound.
  constexpr int kMoreThanItHolds = 10'000;
  for (int i = 0; i < kMoreThanItHolds; ++i) NotifyWatchdog();
  EXPECT_FALSE(NotifyStatus("nobody reads this"));
  while (!Read().empty()) {
  }
  EXPECT_TRUE(NotifyStatus("it reads again"));
  EXPECT_EQ(Read(), "STATUS=it reads again");
}

TEST(ServiceTest, WatchdogIntervalIsAThirdOfTheUnits) {
  EXPECT_EQ(WatchdogInterval(), std::nullopt);
  setenv("WATCHDOG_USEC", "15000000", 1);
  EXPECT_EQ(WatchdogInterval(), std::chrono::seconds(5));
  unsetenv("WATCHDOG_USEC");
}

}  // namespace
}  // namespace isotherm

#include "edge/camera_process/testing/sandbox_probe.h"

#include <fcntl.h>
#include <linux/filter.h>
#include <linux/netlink.h>
#include <linux/seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <string>

#include "common/base/check.h"

namespace isotherm {
namespace {

std::uint16_t ErrorOf(long result) { return static_cast<std::uint16_t>(result < 0 ? errno : 0); }

/// Closes what was opened.
std::uint16_t Opened(int descriptor) {
  const std::uint16_t error = ErrorOf(descriptor);
  if (descriptor >= 0) ::close(descriptor);
  return error;
}

std::uint16_t Open(const std::filesystem::path& path, int flags) {
  constexpr int kForAll = 0666;
  return Opened(::open(path.c_str(), flags, kForAll));
}

}  // namespace

SandboxResults ProbeSandbox(const std::filesystem::path& folder) {
  SandboxResults results{};
  const auto set = [&results](SandboxAttempt attempt, std::uint16_t error) {
    results[static_cast<std::size_t>(attempt)] = error;
  };
  const std::string parent = std::to_string(::getppid());
  set(SandboxAttempt::kInternetSocket, Opened(::socket(AF_INET, SOCK_STREAM, 0)));
  set(SandboxAttempt::kInternetDatagrams, Opened(::socket(AF_INET6, SOCK_DGRAM, 0)));
  set(SandboxAttempt::kLocalSocket, Opened(::socket(AF_UNIX, SOCK_STREAM, 0)));
  set(SandboxAttempt::kRouteSocket, Opened(::socket(AF_NETLINK, SOCK_RAW, NETLINK_ROUTE)));
  set(SandboxAttempt::kDeviceSocket,
      Opened(::socket(AF_NETLINK, SOCK_RAW, NETLINK_KOBJECT_UEVENT)));
  set(SandboxAttempt::kReadForeign, Open(folder / "foreign", O_RDONLY));
  set(SandboxAttempt::kWriteForeign, Open(folder / "foreign", O_WRONLY));
  set(SandboxAttempt::kCreateFile, Open(folder / "new", O_WRONLY | O_CREAT));
  set(SandboxAttempt::kReadAllowed, Open(folder / "allowed", O_RDONLY));
  set(SandboxAttempt::kWriteAllowed, Open(folder / "allowed", O_WRONLY));
  set(SandboxAttempt::kReadParent, Open("/proc/" + parent + "/status", O_RDONLY));
  set(SandboxAttempt::kSignalParent, ErrorOf(::kill(::getppid(), 0)));
  char* const nothing[] = {nullptr};
  set(SandboxAttempt::kStartProgram, ErrorOf(::execve("/nowhere/program", nothing, nothing)));
  set(SandboxAttempt::kIoRing, Opened(static_cast<int>(::syscall(SYS_io_uring_setup, 0, nullptr))));
  return results;
}

void ForbidLandlock() {
  sock_filter instructions[] = {
      {BPF_LD | BPF_W | BPF_ABS, 0, 0, offsetof(seccomp_data, nr)},
      {BPF_JMP | BPF_JEQ | BPF_K, 0, 1, SYS_landlock_create_ruleset},
      {BPF_RET | BPF_K, 0, 0, SECCOMP_RET_KILL_PROCESS},
      {BPF_RET | BPF_K, 0, 0, SECCOMP_RET_ALLOW},
  };
  const sock_fprog program{static_cast<unsigned short>(std::size(instructions)), instructions};
  CHECK(::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0);
  CHECK(::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program, 0, 0) == 0);
}

}  // namespace isotherm

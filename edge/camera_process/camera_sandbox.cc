#include "edge/camera_process/camera_sandbox.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <linux/landlock.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>
#include <optional>

#include "edge/camera_process/system_call_filter.h"

namespace isotherm {
namespace {

// Rights that a kernel has learnt after the headers that this may be compiled with.
constexpr std::uint64_t kTruncate = 1ULL << 14U;             // Landlock 3.
constexpr std::uint64_t kDeviceControl = 1ULL << 15U;        // 5.
constexpr std::uint64_t kBindTcp = 1ULL << 0U;               // 4.
constexpr std::uint64_t kConnectTcp = 1ULL << 1U;            // 4.
constexpr std::uint64_t kScopeAbstractSockets = 1ULL << 0U;  // 6.
constexpr std::uint64_t kScopeSignals = 1ULL << 1U;          // 6.

constexpr std::uint64_t kList = LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kRead = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_READ_DIR;
constexpr std::uint64_t kWrite = kRead | LANDLOCK_ACCESS_FS_WRITE_FILE |
                                 LANDLOCK_ACCESS_FS_MAKE_REG | LANDLOCK_ACCESS_FS_REMOVE_FILE |
                                 kTruncate | kDeviceControl;
/// A rule for a single file may speak of these only.
constexpr std::uint64_t kOfFiles = LANDLOCK_ACCESS_FS_READ_FILE | LANDLOCK_ACCESS_FS_WRITE_FILE |
                                   LANDLOCK_ACCESS_FS_EXECUTE | kTruncate | kDeviceControl;

/// As the kernel's, with what it has learnt since.
struct RulesetAttributes {
  std::uint64_t files = 0;
  std::uint64_t network = 0;
  std::uint64_t scoped = 0;
};

/// Returns which version of Landlock the kernel has; 0: none. kFailedPrecondition: this process
/// would be ended if it asked, as a service's filter of system calls does it: so a child asks.
Result<int> LandlockVersion() {
  const pid_t child = ::fork();
  if (child == 0) {
    const long version =
        ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION);
    ::_exit(version > 0 ? static_cast<int>(version) : 0);
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child || !WIFEXITED(status)) {
    return Err(FailedPrecondition(
        "the service's filter of system calls refuses Landlock; allow landlock_create_ruleset, "
        "landlock_add_rule and landlock_restrict_self in its SystemCallFilter="));
  }
  return WEXITSTATUS(status);
}

/// The rights over files that version `version` knows.
std::uint64_t FileRights(int version) {
  std::uint64_t rights = (1ULL << 13U) - 1;
  if (version >= 2) rights |= LANDLOCK_ACCESS_FS_REFER;
  if (version >= 3) rights |= kTruncate;
  if (version >= 5) rights |= kDeviceControl;
  return rights;
}

void Allow(int ruleset, const std::vector<std::string>& paths, std::uint64_t rights) {
  for (const std::string& path : paths) {
    const int file = ::open(path.c_str(), O_PATH | O_CLOEXEC);
    if (file < 0) continue;
    struct stat what {};
    landlock_path_beneath_attr rule{};
    rule.parent_fd = file;
    rule.allowed_access =
        ::fstat(file, &what) == 0 && S_ISDIR(what.st_mode) ? rights : rights & kOfFiles;
    ::syscall(SYS_landlock_add_rule, ruleset, LANDLOCK_RULE_PATH_BENEATH, &rule, 0);
    ::close(file);
  }
}

Status RestrictFiles(const CameraSandbox& sandbox) {
  const Result<int> version = LandlockVersion();
  if (!version) return version.error();
  if (*version < 1) {
    return FailedPrecondition("this kernel has no Landlock (lsm=landlock,... on its command line)");
  }
  const std::uint64_t rights = FileRights(*version);
  RulesetAttributes attributes{.files = rights};
  if (*version >= 4) attributes.network = kBindTcp | kConnectTcp;
  if (*version >= 6) {
    attributes.scoped = kScopeSignals | (sandbox.local_sockets ? 0 : kScopeAbstractSockets);
  }
  // An older kernel knows fewer of the fields.
  const std::size_t size = *version >= 6 ? 24 : *version >= 4 ? 16 : 8;
  const int ruleset =
      static_cast<int>(::syscall(SYS_landlock_create_ruleset, &attributes, size, 0));
  if (ruleset < 0) {
    return FailedPrecondition(fmt::format("no Landlock rules: {}", std::strerror(errno)));
  }
  Allow(ruleset, sandbox.list, kList & rights);
  Allow(ruleset, sandbox.read, kRead & rights);
  Allow(ruleset, sandbox.write, kWrite & rights);
  const bool restricted = ::syscall(SYS_landlock_restrict_self, ruleset, 0) == 0;
  const int error = errno;
  ::close(ruleset);
  if (restricted) return OkStatus();
  return FailedPrecondition(fmt::format("Landlock: {}", std::strerror(error)));
}

}  // namespace

Status EnterSandbox(const CameraSandbox& sandbox) {
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) {
    return FailedPrecondition(fmt::format("not confined at all: {}", std::strerror(errno)));
  }
  const Status files = RestrictFiles(sandbox);
  const Status calls = FilterSystemCalls(sandbox.local_sockets);
  if (files.ok() && calls.ok()) return OkStatus();
  if (calls.ok()) return files.WithContext("its files are not restricted");
  if (files.ok()) return calls.WithContext("it has the network");
  return FailedPrecondition(
      fmt::format("not confined at all: {}; {}", files.message(), calls.message()));
}

}  // namespace isotherm

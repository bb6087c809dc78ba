#include "tests/support/container.h"

#include <fmt/format.h>
#include <sched.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/xattr.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>
#include <thread>

namespace isotherm::system_test {
namespace {

using std::filesystem::path;

constexpr Seconds kBootLimit{60};
constexpr Seconds kLookAgain{0.1};

constexpr const char* kHostName = "isotherm-test";
constexpr const char* kTarget = "isotherm-test.target";
constexpr const char* kTargetText =
    "[Unit]\nDescription=What a service needs, and no service\nRequires=sysinit.target\n"
    "After=sysinit.target\nAllowIsolate=yes\n";

std::string Failed(const std::string& what) {
  return fmt::format("{} failed: {}", what, std::strerror(errno));
}

std::string ReadAll(const path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Where this process stands among the control groups that service managers use; empty if there are
/// none.
path OwnCgroup() {
  std::ifstream groups("/proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    // Version 1 has a hierarchy of its own for service managers, version 2 only one for all.
    for (const auto& [mark, mount] : {std::pair{":name=systemd:", "/sys/fs/cgroup/systemd"},
                                      std::pair{"0::", "/sys/fs/cgroup"}}) {
      const std::size_t at = line.find(mark);
      const path root = mount;
      if (at == std::string::npos || !std::filesystem::exists(root / "cgroup.procs")) continue;
      return root / path(line.substr(at + std::strlen(mark))).relative_path();
    }
  }
  return {};
}

/// The first process of the container, among those that `pid` has started; -1 if there is none yet.
pid_t FindSystemd(pid_t pid) {
  for (const pid_t child : ChildrenOf(pid)) {
    if (ReadAll(fmt::format("/proc/{}/comm", child)) == "systemd\n") return child;
    if (const pid_t found = FindSystemd(child); found > 0) return found;
  }
  return -1;
}

/// Control groups are removed from the leaves on; their files cannot be.
void RemoveCgroup(const path& group) {
  std::error_code gone;
  std::vector<path> folders = {group};
  for (const auto& entry : std::filesystem::recursive_directory_iterator(group, gone)) {
    if (entry.is_directory(gone)) folders.push_back(entry.path());
  }
  for (auto folder = folders.rbegin(); folder != folders.rend(); ++folder) rmdir(folder->c_str());
}

}  // namespace

Container::Container(path folder) : folder_(std::move(folder)) { obstacle_ = MakeRoot(); }

Container::~Container() {
  nspawn_.reset();
  umount2(root().c_str(), MNT_DETACH);
  umount2(folder_.c_str(), MNT_DETACH);
  std::error_code ignored;
  std::filesystem::remove(folder_, ignored);
  if (cgroup_.empty()) return;
  // The last processes may still be on their way out.
  for (int tries = 0; tries < 50 && std::filesystem::exists(cgroup_, ignored); ++tries) {
    RemoveCgroup(cgroup_);
    if (std::filesystem::exists(cgroup_, ignored)) std::this_thread::sleep_for(kLookAgain);
  }
}

std::optional<std::string> Container::MakeRoot() {
  if (geteuid() != 0) return "a container needs root";
  if (!std::filesystem::exists("/usr/bin/systemd-nspawn"))
    return "systemd-nspawn is not installed (package systemd-container)";
  if (!std::filesystem::exists("/lib/systemd/systemd")) return "systemd is not installed";
  // From here on, mounts are seen by this process and its children only, and end with them.
  if (unshare(CLONE_NEWNS) != 0) return Failed("a mount namespace");
  if (mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return Failed("mount /");
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (mount("isotherm-test", folder_.c_str(), "tmpfs", 0, "size=2g,mode=0755") != 0)
    return Failed("mount " + folder_.string());
  const path upper = folder_ / "upper";
  const path settings = upper / "etc/systemd/system";
  for (const path& made : {settings, folder_ / "work", root()})
    std::filesystem::create_directories(made);
  // Hides this computer's services, mounts and name from the container.
  if (setxattr((upper / "etc/systemd").c_str(), "trusted.overlay.opaque", "y", 1, 0) != 0)
    return Failed("an opaque folder");
  const std::string layers =
      fmt::format("lowerdir=/,upperdir={},workdir={}", upper.string(), (folder_ / "work").string());
  if (mount("overlay", root().c_str(), "overlay", 0, layers.c_str()) != 0)
    return Failed("an overlay of this computer's system");
  std::ofstream(root() / "etc/fstab", std::ios::trunc) << "";
  std::ofstream(root() / "etc/hostname", std::ios::trunc) << kHostName << '\n';
  std::ofstream(root() / "etc/machine-id", std::ios::trunc) << std::string(31, '0') << "1\n";
  // The journal stays in memory, and so do this computer's own results.
  std::filesystem::remove_all(root() / "var/log/journal", error);
  std::filesystem::remove_all(root() / "var/lib/isotherm", error);
  std::ofstream(root() / "etc/systemd/system" / kTarget) << kTargetText;
  std::filesystem::create_symlink(kTarget, root() / "etc/systemd/system/default.target", error);
  return std::nullopt;
}

std::optional<std::string> Container::Boot() {
  if (obstacle_) return obstacle_;
  if (const path own = OwnCgroup(); !own.empty()) {
    cgroup_ = own / fmt::format("isotherm-test-{}", getpid());
    std::error_code error;
    if (!std::filesystem::create_directory(cgroup_, error)) cgroup_.clear();
  }
  const std::string enter =
      cgroup_.empty() ? ":" : "echo $$ >" + (cgroup_ / "cgroup.procs").string();
  // What our services may do inside is limited by their units, not by the container; it still
  // cannot set the clock, for want of the capability.
  // All of it lives in a PID namespace that ends with this process.
  const std::string nspawn =
      "exec setpriv --pdeathsig KILL unshare --pid --fork --kill-child --mount-proc"
      " systemd-nspawn --quiet --register=no --keep-unit "
      "--directory " +
      root().string() + " --private-network --console=pipe --hostname=" + kHostName +
      " --resolv-conf=off --timezone=off"
      " --link-journal=no --boot --system-call-filter=\"adjtimex clock_adjtime seccomp"
      " landlock_create_ruleset landlock_add_rule landlock_restrict_self\"";
  nspawn_ = std::make_unique<Process>(Command{"/bin/sh", {"-c", enter + "\n" + nspawn}, {}});
  return WaitForBoot();
}

std::optional<std::string> Container::WaitForBoot() {
  const auto limit = std::chrono::steady_clock::now() + kBootLimit;
  while (std::chrono::steady_clock::now() < limit) {
    if (nspawn_->WaitForExit(kLookAgain)) return "systemd-nspawn left: " + nspawn_->output();
    init_ = FindSystemd(nspawn_->pid());
    if (init_ > 0 && Run({"systemctl", "is-active", "--quiet", kTarget}).status == 0)
      return std::nullopt;
  }
  return "systemd did not come up in the container: " + nspawn_->output();
}

Finished Container::Run(const std::vector<std::string>& command, Seconds timeout) const {
  std::vector<std::string> arguments = {"--target", std::to_string(init_), "--all", "--"};
  arguments.insert(arguments.end(), command.begin(), command.end());
  return RunToEnd({"/usr/bin/nsenter", arguments, {"LC_ALL=C", "SYSTEMD_PAGER="}}, timeout);
}

std::string Container::Output(const std::string& shell_line, Seconds timeout) const {
  std::string output = Run({"/bin/sh", "-c", shell_line}, timeout).output;
  if (output.ends_with('\n')) output.pop_back();
  return output;
}

}  // namespace isotherm::system_test

#include "tests/support/process.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <system_error>

#include "common/base/check.h"

namespace isotherm::system_test {
namespace {

/// For poll(): rounded up, so that a short rest is not a busy wait.
int ToMilliseconds(Seconds duration) {
  return static_cast<int>(std::ceil(std::max(duration.count(), 0.0) * 1e3));
}

/// Waits until `descriptor` can be read.
bool WaitReadable(int descriptor, Seconds timeout) {
  pollfd waited{descriptor, POLLIN, 0};
  int ready = 0;
  do {
    ready = poll(&waited, 1, ToMilliseconds(timeout));
  } while (ready < 0 && errno == EINTR);
  return ready > 0;
}

std::vector<char*> Pointers(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// This process's environment with `added` in place of variables of the same name.
std::vector<std::string> MergedEnvironment(const std::vector<std::string>& added) {
  std::vector<std::string> merged = added;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view variable = *entry;
    const std::string_view name = variable.substr(0, variable.find('=') + 1);
    const bool replaced = std::any_of(added.begin(), added.end(), [&](const std::string& other) {
      return other.starts_with(name);
    });
    if (!replaced) merged.emplace_back(variable);
  }
  return merged;
}

pid_t Spawn(const Command& command, int output_pipe) {
  posix_spawn_file_actions_t actions;
  CHECK(posix_spawn_file_actions_init(&actions) == 0);
  CHECK(posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0) == 0);
  CHECK(posix_spawn_file_actions_adddup2(&actions, output_pipe, STDERR_FILENO) == 0);
  if (command.output_file.empty()) {
    CHECK(posix_spawn_file_actions_adddup2(&actions, output_pipe, STDOUT_FILENO) == 0);
  } else {
    CHECK(posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, command.output_file.c_str(),
                                           O_WRONLY | O_CREAT, 0644) == 0);
  }
  std::vector<std::string> arguments = {command.program.string()};
  arguments.insert(arguments.end(), command.arguments.begin(), command.arguments.end());
  std::vector<std::string> environment = MergedEnvironment(command.environment);
  pid_t pid = -1;
  const int error = posix_spawn(&pid, command.program.c_str(), &actions, nullptr,
                                Pointers(arguments).data(), Pointers(environment).data());
  posix_spawn_file_actions_destroy(&actions);
  CHECK(error == 0);
  return pid;
}

}  // namespace

Process::Process(const Command& command) {
  std::array<int, 2> pipe_ends{};
  CHECK(pipe2(pipe_ends.data(), O_CLOEXEC) == 0);
  pid_ = Spawn(command, pipe_ends[1]);
  close(pipe_ends[1]);
  pidfd_ = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));
  CHECK(pidfd_ >= 0);
  reader_ = std::jthread([this, read_end = pipe_ends[0]] { Drain(read_end); });
}

Process::~Process() {
  if (!exit_status_) {
    Signal(SIGKILL);
    WaitForExit(Seconds(10));
  }
  if (reader_.joinable()) reader_.join();
  close(pidfd_);
}

void Process::Signal(int signal) const { kill(pid_, signal); }

bool Process::HasEnded(Seconds timeout) const {
  return exit_status_.has_value() || WaitReadable(pidfd_, timeout);
}

std::optional<ExitStatus> Process::WaitForExit(Seconds timeout) {
  if (exit_status_) return exit_status_;
  if (!HasEnded(timeout)) return std::nullopt;
  int status = 0;
  CHECK(waitpid(pid_, &status, 0) == pid_);
  exit_status_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  // Grandchildren may hold the pipe open for longer; the program's own output is complete by now.
  MutexLock lock(mutex_);
  changed_.wait_for(lock, std::chrono::seconds(2),
                    [this]() REQUIRES(mutex_) { return output_ended_; });
  return exit_status_;
}

bool Process::WaitForOutput(std::string_view text, Seconds timeout, int times) {
  MutexLock lock(mutex_);
  const auto seen = [&]() REQUIRES(mutex_) {
    std::size_t at = output_.find(text);
    for (int more = times - 1; more > 0 && at != std::string::npos; --more) {
      at = output_.find(text, at + 1);
    }
    return at != std::string::npos;
  };
  changed_.wait_for(lock, timeout, [&]() REQUIRES(mutex_) { return seen() || output_ended_; });
  return seen();
}

std::string Process::output() const {
  MutexLock lock(mutex_);
  return output_;
}

void Process::Drain(int pipe) {
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = read(pipe, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    MutexLock lock(mutex_);
    if (count <= 0) {
      output_ended_ = true;
      changed_.notify_all();
      break;
    }
    output_.append(buffer.data(), static_cast<std::size_t>(count));
    changed_.notify_all();
  }
  close(pipe);
}

std::vector<pid_t> ChildrenOf(pid_t pid) {
  std::vector<pid_t> children;
  std::error_code gone;
  const std::string tasks = "/proc/" + std::to_string(pid) + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks, gone)) {
    std::ifstream list(task.path() / "children");
    for (pid_t child = 0; list >> child;) children.push_back(child);
  }
  return children;
}

std::string CommandLineOf(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/cmdline", std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Finished RunToEnd(const Command& command, Seconds timeout) {
  Process process(command);
  const std::optional<ExitStatus> status = process.WaitForExit(timeout);
  return {status.value_or(-1), process.output()};
}

NotifySocket::NotifySocket(const std::filesystem::path& folder) : path_(folder / "notify") {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  CHECK(path_.string().size() < sizeof(address.sun_path));
  std::strcpy(address.sun_path, path_.c_str());
  socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  CHECK(socket_ >= 0);
  CHECK(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0);
}

NotifySocket::~NotifySocket() { close(socket_); }

std::string NotifySocket::Receive(Seconds timeout) {
  if (!WaitReadable(socket_, timeout)) return "";
  std::array<char, 4096> buffer{};
  const ssize_t count = recv(socket_, buffer.data(), buffer.size(), 0);
  if (count <= 0) return "";
  return "\n" + std::string(buffer.data(), static_cast<std::size_t>(count)) + "\n";
}

bool NotifySocket::WaitFor(std::string_view line, Seconds timeout) {
  return WaitForText("\n" + std::string(line) + "\n", timeout);
}

bool NotifySocket::WaitForText(std::string_view text, Seconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (received_.find(text) == std::string::npos) {
    const Seconds left = deadline - std::chrono::steady_clock::now();
    if (left.count() <= 0) return false;
    received_ += Receive(left);
  }
  return true;
}

void NotifySocket::Drain() {
  for (std::string message = Receive(Seconds(0)); !message.empty(); message = Receive(Seconds(0)))
    received_ += message;
}

void NotifySocket::Forget() {
  while (!Receive(Seconds(0)).empty()) {
  }
  received_ = "\n";
}

Seconds NotifySocket::LongestSilence(std::string_view line, Seconds duration) {
  const std::string wanted = "\n" + std::string(line) + "\n";
  const auto start = std::chrono::steady_clock::now();
  auto last = start;
  Seconds longest{0};
  for (auto now = start; now - start < duration; now = std::chrono::steady_clock::now()) {
    const std::string message = Receive(duration - (now - start));
    const auto then = std::chrono::steady_clock::now();
    longest = std::max(longest, Seconds(then - last));
    if (message.find(wanted) != std::string::npos) last = then;
    received_ += message;
  }
  return longest;
}

bool NotifySocket::WaitForSilence(std::string_view line, Seconds silence, Seconds timeout) {
  const std::string wanted = "\n" + std::string(line) + "\n";
  const auto start = std::chrono::steady_clock::now();
  auto last = start;
  for (auto now = start; now - start < timeout; now = std::chrono::steady_clock::now()) {
    if (now - last >= silence) return true;
    const std::string message = Receive(silence - (now - last));
    if (message.find(wanted) != std::string::npos) last = std::chrono::steady_clock::now();
    received_ += message;
  }
  return false;
}

}  // namespace isotherm::system_test

#include "common/base/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <fstream>
#include <thread>
#include <utility>

namespace isotherm {
namespace {

/// As shells say that a program cannot be started.
constexpr int kCannotStart = 127;

/// Points standard input, output and error away from this program's own.
bool UseLog(const char* log) {
  constexpr mode_t kMode = 0644;
  const int in = ::open("/dev/null", O_RDONLY);
  const int out = ::open(log, O_WRONLY | O_CREAT | O_TRUNC, kMode);
  return in >= 0 && out >= 0 && ::dup2(in, STDIN_FILENO) >= 0 && ::dup2(out, STDOUT_FILENO) >= 0 &&
         ::dup2(out, STDERR_FILENO) >= 0;
}

void ResetSignals() {
  sigset_t none;
  sigemptyset(&none);
  for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
}

/// In the child, between fork and exec: nothing here may allocate or lock. Writes errno to
/// `failure` if the program cannot be started.
[[noreturn]] void Become(char* const* words, const char* log, pid_t parent, int failure) {
  ResetSignals();
  // If the parent is killed, the child is not left behind; it may flush its files.
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (::getppid() != parent) ::_exit(kCannotStart);  // Gone before that.
  if (UseLog(log)) ::execv(words[0], words);
  const int error = errno;
  static_cast<void>(!::write(failure, &error, sizeof(error)));
  ::_exit(kCannotStart);
}

}  // namespace

Result<ChildProcess> ChildProcess::Start(const std::filesystem::path& program,
                                         const std::vector<std::string>& arguments,
                                         const std::filesystem::path& log) {
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const auto fail = [&program](int error) {
    return Err(Unavailable(
        fmt::format("{}: cannot be started: {}", program.string(), std::strerror(error))));
  };
  int failure[2];
  if (::pipe2(failure, O_CLOEXEC) != 0) return fail(errno);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid == 0) Become(pointers.data(), log.c_str(), parent, failure[1]);
  int error = pid < 0 ? errno : 0;
  ::close(failure[1]);
  // Ends when the program has begun.
  static_cast<void>(!::read(failure[0], &error, sizeof(error)));
  ::close(failure[0]);
  if (error == 0) return ChildProcess(pid, log);
  if (pid > 0) ::waitpid(pid, nullptr, 0);
  return fail(error);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), log_(std::move(other.log_)), status_(other.status_) {}

ChildProcess::~ChildProcess() {
  if (pid_ < 0 || Poll()) return;
  Terminate();
  // An edge leaves within two seconds while all answers (stop_limits.h); what takes longer is
  // killed.
  constexpr auto kPatience = std::chrono::seconds(5);
  // Short against what a user notices.
  constexpr auto kTick = std::chrono::milliseconds(20);
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (!Poll() && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(kTick);
  if (status_) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
}

std::optional<int> ChildProcess::Poll() {
  if (status_ || pid_ < 0) return status_;
  int raw = 0;
  if (::waitpid(pid_, &raw, WNOHANG) != pid_) return std::nullopt;
  constexpr int kSignalBase = 128;  // As shells count.
  status_ = WIFEXITED(raw) ? WEXITSTATUS(raw) : kSignalBase + WTERMSIG(raw);
  return status_;
}

void ChildProcess::Terminate() {
  if (!status_ && pid_ > 0) ::kill(pid_, SIGTERM);
}

Result<std::filesystem::path> NeighbourProgram(const std::string& name) {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::filesystem::path program = self.parent_path() / name;
  if (error || ::access(program.c_str(), X_OK) != 0) {
    return Err(Unavailable(fmt::format(
        "{}: there is no such program; build or install all of Isotherm", program.string())));
  }
  return program;
}

std::string LastLines(const std::filesystem::path& log, std::size_t count) {
  std::ifstream file(log);
  std::deque<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    lines.push_back(std::move(line));
    if (lines.size() > count) lines.pop_front();
  }
  std::string text;
  for (const std::string& line : lines) text += "  " + line + "\n";
  return text;
}

}  // namespace isotherm

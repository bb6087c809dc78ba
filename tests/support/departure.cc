#include "tests/support/departure.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

namespace isotherm::system_test {
namespace {

/// A wait between the last look and the end of a thread is not seen.
constexpr Seconds kLook{0.01};

}  // namespace

ProcessorWait::ProcessorWait(pid_t pid) : pid_(pid), before_(Read()) {}

std::map<pid_t, ProcessorWait::Nanoseconds> ProcessorWait::Read() const {
  std::map<pid_t, Nanoseconds> waited;
  std::error_code gone;
  const std::string tasks = "/proc/" + std::to_string(pid_) + "/task";
  for (std::filesystem::directory_iterator task(tasks, gone), end; !gone && task != end;
       task.increment(gone)) {
    std::ifstream file(task->path() / "schedstat");
    Nanoseconds ran = 0;
    Nanoseconds stood_ready = 0;
    if (file >> ran >> stood_ready) waited[std::stoi(task->path().filename())] = stood_ready;
  }
  return waited;
}

void ProcessorWait::Look() {
  std::map<pid_t, Nanoseconds> now = Read();
  Nanoseconds longest = 0;
  for (const auto& [thread, waited] : now) {
    const auto before = before_.find(thread);
    longest = std::max(longest, waited - (before == before_.end() ? 0 : before->second));
  }
  total_ += std::chrono::nanoseconds(longest);
  before_ = std::move(now);
}

std::string Departure::ToText() const {
  std::ostringstream text;
  text << "left after " << took.count() << " s, " << waited.count()
       << " s of them without a processor\n";
  return text.str();
}

Departure Leave(Process& program, int signal, Seconds patience) {
  ProcessorWait wait(program.pid());
  const auto told = std::chrono::steady_clock::now();
  program.Signal(signal);
  while (!program.HasEnded(kLook) && std::chrono::steady_clock::now() - told < patience)
    wait.Look();
  Departure departure;
  departure.took = std::chrono::steady_clock::now() - told;
  departure.waited = std::min(wait.total(), departure.took);
  departure.status = program.WaitForExit(Seconds(0));
  return departure;
}

}  // namespace isotherm::system_test

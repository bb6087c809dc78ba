#include "common/base/processor_time.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <system_error>
#include <utility>
#include <vector>

namespace isotherm {
namespace {

constexpr double kNsToS = 1e-9;
/// A thread that used less than this since the first reading is left out: it has done nothing worth
/// a line.
constexpr double kMin_s = 1e-3;
/// Threads below this fraction of one core are shown together as "others".
constexpr double kWorthNaming = 0.01;

thread_local std::chrono::nanoseconds of_helpers{0};

std::chrono::nanoseconds ReadClock(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

/// The kernel cuts longer names itself, but pthread_setname_np refuses them.
constexpr std::size_t kMaxName = 15;

}  // namespace

void NameThread(const char* name) {
  pthread_setname_np(pthread_self(), std::string(name).substr(0, kMaxName).c_str());
}

void LowerThreadPriority(int niceness) {
  // Of this thread only, which is what Linux does.
  static_cast<void>(setpriority(PRIO_PROCESS, static_cast<id_t>(syscall(SYS_gettid)), niceness));
}

std::chrono::nanoseconds ThreadProcessorTime() {
  return ReadClock(CLOCK_THREAD_CPUTIME_ID) + of_helpers;
}

void AddProcessorTimeOfHelpers(std::chrono::nanoseconds worked) { of_helpers += worked; }

ProcessorTimes ReadProcessorTimes() {
  ProcessorTimes times;
  std::error_code error;
  std::filesystem::directory_iterator task("/proc/self/task", error);
  for (; !error && task != std::filesystem::directory_iterator(); task.increment(error)) {
    // A thread may end between any two of these lines: then a file lacks its text.
    std::string name;
    std::uint64_t on_processor_ns = 0;
    std::ifstream(task->path() / "comm") >> name;
    std::ifstream(task->path() / "schedstat") >> on_processor_ns;
    if (!name.empty()) times.by_thread_s[name] += kNsToS * static_cast<double>(on_processor_ns);
  }
  // Last, so that it is not less than the sum of the threads.
  times.total_s = kNsToS * static_cast<double>(ReadClock(CLOCK_PROCESS_CPUTIME_ID).count());
  return times;
}

double ProcessorTimeOfChildren_s() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

ProcessorTimes operator-(const ProcessorTimes& after, const ProcessorTimes& before) {
  ProcessorTimes used{.total_s = after.total_s - before.total_s, .by_thread_s = {}};
  double of_ended_s = used.total_s;
  for (const auto& [name, after_s] : after.by_thread_s) {
    const auto found = before.by_thread_s.find(name);
    // Less than before: one of several threads of the name has ended.
    const double used_s =
        std::max(0.0, after_s - (found == before.by_thread_s.end() ? 0.0 : found->second));
    of_ended_s -= used_s;
    if (used_s >= kMin_s) used.by_thread_s[name] = used_s;
  }
  if (of_ended_s >= kMin_s) used.by_thread_s["ended"] = of_ended_s;
  return used;
}

std::string ToText(const ProcessorTimes& used, double seconds) {
  std::string text = fmt::format("{:.1f} s", used.total_s);
  if (!(seconds > 0.0)) return text;
  text += fmt::format(", {:.2f} of a core", used.total_s / seconds);
  std::vector<std::pair<double, std::string>> fractions;
  double others = used.total_s / seconds;
  for (const auto& [name, thread_s] : used.by_thread_s) {
    const double fraction = thread_s / seconds;
    if (fraction < kWorthNaming) continue;
    fractions.emplace_back(fraction, name);
    others -= fraction;
  }
  std::ranges::sort(fractions, std::greater<>());
  if (others >= kWorthNaming) fractions.emplace_back(others, "others");
  const char* separator = ": ";
  for (const auto& [fraction, name] : fractions) {
    text += fmt::format("{}{} {:.2f}", std::exchange(separator, ", "), name, fraction);
  }
  return text;
}

}  // namespace isotherm

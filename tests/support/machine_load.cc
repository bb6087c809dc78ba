#include "tests/support/machine_load.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <sstream>

#include "common/base/pause.h"
#include "tests/support/process.h"

namespace isotherm::system_test {
namespace {

constexpr std::chrono::seconds kWindow{1};
/// The programs need a third of one of two processors: with half of them they have what they need.
constexpr double kBusyOnAverage = 0.5;
constexpr double kBusyForASecond = 0.8;

/// User and system time of a process and of its children that have ended.
std::uint64_t TicksOf(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return 0;
  std::istringstream fields(text.substr(name_end + 1));
  std::string skipped;
  for (int field = 3; field < 14; ++field) fields >> skipped;
  std::uint64_t sum = 0;
  for (int field = 14; field <= 17; ++field) {
    std::uint64_t ticks = 0;
    fields >> ticks;
    sum += ticks;
  }
  return sum;
}

std::uint64_t TicksWithDescendants(pid_t pid) {
  std::uint64_t sum = TicksOf(pid);
  for (const pid_t child : ChildrenOf(pid)) sum += TicksWithDescendants(child);
  return sum;
}

}  // namespace

MachineLoad::MachineLoad()
    : start_(Read()), thread_([this](const std::stop_token& stop) { Watch(stop); }) {}

MachineLoad::ProcessorTime MachineLoad::Read() {
  ProcessorTime time;
  // The own part last: it is never too small for what it is taken off from.
  std::ifstream file("/proc/stat");
  std::string name;
  file >> name;
  // user, nice, system, idle, iowait, irq, softirq, steal; what follows is contained in these.
  constexpr int kFields = 8;
  constexpr int kIdle = 3;
  constexpr int kWaitingForDisks = 4;
  for (int field = 0; field < kFields; ++field) {
    std::uint64_t ticks = 0;
    file >> ticks;
    time.all += ticks;
    if (field != kIdle && field != kWaitingForDisks) time.busy += ticks;
  }
  time.own = TicksWithDescendants(::getpid());
  return time;
}

double MachineLoad::OthersFraction(const ProcessorTime& from, const ProcessorTime& to) {
  const auto all = static_cast<double>(to.all - from.all);
  if (all <= 0.0) return 0.0;
  const double others =
      static_cast<double>(to.busy - from.busy) - static_cast<double>(to.own - from.own);
  return std::clamp(others / all, 0.0, 1.0);
}

void MachineLoad::Watch(const std::stop_token& stop) {
  ProcessorTime before = start_;
  while (!stop.stop_requested()) {
    Pause(stop, kWindow);
    if (stop.stop_requested()) return;
    const ProcessorTime now = Read();
    const MutexLock lock(mutex_);
    worst_ = std::max(worst_, OthersFraction(before, now));
    before = now;
  }
}

double MachineLoad::others_fraction() const { return OthersFraction(start_, Read()); }

double MachineLoad::worst_others_fraction() const {
  const MutexLock lock(mutex_);
  return worst_;
}

bool MachineLoad::is_busy() const {
  return others_fraction() > kBusyOnAverage || worst_others_fraction() > kBusyForASecond;
}

double MachineLoad::excused_fraction() const {
  constexpr double kMaxExcused = 0.25;
  return is_busy() ? std::min(others_fraction(), kMaxExcused) : 0.0;
}

std::string MachineLoad::ToText() const {
  return fmt::format(
      "others took {:.0f} % of this computer's processors, {:.0f} % in the worst "
      "second",
      100.0 * others_fraction(), 100.0 * worst_others_fraction());
}

}  // namespace isotherm::system_test

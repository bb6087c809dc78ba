#include "tests/benchmark/machine.h"

#include <fmt/format.h>
#include <hwy/highway.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <thread>

namespace isotherm {

std::string DescribeMachine() {
  std::array<double, 3> load{};
  if (::getloadavg(load.data(), 3) != 3) load.fill(-1.0);
  const std::int64_t targets = hwy::SupportedTargets() & HWY_TARGETS;
  return fmt::format("{} cores, load average {:.2f} {:.2f} {:.2f}, SIMD {}",
                     std::thread::hardware_concurrency(), load[0], load[1], load[2],
                     hwy::TargetName(targets & -targets));
}

double ResidentMib() {
  std::ifstream status("/proc/self/statm");
  double size = 0.0, resident = 0.0;
  status >> size >> resident;
  constexpr double kPageMib = 4096.0 / (1 << 20);
  return resident * kPageMib;
}

}  // namespace isotherm

#include "edge/host_status.h"

#include <fstream>
#include <system_error>

namespace isotherm {
namespace {

double CpuTemperature() {
  std::ifstream file("/sys/class/thermal/thermal_zone0/temp");
  double millidegrees = 0.0;
  if (!(file >> millidegrees)) return std::numeric_limits<double>::quiet_NaN();
  return millidegrees / 1000.0;
}

}  // namespace

std::uint64_t FreeDiskBytes(std::filesystem::path path) {
  std::error_code error;
  path = std::filesystem::absolute(path, error);
  while (!std::filesystem::exists(path, error) && path.has_relative_path())
    path = path.parent_path();
  const std::filesystem::space_info space = std::filesystem::space(path, error);
  return error ? 0 : space.available;
}

HostStatus ReadHostStatus(const std::filesystem::path& disk) {
  HostStatus status;
  status.disk_free_bytes = FreeDiskBytes(disk);
  status.cpu_temperature_celsius = CpuTemperature();
  status.clock = ReadKernelClock();
  return status;
}

}  // namespace isotherm

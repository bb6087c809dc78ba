#include "edge/daemon/host_status.h"

#include <fmt/format.h>

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

Result<std::uint64_t> FreeDiskBytes(std::filesystem::path path) {
  std::error_code error;
  path = std::filesystem::absolute(path, error);
  while (!std::filesystem::exists(path, error) && path.has_relative_path())
    path = path.parent_path();
  const std::filesystem::space_info space = std::filesystem::space(path, error);
  if (error) {
    return Err(IoError(fmt::format("the free space of the disk of {} is not known: {}",
                                   path.string(), error.message())));
  }
  return space.available;
}

HostStatus ReadHostStatus(const std::filesystem::path& disk) {
  HostStatus status;
  if (const Result<std::uint64_t> free = FreeDiskBytes(disk)) status.disk_free_bytes = *free;
  status.cpu_temperature_celsius = CpuTemperature();
  status.clock = ReadKernelClock();
  return status;
}

}  // namespace isotherm

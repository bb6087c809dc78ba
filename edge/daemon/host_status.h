#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>

#include "common/base/status.h"
#include "common/time/kernel_clock.h"

namespace isotherm {

/// Holds what the edge computer says about itself; NaN or absent: it does not say.
struct HostStatus {
  std::optional<std::uint64_t> disk_free_bytes;
  double cpu_temperature_celsius = std::numeric_limits<double>::quiet_NaN();
  KernelClock clock;
};

/// Free on the disk of `path`, a file or folder that need not exist; or why that is not known.
Result<std::uint64_t> FreeDiskBytes(std::filesystem::path path);

/// `disk` is a file or folder on the disk in question (its nearest existing parent counts).
HostStatus ReadHostStatus(const std::filesystem::path& disk);

}  // namespace isotherm

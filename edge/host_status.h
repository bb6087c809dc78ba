#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>

namespace isotherm {

/// What the edge computer says about itself; NaN or 0 = it does not say.
struct HostStatus {
  std::uint64_t disk_free_bytes = 0;
  double cpu_temperature_celsius = std::numeric_limits<double>::quiet_NaN();
  double clock_offset_s =
      std::numeric_limits<double>::quiet_NaN();  ///< That the kernel is still correcting.
  double clock_error_s =
      std::numeric_limits<double>::quiet_NaN();  ///< Bound; NaN while unsynchronised.
};

/// `disk` is a file or folder on the disk in question (its nearest existing parent counts).
HostStatus ReadHostStatus(const std::filesystem::path& disk);

}  // namespace isotherm

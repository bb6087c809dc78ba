#include "common/recording/disk_time.h"

#include <fmt/format.h>

#include <cmath>

namespace isotherm {

std::string DiskTimeText(double left_s) {
  constexpr double kSecondsPerMinute = 60.0;
  constexpr double kMinutesPerHour = 60.0;
  if (std::isnan(left_s)) return {};
  const double minutes = left_s / kSecondsPerMinute;
  if (minutes < 2.0 * kMinutesPerHour) return fmt::format("disk: {:.0f} min left", minutes);
  const double hours = minutes / kMinutesPerHour;
  return hours < 100.0 ? fmt::format("disk: {:.0f} h left", hours) : "disk: days left";
}

}  // namespace isotherm

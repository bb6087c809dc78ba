#include "common/recording/disk_time.h"

#include <fmt/format.h>

#include <cmath>

#include "common/base/units.h"

namespace isotherm {

std::string DiskTimeText(double left_s) {
  if (std::isnan(left_s)) return {};
  if (left_s < 2.0 * kSPerHour) return fmt::format("disk: {:.0f} min left", left_s / kSPerMin);
  const double hours = left_s / kSPerHour;
  return hours < 100.0 ? fmt::format("disk: {:.0f} h left", hours) : "disk: days left";
}

}  // namespace isotherm

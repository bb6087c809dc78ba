#include "ground/cli/today.h"

#include <fmt/format.h>

#include <chrono>

#include "common/time/clock.h"

namespace isotherm {

std::string Today() {
  const auto day = std::chrono::floor<std::chrono::days>(SystemClock().Now());
  const std::chrono::year_month_day date{
      std::chrono::sys_days(std::chrono::duration_cast<std::chrono::days>(day.time_since_epoch()))};
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

}  // namespace isotherm

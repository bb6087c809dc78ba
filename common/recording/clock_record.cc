#include "common/recording/clock_record.h"

#include <fmt/format.h>

namespace isotherm {

std::map<std::string, std::string> ToMetadata(const ClockReport& clock) {
  if (!clock.synchronised) return {{"synchronised", "no"}};
  return {{"synchronised", "yes"},
          {"offset_s", fmt::format("{}", clock.offset_s)},
          {"estimated_error_s", fmt::format("{}", clock.estimated_error_s)},
          {"max_error_s", fmt::format("{}", clock.max_error_s)}};
}

}  // namespace isotherm

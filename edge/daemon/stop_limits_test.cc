#include "edge/daemon/stop_limits.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

namespace isotherm {
namespace {

// Systemd kills what is not gone by then, and leaves the recording as it is.
TEST(StopLimitsTest, TheUnitLeavesAMarginAboveTheLongestStop) {
  constexpr double kMargin_s = 2.0;
  std::ifstream unit(ISOTHERM_SOURCE_DIR "/systemd/isotherm-edge.service.in");
  ASSERT_TRUE(unit);
  const std::string key = "TimeoutStopSec=";
  double timeout_s = 0.0;
  for (std::string line; std::getline(unit, line);)
    if (line.starts_with(key)) timeout_s = std::strtod(line.c_str() + key.size(), nullptr);
  EXPECT_GE(timeout_s, ToSeconds(stop_limits::kMaxStop) + kMargin_s);
}

}  // namespace
}  // namespace isotherm

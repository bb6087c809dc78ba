#include "common/transport/transport_environment.h"

#include <dds/ddsrt/log.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <string>

#include "common/time/clock.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

std::size_t Lines(const std::string& text) {
  return static_cast<std::size_t>(std::ranges::count(text, '\n'));
}

/// The middleware says this while it cannot send, ten times a second for as long as that.
std::string LogOfAnOutage(FakeClock& clock, Nanoseconds outage) {
  ::testing::internal::CaptureStderr();
  for (Nanoseconds at{}; at < outage; at += 100ms) {
    dds_log(DDS_LC_ERROR, __FILE__, __LINE__, __func__,
            "ddsi_udp_conn_write to udp/10.77.0.%d:7411 failed with retcode -1\n",
            static_cast<int>(at / 100ms) % 250);
    clock.Advance(100ms);
  }
  return ::testing::internal::GetCapturedStderr();
}

TEST(TransportEnvironmentTest, F64AnOutageOfTheNetworkIsToldOnceThenOnceInTenSecondsWithTheNumber) {
  FakeClock clock;
  const TransportEnvironment environment(clock);
  const std::string log = LogOfAnOutage(clock, 30s);
  EXPECT_EQ(Lines(log), 3U) << log;
  EXPECT_THAT(log, HasSubstr("udp/10.77.0.100:7411 failed with retcode -1 (99 more since the "
                             "last such line)"));
  EXPECT_EQ(environment.suppressed_log_lines(), 297U);
  EXPECT_THAT(environment.last_error(), HasSubstr("failed with retcode -1"));
}

TEST(TransportEnvironmentTest, F64WhatWasLeftOutLastIsToldAtTheEnd) {
  FakeClock clock;
  auto environment = std::make_unique<TransportEnvironment>(clock);
  LogOfAnOutage(clock, 5s);
  ::testing::internal::CaptureStderr();
  environment.reset();
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("49 more lines"));
}

TEST(TransportEnvironmentTest, F64RefusedPacketsAreAllCountedAndToldAgainWhileTheyCome) {
  FakeClock clock;
  const TransportEnvironment environment(clock);
  ::testing::internal::CaptureStderr();
  for (int packet = 0; packet < 1000; ++packet) {
    dds_log(DDS_LC_WARNING, __FILE__, __LINE__, __func__,
            "malformed packet received from vendor 1.%d state parse\n", packet % 7);
    clock.Advance(20ms);
  }
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(Lines(log), 2U) << log;
  EXPECT_THAT(log, HasSubstr("(499 more since the last such line)"));
  EXPECT_EQ(environment.refused().malformed, 1000U);
}

TEST(TransportEnvironmentTest, NothingIsSaidWhileItIsQuiet) {
  FakeClock clock;
  const TransportEnvironment environment(clock);
  const TransportEnvironment::Quiet quiet(environment);
  EXPECT_EQ(LogOfAnOutage(clock, 1s), "");
  EXPECT_THAT(environment.last_error(), HasSubstr("failed with retcode -1"));
}

}  // namespace
}  // namespace isotherm

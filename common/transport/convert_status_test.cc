#include <gtest/gtest.h>
#include <isotherm_control.h>

#include <cmath>
#include <functional>
#include <limits>

#include "common/transport/conversions.h"

namespace isotherm {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::int64_t kTime_ns = 1'700'000'000'123'456'789;

EdgeStatus MakeStatus() {
  EdgeStatus status;
  status.time = CaptureTimeFromNanoseconds(kTime_ns);
  status.depth_camera = {
      .state = CameraState::kWorking, .stamp_sigma_s = 0.00005, .unsynchronised_frames = 3};
  status.clock = {.synchronised = true,
                  .offset_s = -1e-5,
                  .estimated_error_s = 0.0001,
                  .max_error_s = 0.0012,
                  .steps = 2,
                  .step_sum_s = -3600.5};
  status.clock_echo = {.ping = 77,
                       .received = CaptureTimeFromNanoseconds(kTime_ns - 5),
                       .sent = CaptureTimeFromNanoseconds(kTime_ns + 5)};
  return status;
}

TEST(ConvertStatusTest, TheClockArrivesAsItWasWritten) {
  const EdgeStatus sent = MakeStatus();
  isotherm_wire_EdgeStatus wire{};
  ToWire(sent, &wire);
  EdgeStatus status;
  ASSERT_EQ(FromWire(wire, &status), std::nullopt);
  EXPECT_EQ(status.clock, sent.clock);
  ASSERT_TRUE(status.clock_echo.has_value());
  EXPECT_EQ(status.clock_echo->ping, 77U);
  EXPECT_EQ(status.clock_echo->received, sent.clock_echo->received);
  EXPECT_EQ(status.clock_echo->sent, sent.clock_echo->sent);
  EXPECT_EQ(status.depth_camera.stamp_sigma_s, 0.00005);
  EXPECT_EQ(status.depth_camera.unsynchronised_frames, 3U);
  EXPECT_TRUE(std::isnan(status.thermal_camera.stamp_sigma_s));
}

TEST(ConvertStatusTest, AStatusWithoutEchoHasNone) {
  EdgeStatus sent = MakeStatus();
  sent.clock_echo.reset();
  isotherm_wire_EdgeStatus wire{};
  ToWire(sent, &wire);
  EdgeStatus status;
  ASSERT_EQ(FromWire(wire, &status), std::nullopt);
  EXPECT_FALSE(status.clock_echo.has_value());
}

TEST(ConvertStatusTest, F17AnUnsynchronisedClockSaysSo) {
  EdgeStatus sent;
  isotherm_wire_EdgeStatus wire{};
  ToWire(sent, &wire);
  EdgeStatus status = MakeStatus();
  ASSERT_EQ(FromWire(wire, &status), std::nullopt);
  EXPECT_FALSE(status.clock.synchronised);
  EXPECT_TRUE(std::isnan(status.clock.estimated_error_s));
}

TEST(ConvertStatusTest, F60HostileClocksAreRefused) {
  using Wire = isotherm_wire_EdgeStatus;
  struct Case {
    const char* what;
    std::function<void(Wire&)> change;
    RefusalCause cause;
  };
  constexpr std::int64_t kLast = std::numeric_limits<std::int64_t>::max();
  const Case cases[] = {
      {"time", [](Wire& w) { w.time_ns = -1; }, RefusalCause::kNegativeTime},
      {"far time", [](Wire& w) { w.time_ns = kLast; }, RefusalCause::kOutOfRange},
      {"echo", [](Wire& w) { w.echo_received_ns = -1; }, RefusalCause::kNegativeTime},
      {"far echo", [](Wire& w) { w.echo_received_ns = kLast; }, RefusalCause::kOutOfRange},
      {"sent", [](Wire& w) { w.echo_sent_ns = -kLast; }, RefusalCause::kNegativeTime},
      {"far sent", [](Wire& w) { w.echo_sent_ns = kLast; }, RefusalCause::kOutOfRange},
      {"offset", [](Wire& w) { w.clock_offset_s = kInfinity; }, RefusalCause::kNotFinite},
      {"estimate", [](Wire& w) { w.clock_estimated_error_s = kInfinity; },
       RefusalCause::kNotFinite},
      {"negative error", [](Wire& w) { w.clock_error_s = -1.0; }, RefusalCause::kOutOfRange},
      {"negative estimate", [](Wire& w) { w.clock_estimated_error_s = -1.0; },
       RefusalCause::kOutOfRange},
      {"sum", [](Wire& w) { w.clock_step_sum_s = std::nan(""); }, RefusalCause::kNotFinite},
      {"far sum", [](Wire& w) { w.clock_step_sum_s = -1e300; }, RefusalCause::kOutOfRange},
      {"sigma", [](Wire& w) { w.depth_camera.stamp_sigma_s = kInfinity; },
       RefusalCause::kNotFinite},
      {"negative sigma", [](Wire& w) { w.thermal_camera.stamp_sigma_s = -1.0; },
       RefusalCause::kOutOfRange},
  };
  for (const Case& hostile : cases) {
    Wire wire{};
    ToWire(MakeStatus(), &wire);
    hostile.change(wire);
    EdgeStatus status;
    EXPECT_EQ(FromWire(wire, &status), hostile.cause) << hostile.what;
  }
}

TEST(ConvertStatusTest, APingCrossesWithTheReceipt) {
  isotherm_wire_Receipt wire{};
  ToWire(Receipt{.session = 3, .depth = {}, .thermal = {}, .clock_ping = 1234}, &wire);
  Receipt receipt;
  ASSERT_EQ(FromWire(wire, &receipt), std::nullopt);
  EXPECT_EQ(receipt.clock_ping, 1234U);
}

}  // namespace
}  // namespace isotherm

#include "edge/source/simulated_shutter.h"

#include <gtest/gtest.h>

#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

constexpr std::uint16_t kTrue = 30'000;  // What the scan shows without error, centi-kelvin.

class SimulatedShutterTest : public testing::Test {
 protected:
  SimulatedShutterTest() {
    ShutterOptions& shutter = *options_.mutable_shutter();
    shutter.set_interval_s(0);
    shutter.set_duration_s(0.4);
    shutter.mutable_expert()->set_order_delay_s(0.1);
    options_.mutable_drift()->set_error_per_kelvin(4.0);
  }
  void Start() { shutter_ = std::make_unique<SimulatedShutter>(options_); }

  /// The next frame of a scan whose housing has reached `housing_celsius`, with the error that the
  /// rendered scan has.
  RawFrame Frame(float housing_celsius, bool closed = false) {
    RawFrame frame;
    frame.sensor = Sensor::kThermal;
    frame.frame_number = number_++;
    frame.arrival_wall = now_;
    frame.shutter_closed = closed;
    if (closed) scan_reference_celsius_ = housing_celsius;
    frame.housekeeping.housing_celsius = housing_celsius;
    const double error_k = 4.0 * static_cast<double>(housing_celsius - scan_reference_celsius_);
    // The image changes, as any does.
    frame.pixels =
        Image<std::uint16_t>(8, 6, static_cast<std::uint16_t>(kTrue + 100.0 * error_k + 0.5));
    frame.pixels.At(0, 0) = static_cast<std::uint16_t>(29'000 + number_);
    now_ += milliseconds(25);
    shutter_->Apply(frame);
    return frame;
  }
  static double ErrorKelvin(const RawFrame& frame) {
    return 0.01 * (static_cast<double>(frame.pixels.At(4, 3)) - kTrue);
  }

  SimulationOptions options_;
  std::unique_ptr<SimulatedShutter> shutter_;
  CaptureTime now_{std::chrono::hours(1)};
  std::uint64_t number_ = 0;
  float scan_reference_celsius_ = 30.0F;
};

TEST_F(SimulatedShutterTest, ClosesAfterAnOrderForItsTimeAndSaysSo) {
  Start();
  EXPECT_FALSE(Frame(30.0F).shutter_closed);
  ASSERT_TRUE(shutter_->Control(TriggerNuc{}).ok());
  int before = 0, closed = 0;
  RawFrame frame;
  for (int i = 0; i < 40; ++i) {
    frame = Frame(30.0F);
    closed += frame.shutter_closed ? 1 : 0;
    before += closed == 0 ? 1 : 0;
    ASSERT_TRUE(frame.camera_nuc.has_value());
    EXPECT_EQ(frame.camera_nuc->state,
              frame.shutter_closed ? NucState::kInProgress : NucState::kIdle);
  }
  EXPECT_EQ(before, 4) << "0.1 s at 40 Hz";
  EXPECT_EQ(closed, 16) << "0.4 s at 40 Hz";
  EXPECT_GT(frame.camera_nuc->seconds_since.value(), 0.4);
}

TEST_F(SimulatedShutterTest, AClosedCameraShowsTheLastImageOrTheShutter) {
  Start();
  const RawFrame last = Frame(30.0F);
  ASSERT_TRUE(shutter_->Control(TriggerNuc{}).ok());
  RawFrame open;
  RawFrame frame = Frame(30.0F);
  for (int i = 0; i < 100 && !frame.shutter_closed; ++i) open = std::exchange(frame, Frame(30.0F));
  EXPECT_EQ(frame.pixels, open.pixels);
  EXPECT_NE(frame.pixels, last.pixels);

  options_.mutable_shutter()->mutable_expert()->set_appearance(ShutterOptions::SHUTTER);
  options_.mutable_shutter()->mutable_expert()->set_shutter_celsius(60.0);
  Start();
  Frame(30.0F);
  ASSERT_TRUE(shutter_->Control(TriggerNuc{}).ok());
  do frame = Frame(30.0F);
  while (!frame.shutter_closed);
  EXPECT_NEAR(kCentikelvin.Celsius(frame.pixels.At(4, 3)), 60.0, 0.3) << "and noise";
}

TEST_F(SimulatedShutterTest, ACorrectionTakesTheErrorOfTheHousingAway) {
  Start();
  Frame(30.0F);
  EXPECT_NEAR(ErrorKelvin(Frame(35.0F)), 20.0, 0.01) << "fig. 3.4b";
  ASSERT_TRUE(shutter_->Control(TriggerNuc{}).ok());
  for (int i = 0; i < 40; ++i) Frame(35.0F);
  EXPECT_NEAR(ErrorKelvin(Frame(35.0F)), 0.0, 0.01);
  EXPECT_NEAR(ErrorKelvin(Frame(35.5F)), 2.0, 0.01) << "it drifts on from there";
  // A correction of the scan itself counts as well.
  Frame(36.0F, true);
  EXPECT_NEAR(ErrorKelvin(Frame(36.0F)), 0.0, 0.01);
  EXPECT_NEAR(ErrorKelvin(Frame(36.25F)), 1.0, 0.01);
}

TEST_F(SimulatedShutterTest, CanKeepSilent) {
  options_.mutable_shutter()->mutable_expert()->set_reports_shutter(false);
  Start();
  EXPECT_FALSE(Frame(30.0F, true).shutter_closed);
  EXPECT_FALSE(Frame(30.0F).camera_nuc.has_value());
}

TEST_F(SimulatedShutterTest, CanIgnoreOrders) {
  options_.mutable_shutter()->mutable_expert()->set_follows_orders(false);
  Start();
  EXPECT_TRUE(shutter_->Control(TriggerNuc{}).ok());
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(Frame(30.0F).shutter_closed);
}

TEST_F(SimulatedShutterTest, CorrectionsThatAreRenderedCannotBeSwitchedOff) {
  Start();
  EXPECT_TRUE(shutter_->Control(SetAutomaticNuc{false}).ok());
  options_.mutable_shutter()->set_interval_s(30);
  Start();
  EXPECT_FALSE(shutter_->Control(SetAutomaticNuc{false}).ok());
  EXPECT_TRUE(shutter_->Control(SetAutomaticNuc{true}).ok());
}

}  // namespace
}  // namespace isotherm

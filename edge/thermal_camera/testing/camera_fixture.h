#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "common/time/clock.h"
#include "edge/options/edge_options.pb.h"
#include "edge/thermal_camera/thermal_camera_source.h"
#include "edge/usb/testing/emulated_bus.h"

namespace isotherm {

/// Cameras on an emulated bus, used through the genuine libusb.
class EmulatedCameraTest : public testing::Test {
 protected:
  void SetUp() override {
    if (const auto reason = EmulatedBus::Missing()) GTEST_SKIP() << *reason;
    bus_.emplace();
  }

  template <typename Camera>
  std::shared_ptr<Camera> Plug(std::string_view script) {
    auto camera = std::make_shared<Camera>(script);
    bus_->Plug(camera);
    return camera;
  }

  std::unique_ptr<ThermalCameraSource> MakeSource() {
    ThermalCameraSource::Cameras cameras;
    cameras.list = ListThermalCameras;
    cameras.make = [this](const DeviceDescription& device) {
      return MakeThermalCamera(device, options_, clock_);
    };
    return std::make_unique<ThermalCameraSource>(options_, clock_, cameras);
  }
  std::unique_ptr<ThermalCameraSource> Open() {
    auto source = MakeSource();
    const Status opened = source->Open();
    EXPECT_TRUE(opened.ok()) << opened.message();
    return source;
  }

  /// Reads until `count` frames came or Read failed.
  std::vector<RawFrame> ReadFrames(FrameSource& source, std::size_t count) {
    std::vector<RawFrame> frames;
    // Patience for a busy computer.
    const SteadyTime end = clock_.SteadyNow() + std::chrono::seconds(60);
    while (frames.size() < count && clock_.SteadyNow() < end) {
      Result<SourceItem> item = source.Read({});
      if (!item) {
        failure_ = item.error();
        break;
      }
      if (RawFrame* frame = std::get_if<RawFrame>(&*item)) frames.push_back(std::move(*frame));
    }
    return frames;
  }

  SystemClock clock_;
  ThermalCameraOptions options_;
  std::optional<EmulatedBus> bus_;
  Status failure_;
};

/// Checks that each pixel is the emulated camera's ramp plus its noise, in counts of the frame's
/// scale.
inline void ExpectRamp(const RawFrame& frame, double kelvin_per_count, int first, int noise) {
  ASSERT_FALSE(frame.pixels.empty());
  const double raw_per_count = kelvin_per_count / frame.thermal_scale.kelvin_per_count;
  for (int y = 0; y < frame.pixels.height(); ++y) {
    for (int x = 0; x < frame.pixels.width(); ++x) {
      const double lowest = raw_per_count * (first + x);
      const double highest = raw_per_count * (first + x + noise - 1);
      ASSERT_GE(frame.pixels.At(x, y), std::floor(lowest)) << x << " " << y;
      ASSERT_LE(frame.pixels.At(x, y), std::ceil(highest)) << x << " " << y;
    }
  }
}

}  // namespace isotherm

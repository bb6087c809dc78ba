#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/time/clock.h"
#include "edge/edge_options.pb.h"
#include "edge/thermal_camera/testing/emulated_lepton.h"
#include "edge/thermal_camera/thermal_camera_source.h"
#include "edge/usb/testing/emulated_bus.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

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

  /// Reads until `count` frames came or Read failed.
  std::vector<RawFrame> ReadFrames(FrameSource& source, std::size_t count) {
    std::vector<RawFrame> frames;
    const SteadyTime end = clock_.SteadyNow() + seconds(20);
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

TEST_F(EmulatedCameraTest, LeptonIsListedWithSerialAndPort) {
  Plug<EmulatedLepton>("f");
  const auto devices = ListThermalCameras();
  ASSERT_TRUE(devices.has_value()) << devices.error().message();
  ASSERT_EQ(devices->size(), 1U);
  EXPECT_EQ(devices->front().driver, "lepton-uvc");
  EXPECT_EQ(devices->front().serial, "LEPTON-1");
  EXPECT_EQ(devices->front().product, "PureThermal (fw:v1.3.0)");
  EXPECT_EQ(devices->front().bus_port, EmulatedBus::kBusPort);
  EXPECT_EQ(devices->front().problem, "");
}

TEST_F(EmulatedCameraTest, LeptonStreamsOverIsochronousTransfers) {
  const auto camera = Plug<EmulatedLepton>("f");
  const auto source = MakeSource();
  const Status opened = source->Open();
  ASSERT_TRUE(opened.ok()) << opened.message();
  const std::vector<RawFrame> frames = ReadFrames(*source, 5);
  ASSERT_EQ(frames.size(), 5U) << failure_.message();
  EXPECT_EQ(camera->alternate(), 1);
  EXPECT_EQ(frames[0].pixels.width(), 160);
  source->Close();
  EXPECT_EQ(camera->alternate(), 0);
}

}  // namespace
}  // namespace isotherm

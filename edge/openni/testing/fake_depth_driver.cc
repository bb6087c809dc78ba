// A depth camera driver for OpenNI2 that no hardware stands behind: tests give it to the genuine
// library, so that everything but the cable is real. What the camera does is said by a text file;
// fake_depth_camera.h writes it.

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "common/base/mutex.h"
#include "common/base/pause.h"
#include "edge/openni/testing/fake_depth_script.h"
#include "edge/openni/testing/shared_counter.h"

// The driver interface wants the allocation macros of a library that is not shipped with it.
#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)
// The interface's classes have no warnings switched on.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wshadow"
#include <Driver/OniDriverAPI.h>
#include <PS1080.h>
#pragma GCC diagnostic pop

namespace isotherm {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr const char* kUri = "fake-depth://0";
constexpr milliseconds kPollInterval{20};
constexpr int kFlippedBit = 1 << 20;
// A Carmine's: f = 120 mm / (0.1042 mm x 1280 / width).
constexpr std::uint64_t kZeroPlaneDistance_mm = 120;
constexpr double kZeroPlanePixel_mm = 0.1042;

OniVideoMode kModes[] = {
    {ONI_PIXEL_FORMAT_DEPTH_1_MM, 640, 480, 30},   {ONI_PIXEL_FORMAT_DEPTH_100_UM, 640, 480, 30},
    {ONI_PIXEL_FORMAT_DEPTH_1_MM, 320, 240, 30},   {ONI_PIXEL_FORMAT_DEPTH_1_MM, 320, 240, 60},
    {ONI_PIXEL_FORMAT_DEPTH_100_UM, 320, 240, 30},
};

/// Copies `value` out if the caller's buffer has exactly its size.
template <typename T>
OniStatus Give(const T& value, void* data, int* size) {
  if (*size != static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(data, &value, sizeof(T));
  return ONI_STATUS_OK;
}

template <typename T>
OniStatus Take(const void* data, int size, T& value) {
  if (size != static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
  std::memcpy(&value, data, sizeof(T));
  return ONI_STATUS_OK;
}

class FakeStream final : public oni::driver::StreamBase {
 public:
  explicit FakeStream(const FakeDepthScript& script) : script_(script), made_(script.counter) {
    mirroring_ = TRUE;  // As some cameras start.
  }
  ~FakeStream() override { stop(); }

  OniStatus start() override {
    Prepare();
    thread_ = std::jthread([this](const std::stop_token& stop) { Run(stop); });
    return ONI_STATUS_OK;
  }
  void stop() override {
    if (!thread_.joinable()) return;
    thread_.request_stop();
    thread_.join();
  }

  OniBool isPropertySupported(int property) override {
    switch (property) {
      case ONI_STREAM_PROPERTY_CROPPING:
      case ONI_STREAM_PROPERTY_VIDEO_MODE:
      case ONI_STREAM_PROPERTY_STRIDE:
      case ONI_STREAM_PROPERTY_MIRRORING:
      case ONI_STREAM_PROPERTY_MAX_VALUE:
        return TRUE;
      case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
      case ONI_STREAM_PROPERTY_VERTICAL_FOV:
        return script_.has_field_of_view ? TRUE : FALSE;
      case XN_STREAM_PROPERTY_ZERO_PLANE_DISTANCE:
      case XN_STREAM_PROPERTY_ZERO_PLANE_PIXEL_SIZE:
        return script_.has_zero_plane ? TRUE : FALSE;
      case XN_STREAM_PROPERTY_CLOSE_RANGE:
        return script_.has_close_range ? TRUE : FALSE;
      default:
        return FALSE;
    }
  }

  OniStatus getProperty(int property, void* data, int* size) override {
    if (isPropertySupported(property) == FALSE) return ONI_STATUS_NOT_SUPPORTED;
    switch (property) {
      case ONI_STREAM_PROPERTY_CROPPING:
        return Give(OniCropping{FALSE, 0, 0, mode_.resolutionX, mode_.resolutionY}, data, size);
      case ONI_STREAM_PROPERTY_VIDEO_MODE:
        return Give(mode_, data, size);
      case ONI_STREAM_PROPERTY_STRIDE:
        return Give(mode_.resolutionX * 2, data, size);
      case ONI_STREAM_PROPERTY_MIRRORING:
        return Give(mirroring_, data, size);
      case ONI_STREAM_PROPERTY_MAX_VALUE:
        return Give(int{10'000}, data, size);
      case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
        return Give(static_cast<float>(script_.horizontal_fov_rad), data, size);
      case ONI_STREAM_PROPERTY_VERTICAL_FOV:
        return Give(static_cast<float>(script_.vertical_fov_rad), data, size);
      case XN_STREAM_PROPERTY_ZERO_PLANE_DISTANCE:
        return Give(kZeroPlaneDistance_mm, data, size);
      case XN_STREAM_PROPERTY_ZERO_PLANE_PIXEL_SIZE:
        return Give(kZeroPlanePixel_mm, data, size);
      default:
        return Give(close_range_, data, size);
    }
  }

  OniStatus setProperty(int property, const void* data, int size) override {
    switch (property) {
      case ONI_STREAM_PROPERTY_MIRRORING:
        return script_.mirroring_stays_on ? ONI_STATUS_OK : Take(data, size, mirroring_);
      case ONI_STREAM_PROPERTY_VIDEO_MODE:
        return Take(data, size, mode_);
      case XN_STREAM_PROPERTY_CLOSE_RANGE:
        return script_.has_close_range ? Take(data, size, close_range_) : ONI_STATUS_NOT_SUPPORTED;
      default:
        return ONI_STATUS_NOT_SUPPORTED;
    }
  }

  /// The cable is off: no more frames.
  void Unplug() { unplugged_ = true; }

 private:
  /// The frames to send, so that sending one is a copy, as it is behind a real cable.
  void Prepare() {
    const bool tenth_mm = mode_.pixelFormat == ONI_PIXEL_FORMAT_DEPTH_100_UM;
    frames_ = PrepareFakeDepth(script_, mode_.resolutionX, mode_.resolutionY, tenth_mm);
    if (mirroring_ == FALSE) return;
    const auto width = static_cast<std::size_t>(mode_.resolutionX);
    for (std::size_t row = 0; row + width <= frames_.size(); row += width) {
      const auto begin = frames_.begin() + static_cast<std::ptrdiff_t>(row);
      std::reverse(begin, begin + static_cast<std::ptrdiff_t>(width));
    }
  }

  void Run(const std::stop_token& stop) {
    const auto period = std::chrono::duration_cast<std::chrono::nanoseconds>(
        std::chrono::duration<double>(1.0 / mode_.fps));
    const auto start = std::chrono::steady_clock::now();
    FakeDepthClock clock(script_, mode_.fps);
    for (int tick = 1; !stop.stop_requested(); ++tick) {
      Pause(stop, start + tick * period - std::chrono::steady_clock::now());
      if (stop.stop_requested() || unplugged_ || clock.stalled()) continue;
      if (const auto frame = clock.Next()) Send(*frame);
    }
  }

  void Send(const FakeDepthFrame& what) {
    if (what.fault == FakeDepthFault::kCrash) raise(SIGSEGV);
    if (what.fault == FakeDepthFault::kHang) raise(SIGSTOP);
    made_.Count();
    OniFrame* frame = getServices().acquireFrame();
    if (frame == nullptr) return;
    const std::size_t pixels =
        static_cast<std::size_t>(mode_.resolutionX) * static_cast<std::size_t>(mode_.resolutionY);
    const std::size_t count = frames_.size() / pixels;
    const auto offset = static_cast<std::size_t>(what.index) % count * pixels;
    std::memcpy(frame->data, frames_.data() + offset, pixels * 2);
    frame->sensorType = ONI_SENSOR_DEPTH;
    frame->timestamp = what.timestamp_us;
    frame->frameIndex = what.fault == FakeDepthFault::kFlip ? what.index ^ kFlippedBit : what.index;
    frame->videoMode = mode_;
    frame->width = mode_.resolutionX;
    frame->height = mode_.resolutionY;
    frame->croppingEnabled = FALSE;
    frame->cropOriginX = frame->cropOriginY = 0;
    frame->stride = mode_.resolutionX * 2;
    frame->dataSize = static_cast<int>(pixels * 2);
    if (what.fault == FakeDepthFault::kShort) frame->dataSize /= 2;
    if (what.fault == FakeDepthFault::kWrongSize) frame->height /= 2;
    raiseNewFrame(frame);
    getServices().releaseFrame(frame);
  }

  const FakeDepthScript script_;
  SharedCounter made_;
  OniVideoMode mode_ = kModes[2];  // As PrimeSense's start: quarter size.
  OniBool mirroring_ = FALSE;
  std::uint64_t close_range_ = 0;
  std::vector<std::uint16_t> frames_;
  std::atomic<bool> unplugged_{false};
  std::jthread thread_;
};

class FakeDevice final : public oni::driver::DeviceBase {
 public:
  explicit FakeDevice(FakeDepthScript script) : script_(std::move(script)) {}

  OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
    *sensors = &sensor_;
    *count = 1;
    return ONI_STATUS_OK;
  }
  oni::driver::StreamBase* createStream(OniSensorType type) override {
    if (type != ONI_SENSOR_DEPTH) return nullptr;
    stream_ = new FakeStream(script_);
    return stream_;
  }
  void destroyStream(oni::driver::StreamBase* stream) override {
    stream_ = nullptr;
    delete stream;
  }
  OniBool isPropertySupported(int property) override {
    return property == ONI_DEVICE_PROPERTY_SERIAL_NUMBER ||
                   property == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION
               ? TRUE
               : FALSE;
  }
  OniStatus getProperty(int property, void* data, int* size) override {
    if (property == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return Give(registration_, data, size);
    if (property != ONI_DEVICE_PROPERTY_SERIAL_NUMBER) return ONI_STATUS_NOT_SUPPORTED;
    const int needed = static_cast<int>(script_.serial.size()) + 1;
    if (*size < needed) return ONI_STATUS_BAD_PARAMETER;
    std::memcpy(data, script_.serial.c_str(), static_cast<std::size_t>(needed));
    *size = needed;
    return ONI_STATUS_OK;
  }
  OniStatus setProperty(int property, const void* data, int size) override {
    if (property != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return ONI_STATUS_NOT_SUPPORTED;
    return Take(data, size, registration_);
  }
  OniBool isImageRegistrationModeSupported(OniImageRegistrationMode mode) override {
    return mode == ONI_IMAGE_REGISTRATION_OFF || script_.has_registration ? TRUE : FALSE;
  }
  void Unplug() {
    if (stream_ != nullptr) stream_->Unplug();
  }

 private:
  const FakeDepthScript script_;
  OniImageRegistrationMode registration_ = ONI_IMAGE_REGISTRATION_OFF;
  OniSensorInfo sensor_ = {ONI_SENSOR_DEPTH, static_cast<int>(std::size(kModes)), kModes};
  FakeStream* stream_ = nullptr;
};

class FakeDriver final : public oni::driver::DriverBase {
 public:
  explicit FakeDriver(OniDriverServices* services) : DriverBase(services) {
    std::strncpy(info_.uri, kUri, sizeof(info_.uri) - 1);
    std::strncpy(info_.vendor, "Isotherm", sizeof(info_.vendor) - 1);
    std::strncpy(info_.name, "Fake Depth Camera", sizeof(info_.name) - 1);
  }

  OniStatus initialize(oni::driver::DeviceConnectedCallback connected,
                       oni::driver::DeviceDisconnectedCallback disconnected,
                       oni::driver::DeviceStateChangedCallback changed, void* cookie) override {
    DriverBase::initialize(connected, disconnected, changed, cookie);
    Look();
    watcher_ = std::jthread([this](const std::stop_token& stop) {
      while (!stop.stop_requested()) {
        Pause(stop, kPollInterval);
        Look();
      }
    });
    return ONI_STATUS_OK;
  }
  void shutdown() override {
    watcher_.request_stop();
    if (watcher_.joinable()) watcher_.join();
  }

  oni::driver::DeviceBase* deviceOpen(const char* uri, const char* /*mode*/) override {
    const std::optional<FakeDepthScript> script = ReadFakeDepthScript();
    if (!script || !script->connected || std::strcmp(uri, kUri) != 0) return nullptr;
    if (script->open_hangs) MarkHang();
    while (script->open_hangs) pause();
    MutexLock lock(mutex_);
    device_ = new FakeDevice(*script);
    return device_;
  }
  void deviceClose(oni::driver::DeviceBase* device) override {
    MutexLock lock(mutex_);
    device_ = nullptr;
    delete device;
  }

 private:
  /// Plugs and unplugs as the script says.
  void Look() {
    const std::optional<FakeDepthScript> script = ReadFakeDepthScript();
    const bool there = script && script->connected;
    if (there == there_) return;
    there_ = there;
    if (there) {
      deviceConnected(&info_);
      return;
    }
    {
      MutexLock lock(mutex_);
      if (device_ != nullptr) device_->Unplug();
    }
    deviceDisconnected(&info_);
  }

  OniDeviceInfo info_{};
  bool there_ = false;
  Mutex mutex_;
  FakeDevice* device_ GUARDED_BY(mutex_) = nullptr;
  std::jthread watcher_;
};

}  // namespace
}  // namespace isotherm

ONI_EXPORT_DRIVER(isotherm::FakeDriver)

#include "edge/openni/openni_device.h"

#include <OpenNI.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "edge/openni/openni_settings.h"
#include "edge/options/edge_options.pb.h"

namespace isotherm {
namespace {

/// The library cannot be woken, so that a stop waits for at most this long: three frames at 30 Hz.
constexpr Nanoseconds kMaxFrameWait = std::chrono::milliseconds(100);

bool IsFile(const std::string& uri) { return std::filesystem::path(uri).extension() == ".oni"; }

/// Hears of cameras that were unplugged, from a thread of the library.
class UnplugListener final : public openni::OpenNI::DeviceDisconnectedListener {
 public:
  explicit UnplugListener(std::string uri) : uri_(std::move(uri)) {
    openni::OpenNI::addDeviceDisconnectedListener(this);
  }
  ~UnplugListener() override { openni::OpenNI::removeDeviceDisconnectedListener(this); }

  void onDeviceDisconnected(const openni::DeviceInfo* info) override {
    if (uri_ == info->getUri()) unplugged_ = true;
  }
  bool unplugged() const { return unplugged_; }

 private:
  const std::string uri_;
  std::atomic<bool> unplugged_{false};
};

/// Holds what the library gave us.
struct Handles {
  const OpenniLibrary library;
  openni::Device device;
  openni::VideoStream stream;
};

class OpenedDevice final : public OpenniDevice {
 public:
  OpenedDevice() = default;
  OpenedDevice(const OpenedDevice&) = delete;
  OpenedDevice& operator=(const OpenedDevice&) = delete;
  ~OpenedDevice() override {
    stream_.stop();
    unplug_.reset();
    if (is_file_) {
      // The player's thread walks the list of streams without a lock, until its device is closed,
      // and a stream must be taken from the list before: now and then it reads what was freed. A
      // stopped one that stays in the list does no harm. A camera's process ends soon.
      static_cast<void>(handles_.release());
      return;
    }
    stream_.destroy();
    device_.close();
  }

  Status Start(const DepthCameraOptions& options, double file_rate) {
    if (!handles_->library.status().ok()) return handles_->library.status();
    ISOTHERM_RETURN_IF_ERROR(IsFile(options.uri()) ? OpenFile(options.uri()) : OpenCamera(options));
    if (stream_.create(device_, openni::SENSOR_DEPTH) != openni::STATUS_OK) {
      return Unavailable(
          fmt::format("{} has no depth: {}", device_.getDeviceInfo().getUri(), OpenniError()));
    }
    Result<ActiveSettings> active =
        is_file_ ? ReadSettings(device_, stream_) : Configure(options, device_, stream_);
    if (!active) return active.error();
    active_ = std::move(*active);
    if (is_file_) ISOTHERM_RETURN_IF_ERROR(PrepareFile(options.uri(), file_rate));
    Describe();
    intrinsics_ = NominalIntrinsics(stream_, active_.width, active_.height);
    if (stream_.start() != openni::STATUS_OK) {
      return Unavailable(fmt::format("depth does not start: {}", OpenniError()));
    }
    return OkStatus();
  }

  Result<std::optional<Frame>> Wait(Nanoseconds timeout) override {
    // The library goes on delivering nothing; only its listener tells.
    if (unplug_ && unplug_->unplugged()) return Err(Unavailable("it was unplugged"));
    if (ended()) return std::nullopt;
    openni::VideoStream* streams[] = {&stream_};
    int ready = -1;
    const auto wait =
        std::chrono::ceil<std::chrono::milliseconds>(std::min(timeout, kMaxFrameWait));
    const openni::Status waited =
        openni::OpenNI::waitForAnyStream(streams, 1, &ready, static_cast<int>(wait.count()));
    if (waited == openni::STATUS_TIME_OUT) return std::nullopt;
    openni::VideoFrameRef frame;
    if (waited != openni::STATUS_OK || stream_.readFrame(&frame) != openni::STATUS_OK) {
      return Err(Unavailable(fmt::format("no more frames: {}", OpenniError())));
    }
    if (!frame.isValid()) return std::nullopt;
    return Copy(frame);
  }

  bool ended() const override { return is_file_ && last_index_ >= frames_in_file_; }
  bool is_file() const override { return is_file_; }
  const CameraDescription& description() const override { return description_; }
  double depth_scale() const override { return active_.depth_scale; }
  const std::optional<CameraModel>& nominal_intrinsics() const override { return intrinsics_; }

 private:
  Status OpenFile(const std::string& path) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path, error);
    if (status.type() == std::filesystem::file_type::not_found)
      return NotFound(path + ": no such file");
    if (error) return InvalidArgument(fmt::format("{}: {}", path, error.message()));
    // A pipe would be waited for until somebody writes to it.
    if (!std::filesystem::is_regular_file(status))
      return InvalidArgument(path + ": is a folder, a pipe or a device, expected an .oni file");
    if (device_.open(path.c_str()) != openni::STATUS_OK || !device_.isFile()) {
      return DataLoss(fmt::format("{}: not a recording of OpenNI2: {}", path, OpenniError()));
    }
    is_file_ = true;
    return OkStatus();
  }

  /// The first camera that is the one that is asked for.
  Status OpenCamera(const DepthCameraOptions& options) {
    std::vector<std::string> uris = {options.uri()};
    if (options.uri().empty()) uris = ConnectedUris();
    std::string problem;
    for (const std::string& uri : uris) {
      if (device_.open(uri.c_str()) != openni::STATUS_OK) {
        problem = fmt::format("{} cannot be opened: {}", uri, OpenniError());
        continue;
      }
      serial_ = SerialOf(device_);
      if (options.serial().empty() || options.serial() == serial_) {
        unplug_.emplace(uri);
        return OkStatus();
      }
      problem = fmt::format("{} has serial number \"{}\", not \"{}\" (source.depth_camera.serial)",
                            uri, serial_, options.serial());
      device_.close();
    }
    return Unavailable(problem.empty() ? "no depth camera is connected that OpenNI2 has a driver "
                                         "for; `isotherm devices` lists what is there"
                                       : problem);
  }

  static std::vector<std::string> ConnectedUris() {
    openni::Array<openni::DeviceInfo> found;
    openni::OpenNI::enumerateDevices(&found);
    std::vector<std::string> uris;
    for (int i = 0; i < found.getSize(); ++i) uris.emplace_back(found[i].getUri());
    return uris;
  }

  Status PrepareFile(const std::string& path, double rate) {
    openni::PlaybackControl* playback = device_.getPlaybackControl();
    frames_in_file_ = playback->getNumberOfFrames(stream_);
    if (frames_in_file_ <= 0) return DataLoss(path + ": there is no depth frame in it");
    playback->setRepeatEnabled(false);
    playback->setSpeed(rate > 0.0 ? static_cast<float>(rate) : -1.0F);
    return OkStatus();
  }

  void Describe() {
    const openni::DeviceInfo& info = device_.getDeviceInfo();
    description_.sensor = Sensor::kDepth;
    description_.driver = is_file_ ? "oni-file" : "openni2";
    description_.model = is_file_ ? std::string(info.getUri())
                                  : fmt::format("{} {}", info.getVendor(), info.getName());
    description_.serial = serial_;
    description_.width = active_.width;
    description_.height = active_.height;
    description_.rate_hz = active_.rate_hz;
    description_.settings = active_.text;
  }

  std::optional<Frame> Copy(const openni::VideoFrameRef& from) {
    Frame frame;
    frame.timestamp_us = from.getTimestamp();
    frame.index = last_index_ = from.getFrameIndex();
    frame.depth_scale = active_.depth_scale;
    const std::int64_t width = from.getWidth();
    const std::int64_t height = from.getHeight();
    // Rows may be padded, and the sizes come from a driver: they are checked before anything is
    // read.
    const std::int64_t stride = from.getStrideInBytes();
    constexpr std::int64_t kPixelBytes = 2;
    constexpr std::int64_t kMaxSide_px = 16384;
    if (width <= 0 || height <= 0 || width > kMaxSide_px || height > kMaxSide_px ||
        stride < width * kPixelBytes ||
        from.getDataSize() < (height - 1) * stride + width * kPixelBytes) {
      return frame;
    }
    frame.pixels = Image<std::uint16_t>(static_cast<int>(width), static_cast<int>(height));
    const auto* bytes = static_cast<const char*>(from.getData());
    for (std::int64_t row = 0; row < height; ++row) {
      std::uint16_t* line = frame.pixels.data() + row * width;
      std::memcpy(line, bytes + row * stride, static_cast<std::size_t>(width * kPixelBytes));
      // Mirrored images have the geometry of no camera.
      if (active_.mirrored) std::reverse(line, line + width);
    }
    return frame;
  }

  std::unique_ptr<Handles> handles_ = std::make_unique<Handles>();
  openni::Device& device_ = handles_->device;
  openni::VideoStream& stream_ = handles_->stream;
  std::optional<UnplugListener> unplug_;  ///< Cameras only.
  bool is_file_ = false;
  int frames_in_file_ = 0;
  int last_index_ = 0;
  std::string serial_;
  ActiveSettings active_;
  CameraDescription description_;
  std::optional<CameraModel> intrinsics_;
};

}  // namespace

Result<std::unique_ptr<OpenniDevice>> OpenniDevice::Open(const DepthCameraOptions& options,
                                                         double file_rate) {
  auto device = std::make_unique<OpenedDevice>();
  if (Status started = device->Start(options, file_rate); !started.ok()) {
    return Err(std::move(started));
  }
  return device;
}

}  // namespace isotherm

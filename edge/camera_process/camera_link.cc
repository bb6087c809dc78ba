#include "edge/camera_process/camera_link.h"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>

#include "common/rig/rig_calibration.h"
#include "common/rig/rig_calibration.pb.h"
#include "edge/camera_process/camera_link.pb.h"
#include "edge/camera_process/pixel_slots.h"

namespace isotherm {
namespace {

// Longer than any message; a rig with all its texts has a few hundred bytes.
constexpr std::size_t kMaxMessageBytes = 16'384;

constexpr const char* kNotOfASoundProcess = "its process sent what no sound one sends: ";

/// The process runs a vendor's library: whatever it sends may be garbage.
bool IsOneOf(int value, int last) { return value >= 0 && value <= last; }

bool IsSensor(int value) { return IsOneOf(value, static_cast<int>(Sensor::kThermal)); }
bool IsNucState(int value) { return IsOneOf(value, static_cast<int>(NucState::kError)); }
bool IsNucSource(int value) { return IsOneOf(value, static_cast<int>(NucSource::kInferred)); }

}  // namespace

CameraLink::~CameraLink() { ::close(descriptor_); }

CameraLink::Received CameraLink::Receive(FromCamera* message, Nanoseconds timeout) {
  return ReceiveAny(message, timeout);
}
CameraLink::Received CameraLink::Receive(ToCamera* message, Nanoseconds timeout) {
  return ReceiveAny(message, timeout);
}
bool CameraLink::Send(const FromCamera& message) { return SendAny(message); }
bool CameraLink::Send(const ToCamera& message) { return SendAny(message); }

template <typename Message>
CameraLink::Received CameraLink::ReceiveAny(Message* message, Nanoseconds timeout) {
  pollfd wait{descriptor_, POLLIN, 0};
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(timeout).count();
  if (::poll(&wait, 1, static_cast<int>(ms)) <= 0) return Received::kNothingYet;
  std::array<char, kMaxMessageBytes> bytes;
  ssize_t size = ::recv(descriptor_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  // The other side left without reading all that it was sent. The kernel says so once, before the
  // messages that it left behind.
  if (size < 0 && errno == ECONNRESET)
    size = ::recv(descriptor_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return Received::kNothingYet;
  // An empty message cannot be told from the end; SendAny sends none.
  if (size <= 0 || !message->ParseFromArray(bytes.data(), static_cast<int>(size))) {
    return Received::kClosed;
  }
  return Received::kMessage;
}

template <typename Message>
bool CameraLink::SendAny(const Message& message) {
  const std::string bytes = message.SerializeAsString();
  // Never waits, and no signal: the other process may have hung or died.
  const auto sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  return sent == static_cast<ssize_t>(bytes.size());
}

void ToLink(const Status& status, LinkStatus* to) {
  to->set_code(static_cast<int>(status.code()));
  to->set_message(status.message());
}

Status FromLink(const LinkStatus& from) {
  if (!IsOneOf(from.code(), static_cast<int>(StatusCode::kInternal))) {
    return DataLoss(
        fmt::format("{}status {}, \"{}\"", kNotOfASoundProcess, from.code(), from.message()));
  }
  return Status(static_cast<StatusCode>(from.code()), from.message());
}

Status FailureFromLink(const LinkStatus& from) {
  Status status = FromLink(from);
  if (!status.ok()) return status;
  return DataLoss(fmt::format("{}a failure without a reason", kNotOfASoundProcess));
}

namespace {

Result<RadiometricScale> ScaleOf(double kelvin_per_count, double offset_kelvin) {
  const RadiometricScale scale{kelvin_per_count, offset_kelvin};
  if (Status status = Validate(scale); !status.ok())
    return Err(DataLoss(kNotOfASoundProcess + status.message()));
  return scale;
}

}  // namespace

void ToLink(const RawFrame& frame, LinkFrame* to) {
  to->set_width(frame.pixels.width());
  to->set_height(frame.pixels.height());
  to->set_sensor(static_cast<int>(frame.sensor));
  to->set_frame_number(frame.frame_number);
  to->set_device_ticks_us(frame.device_ticks.time_since_epoch().count());
  to->set_has_device_clock(frame.has_device_clock);
  to->set_arrival_wall_ns(ToNanoseconds(frame.arrival_wall));
  to->set_arrival_steady_ns(Nanoseconds(frame.arrival_steady.time_since_epoch()).count());
  to->set_depth_scale(frame.depth_scale);
  to->set_kelvin_per_count(frame.thermal_scale.kelvin_per_count);
  to->set_offset_kelvin(frame.thermal_scale.offset_kelvin);
  to->set_shutter_closed(frame.shutter_closed);
  if (frame.camera_nuc) {
    to->set_has_camera_nuc(true);
    to->set_nuc_state(static_cast<int>(frame.camera_nuc->state));
    to->set_nuc_source(static_cast<int>(frame.camera_nuc->source));
    if (frame.camera_nuc->seconds_since)
      to->set_nuc_seconds_since(*frame.camera_nuc->seconds_since);
  }
  to->set_fpa_celsius(frame.housekeeping.fpa_celsius);
  to->set_housing_celsius(frame.housekeeping.housing_celsius);
  to->set_shutter_celsius(frame.housekeeping.shutter_celsius);
}

Result<RawFrame> FromLink(const LinkFrame& from, const PixelSlots& slots) {
  const std::int64_t width = from.width();
  const std::int64_t height = from.height();
  // Everything that sizes or indexes is checked here: the process runs foreign code, and may be
  // taken over.
  if (from.slot() < 0 || from.slot() >= PixelSlots::kSlots || width < 0 || height < 0 ||
      width * height > static_cast<std::int64_t>(PixelSlots::kPixelsPerSlot)) {
    return Err(DataLoss(fmt::format("{}a frame of {}x{} in slot {}", kNotOfASoundProcess, width,
                                    height, from.slot())));
  }
  if (!IsSensor(from.sensor()) || !IsNucState(from.nuc_state()) ||
      !IsNucSource(from.nuc_source())) {
    return Err(DataLoss(fmt::format("{}a frame of sensor {} with NUC state {} from source {}",
                                    kNotOfASoundProcess, from.sensor(), from.nuc_state(),
                                    from.nuc_source())));
  }
  RawFrame frame;
  frame.sensor = static_cast<Sensor>(from.sensor());
  frame.frame_number = from.frame_number();
  frame.device_ticks = DeviceTicks(std::chrono::microseconds(from.device_ticks_us()));
  frame.has_device_clock = from.has_device_clock();
  frame.arrival_wall = CaptureTimeFromNanoseconds(from.arrival_wall_ns());
  frame.arrival_steady = SteadyTime(Nanoseconds(from.arrival_steady_ns()));
  frame.depth_scale = from.depth_scale();
  if (frame.sensor == Sensor::kThermal) {
    const auto scale = ScaleOf(from.kelvin_per_count(), from.offset_kelvin());
    if (!scale) return Err(scale.error());
    frame.thermal_scale = *scale;
  }
  frame.shutter_closed = from.shutter_closed();
  if (from.has_camera_nuc()) {
    frame.camera_nuc = CameraNuc{static_cast<NucState>(from.nuc_state()),
                                 static_cast<NucSource>(from.nuc_source()), std::nullopt};
    if (from.has_nuc_seconds_since()) frame.camera_nuc->seconds_since = from.nuc_seconds_since();
  }
  frame.housekeeping = {from.fpa_celsius(), from.housing_celsius(), from.shutter_celsius()};
  frame.pixels = Image<std::uint16_t>(from.width(), from.height());
  // Copied out: the slot is given back, and the other process may write to it at any time.
  const std::span<const std::uint16_t> slot = slots.slot(from.slot());
  std::copy_n(slot.begin(), frame.pixels.size(), frame.pixels.data());
  return frame;
}

void ToLink(const std::optional<Rig>& rig, const std::vector<CameraDescription>& cameras,
            LinkOpened* to) {
  if (rig) to->set_rig(ToProto(*rig).SerializeAsString());
  for (const CameraDescription& camera : cameras) {
    LinkCamera& link = *to->add_cameras();
    link.set_sensor(static_cast<int>(camera.sensor));
    link.set_driver(camera.driver);
    link.set_model(camera.model);
    link.set_serial(camera.serial);
    link.set_width(camera.width);
    link.set_height(camera.height);
    link.set_rate_hz(camera.rate_hz);
    link.set_settings(camera.settings);
    link.set_counts_only(camera.counts_only);
    link.set_kelvin_per_count(camera.thermal_scale.kelvin_per_count);
    link.set_offset_kelvin(camera.thermal_scale.offset_kelvin);
  }
}

std::optional<Rig> RigOf(const LinkOpened& from) {
  if (!from.has_rig()) return std::nullopt;
  RigCalibration rig;
  if (!rig.ParseFromString(from.rig())) return std::nullopt;
  return FromProto(rig);
}

Result<std::vector<CameraDescription>> CamerasOf(const LinkOpened& from) {
  std::vector<CameraDescription> cameras;
  for (const LinkCamera& link : from.cameras()) {
    if (!IsSensor(link.sensor())) {
      return Err(
          DataLoss(fmt::format("{}a camera of sensor {}", kNotOfASoundProcess, link.sensor())));
    }
    const auto scale = ScaleOf(link.kelvin_per_count(), link.offset_kelvin());
    if (!scale) return Err(scale.error());
    cameras.push_back({static_cast<Sensor>(link.sensor()), link.driver(), link.model(),
                       link.serial(), link.width(), link.height(), link.rate_hz(), link.settings(),
                       link.counts_only(), *scale});
  }
  return cameras;
}

}  // namespace isotherm

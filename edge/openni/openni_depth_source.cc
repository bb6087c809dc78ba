#include "edge/openni/openni_depth_source.h"

#include <fmt/format.h>

#include <utility>

#include "common/base/log.h"

namespace isotherm {

OpenniDepthSource::OpenniDepthSource(const DepthCameraOptions& options, double file_rate,
                                     const Clock& clock)
    : options_(options), file_rate_(file_rate), clock_(clock) {}

OpenniDepthSource::~OpenniDepthSource() = default;

Status OpenniDepthSource::Open() {
  device_.reset();  // The library must let go of the camera before it is opened again.
  Result<std::unique_ptr<OpenniDevice>> device = OpenniDevice::Open(options_, file_rate_);
  if (!device) return device.error();
  device_ = std::move(*device);
  // The camera's counter starts anew when it is opened.
  unwrapper_ = {};
  missed_.emplace(1);
  last_frame_at_ = clock_.SteadyNow();
  const CameraDescription& found = device_->description();
  LOG(Openni, Info) << found.model << ", serial=" << (found.serial.empty() ? "?" : found.serial)
                    << " mode=" << found.width << "x" << found.height << "@" << found.rate_hz
                    << ", " << found.settings;
  return OkStatus();
}

Result<SourceItem> OpenniDepthSource::Read(std::stop_token stop) {
  if (stop.stop_requested()) return NothingYet{};
  Result<std::optional<OpenniDevice::Frame>> frame = device_->Wait(kReadWait);
  if (!frame) return Err(frame.error());
  if (*frame) return ToRawFrame(std::move(**frame));
  if (device_->ended()) return EndOfStream{};
  if (const Status stall = CheckStall(); !stall.ok()) return Err(stall);
  return NothingYet{};
}

RawFrame OpenniDepthSource::ToRawFrame(OpenniDevice::Frame frame) {
  RawFrame raw;
  raw.sensor = Sensor::kDepth;
  raw.arrival_wall = clock_.Now();
  raw.arrival_steady = clock_.SteadyNow();
  const std::uint64_t resets = unwrapper_.resets();
  raw.device_ticks = unwrapper_.Unwrap(frame.timestamp_us);
  if (unwrapper_.resets() != resets) {
    LOG(Openni, Warning) << "the camera's clock was set back, resets=" << unwrapper_.resets();
  }
  raw.frame_number = Number(frame.index);
  raw.pixels = std::move(frame.pixels);
  raw.depth_scale = frame.depth_scale;
  last_frame_at_ = raw.arrival_steady;
  if (device_->is_file() && file_rate_ != 1.0) PlaceInTime(raw);
  return raw;
}

std::uint64_t OpenniDepthSource::Number(int index) {
  // Frames that the library dropped leave holes in its index; they become holes in our numbers, so
  // that they are counted.
  next_number_ += missed_->Process(static_cast<std::uint64_t>(std::int64_t{index}));
  return next_number_++;
}

void OpenniDepthSource::PlaceInTime(RawFrame& raw) {
  if (!file_start_) {
    file_start_ = raw.arrival_wall;
    file_first_ticks_ = raw.device_ticks;
  }
  // Played faster or slower than it was recorded, the moment of arrival says nothing; the camera's
  // own clock does.
  raw.arrival_wall = *file_start_ + (raw.device_ticks - file_first_ticks_);
  // Says that these times are not of this computer's clock.
  raw.arrival_steady = {};
}

Status OpenniDepthSource::CheckStall() const {
  const Nanoseconds silent = clock_.SteadyNow() - last_frame_at_;
  if (silent < FromSeconds(options_.expert().stall_timeout_s())) return OkStatus();
  return Unavailable(fmt::format("no frame for {:.1f} s", ToSeconds(silent)));
}

std::optional<Rig> OpenniDepthSource::rig() const {
  if (!device_ || !device_->nominal_intrinsics()) return std::nullopt;
  Rig rig;
  rig.depth = device_->nominal_intrinsics();
  rig.depth_scale = device_->depth_scale();
  rig.serial = device_->description().serial;
  rig.method = "nominal: the depth camera's field of view, no calibration";
  return rig;
}

std::vector<CameraDescription> OpenniDepthSource::cameras() const {
  if (!device_) return {};
  return {device_->description()};
}

}  // namespace isotherm

#include "edge/thermal_camera/thermal_camera_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/log.h"

namespace isotherm {
namespace {

ThermalGain GainOf(ThermalGainOption gain) {
  switch (gain) {
    case HIGH_GAIN:
      return ThermalGain::kHigh;
    case LOW_GAIN:
      return ThermalGain::kLow;
    case KEEP_GAIN:
      break;
  }
  return ThermalGain::kKeep;
}

bool IsCorrecting(const RawThermalFrame& raw) {
  return raw.nuc && raw.nuc->state == NucState::kInProgress;
}

}  // namespace

std::unique_ptr<FrameSource> MakeThermalCameraSource(const ThermalCameraOptions& options,
                                                     const Clock& clock) {
  ThermalCameraSource::Cameras cameras;
  cameras.list = ListThermalCameras;
  cameras.make = [options, &clock](const DeviceDescription& device) {
    return MakeThermalCamera(device, options, clock);
  };
  return std::make_unique<ThermalCameraSource>(options, clock, std::move(cameras));
}

ThermalCameraSource::ThermalCameraSource(const ThermalCameraOptions& options, const Clock& clock,
                                         Cameras cameras)
    : options_(options), clock_(clock), cameras_(std::move(cameras)) {}

ThermalCameraSource::~ThermalCameraSource() = default;

Status ThermalCameraSource::Open() {
  Close();
  const Result<std::vector<DeviceDescription>> devices = cameras_.list();
  if (!devices) return devices.error();
  const Result<DeviceDescription> device = ChooseThermalCamera(*devices, options_, serial_);
  if (!device) return device.error();
  if (!device->problem.empty()) {
    return FailedPrecondition(fmt::format("thermal camera {} at {}: {}", device->driver,
                                          device->bus_port, device->problem));
  }
  camera_ = cameras_.make(*device);
  Status opened = camera_->Open();
  if (opened.ok()) opened = camera_->SetGain(GainOf(options_.gain()));
  if (opened.ok() && !scale_) {
    const Result<RadiometricScale> scale = ChooseScale();
    if (scale) scale_ = *scale;
    if (!scale) opened = scale.error();
  }
  if (!opened.ok()) {
    Close();
    return opened.WithContext(
        fmt::format("thermal camera {} at {}", device->driver, device->bus_port));
  }
  const ThermalCameraInfo& info = camera_->info();
  // As listed: that is what the next opening compares it with.
  serial_ = device->serial;
  name_ = fmt::format("thermal camera {}", info.driver);
  novelty_.emplace(info.counter_step, info.native_repeats);
  last_frame_at_ = clock_.SteadyNow() + info.start_time;
  frozen_ = false;
  incomplete_ = false;
  incomplete_since_ = 0;
  told_temperatures_ = false;
  LOG(Thermal, Info) << name_ << " opened, product=\"" << info.product << "\" serial=\""
                     << info.serial << "\" port=" << info.bus_port << " width=" << info.width
                     << " height=" << info.height << " settings=\"" << info.settings << "\"";
  return OkStatus();
}

void ThermalCameraSource::Close() {
  if (!camera_) return;
  camera_->Close();
  camera_.reset();
  LOG(Thermal, Info) << name_ << " closed, delivered=" << counts_.delivered
                     << " frozen=" << counts_.frozen << " repeated=" << counts_.repeated
                     << " incomplete=" << counts_.incomplete << " lost=" << counts_.lost;
}

Result<SourceItem> ThermalCameraSource::Read(std::stop_token stop) {
  if (!camera_) return Err(FailedPrecondition(name_ + " is not open"));
  if (stop.stop_requested()) return NothingYet{};
  Result<std::optional<RawThermalFrame>> raw = camera_->Read(kReadWait);
  if (!raw) return Err(raw.error());
  if (*raw) {
    last_frame_at_ = clock_.SteadyNow();
    return Check(std::move(**raw));
  }
  const Nanoseconds silence = clock_.SteadyNow() - last_frame_at_;
  if (ToSeconds(silence) < options_.expert().stall_timeout_s()) return NothingYet{};
  return Err(Hangs("sends nothing", silence));
}

Result<SourceItem> ThermalCameraSource::Check(RawThermalFrame raw) {
  // Cameras without a counter: what the driver dropped is all that is known. With one, the
  // counter's holes say it below, and would count the same frames again.
  if (camera_->info().counter_step == 0) {
    counts_.lost += raw.dropped_before;
    next_frame_number_ += raw.dropped_before;
  }
  if (raw.incomplete) return WithoutPixels(std::move(raw), "incomplete frame");
  if (!EncodingOf(raw).radiometric && !camera_->info().counts_only) {
    // A wrong bit of what the camera says beside an image; ten in a row open it again
    // (SupervisedSource).
    if (told_temperatures_) {
      return WithoutPixels(std::move(raw), "frame that says that it has no temperatures");
    }
    return Err(
        FailedPrecondition(name_ +
                           " sends counts that it does not relate to temperatures; say how in "
                           "source.thermal_camera.expert.kelvin_per_count and offset_kelvin"));
  }
  incomplete_ = false;
  told_temperatures_ = true;
  const Novelty novelty = novelty_->Process(raw);
  // Incomplete frames have their numbers already.
  const std::uint64_t lost = novelty.lost - std::min(novelty.lost, incomplete_since_);
  incomplete_since_ = 0;
  counts_.lost += lost;
  next_frame_number_ += lost;
  // What the camera declares as a correction is delivered as that, whatever it shows meanwhile.
  if (novelty.kind == Novelty::Kind::kRepeat && !IsCorrecting(raw)) {
    ++counts_.repeated;
    return NothingYet{};
  }
  const bool frozen = novelty.kind == Novelty::Kind::kFrozen && !IsCorrecting(raw);
  // Long enough to be no correction: the source is opened again, which cures cameras that hang so.
  if (frozen && ToSeconds(novelty.frozen_for) >= options_.expert().stall_timeout_s()) {
    return Err(Hangs("sends the same image", novelty.frozen_for));
  }
  if (frozen) {
    ++counts_.frozen;
    if (!frozen_) {
      LOG(Thermal, Warning) << name_ << ": the image is frozen, number=" << next_frame_number_;
    }
    // A camera that would say so is not correcting itself: something is wrong.
    const bool would_say = raw.nuc && raw.nuc->source == NucSource::kInBand;
    const NucState state = would_say ? NucState::kError : NucState::kInProgress;
    raw.nuc = CameraNuc{state, NucSource::kInferred, std::nullopt};
    // Whatever froze it, these are not the scene's temperatures now.
    raw.shutter_closed = true;
  }
  frozen_ = frozen;
  ++counts_.delivered;
  return Convert(raw);
}

RawFrame ThermalCameraSource::WithoutPixels(RawThermalFrame raw, std::string_view what) {
  ++counts_.incomplete;
  ++incomplete_since_;
  if (!std::exchange(incomplete_, true)) {
    LOG(Thermal, Warning) << name_ << ": " << what << ", number=" << next_frame_number_;
  }
  raw.counts = {};
  return Convert(raw);
}

RawFrame ThermalCameraSource::Convert(const RawThermalFrame& raw) {
  RawFrame frame;
  frame.sensor = Sensor::kThermal;
  frame.thermal_scale = *scale_;
  frame.frame_number = next_frame_number_++;
  frame.has_device_clock = raw.device_ticks.has_value();
  frame.device_ticks = raw.device_ticks.value_or(DeviceTicks{});
  frame.arrival_wall = raw.first_packet.wall;
  frame.arrival_steady = raw.first_packet.steady;
  frame.shutter_closed = raw.shutter_closed;
  frame.camera_nuc = raw.nuc;
  frame.housekeeping = raw.housekeeping;
  if (raw.counts.empty()) return frame;
  if (!EncodingOf(raw).radiometric) {
    frame.pixels = raw.counts;
    return frame;
  }
  UpdateTable(EncodingOf(raw));
  frame.pixels.Resize(raw.counts.width(), raw.counts.height());
  const std::uint16_t* counts = raw.counts.data();
  for (std::uint16_t& pixel : frame.pixels.pixels()) pixel = raw_of_count_[*counts++];
  return frame;
}

PixelEncoding ThermalCameraSource::EncodingOf(const RawThermalFrame& raw) const {
  if (raw.encoding.radiometric || options_.expert().kelvin_per_count() == 0.0) return raw.encoding;
  return {true, options_.expert().kelvin_per_count(), options_.expert().offset_kelvin()};
}

void ThermalCameraSource::UpdateTable(const PixelEncoding& encoding) {
  if (encoding == encoding_ && !raw_of_count_.empty()) return;
  encoding_ = encoding;
  // A table of all counts: a frame is 110 000 pixels, and most cameras change their encoding never.
  raw_of_count_.resize(65'536);
  for (std::size_t count = 0; count < raw_of_count_.size(); ++count) {
    const double kelvin =
        encoding.kelvin_per_count * static_cast<double>(count) + encoding.offset_kelvin;
    raw_of_count_[count] = scale_->CountOf(kelvin - kCelsiusZero_k);
  }
}

Result<RadiometricScale> ThermalCameraSource::ChooseScale() const {
  const ThermalCameraInfo& info = camera_->info();
  RadiometricScale scale = kCentikelvin;
  if (info.range) {
    const auto of_range = ScaleForRange(info.range->min_celsius, info.range->max_celsius);
    if (!of_range) return of_range;
    scale = *of_range;
  }
  // What the options make of counts is kept as it is where that would cut it off.
  const ThermalCameraExpertOptions& expert = options_.expert();
  const RadiometricScale own{expert.kelvin_per_count(), expert.offset_kelvin()};
  if (own.kelvin_per_count <= 0.0 || own.max_celsius() <= scale.max_celsius()) return scale;
  if (Status status = Validate(own); !status.ok()) {
    return Err(status.WithContext(
        "source.thermal_camera.expert.kelvin_per_count and offset_kelvin as the frames' scale"));
  }
  return own;
}

Status ThermalCameraSource::Hangs(const std::string& what, Nanoseconds duration) const {
  return Unavailable(fmt::format("{} at {} {} for {:.1f} s", name_, camera_->info().bus_port, what,
                                 ToSeconds(duration)));
}

std::vector<CameraDescription> ThermalCameraSource::cameras() const {
  if (!camera_) return {};
  const ThermalCameraInfo& info = camera_->info();
  CameraDescription description;
  description.sensor = Sensor::kThermal;
  description.driver = info.driver;
  description.model = info.product;
  description.serial = info.serial;
  description.width = info.width;
  description.height = info.height;
  description.rate_hz = info.rate_hz;
  description.settings = "port " + info.bus_port;
  if (!info.settings.empty()) description.settings += ", " + info.settings;
  description.counts_only = info.counts_only && options_.expert().kelvin_per_count() == 0.0;
  description.thermal_scale = *scale_;
  return {description};
}

std::optional<Status> ThermalCameraSource::Control(const CameraControl& control) {
  if (!camera_) return Unavailable(name_ + " is not open");
  if (std::holds_alternative<TriggerNuc>(control)) return camera_->TriggerNuc();
  if (const auto* automatic = std::get_if<SetAutomaticNuc>(&control)) {
    return camera_->SetAutomaticNuc(automatic->on);
  }
  return FailedPrecondition(name_ + " is restarted by closing and opening it");
}

}  // namespace isotherm

#include "edge/thermal_camera/seek_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "common/base/log.h"
#include "edge/usb/usb_device.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kInterface = 0;
constexpr std::uint8_t kEndpoint = 0x81;
// Vendor requests to the interface, value and index 0.
constexpr std::uint8_t kOut = 0x41;
constexpr std::uint8_t kIn = 0xC1;

// The vendor's program sends the order to sleep this many times at the end.
constexpr int kSleeps = 3;
// The first frame after a start sometimes lacks its beginning (libseek-thermal, SeekCam.cpp).
constexpr int kMaxStarts = 3;
// The start reads the factory settings, some hundred requests, and then the first frame. Not tuned.
constexpr Nanoseconds kStartTime = seconds(5);
// Nine frames per second; a correction takes longer than a frame.
constexpr double kRate_hz = 9.0;
constexpr Nanoseconds kFrameTimeout = seconds(1);
// Rests of a frame follow each other closely.
constexpr Nanoseconds kSilence = milliseconds(20);
// More than a frame has; a camera that sends without end must not be waited for.
constexpr int kMaxDrained = 64;

}  // namespace

SeekCamera::SeekCamera(std::string bus_port, const SeekModel& model, const Clock& clock)
    : clock_(clock), model_(model), assembler_(model_) {
  info_.driver = kDriver;
  info_.bus_port = std::move(bus_port);
  info_.product = model.name;
  info_.width = model.width;
  info_.height = model.height;
  info_.rate_hz = kRate_hz;
  info_.settings = "counts only";
  info_.counts_only = true;
  info_.counter_step = 1;
  info_.start_time = kStartTime;
}

SeekCamera::~SeekCamera() { Close(); }

Status SeekCamera::Open() {
  Close();
  Result<std::unique_ptr<UsbDevice>> device = UsbDevice::Open(info_.bus_port, clock_);
  if (!device) return device.error();
  device_ = std::move(*device);
  if (!device_->info().product.empty()) info_.product = device_->info().product;
  info_.serial = device_->info().serial;
  Status begun = device_->Claim(kInterface);
  starts_ = 0;
  if (begun.ok()) begun = Begin();
  if (!begun.ok()) Close();
  return begun;
}

Status SeekCamera::Begin() {
  ++starts_;
  images_ = {};
  counter_.Reset();
  next_counter_.reset();
  started_ = false;
  out_of_step_ = false;
  asked_at_.reset();
  left_out_ = 0;
  ISOTHERM_RETURN_IF_ERROR(Wake());
  for (const SeekRequest& request : SeekStartRequests(model_)) {
    const auto answer = Do(request);
    if (!answer) {
      return answer.error().WithContext(fmt::format("starting it, opcode {}", request.opcode));
    }
    if (request.opcode != kSeekReadChipId || !info_.serial.empty()) continue;
    for (const std::uint8_t byte : *answer) info_.serial += fmt::format("{:02x}", byte);
  }
  return OkStatus();
}

Status SeekCamera::Wake() {
  if (Do(SeekWakeRequest())) return OkStatus();
  Sleep();
  const auto woken = Do(SeekWakeRequest());
  return woken ? OkStatus() : woken.error().WithContext("waking it up, opcode 84");
}

void SeekCamera::Sleep() {
  for (int i = 0; i < kSleeps; ++i) static_cast<void>(Do(SeekSleepRequest()));
}

Result<std::vector<std::uint8_t>> SeekCamera::Do(const SeekRequest& request) {
  if (request.answer_bytes > 0) {
    return device_->ControlIn({kIn, request.opcode, 0, 0}, request.answer_bytes);
  }
  if (Status sent = device_->ControlOut({kOut, request.opcode, 0, 0}, request.data); !sent.ok()) {
    return Err(std::move(sent));
  }
  return std::vector<std::uint8_t>();
}

Status SeekCamera::AskForFrame() {
  if (std::exchange(out_of_step_, false)) ISOTHERM_RETURN_IF_ERROR(Drain());
  const auto asked = Do(SeekFrameRequest(model_));
  if (!asked) return asked.error().WithContext("asking for a frame");
  assembler_.Begin();
  asked_at_ = clock_.SteadyNow();
  return OkStatus();
}

Status SeekCamera::Drain() {
  for (int i = 0; i < kMaxDrained; ++i) {
    const auto rest = device_->BulkIn(kEndpoint, model_.read_bytes, kSilence);
    if (!rest) return rest.error();
    if (rest->empty()) break;
  }
  return OkStatus();
}

Result<std::optional<RawThermalFrame>> SeekCamera::Read(Nanoseconds timeout) {
  if (!device_) return Err(Unavailable("the Seek at " + info_.bus_port + " is not open"));
  const SteadyTime deadline = clock_.SteadyNow() + timeout;
  do {
    if (!asked_at_) {
      if (Status asked = AskForFrame(); !asked.ok()) return Err(std::move(asked));
    }
    const auto bytes =
        device_->BulkIn(kEndpoint, assembler_.wanted_bytes(), deadline - clock_.SteadyNow());
    if (!bytes) return Err(bytes.error());
    assembler_.Add(*bytes, {clock_.Now(), clock_.SteadyNow()});
    if (assembler_.wanted_bytes() == 0) {
      Result<std::optional<RawThermalFrame>> frame = Finish();
      if (!frame || *frame) return frame;
    } else if (clock_.SteadyNow() - *asked_at_ > kFrameTimeout) {
      return GiveUp();
    }
  } while (clock_.SteadyNow() < deadline);
  return std::optional<RawThermalFrame>();
}

Result<std::optional<RawThermalFrame>> SeekCamera::Finish() {
  asked_at_.reset();
  Result<SeekRawFrame> frame = ParseSeekFrame(assembler_.bytes(), model_);
  if (!frame) return Err(frame.error());
  // Bytes out of step look like a frame of a kind that is not known, with any number.
  out_of_step_ = frame->kind == SeekFrameKind::kOther && frame->counter != next_counter_;
  if (out_of_step_) return std::optional<RawThermalFrame>();
  next_counter_ = static_cast<std::uint16_t>(frame->counter + 1);
  const std::uint64_t counter = counter_.Process(frame->counter);
  Result<std::optional<SeekImage>> image = images_.Process(std::move(*frame));
  if (!image) {
    if (started_ || starts_ >= kMaxStarts) return Err(image.error());
    LOG(Thermal, Info) << "thermal camera " << kDriver << ": " << image.error().message()
                       << "; starting it again";
    Status begun = Begin();
    if (!begun.ok()) return Err(std::move(begun));
    return std::optional<RawThermalFrame>();
  }
  started_ = true;
  if (!*image) {
    ++left_out_;
    return std::optional<RawThermalFrame>();
  }
  RawThermalFrame raw;
  raw.first_packet = assembler_.first_stamp();
  raw.counts = std::move((*image)->counts);
  raw.device_counter = counter - left_out_;
  raw.shutter_closed = (*image)->shutter_closed;
  raw.nuc = CameraNuc{raw.shutter_closed ? NucState::kInProgress : NucState::kIdle,
                      NucSource::kInBand, std::nullopt};
  return std::optional(std::move(raw));
}

Result<std::optional<RawThermalFrame>> SeekCamera::GiveUp() {
  asked_at_.reset();
  out_of_step_ = true;
  // Nothing at all came: silence, which is no frame.
  if (assembler_.is_empty()) return std::optional<RawThermalFrame>();
  if (!started_) {
    if (starts_ >= kMaxStarts) {
      return Err(DataLoss(fmt::format("the first frame is incomplete, bytes={} of {}",
                                      assembler_.bytes().size(), model_.frame_bytes())));
    }
    Status drained = Drain();
    if (drained.ok()) drained = Begin();
    if (!drained.ok()) return Err(std::move(drained));
    return std::optional<RawThermalFrame>();
  }
  RawThermalFrame raw;
  raw.first_packet = assembler_.first_stamp();
  raw.incomplete = true;
  return std::optional(std::move(raw));
}

void SeekCamera::Close() {
  if (!device_) return;
  // One that is gone refuses at once.
  Sleep();
  device_->Release(kInterface);
  device_.reset();
}

Status SeekCamera::TriggerNuc() {
  return Refuse("closes its shutter when it sees fit: no order for it is known");
}

}  // namespace isotherm

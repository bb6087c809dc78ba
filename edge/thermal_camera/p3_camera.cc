#include "edge/thermal_camera/p3_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "edge/thermal_camera/infiray_protocol.h"
#include "edge/thermal_camera/open_uvc_camera.h"
#include "edge/usb/usb_device.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kStreamInterface = 1;
constexpr std::uint8_t kEndpoint = 0x81;
// Smaller than a frame, so that the first bytes are stamped soon; transfers of the camera end with
// frames and markers.
constexpr int kTransferBytes = 16'384;
// 128 kB under way that the kernel can take while this process does not run. Not tuned.
constexpr int kTransfers = 8;

// Vendor requests.
constexpr std::uint8_t kOut = 0x41;
constexpr std::uint8_t kIn = 0xC1;
constexpr std::uint8_t kCommand = 0x20;
constexpr std::uint8_t kAnswer = 0x21;
constexpr std::uint8_t kStatus = 0x22;
constexpr UsbControl kStartStreaming = {0x40, 0xEE, 0, kStreamInterface};
// A status longer than a byte is text of the camera's log.
constexpr std::size_t kStatusBytes = 64;

// Commands: type, parameter.
constexpr std::uint16_t kReadRegister = 0x0101;
constexpr std::uint16_t kStream = 0x2F01;
constexpr std::uint16_t kShutter = 0x3601;
constexpr std::uint16_t kReads = 0x81;
constexpr std::uint16_t kWrites = 0x41;
constexpr std::uint16_t kRuns = 0x43;
constexpr std::uint16_t kSerialRegister = 0x07;
constexpr std::uint16_t kSerialBytes = 64;

// The vendor's program waits this long between the steps of the start.
constexpr Nanoseconds kBeforeStream = seconds(1);
constexpr Nanoseconds kAfterStream = seconds(2);
// Until the first frame: the waits above and two seconds more. Not tuned.
constexpr Nanoseconds kStartTime = seconds(5);

}  // namespace

P3Camera::P3Camera(std::string bus_port, const P3Layout& layout, const Clock& clock)
    : clock_(clock), layout_(layout) {
  info_.driver = kDriver;
  info_.bus_port = std::move(bus_port);
  info_.width = layout.width;
  info_.height = layout.height;
  info_.rate_hz = 25.0;
  // Where the P1 keeps its metadata was never published: there, images are told apart by pixels.
  info_.counter_step = layout.width == 256 ? 1 : 0;
  info_.start_time = kStartTime;
}

P3Camera::~P3Camera() { Close(); }

Status P3Camera::Open() {
  Close();
  Result<std::unique_ptr<UsbDevice>> device = UsbDevice::Open(info_.bus_port, clock_);
  if (!device) return device.error();
  device_ = std::move(*device);
  info_.product = device_->info().product;
  ISOTHERM_RETURN_IF_ERROR(device_->Claim(0));
  ISOTHERM_RETURN_IF_ERROR(device_->Claim(kStreamInterface));
  info_.serial = device_->info().serial;
  const auto serial = Command(kReadRegister, kReads, kSerialRegister, kSerialBytes);
  if (!serial) return serial.error().WithContext("reading its serial number");
  if (info_.serial.empty()) info_.serial = P3Text(*serial);
  const auto started = Command(kStream, kReads, 0, 1);
  if (!started) return started.error().WithContext("starting its stream");
  stamp_.Reset();
  counter_.Reset();
  step_ = 0;
  next_step_at_ = clock_.SteadyNow() + kBeforeStream;
  return OkStatus();
}

Status P3Camera::StartStep() {
  switch (step_++) {
    case 0:
      next_step_at_ += kAfterStream;
      return BeginStream();
    case 1: {
      const auto started = Command(kStream, kReads, 0, 1);
      return started ? OkStatus() : started.error().WithContext("starting its stream again");
    }
    default:
      return OkStatus();
  }
}

Status P3Camera::BeginStream() {
  ISOTHERM_RETURN_IF_ERROR(device_->SetAlternate(kStreamInterface, 1));
  ISOTHERM_RETURN_IF_ERROR(device_->ControlOut(kStartStreaming, {}));
  assembler_.emplace(layout_);
  UsbStreamPlan plan;
  plan.endpoint = {kEndpoint, UsbTransferKind::kBulk, 512};
  plan.transfers = kTransfers;
  plan.transfer_bytes = kTransferBytes;
  return device_->StartStream(plan, [this](const UsbPacket& packet) {
    if (packet.lost) assembler_->NoteLost();
    assembler_->AddTransfer(packet.data, packet.stamp);
  });
}

Result<std::optional<RawThermalFrame>> P3Camera::Read(Nanoseconds timeout) {
  if (!device_) return Err(Unavailable("the P3 at " + info_.bus_port + " is not open"));
  const SteadyTime deadline = clock_.SteadyNow() + timeout;
  while (true) {
    const SteadyTime now = clock_.SteadyNow();
    if (step_ < 2 && now >= next_step_at_) {
      if (Status done = StartStep(); !done.ok()) return Err(std::move(done));
    }
    const std::optional<UvcFrame> frame = assembler_ ? assembler_->Pop() : std::nullopt;
    if (frame) {
      Result<P3Frame> parsed = ParseP3Frame(frame->bytes, layout_);
      if (!parsed) return Err(parsed.error());
      return std::optional(Convert(*frame, std::move(*parsed)));
    }
    if (now >= deadline) return std::optional<RawThermalFrame>();
    Status pumped = device_->Pump(deadline - now);
    // What came before the failure comes first.
    const bool has_frame = assembler_ && assembler_->has_frame();
    if (!pumped.ok() && !has_frame) return Err(std::move(pumped));
  }
}

RawThermalFrame P3Camera::Convert(const UvcFrame& frame, P3Frame parsed) {
  RawThermalFrame raw = BeginFrame(frame);
  raw.encoding = kInfirayEncoding;
  if (raw.incomplete) return raw;
  raw.counts = std::move(parsed.counts);
  if (frame.presentation_time) {
    const std::uint64_t ticks = stamp_.Process(*frame.presentation_time);
    raw.device_ticks = DeviceTicks(
        std::chrono::microseconds(static_cast<std::int64_t>(ticks / kP3TicksPerMicrosecond)));
  }
  if (info_.counter_step == 0) return raw;
  raw.device_counter = counter_.Process(parsed.metadata.frame_counter);
  raw.shutter_closed = parsed.metadata.correcting;
  raw.nuc = CameraNuc{raw.shutter_closed ? NucState::kInProgress : NucState::kIdle,
                      NucSource::kInBand, std::nullopt};
  return raw;
}

void P3Camera::Close() {
  if (!device_) return;
  device_->StopStream();
  // Stops the camera: the interface goes back to its alternate setting 0.
  device_->Release(kStreamInterface);
  device_.reset();
  assembler_.reset();
}

Status P3Camera::TriggerNuc() {
  const auto done = Command(kShutter, kRuns, 0, 0);
  return done ? OkStatus() : done.error().WithContext("starting a correction");
}

Status P3Camera::SetGain(ThermalGain gain) {
  if (gain == ThermalGain::kKeep) {
    info_.settings = "gain as found";
    return OkStatus();
  }
  const auto done = Command(kStream, kWrites, gain == ThermalGain::kHigh ? 1 : 0, 0);
  if (!done) return done.error().WithContext("setting the gain");
  // No way to ask for it was ever published: the camera's acknowledgement is all there is.
  info_.settings = fmt::format("gain {} (acknowledged, not read back)", NameOf(gain));
  info_.range = InfirayRange(gain);
  return OkStatus();
}

Result<std::vector<std::uint8_t>> P3Camera::Command(std::uint16_t type, std::uint16_t parameter,
                                                    std::uint16_t reg, std::uint16_t answer_bytes) {
  if (!device_) return Err(Unavailable("the P3 at " + info_.bus_port + " is not open"));
  Status sent = device_->ControlOut({kOut, kCommand, 0, 0},
                                    PackP3Command(type, parameter, reg, answer_bytes));
  if (sent.ok()) sent = Acknowledge();
  if (!sent.ok()) return Err(std::move(sent));
  if (answer_bytes == 0) return std::vector<std::uint8_t>();
  auto answer = device_->ControlIn({kIn, kAnswer, 0, 0}, answer_bytes);
  if (!answer) return answer;
  if (Status read = Acknowledge(); !read.ok()) return Err(std::move(read));
  return answer;
}

Status P3Camera::Acknowledge() {
  const auto status = device_->ControlIn({kIn, kStatus, 0, 0}, kStatusBytes);
  return status ? OkStatus() : status.error();
}

}  // namespace isotherm

#include "edge/usb/uvc_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "edge/usb/uvc_probe.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

// Class requests (UVC 1.5, tables ).
constexpr std::uint8_t kSetInterface = 0x21;
constexpr std::uint8_t kGetInterface = 0xA1;
constexpr std::uint8_t kSetCurrent = 0x01;
constexpr std::uint8_t kGetCurrent = 0x81;
constexpr std::uint16_t kProbe = 0x0100;
constexpr std::uint16_t kCommit = 0x0200;

// Transfers under way at a time: 64 ms of data that the kernel can take while this process does not
// run. More: memory of the kernel, which bounds it; fewer: frames are torn under load. Not tuned.
constexpr int kTransfers = 8;
// A transfer spans this much time on the bus: what a frame may wait for its completion, against
// wake-ups.
constexpr Nanoseconds kTransferTime = milliseconds(8);
// A bulk transfer is so small that the first bytes of a frame are stamped soon.
constexpr std::size_t kBulkTransferBytes = 16'384;
// The longest header is 255 bytes.
constexpr std::size_t kMaxHeaderBytes = 256;
// Small cameras answer requests one after the other, and refuse what comes too soon.
constexpr int kTries = 4;
constexpr Nanoseconds kRetryWait = milliseconds(10);

std::uint16_t Index(int interface, std::uint8_t unit = 0) {
  return static_cast<std::uint16_t>(unit << 8 | interface);
}

const UvcFrameSize* FindFrame(const UvcFormat& format, const UvcMode& mode) {
  for (const UvcFrameSize& frame : format.frames) {
    if (frame.width == mode.width && frame.height == mode.height) return &frame;
  }
  return nullptr;
}

bool IsRefusal(const Status& status) { return status.code() == StatusCode::kIoError; }

}  // namespace

Result<std::unique_ptr<UvcCamera>> UvcCamera::Make(std::unique_ptr<UsbDevice> device) {
  Result<UvcFunction> function = ParseUvc(device->configuration());
  if (!function) return Err(function.error().WithContext("USB device " + device->info().bus_port));
  return std::unique_ptr<UvcCamera>(new UvcCamera(std::move(device), std::move(*function)));
}

UvcCamera::UvcCamera(std::unique_ptr<UsbDevice> device, UvcFunction function)
    : device_(std::move(device)), function_(std::move(function)) {}

UvcCamera::~UvcCamera() { Stop(); }

const UvcFormat* UvcCamera::FindFormat(const UvcMode& mode) const {
  for (const UvcFormat& format : function_.formats) {
    if (format.four_characters() == mode.four_characters && FindFrame(format, mode) != nullptr) {
      return &format;
    }
  }
  return nullptr;
}

bool UvcCamera::Has(const UvcMode& mode) const { return FindFormat(mode) != nullptr; }

double UvcCamera::frame_rate_hz() const { return interval_ == 0 ? 0.0 : 1e7 / interval_; }

Status UvcCamera::ClaimControl() {
  if (!claimed_) ISOTHERM_RETURN_IF_ERROR(device_->Claim(function_.control_interface));
  claimed_ = true;
  return OkStatus();
}

Status UvcCamera::Start(const UvcMode& mode) {
  const UvcFormat* format = FindFormat(mode);
  if (format == nullptr) {
    return NotFound(fmt::format("the camera at {} offers no {}x{} images of format \"{}\"",
                                device_->info().bus_port, mode.width, mode.height,
                                mode.four_characters));
  }
  Stop();
  ISOTHERM_RETURN_IF_ERROR(ClaimControl());
  ISOTHERM_RETURN_IF_ERROR(device_->Claim(function_.streaming_interface));
  // From here on Stop has something to undo, also if the rest fails.
  started_ = true;
  ISOTHERM_RETURN_IF_ERROR(Negotiate(*format, *FindFrame(*format, mode)));
  const Result<UvcAlternate> alternate = ChooseAlternate();
  if (!alternate) return alternate.error();
  if (alternate->number != 0) {
    ISOTHERM_RETURN_IF_ERROR(
        device_->SetAlternate(function_.streaming_interface, alternate->number));
  }
  assembler_.emplace(frame_bytes_);
  const UsbStreamPlan plan = PlanFor(*alternate);
  joiner_.reset();
  if (plan.endpoint.kind == UsbTransferKind::kBulk) {
    joiner_.emplace(static_cast<std::size_t>(plan.transfer_bytes), MaxPayloadBytes());
    bulk_endpoint_ = plan.endpoint.address;
  }
  return device_->StartStream(plan, [this](const UsbPacket& packet) { Take(packet); });
}

void UvcCamera::Take(const UsbPacket& packet) {
  // Before its data: the frame under way is incomplete, whatever comes next.
  if (packet.lost) assembler_->NoteLostPacket();
  if (!joiner_) return assembler_->AddPayload(packet.data, packet.stamp);
  if (packet.lost) return joiner_->NoteLost();
  if (joiner_->Add(packet.data, packet.stamp)) {
    assembler_->AddPayload(joiner_->payload(), joiner_->first_stamp());
  }
}

std::size_t UvcCamera::MaxPayloadBytes() const {
  // A payload belongs to one frame, whatever the camera asks for.
  const std::size_t most = frame_bytes_ + kMaxHeaderBytes;
  return payload_bytes_ == 0 ? most : std::min<std::size_t>(payload_bytes_, most);
}

Status UvcCamera::Negotiate(const UvcFormat& format, const UvcFrameSize& frame) {
  frame_bytes_ = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height) *
                 static_cast<std::size_t>(format.bits_per_pixel) / 8;
  const std::size_t size = UvcProbeBytes(function_.version);
  UvcProbe wanted;
  wanted.format = format.index;
  wanted.frame = frame.index;
  wanted.interval = frame.default_interval;
  const std::uint16_t index = Index(function_.streaming_interface);
  const Status sent =
      device_->ControlOut({kSetInterface, kSetCurrent, kProbe, index}, PackUvcProbe(wanted, size));
  if (!sent.ok()) return sent.WithContext("agreeing on a mode");
  // The camera may change what was asked for; only what it answers may be committed.
  const auto answer = device_->ControlIn({kGetInterface, kGetCurrent, kProbe, index}, size);
  if (!answer) return answer.error().WithContext("agreeing on a mode");
  const Result<UvcProbe> agreed = UnpackUvcProbe(*answer);
  if (!agreed) return agreed.error();
  if (agreed->format != wanted.format || agreed->frame != wanted.frame) {
    return FailedPrecondition(fmt::format(
        "the camera at {} wants to send format {} frame size {} instead of {} and {}",
        device_->info().bus_port, agreed->format, agreed->frame, wanted.format, wanted.frame));
  }
  // max_frame_bytes is not believed: frames have the size that the descriptor says.
  interval_ = agreed->interval != 0 ? agreed->interval : wanted.interval;
  payload_bytes_ = agreed->max_payload_bytes;
  return device_
      ->ControlOut({kSetInterface, kSetCurrent, kCommit, index},
                   PackUvcProbe(*agreed, answer->size()))
      .WithContext("agreeing on a mode");
}

Result<UvcAlternate> UvcCamera::ChooseAlternate() const {
  const UvcAlternate* best = nullptr;
  const UvcAlternate* largest = nullptr;
  for (const UvcAlternate& alternate : function_.alternates) {
    const int bytes = alternate.endpoint.packet_bytes;
    if (alternate.endpoint.kind == UsbTransferKind::kBulk) return alternate;
    if (largest == nullptr || bytes > largest->endpoint.packet_bytes) largest = &alternate;
    // The smallest that suffices: bandwidth that is reserved is lost to the depth camera on the
    // same bus.
    if (bytes < static_cast<int>(payload_bytes_)) continue;
    if (best == nullptr || bytes < best->endpoint.packet_bytes) best = &alternate;
  }
  // A camera that asks for more than it offers gets the most that there is.
  if (best == nullptr) best = largest;
  if (best == nullptr) {
    return Err(NotFound(
        fmt::format("the camera at {} has no endpoint to stream from", device_->info().bus_port)));
  }
  return *best;
}

UsbStreamPlan UvcCamera::PlanFor(const UvcAlternate& alternate) const {
  UsbStreamPlan plan;
  plan.endpoint = alternate.endpoint;
  plan.transfers = kTransfers;
  plan.packet_interval = device_->bus_interval();
  plan.packets_per_transfer = static_cast<int>(kTransferTime / plan.packet_interval);
  // Whole packets, since the camera may fill its last one.
  const auto packet = static_cast<std::size_t>(alternate.endpoint.packet_bytes);
  const std::size_t packets =
      (std::min(MaxPayloadBytes(), kBulkTransferBytes) + packet - 1) / packet;
  plan.transfer_bytes = static_cast<int>(packets * packet);
  return plan;
}

Result<std::optional<UvcFrame>> UvcCamera::Read(Nanoseconds timeout) {
  if (!assembler_) return Err(FailedPrecondition("the camera was not started"));
  const Clock& clock = device_->clock();
  const SteadyTime deadline = clock.SteadyNow() + timeout;
  while (true) {
    if (std::optional<UvcFrame> frame = assembler_->Pop()) return frame;
    const Nanoseconds left = deadline - clock.SteadyNow();
    if (left <= Nanoseconds(0)) return std::optional<UvcFrame>();
    Status pumped = device_->Pump(left);
    // What came before the failure comes first.
    if (!pumped.ok() && !assembler_->has_frame()) return Err(std::move(pumped));
  }
}

void UvcCamera::Stop() {
  if (!std::exchange(started_, false)) return;
  device_->StopStream();
  // The class says nothing about ending a stream of bulk transfers; this is what cameras are used
  // to from Windows and Linux (uvcvideo, uvc_video_stop_streaming). One that is gone cannot.
  if (joiner_) static_cast<void>(device_->ClearHalt(bulk_endpoint_));
  // Frees the bandwidth: the interface goes back to its alternate setting 0.
  device_->Release(function_.streaming_interface);
}

Result<std::vector<std::uint8_t>> UvcCamera::GetControl(const UvcGuid& guid, std::uint8_t selector,
                                                        std::size_t size) {
  const std::optional<std::uint8_t> unit = function_.UnitWithGuid(guid);
  if (!unit) return Err(NotFound("the camera has no such extension unit"));
  if (Status claimed = ClaimControl(); !claimed.ok()) return Err(std::move(claimed));
  const UsbControl control{kGetInterface, kGetCurrent, static_cast<std::uint16_t>(selector << 8),
                           Index(function_.control_interface, *unit)};
  Result<std::vector<std::uint8_t>> answer = device_->ControlIn(control, size);
  for (int i = 1; i < kTries && !answer && IsRefusal(answer.error()); ++i) {
    static_cast<void>(device_->Pump(kRetryWait));
    answer = device_->ControlIn(control, size);
  }
  return answer;
}

Status UvcCamera::SetControl(const UvcGuid& guid, std::uint8_t selector, Bytes data) {
  const std::optional<std::uint8_t> unit = function_.UnitWithGuid(guid);
  if (!unit) return NotFound("the camera has no such extension unit");
  ISOTHERM_RETURN_IF_ERROR(ClaimControl());
  const UsbControl control{kSetInterface, kSetCurrent, static_cast<std::uint16_t>(selector << 8),
                           Index(function_.control_interface, *unit)};
  Status sent = device_->ControlOut(control, data);
  for (int i = 1; i < kTries && IsRefusal(sent); ++i) {
    static_cast<void>(device_->Pump(kRetryWait));
    sent = device_->ControlOut(control, data);
  }
  return sent;
}

}  // namespace isotherm

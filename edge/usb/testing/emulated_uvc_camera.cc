#include "edge/usb/testing/emulated_uvc_camera.h"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace isotherm {
namespace {

constexpr std::uint8_t kSetCurrent = 0x01;
constexpr std::uint16_t kProbe = 0x0100;
constexpr std::uint16_t kCommit = 0x0200;
constexpr std::uint16_t kStreamingInterface = 1;

}  // namespace

EmulatedUvcCamera::EmulatedUvcCamera(EmulatedIdentity identity, UvcCameraLayout layout,
                                     int header_bytes, std::string_view script)
    : identity_(std::move(identity)),
      layout_(std::move(layout)),
      header_bytes_(static_cast<std::size_t>(header_bytes)),
      script_(script) {
  identity_.configuration = MakeUvcConfiguration(layout_);
}

std::optional<std::vector<std::uint8_t>> EmulatedUvcCamera::Control(const UsbControl& control,
                                                                    Bytes data,
                                                                    std::size_t read_bytes) {
  if (stalled_) return std::nullopt;
  const bool streaming =
      (control.request_type & 0x7F) == 0x21 && control.index == kStreamingInterface;
  if (!streaming) return VendorControl(control, data, read_bytes);
  if (control.request == kSetCurrent) {
    const Result<UvcProbe> wanted = UnpackUvcProbe(data);
    if (!wanted || wanted->frame < 1 || wanted->frame > layout_.sizes.size()) return std::nullopt;
    UvcProbe& probe = control.value == kCommit ? committed_ : probe_;
    probe = *wanted;
    const UvcCameraLayout::Size& size = layout_.sizes[wanted->frame - 1U];
    probe.max_frame_bytes = static_cast<std::uint32_t>(2 * size.width * size.height);
    probe.max_payload_bytes = layout_.packet_fields.front() & 0x7FFU;
    if (layout_.bulk) probe.max_payload_bytes = layout_.bulk_payload_bytes;
    // Bulk cameras have no alternate setting that says when to begin.
    if (control.value == kCommit && layout_.bulk) {
      SetAlternate(kStreamingInterface, 0);
      bulk_streaming_ = true;
    }
    return std::vector<std::uint8_t>();
  }
  if (control.value != kProbe && control.value != kCommit) return std::nullopt;
  return PackUvcProbe(probe_, std::min(read_bytes, UvcProbeBytes(layout_.version)));
}

void EmulatedUvcCamera::SetAlternate(int interface, int alternate) {
  if (interface != kStreamingInterface) return;
  alternate_ = alternate;
  next_frame_at_.reset();
  in_frame_ = false;
}

bool EmulatedUvcCamera::HasFrame(Nanoseconds time) {
  if (in_frame_) return true;
  if (!next_frame_at_) next_frame_at_ = time;
  if (unplugged_ || time < *next_frame_at_) return false;
  FaultStep step = script_.Next();
  while (step.what == "stall" || step.what == "unstall") {
    stalled_ = step.what == "stall";
    step = script_.Next();
  }
  *next_frame_at_ += Nanoseconds(std::int64_t{100} * layout_.interval);
  if (step.what == "-") return false;
  frame_time_ = time;
  Begin(step);
  return true;
}

void EmulatedUvcCamera::Begin(const FaultStep& step) {
  step_ = step;
  frame_ = MakeFrame(step);
  sent_ = 0;
  end_ = step.fault == "short" ? frame_.size() * 3 / 4 : frame_.size();
  in_frame_ = true;
  fault_done_ = false;
  frame_id_ = !frame_id_;
  ++frames_sent_;
}

std::vector<std::uint8_t> EmulatedUvcCamera::Header(Nanoseconds time, bool last) const {
  std::vector<std::uint8_t> header(header_bytes_);
  header[0] = static_cast<std::uint8_t>(header_bytes_);
  header[1] = static_cast<std::uint8_t>(frame_id_ ? 0x01 : 0x00);
  if (last && step_.fault != "noeof") header[1] |= 0x02;
  if (step_.fault == "error") header[1] |= 0x40;
  if (header_bytes_ == 12) {
    header[1] |= 0x8C;
    PutLe32(header, 2, static_cast<std::uint32_t>(frame_time_.count() / 100));
    PutLe32(header, 6, static_cast<std::uint32_t>(time.count() / 100));
    PutLe16(header, 10, static_cast<std::uint16_t>(time.count() / 1'000'000 & 0x7FF));
  }
  return header;
}

EmulatedPacket EmulatedUvcCamera::NextPayload(Nanoseconds time, std::size_t most) {
  const std::size_t size = std::min(most - header_bytes_, end_ - sent_);
  const bool last = sent_ + size == end_;
  EmulatedPacket packet;
  packet.bytes = Header(time, last);
  const auto begin = frame_.begin() + static_cast<std::ptrdiff_t>(sent_);
  packet.bytes.insert(packet.bytes.end(), begin, begin + static_cast<std::ptrdiff_t>(size));
  sent_ += size;
  const bool in_the_middle = sent_ > end_ / 2 && !std::exchange(fault_done_, sent_ > end_ / 2);
  if (in_the_middle && step_.fault == "head") packet.bytes[0] = 0xFF;
  if (in_the_middle && step_.fault == "lost") packet = {{}, true};
  if (in_the_middle && step_.what == "unplug") {
    unplugged_.emplace();
    if (!step_.fault.empty()) {
      unplugged_->back_after = std::chrono::milliseconds(std::atoi(step_.fault.c_str()));
    }
    in_frame_ = false;
  }
  if (last) in_frame_ = false;
  return packet;
}

EmulatedPacket EmulatedUvcCamera::Isochronous(std::uint8_t, Nanoseconds time, std::size_t most) {
  if (alternate_ == 0 || most <= header_bytes_ || !HasFrame(time)) return {};
  return NextPayload(time, most);
}

bool EmulatedUvcCamera::HasBulkPayload(Nanoseconds time) {
  if (!bulk_payload_.empty()) return true;
  if (!bulk_streaming_ || !HasFrame(time)) return false;
  bulk_payload_ = NextPayload(time, layout_.bulk_payload_bytes).bytes;
  bulk_sent_ = 0;
  return !bulk_payload_.empty();
}

std::optional<std::vector<std::uint8_t>> EmulatedUvcCamera::Bulk(std::uint8_t, Nanoseconds time,
                                                                 std::size_t most) {
  if (!HasBulkPayload(time)) return std::nullopt;
  const std::size_t size = std::min(most, bulk_payload_.size() - bulk_sent_);
  const auto begin = bulk_payload_.begin() + static_cast<std::ptrdiff_t>(bulk_sent_);
  std::vector<std::uint8_t> transfer(begin, begin + static_cast<std::ptrdiff_t>(size));
  bulk_sent_ += size;
  // A full transfer does not show that the payload is at its end: one without bytes follows, unless
  // the payload has the agreed size.
  const bool shows_end = size < most || bulk_sent_ == layout_.bulk_payload_bytes;
  if (bulk_sent_ == bulk_payload_.size() && shows_end) bulk_payload_.clear();
  return transfer;
}

void EmulatedUvcCamera::ClearHalt(std::uint8_t) {
  if (!layout_.bulk) return;
  bulk_streaming_ = false;
  bulk_payload_.clear();
  SetAlternate(kStreamingInterface, 0);
}

std::optional<EmulatedDevice::Unplugged> EmulatedUvcCamera::TakeUnplugged() {
  return std::exchange(unplugged_, std::nullopt);
}

}  // namespace isotherm

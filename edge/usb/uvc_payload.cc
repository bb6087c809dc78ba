#include "edge/usb/uvc_payload.h"

#include <algorithm>
#include <utility>

namespace isotherm {

std::optional<UvcPayloadHeader> ParseUvcPayloadHeader(Bytes payload) {
  if (payload.size() < 2 || payload[0] < 2 || payload[0] > payload.size()) return std::nullopt;
  // Bits of bmHeaderInfo, UVC 1.5, table 2-6.
  const std::uint8_t flags = payload[1];
  UvcPayloadHeader header;
  header.length = payload[0];
  header.frame_id = (flags & 0x01) != 0;
  header.end_of_frame = (flags & 0x02) != 0;
  header.error = (flags & 0x40) != 0;
  std::size_t at = 2;
  if ((flags & 0x04) != 0) {
    if (header.length < at + 4) return std::nullopt;
    header.presentation_time = Le32(payload, at);
    at += 4;
  }
  if ((flags & 0x08) != 0) {
    if (header.length < at + 6) return std::nullopt;
    header.source_clock = Le32(payload, at);
    header.usb_frame = static_cast<std::uint16_t>(Le16(payload, at + 4) & 0x7FF);
  }
  return header;
}

void WaitingFrames::Push(UvcFrame frame) {
  frames_.push_back(std::move(frame));
  if (frames_.size() <= kMax) return;
  // The oldest goes; the next one tells the reader that it went.
  const std::uint64_t dropped = frames_.front().dropped_before + 1;
  frames_.pop_front();
  frames_.front().dropped_before += dropped;
}

std::optional<UvcFrame> WaitingFrames::Pop() {
  if (frames_.empty()) return std::nullopt;
  UvcFrame frame = std::move(frames_.front());
  frames_.pop_front();
  return frame;
}

bool UvcBulkJoiner::Add(Bytes transfer, const HostStamp& stamp) {
  if (received_ == 0 && !skipping_) {
    payload_.clear();
    first_stamp_ = stamp;
  }
  received_ += transfer.size();
  if (!skipping_) payload_.insert(payload_.end(), transfer.begin(), transfer.end());
  // A short transfer ends a payload, and so does the size that was negotiated: a payload that fills
  // its last transfer has no short one.
  const bool ends = transfer.size() < transfer_bytes_ || received_ >= max_payload_bytes_;
  if (!ends) return false;
  received_ = 0;
  // A payload of which a transfer was lost is not given out: its header may be what is missing.
  return !std::exchange(skipping_, false) && !payload_.empty();
}

void UvcBulkJoiner::NoteLost() {
  received_ += transfer_bytes_;
  // The lost transfer may have been the payload's last one.
  skipping_ = received_ < max_payload_bytes_;
  if (!skipping_) received_ = 0;
}

void UvcAssembler::AddPayload(Bytes payload, const HostStamp& stamp) {
  if (payload.empty()) return;  // Nothing was due in this bus interval.
  const std::optional<UvcPayloadHeader> header = ParseUvcPayloadHeader(payload);
  if (!header) {
    ++bad_payloads_;
    NoteLostPacket();
    return;
  }
  const Bytes data = payload.subspan(header->length);
  // The frame ID toggles with each frame: a change ends a frame whose last packet was lost.
  if (in_frame_ && header->frame_id != frame_id_) Finish();
  if (!in_frame_) {
    // Strays of the frame that has ended.
    if (frame_id_ == header->frame_id) return;
    if (data.empty() && !header->error) return;
    Begin(*header);
  }
  Append(*header, data, stamp);
  if (header->end_of_frame) Finish();
}

void UvcAssembler::NoteLostPacket() {
  if (in_frame_) {
    frame_.incomplete = true;
  } else {
    damaged_ = true;
  }
}

void UvcAssembler::Begin(const UvcPayloadHeader& header) {
  frame_ = {};
  frame_.bytes.resize(frame_bytes_);
  // Packets that were lost between two frames may have been this one's first.
  frame_.incomplete = std::exchange(damaged_, false);
  frame_id_ = header.frame_id;
  in_frame_ = true;
}

void UvcAssembler::Append(const UvcPayloadHeader& header, Bytes data, const HostStamp& stamp) {
  if (header.error) frame_.incomplete = true;
  if (!frame_.presentation_time) frame_.presentation_time = header.presentation_time;
  if (data.empty()) return;
  if (frame_.received == 0) frame_.first_packet = stamp;
  frame_.last_packet = stamp;
  const std::size_t room = frame_bytes_ - frame_.received;
  if (data.size() > room) frame_.incomplete = true;
  const std::size_t taken = std::min(room, data.size());
  std::copy_n(data.begin(), taken,
              frame_.bytes.begin() + static_cast<std::ptrdiff_t>(frame_.received));
  frame_.received += taken;
}

void UvcAssembler::Finish() {
  in_frame_ = false;
  if (frame_.received != frame_bytes_) frame_.incomplete = true;
  // The stream is joined in the middle of a frame: its rest is no damage worth counting.
  if (!std::exchange(seen_a_frame_, true) && frame_.incomplete) return;
  finished_.Push(std::move(frame_));
}

}  // namespace isotherm

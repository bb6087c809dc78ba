#include <isotherm_pieces.h>

#include "common/transport/conversions.h"
#include "common/transport/sample_validator.h"
#include "common/transport/wire_sequence.h"

namespace isotherm {
namespace {

/// More pieces than a rig sends in a thousand years.
constexpr std::uint64_t kMaxOrder = std::uint64_t{1} << 50U;
/// A hundred years; sums with it do not overflow.
constexpr std::int64_t kMaxTime_ns = std::int64_t{100} * 365 * 86'400 * 1'000'000'000;

}  // namespace

void ToWire(const FramePiece& from, isotherm_wire_FramePiece* to) {
  to->session = from.session;
  to->sensor = static_cast<std::uint8_t>(from.sensor);
  to->frame_number = from.frame_number;
  to->sent_ns = from.sent.count();
  to->order = from.order;
  to->frame_bytes = from.frame_bytes;
  to->frame_crc = from.frame_crc;
  to->index = from.index;
  const auto bytes = static_cast<std::uint32_t>(from.bytes.size());
  // The middleware only reads it; the C type has no const.
  to->bytes = {._maximum = bytes,
               ._length = bytes,
               ._buffer = const_cast<std::uint8_t*>(from.bytes.data()),
               ._release = false};
}

std::optional<RefusalCause> FromWire(const isotherm_wire_FramePiece& from, FramePiece* to) {
  if (const auto cause = CheckEnum(from.sensor, Sensor::kThermal)) return cause;
  if (from.sent_ns < 0 || from.sent_ns > kMaxTime_ns) return RefusalCause::kImplausibleTime;
  if (from.frame_number > kMaxFrameNumber || from.order > kMaxOrder) {
    return RefusalCause::kImpossibleNumber;
  }
  const auto bytes = Elements(from.bytes);
  if (bytes.empty()) return RefusalCause::kEmptyPayload;
  if (bytes.size() > kMaxFramePieceBytes || from.frame_bytes > kMaxPiecedFrameBytes) {
    return RefusalCause::kOversizePayload;
  }
  if (bytes.size() < kMinFramePieceBytes || from.frame_bytes == 0) {
    return RefusalCause::kImpossibleSize;
  }
  *to = {.session = from.session,
         .sensor = static_cast<Sensor>(from.sensor),
         .frame_number = from.frame_number,
         .sent = Nanoseconds(from.sent_ns),
         .order = from.order,
         .frame_bytes = from.frame_bytes,
         .frame_crc = from.frame_crc,
         .index = from.index,
         .bytes = {bytes.begin(), bytes.end()}};
  return std::nullopt;
}

void ToWire(const PieceReport& from, isotherm_wire_PieceReport* to) {
  to->session = from.session;
  to->next_order = from.next_order;
  to->received = from.received;
  to->frames = from.frames;
  to->broken = from.broken;
  to->queued_ns = from.queued.count();
}

std::optional<RefusalCause> FromWire(const isotherm_wire_PieceReport& from, PieceReport* to) {
  if (from.queued_ns < 0 || from.queued_ns > kMaxTime_ns) return RefusalCause::kOutOfRange;
  if (from.next_order > kMaxOrder || from.received > from.next_order ||
      from.frames > from.received || from.broken > from.received) {
    return RefusalCause::kImpossibleNumber;
  }
  *to = {.session = from.session,
         .next_order = from.next_order,
         .received = from.received,
         .frames = from.frames,
         .broken = from.broken,
         .queued = Nanoseconds(from.queued_ns)};
  return std::nullopt;
}

}  // namespace isotherm

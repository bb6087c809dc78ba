#include <isotherm_recordings.h>

#include <algorithm>

#include "common/transport/bounded_text.h"
#include "common/transport/conversions.h"
#include "common/transport/sample_validator.h"
#include "common/transport/wire_sequence.h"

namespace isotherm {
namespace {

/// More bytes than any disk has; sums with it do not overflow.
constexpr std::uint64_t kMaxFileBytes = std::uint64_t{1} << 60U;

}  // namespace

void ToWire(const RecordingRequest& from, isotherm_wire_RecordingRequest* to) {
  to->asker = from.asker;
  to->number = from.number;
  to->kind = static_cast<std::uint8_t>(from.kind);
  CopyText(from.recording, to->recording);
  to->offset = from.offset;
  to->length = from.length;
}

std::optional<RefusalCause> FromWire(const isotherm_wire_RecordingRequest& from,
                                     RecordingRequest* to) {
  if (const auto cause = CheckEnum(from.kind, RecordingRequestKind::kKept)) return cause;
  const auto kind = static_cast<RecordingRequestKind>(from.kind);
  const std::size_t max_length =
      kind == RecordingRequestKind::kChecksum ? kMaxChecksumBytes : kMaxPieceBytes;
  if (from.offset > kMaxFileBytes || from.length > max_length) return RefusalCause::kOutOfRange;
  *to = {.asker = from.asker,
         .number = from.number,
         .kind = kind,
         .recording = ReadText(from.recording),
         .offset = from.offset,
         .length = from.length};
  return std::nullopt;
}

void ToWire(const RecordingPiece& from, isotherm_wire_RecordingPiece* to) {
  to->asker = from.asker;
  to->number = from.number;
  to->outcome = static_cast<std::uint8_t>(from.outcome);
  CopyText(from.recording, to->recording);
  to->size = from.size;
  to->written_ns = ToNanoseconds(from.written);
  to->offset = from.offset;
  std::ranges::copy(from.bytes, Allocate(&to->bytes, from.bytes.size(), kMaxPieceBytes).begin());
  to->crc = from.crc;
}

std::optional<RefusalCause> FromWire(const isotherm_wire_RecordingPiece& from, RecordingPiece* to) {
  if (const auto cause = CheckEnum(from.outcome, RecordingOutcome::kBusy)) return cause;
  if (const auto cause = CheckClockTime(from.written_ns)) return cause;
  if (from.size > kMaxFileBytes || from.offset > kMaxFileBytes) return RefusalCause::kOutOfRange;
  const auto bytes = Elements(from.bytes);
  if (bytes.size() > kMaxPieceBytes) return RefusalCause::kOversizePayload;
  *to = {.asker = from.asker,
         .number = from.number,
         .outcome = static_cast<RecordingOutcome>(from.outcome),
         .recording = ReadText(from.recording),
         .size = from.size,
         .written = CaptureTimeFromNanoseconds(from.written_ns),
         .offset = from.offset,
         .bytes = {bytes.begin(), bytes.end()},
         .crc = from.crc};
  return std::nullopt;
}

}  // namespace isotherm

#include "edge/recording_server/recording_shelf.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <system_error>
#include <utility>

#include "common/base/log.h"
#include "common/recording/byte_stream.h"
#include "common/recording/mcap_records.h"
#include "common/recording/recording_parts.h"
#include "edge/spool/older_recordings.h"

namespace isotherm {
namespace {

/// Enters what is known of a file without opening it.
void Describe(const ListedRecording& recording, RecordingPiece& piece) {
  std::error_code error;
  piece.recording = recording.path.filename().string();
  const std::uintmax_t size = std::filesystem::file_size(recording.path, error);
  piece.size = error ? 0 : size;
  // A time that cannot be would have the answer refused.
  constexpr CaptureTime kYear2100{std::chrono::seconds(4'102'444'800)};
  piece.written = std::clamp(recording.WrittenAt(), CaptureTime(), kYear2100);
  if (IsBeingWritten(recording.path)) piece.outcome = RecordingOutcome::kBeingWritten;
}

}  // namespace

RecordingPiece RecordingShelf::Answer(const RecordingRequest& request) {
  RecordingPiece piece{.asker = request.asker,
                       .number = request.number,
                       .recording = request.recording,
                       .offset = request.offset};
  switch (request.kind) {
    case RecordingRequestKind::kList:
      List(request, piece);
      break;
    case RecordingRequestKind::kRead:
    case RecordingRequestKind::kChecksum:
      Read(request, piece);
      break;
    case RecordingRequestKind::kKept:
      NoteKept(request, piece);
      break;
  }
  return piece;
}

void RecordingShelf::List(const RecordingRequest& request, RecordingPiece& piece) {
  // Whoever asks for one place after the other sees one list.
  constexpr Nanoseconds kLookInterval = std::chrono::seconds(1);
  const SteadyTime now = std::chrono::steady_clock::now();
  if (request.offset == 0 && (!looked_at_ || now - *looked_at_ >= kLookInterval)) {
    looked_at_ = now;
    Look();
  }
  if (request.offset >= listed_.size()) {
    piece.outcome = RecordingOutcome::kNotThere;
    return;
  }
  Describe(listed_[static_cast<std::size_t>(request.offset)], piece);
}

const ListedRecording* RecordingShelf::Find(const std::string& name) const {
  const auto found = std::ranges::find_if(listed_, [&name](const ListedRecording& recording) {
    return recording.path.filename() == name;
  });
  return found == listed_.end() ? nullptr : &*found;
}

const ListedRecording* RecordingShelf::Get(const RecordingRequest& request, RecordingPiece& piece) {
  const ListedRecording* recording = Find(request.recording);
  if (recording == nullptr && !looked_at_) {
    Look();  // Who asks knows the name from before this process.
    recording = Find(request.recording);
  }
  if (recording == nullptr) {
    piece.outcome = RecordingOutcome::kNotThere;
    return nullptr;
  }
  Describe(*recording, piece);
  return piece.outcome == RecordingOutcome::kDone ? recording : nullptr;
}

void RecordingShelf::NoteKept(const RecordingRequest& request, RecordingPiece& piece) {
  const ListedRecording* recording = Get(request, piece);
  if (recording == nullptr || IsFetched(recording->path)) return;
  const Status marked = MarkFetched(recording->path, request.offset);
  if (marked.ok()) return;
  LOG(Recordings, Warning) << recording->path.filename().string()
                           << " was fetched, and cannot be marked so: " << marked.message();
  piece.outcome = RecordingOutcome::kUnreadable;
}

void RecordingShelf::Read(const RecordingRequest& request, RecordingPiece& piece) {
  const ListedRecording* recording = Get(request, piece);
  if (recording == nullptr) return;
  piece.outcome = RecordingOutcome::kUnreadable;
  const Result<std::unique_ptr<ByteSource>> source = OpenFileSource(recording->path);
  if (!source || request.offset > (*source)->size() ||
      request.length > (*source)->size() - request.offset) {
    return;
  }
  std::vector<std::uint8_t> bytes(request.length);
  if (!(*source)->Read(request.offset, bytes).ok()) return;
  piece.outcome = RecordingOutcome::kDone;
  piece.crc = mcap::Crc32(bytes);
  if (request.kind == RecordingRequestKind::kRead) piece.bytes = std::move(bytes);
}

}  // namespace isotherm

#include "ground/fetch/recording_fetcher.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <memory>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/base/file_descriptor.h"
#include "common/base/sync_folder.h"
#include "common/recording/byte_stream.h"
#include "common/recording/mcap_records.h"
#include "common/transport/poll_interval.h"
#include "common/transport/qos.h"

namespace isotherm {
namespace {

/// Large enough for few requests, small enough for a link that loses packets.
constexpr std::uint32_t kPieceBytes = 32'768;
/// A list that does not end is none.
constexpr std::uint64_t kMaxListed = 100'000;
// None of these is tuned.
constexpr Nanoseconds kBusyInterval = std::chrono::seconds(1);
/// The first request may be written before the rig's reader is known.
constexpr Nanoseconds kFirstRetry = std::chrono::milliseconds(200);
/// Answers may overtake each other by so much.
constexpr Nanoseconds kDisorder = std::chrono::milliseconds(300);
/// Requests under way; the rig reads 4 MB for a checksum.
constexpr std::size_t kWindow = kMaxRecordingRequests;
constexpr std::size_t kChecksumWindow = 2;

/// A name that may be written to a folder; the rig may be anybody.
bool IsPlainName(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos &&
         std::filesystem::path(name).extension() == ".mcap";
}

Status Failed(std::string_view action, const std::filesystem::path& path) {
  const std::string reason = std::generic_category().message(errno);
  return IoError(fmt::format("cannot {} {}: {}", action, path.string(), reason));
}

Status Changed(const RemoteRecording& recording) {
  return FailedPrecondition(
      fmt::format("{} has changed on the rig; fetch it again", recording.name));
}

/// Asks for what lies from `from` to `to`, `step` bytes at a time.
auto InSteps(RecordingRequestKind kind, const RemoteRecording& recording, std::uint64_t from,
             std::uint64_t to, std::uint32_t step) {
  return
      [kind, name = recording.name, from, to, step]() mutable -> std::optional<RecordingRequest> {
        if (from >= to) return std::nullopt;
        const auto length = static_cast<std::uint32_t>(std::min<std::uint64_t>(step, to - from));
        RecordingRequest request{.kind = kind, .recording = name, .offset = from, .length = length};
        from += length;
        return request;
      };
}

/// Says why an answer to a read or a checksum cannot be used.
Status Check(const RecordingPiece& piece, const RemoteRecording& recording) {
  switch (piece.outcome) {
    case RecordingOutcome::kDone:
    case RecordingOutcome::kBusy:
      break;
    case RecordingOutcome::kNotThere:
      return NotFound(fmt::format("the rig has no {} any more", recording.name));
    case RecordingOutcome::kBeingWritten:
      return FailedPrecondition(fmt::format(
          "{} is being written; end the scan first (isotherm scan --stop)", recording.name));
    case RecordingOutcome::kUnreadable:
      return piece.size == recording.size
                 ? IoError(fmt::format("the rig cannot read {}: its disk fails", recording.name))
                 : Changed(recording);
  }
  return piece.size == recording.size ? OkStatus() : Changed(recording);
}

}  // namespace

LocalState StateOf(const RemoteRecording& recording, const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::path file = folder / recording.name;
  const bool is_other =
      std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error);
  if (is_other) return LocalState::kOtherSize;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (!error) return size == recording.size ? LocalState::kSameSize : LocalState::kOtherSize;
  return std::filesystem::exists(file.string() + ".part", error) ? LocalState::kPartial
                                                                 : LocalState::kMissing;
}

RecordingFetcher::RecordingFetcher(RecordingWay& way, const Clock& clock, std::uint64_t asker,
                                   Options options)
    : way_(way), clock_(clock), asker_(asker), options_(std::move(options)) {}

Status RecordingFetcher::NoAnswer() const {
  const double patience_s = ToSeconds(options_.patience);
  if (!has_answered_) {
    return Unavailable(fmt::format(
        "the rig has not answered for {:.0f} s; does it record (spool.record), and give recordings "
        "away (link.expert.fetch_mb_per_s), and is its isotherm-edge as new as this program?",
        patience_s));
  }
  return Unavailable(
      fmt::format("the rig has not answered for {:.0f} s; what has come stays, and "
                  "is gone on with the next time",
                  patience_s));
}

Status RecordingFetcher::Exchange(const Next& next, const Take& take, std::size_t window) {
  Exchanged exchanged{.heard = clock_.SteadyNow()};
  while (true) {
    const SteadyTime now = clock_.SteadyNow();
    if (now - exchanged.heard > options_.patience) return NoAnswer();
    if (now >= exchanged.may_ask) {
      AskNext(next, window, exchanged);
      AskAgain(exchanged);
    }
    if (exchanged.is_all_asked && exchanged.under_way.empty()) return OkStatus();
    for (RecordingPiece& piece : way_.Await(kPollInterval)) {
      if (piece.asker == asker_)
        ISOTHERM_RETURN_IF_ERROR(TakePiece(std::move(piece), take, exchanged));
    }
  }
}

void RecordingFetcher::AskNext(const Next& next, std::size_t window, Exchanged& exchanged) {
  while (!exchanged.is_all_asked && exchanged.under_way.size() < window) {
    std::optional<RecordingRequest> request = next();
    exchanged.is_all_asked = !request;
    if (!request) return;
    request->asker = asker_;
    request->number = next_number_++;
    Asked& asked = exchanged.under_way[request->number];
    asked.request = std::move(*request);
    Ask(asked, exchanged);
  }
}

void RecordingFetcher::Ask(Asked& asked, Exchanged& exchanged) {
  static_cast<void>(way_.Ask(asked.request));  // Asked again if nothing comes.
  asked.sent = clock_.SteadyNow();
  asked.turn = exchanged.next_turn++;
}

void RecordingFetcher::AskAgain(Exchanged& exchanged) {
  const SteadyTime now = clock_.SteadyNow();
  const Nanoseconds patience = has_answered_ ? options_.retry : kFirstRetry;
  for (auto& [number, asked] : exchanged.under_way) {
    // A rig answers in turn, at its own pace: what it has not come to is not lost.
    const bool was_passed = asked.turn < exchanged.answered_turn && now - asked.sent > kDisorder;
    const bool is_silent = now - std::max(asked.sent, exchanged.heard) >= patience;
    if (asked.is_refused || was_passed || is_silent) {
      asked.is_refused = false;
      Ask(asked, exchanged);
    }
  }
}

Status RecordingFetcher::TakePiece(RecordingPiece&& piece, const Take& take, Exchanged& exchanged) {
  const auto found = exchanged.under_way.find(piece.number);
  if (found == exchanged.under_way.end()) return OkStatus();
  Asked& asked = found->second;
  if (piece.outcome == RecordingOutcome::kBusy) {
    if (options_.on_busy) options_.on_busy();
    exchanged.heard = clock_.SteadyNow();
    exchanged.may_ask = exchanged.heard + kBusyInterval;
    asked.is_refused = true;
    has_answered_ = true;
    return OkStatus();
  }
  const RecordingRequest& request = asked.request;
  const bool is_read =
      request.kind == RecordingRequestKind::kRead && piece.outcome == RecordingOutcome::kDone;
  const bool is_whole =
      !is_read || (piece.bytes.size() == request.length && mcap::Crc32(piece.bytes) == piece.crc);
  if (!is_whole || piece.offset != request.offset) {
    asked.is_refused = true;  // Asked for again; it is no sign of a rig that works.
    return OkStatus();
  }
  exchanged.heard = clock_.SteadyNow();
  exchanged.answered_turn = std::max(exchanged.answered_turn, asked.turn);
  has_answered_ = true;
  const RecordingRequest taken = std::move(asked.request);
  exchanged.under_way.erase(found);
  return take(taken, std::move(piece));
}

Result<std::vector<RemoteRecording>> RecordingFetcher::List() {
  std::map<std::uint64_t, RemoteRecording> entries;
  std::uint64_t end = kMaxListed;
  const Take take = [&](const RecordingRequest& request, RecordingPiece&& piece) {
    if (piece.outcome == RecordingOutcome::kNotThere) {
      end = std::min(end, request.offset);
    } else if (IsPlainName(piece.recording)) {
      entries[request.offset] = {piece.recording, piece.size, piece.written,
                                 piece.outcome == RecordingOutcome::kBeingWritten};
    }
    return OkStatus();
  };
  std::uint64_t place = 0;
  const auto next_before = [&](std::uint64_t limit) {
    return [&, limit]() -> std::optional<RecordingRequest> {
      if (place >= std::min(end, limit)) return std::nullopt;
      return RecordingRequest{.kind = RecordingRequestKind::kList, .offset = place++};
    };
  };
  // The first place alone: when it is asked for, the rig makes the list.
  for (const std::uint64_t limit : {std::uint64_t{1}, kMaxListed}) {
    if (const Status listed = Exchange(next_before(limit), take, kWindow); !listed.ok())
      return Err(listed);
  }
  std::vector<RemoteRecording> recordings;
  for (auto& [at, recording] : entries) recordings.push_back(std::move(recording));
  return recordings;
}

Result<std::uint64_t> RecordingFetcher::CountSame(const RemoteRecording& recording,
                                                  const std::filesystem::path& file,
                                                  const Progress& progress) {
  const Result<std::unique_ptr<ByteSource>> source = OpenFileSource(file);
  if (!source) return Err(source.error());
  const std::uint64_t here = std::min((*source)->size(), recording.size);
  std::uint64_t same = here;
  std::uint64_t compared = 0;
  const Status done = Exchange(
      InSteps(RecordingRequestKind::kChecksum, recording, 0, here, kMaxChecksumBytes),
      [&](const RecordingRequest& request, RecordingPiece&& piece) -> Status {
        ISOTHERM_RETURN_IF_ERROR(Check(piece, recording));
        std::vector<std::uint8_t> bytes(request.length);
        ISOTHERM_RETURN_IF_ERROR((*source)->Read(request.offset, bytes));
        if (mcap::Crc32(bytes) != piece.crc) same = std::min(same, request.offset);
        compared += request.length;
        progress(compared);
        return OkStatus();
      },
      kChecksumWindow);
  if (!done.ok()) return Err(done);
  return same;
}

Status RecordingFetcher::ReadInto(const RemoteRecording& recording, std::uint64_t from,
                                  const FileDescriptor& file, const Progress& progress) {
  std::uint64_t done = from;
  return Exchange(
      InSteps(RecordingRequestKind::kRead, recording, from, recording.size, kPieceBytes),
      [&](const RecordingRequest& request, RecordingPiece&& piece) -> Status {
        ISOTHERM_RETURN_IF_ERROR(Check(piece, recording));
        if (const int error = file.WriteAt(request.offset, piece.bytes); error != 0) {
          return IoError(
              fmt::format("the disk does not take it: {}; what has come stays, and is "
                          "gone on with the next time",
                          std::generic_category().message(error)));
        }
        done += request.length;
        progress(done);
        return OkStatus();
      },
      kWindow);
}

Status RecordingFetcher::Fetch(const RemoteRecording& recording,
                               const std::filesystem::path& folder, const Progress& progress) {
  if (!IsPlainName(recording.name))
    return InvalidArgument(fmt::format("\"{}\" is no name of a recording", recording.name));
  if (recording.is_being_written) {
    return FailedPrecondition(fmt::format(
        "{} is being written; end the scan first (isotherm scan --stop)", recording.name));
  }
  const std::filesystem::path target = folder / recording.name;
  const std::filesystem::path part = target.string() + ".part";
  const LocalState state = StateOf(recording, folder);
  const auto is_another = [&target] {
    return InvalidArgument(
        fmt::format("{} is there with another content; name another folder (-o)", target.string()));
  };
  if (state == LocalState::kOtherSize) return is_another();
  if (state == LocalState::kSameSize) {
    const Result<std::uint64_t> same = CountSame(recording, target, progress);
    if (!same) return same.error();
    return *same == recording.size ? OkStatus() : is_another();
  }
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const FileDescriptor file(::open(part.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644));
  if (file.get() < 0) return Failed("create", part);
  if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    return Unavailable(fmt::format("another isotherm fetch is at {}", part.string()));
  // A hole that a piece has left which never came is found by its checksum, as anything else is.
  const Result<std::uint64_t> same = CountSame(recording, part, progress);
  if (!same) return same.error();
  if (::ftruncate(file.get(), static_cast<off_t>(*same)) != 0) return Failed("write", part);
  ISOTHERM_RETURN_IF_ERROR(ReadInto(recording, *same, file, progress));
  if (::fsync(file.get()) != 0) return Failed("write", part);
  std::filesystem::rename(part, target, error);
  if (error) return IoError(fmt::format("cannot name {}: {}", target.string(), error.message()));
  SyncFolder(folder);
  return OkStatus();
}

Status RecordingFetcher::TellKept(const RemoteRecording& recording) {
  bool is_asked = false;
  return Exchange(
      [&]() -> std::optional<RecordingRequest> {
        if (std::exchange(is_asked, true)) return std::nullopt;
        return RecordingRequest{.kind = RecordingRequestKind::kKept,
                                .recording = recording.name,
                                .offset = recording.size};
      },
      [&](const RecordingRequest& /*request*/, RecordingPiece&& piece) {
        return Check(piece, recording);
      },
      1);
}

}  // namespace isotherm

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/status.h"
#include "common/messages/recording_transfer.h"
#include "common/time/clock.h"
#include "ground/fetch/recording_way.h"

namespace isotherm {

class FileDescriptor;

/// A recording as a rig lists it.
struct RemoteRecording {
  std::string name;
  std::uint64_t size = 0;  ///< Bytes.
  CaptureTime written{};
  bool is_being_written = false;  ///< It grows, and cannot be fetched yet.
};

/// How a file in the folder relates to a recording of the rig.
enum class LocalState : std::uint8_t { kMissing, kPartial, kSameSize, kOtherSize };
LocalState StateOf(const RemoteRecording& recording, const std::filesystem::path& folder);

/// Fetches recordings from a rig, in pieces with checksums, and asks again for those that get
/// lost. Thread-compatible.
class RecordingFetcher {
 public:
  /// Says how patient it is. Not tuned.
  struct Options {
    Nanoseconds retry =
        std::chrono::seconds(2);  ///< With no answer, all that were asked for are lost.
    Nanoseconds patience = std::chrono::seconds(20);  ///< Without any answer.
    std::function<void()> on_busy;  ///< The rig scans, and is waited for; may be empty.
  };
  /// Bytes of the recording that are here, of those there are.
  using Progress = std::function<void(std::uint64_t bytes)>;

  /// `way` and `clock` must outlive it. `asker` tells it from others who ask.
  RecordingFetcher(RecordingWay& way, const Clock& clock, std::uint64_t asker, Options options);

  /// Returns the rig's recordings, the one that was written last first. kUnavailable if the rig
  /// does not answer.
  Result<std::vector<RemoteRecording>> List();
  /// Brings a recording into `folder`. What an attempt before has left (NAME.part) is compared with
  /// the rig's by checksums, and gone on with; a file that is there with the same content is left
  /// as it is. kFailedPrecondition if it grows on the rig, kInvalidArgument if another file of its
  /// name is there, kUnavailable if the rig does not answer any more or another fetch is at it,
  /// kIoError if the disk does not take it. What has come stays for the next attempt.
  Status Fetch(const RemoteRecording& recording, const std::filesystem::path& folder,
               const Progress& progress);
  /// Tells the rig that a recording is here whole, so that it may delete its own when it needs the
  /// room. An error if it does not know that then; kUnavailable: it has not answered.
  Status TellKept(const RemoteRecording& recording);

 private:
  /// Says what to ask next; nullopt: nothing more.
  using Next = std::function<std::optional<RecordingRequest>()>;
  /// Takes an answer that fits its request.
  using Take = std::function<Status(const RecordingRequest&, RecordingPiece&&)>;

  /// A request that has no answer yet.
  struct Asked {
    RecordingRequest request;
    SteadyTime sent;
    std::uint64_t turn = 0;   ///< Among all that were sent.
    bool is_refused = false;  ///< Its answer was none.
  };
  /// Holds what is known of requests and answers of one exchange.
  struct Exchanged {
    std::map<std::uint64_t, Asked> under_way{};  ///< By number.
    SteadyTime heard{};                          ///< The newest answer that could be used.
    SteadyTime may_ask{};
    std::uint64_t next_turn = 1;
    std::uint64_t answered_turn = 0;  ///< The highest.
    bool is_all_asked = false;
  };

  /// Asks for all that `next` names, `window` at once, until each has its answer.
  Status Exchange(const Next& next, const Take& take, std::size_t window);
  void AskNext(const Next& next, std::size_t window, Exchanged& exchanged);
  void Ask(Asked& asked, Exchanged& exchanged);
  /// Asks again for what got lost.
  void AskAgain(Exchanged& exchanged);
  Status TakePiece(RecordingPiece&& piece, const Take& take, Exchanged& exchanged);
  Status NoAnswer() const;
  /// Returns how many bytes of the file are those of the recording, from its beginning on.
  Result<std::uint64_t> CountSame(const RemoteRecording& recording,
                                  const std::filesystem::path& file, const Progress& progress);
  Status ReadInto(const RemoteRecording& recording, std::uint64_t from, const FileDescriptor& file,
                  const Progress& progress);

  RecordingWay& way_;
  const Clock& clock_;
  const std::uint64_t asker_;
  const Options options_;
  std::uint64_t next_number_ = 1;
  bool has_answered_ = false;  ///< The rig, ever.
};

}  // namespace isotherm

#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <stop_token>
#include <utility>
#include <vector>

#include "common/frame/frame.h"
#include "common/messages/messages.h"
#include "common/time/clock.h"
#include "common/time/thread_progress.h"
#include "common/time/time_types.h"
#include "common/transport/qos.h"
#include "edge/backfill/backfill_window.h"
#include "edge/frame_counters/frame_counters.h"
#include "edge/publisher/publisher.h"
#include "edge/spool/recorded_frame_reader.h"
#include "edge/spool/recorded_frames.h"

namespace isotherm {

/// Says how frames are sent again.
struct BackfillOptions {
  double frames_per_s = 200.0;  ///< No more are sent, of both streams together.
  /// A ground that is heard and takes nothing is waited for no longer, once the source has ended.
  Nanoseconds patience{};
  /// A ground that is cut off is waited for until it is back, once the source has ended.
  bool waits_for_ground = false;
};

/// Holds what backfill works with; all of it must outlive it.
struct BackfillParts {
  Publisher& publisher;
  RecordedFrames& recorded;
  FrameCounters& counters;
  const Clock& clock;
  /// Returns whether frames wait before the link.
  std::function<bool()> is_live_behind;
};

/// Sends from the recording what the ground lacks: frames that an outage or a narrow link has cost,
/// and those before a ground that came late. The ground's receipts say which these are. What is
/// being captured comes first. Run() and Step() belong to a thread of their own; the rest is
/// thread-safe.
class Backfill {
 public:
  Backfill(const BackfillOptions& options, const BackfillParts& parts);

  /// Calls Step again and again until stop is requested or all is settled.
  void Run(const std::stop_token& stop);
  /// Does what is due by now. Returns whether a frame was sent.
  bool Step(const std::stop_token& stop = {});

  /// The source has ended, and all its frames are recorded and published, or dropped.
  void NoteEnd() { source_ended_ = true; }
  /// Returns whether the ground has everything that it can have. Once true, nothing more is sent.
  /// False before NoteEnd.
  bool is_settled() const { return settled_; }
  /// Returns how many recorded frames the ground lacks, as far as is known.
  std::uint64_t lacking() const { return lacking_; }
  /// Returns how many frames the recording has deleted before the ground had them, as far as is
  /// known.
  std::uint64_t gone() const { return gone_; }
  /// Returns how many frames were sent from the recording and have arrived.
  std::uint64_t arrived() const { return arrived_; }
  /// Returns for how long it has been at one piece of work, such as reading from the disk.
  Nanoseconds AtItFor(SteadyTime now) const { return progress_.AtItFor(now); }

 private:
  /// The history of a topic holds them all, whichever stream they are of.
  static constexpr std::size_t kMaxUnderWay = kMaxFlowWindowFrames;
  /// Holds the ranges that are wanted of each stream, by Sensor; ascending.
  using Wanted = std::array<std::vector<FrameRange>, 2>;

  void TakeReceipt(const Receipt& receipt, SteadyTime now);
  void CountGone(std::uint64_t frames);
  /// These were sent and got lost; what gets lost again and again is not sent any more.
  void NoteLost(Sensor sensor, const std::vector<std::uint64_t>& frames);
  /// Says whether the end has come, by the newest receipt; the source has ended.
  void Settle(SteadyTime now);
  /// Sends the next frame that is wanted; false if there is none, or none can be read by now.
  bool SendNext(SteadyTime now, const std::stop_token& stop);
  /// Returns whether a frame may be sent now without delaying what is live.
  bool MayDisturb(SteadyTime now);
  bool IsWanted(Sensor sensor, std::uint64_t number) const;
  /// A frame that is wanted, and a place before it.
  struct Target {
    Sensor sensor{};
    std::uint64_t number = 0;
    RecordedFrames::Place place;
  };
  /// Returns the one that is read next.
  std::optional<Target> FindTarget() const;
  std::optional<Target> FirstWanted(bool only_ahead) const;
  /// Returns whether more of a stream is published and not handled than is usual.
  bool IsBehind(Sensor sensor, const StreamPublished& sent, const StreamReceipt& receipt,
                SteadyTime now);
  /// Brings the reader before it. Returns whether it can be read by now.
  bool GoTo(const Target& target, SteadyTime now);
  /// The reader has come to this frame: those wanted before it that it did not meet are not there.
  void NotePassed(Sensor sensor, std::uint64_t number);
  void Send(const RecordedFrameReader::Frame& frame, SteadyTime now, const std::stop_token& stop);

  const BackfillOptions options_;
  const BackfillParts parts_;
  BackfillWindow window_;
  RecordedFrameReader reader_;
  /// Frames that the reader has passed since it was sent somewhere, by Sensor; nothing: none. The
  /// one of the target's stream begins before the target.
  std::array<std::optional<std::uint64_t>, 2> passed_;
  std::optional<Receipt> receipt_;                     ///< The newest.
  std::array<std::map<std::uint64_t, int>, 2> tries_;  ///< Counts those that got lost, by Sensor.
  Wanted wanted_;                                      ///< By the newest receipt.
  SteadyTime next_look_{};                             ///< At the receipt.
  SteadyTime retry_at_{};                              ///< The file has not got what is wanted.
  SteadyTime may_disturb_until_{};                     ///< As of the newest look at the link.
  bool reported_ = false;
  int failures_ = 0;  ///< To open the file, in a row.
  /// Tells of each stream what was published last, by Sensor, and since when.
  std::array<std::pair<std::uint64_t, SteadyTime>, 2> newest_published_{};
  SteadyTime progress_at_{};    ///< Since the source has ended.
  std::uint64_t lacked_ = 0;    ///< At that time.
  std::uint64_t received_ = 0;  ///< By the ground, at that time.
  bool is_ending_ = false;
  bool is_stalled_ = false;  ///< Nothing that was published comes by itself any more.
  ThreadProgress progress_;
  std::atomic<bool> source_ended_{false};
  std::atomic<bool> settled_{false};
  std::atomic<std::uint64_t> lacking_{0};
  std::atomic<std::uint64_t> gone_{0};
  std::atomic<std::uint64_t> arrived_{0};
};

}  // namespace isotherm

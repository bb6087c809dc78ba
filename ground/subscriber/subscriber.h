#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/messages/messages.h"
#include "common/time/clock.h"
#include "common/transport/participant.h"
#include "common/transport/refusal.h"
#include "ground/subscriber/received_frame.h"
#include "ground/subscriber/recorded_numbers.h"
#include "ground/subscriber/session_counters.h"
#include "ground/subscriber/subscriber_options.h"

namespace isotherm {

/// Called on the thread that runs the subscriber. A handler may block (a bounded queue with
/// kBlock): receipts then stop, and an edge with the lossless policy waits. Empty handlers are
/// skipped.
struct SubscriberHandlers {
  std::function<void(ReceivedDepth)> depth;      ///< In order of frame number, no duplicates.
  std::function<void(ReceivedThermal)> thermal;  ///< In order of frame number, no duplicates.
  /// Get frames that came too late for their place in the order: only the recording takes them.
  std::function<void(ReceivedDepth)> late_depth;
  std::function<void(ReceivedThermal)> late_thermal;
  /// Gets poses as they come: numbers may be missing.
  std::function<void(const ExternalOdometrySample&)> external_odometry;
  std::function<void(const RigDescription&)> rig;
  std::function<void(const EdgeStatus&)> status;
  std::function<void(const SessionClock&)> clock;  ///< After each status.
  std::function<void(const SessionMark&)> mark;    ///< Each one once.
  std::function<void(const CommandResult&)> command_result;
  /// Again and again, at least every 100 ms: reception goes on.
  std::function<void()> turn;
  /// Once per session, when it is closed: the edge ended it and all is here or given up.
  std::function<void(const SessionCounters&)> session_end;
};

/// Counts what the subscriber received and refused.
struct SubscriberStats {
  SessionCounters counters;      ///< The newest session's.
  std::uint64_t refused = 0;     ///< All causes.
  RefusalCounts refusals{};      ///< Samples of all topics since the start, by cause.
  std::uint64_t other_edge = 0;  ///< Samples of rigs that are not followed.
  bool edge_present = false;
  std::optional<SteadyTime> edge_lost{};  ///< When it was lost; nullopt while it is there.
  /// Tells the operator what is wrong with the rigs that are there: another one than the one that
  /// is followed, or two of one name. Empty = nothing.
  std::string rig_problem;
};

/// The ground's end of the link: samples in, checked frames in order out; receipts, feedback and
/// commands back. Run() belongs to the receive thread; the rest is thread-safe.
class Subscriber {
 public:
  /// `participant` and `clock` must outlive the subscriber.
  static Result<std::unique_ptr<Subscriber>> Create(const Participant& participant,
                                                    const Clock& clock,
                                                    const SubscriberOptions& options,
                                                    SubscriberHandlers handlers);
  virtual ~Subscriber() = default;

  /// Receives until stop is requested; then delivers what waits in the reorder window and sends a
  /// last receipt.
  virtual void Run(std::stop_token stop) = 0;

  /// Gives the network up, and returns true when the participant may go. What has been received
  /// stays known. To be called while Run() goes on, whose thread may be held up: `go_on` is asked
  /// all the time, and false ends the wait, with false.
  virtual bool Leave(const std::function<bool()>& go_on) = 0;
  /// Goes on with another participant, which must outlive the subscriber or the next Leave().
  virtual Status Join(const Participant& participant) = 0;

  virtual Status Publish(const Feedback& feedback) = 0;
  /// Sends a command and returns its number, under which the result comes back.
  virtual Result<std::uint64_t> Send(Command command) = 0;

  /// Enters frames that are here already: the rig is told so, and further copies are dropped.
  virtual void AddRecorded(RecordedNumbers recorded) = 0;

  virtual SubscriberStats stats() const = 0;
  /// The newest counters of one of the last sessions, also of one that never ended; only the number
  /// is set if it was not seen.
  virtual SessionCounters counters(std::uint64_t session) const = 0;
  virtual const RefusalCounter& refusals() const = 0;
};

}  // namespace isotherm

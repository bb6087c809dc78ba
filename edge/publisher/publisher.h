#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/messages/frame_number_set.h"
#include "common/messages/messages.h"
#include "common/time/clock.h"
#include "common/transport/participant.h"
#include "edge/publisher/publisher_options.h"

namespace isotherm {

/// Called on the thread that runs the publisher: they must only take note. Empty ones are skipped.
struct PublisherHandlers {
  std::function<void(const Command&)> command;
  /// `arrival` on the edge's wall clock; `is_live`: it is about a frame that was sent while it was
  /// new, and not again since.
  std::function<void(const Feedback&, CaptureTime arrival, bool is_live)> feedback;
};

/// Counts the frames of one stream that were given to the middleware.
struct StreamPublished {
  std::uint64_t published = 0;
  std::uint64_t failed = 0;             ///< Refused by the middleware (too large, buffer full).
  std::uint64_t next_frame_number = 0;  ///< One above the highest published.
};

/// Tells what of a stream of a session that goes on was published before: by other processes, and
/// by a link of this one that was made anew.
struct PublishedBefore {
  std::uint64_t frames = 0;             ///< They can be sent again.
  std::uint64_t next_frame_number = 0;  ///< One above the highest of other processes.
  std::uint64_t number_limit =
      0;                     ///< No number that another process may have published is as high.
  FrameNumberSet numbers{};  ///< Published by this process.
  std::uint64_t by_this_process = 0;  ///< So many of `frames` are its own.
};

/// The same for both streams; nothing for a session that begins.
struct SessionBefore {
  PublishedBefore depth;
  PublishedBefore thermal;
};

/// Counts of the current session.
struct PublisherStats {
  StreamPublished depth;
  StreamPublished thermal;
  std::uint64_t flow_waits = 0;     ///< Frames that waited for a receipt.
  std::uint64_t flow_timeouts = 0;  ///< Frames that were published although no receipt came.
  std::uint64_t refused = 0;        ///< Samples that cannot be, or not from a ground station.
  bool ground_present = false;
  /// Since the newest receipt of this session; nullopt: none came.
  std::optional<Nanoseconds> receipt_age{};
  bool takes_backfill = false;   ///< A ground that follows this rig reads what Backfill sends.
  bool leaves_frames = false;    ///< The link is too narrow for all of them: TakesNext.
  Nanoseconds ending_for{};      ///< For so long a link that is made anew does not end.
  std::string problem{};         ///< Why there is no network at all; empty if there is one.
  std::string ground_problem{};  ///< GroundWatch::Problem.
};

/// The edge's end of the link. Publish() and Drain() belong to the publish thread, Run() to the
/// receive thread; the rest is thread-safe. Nothing here is called by capture.
class Publisher {
 public:
  /// `participant` and `clock` must outlive the publisher.
  static Result<std::unique_ptr<Publisher>> Create(const Participant& participant,
                                                   const Clock& clock,
                                                   const PublisherOptions& options);
  virtual ~Publisher() = default;

  /// Receives commands, receipts and feedback until stop is requested, and again when called again.
  /// Needed for WaitForGround() and for PublishPolicy::kLossless.
  virtual void Run(std::stop_token stop, const PublisherHandlers& handlers) = 0;

  /// Waits until a ground station follows this rig and reads our frames, in our wire version (an
  /// onlooker does not count, nor does the ground of another rig); true if it is there. Returns at
  /// once with what is known when `timeout` is zero.
  virtual bool WaitForGround(Nanoseconds timeout, std::stop_token stop) = 0;

  /// Starts the counts of a session and announces its rig. Frames of other sessions must not
  /// follow.
  virtual Status BeginSession(const RigDescription& rig, const SessionBefore& before) = 0;
  /// Announces the rig of the running session again, after more has become known of it.
  virtual Status Announce(const RigDescription& rig) = 0;
  /// Says of the next frame of a stream whether it is to be published, or, with kLive, left for
  /// later, because the link is too narrow for all (LivePace, PiecePace); so many newer frames wait
  /// behind it. Here, for Publish() and for Backfill() kLossless is as kLive once the publisher has
  /// found that whole frames do not get along (PublisherOptions::leaves_whole_frames).
  virtual bool TakesNext(Sensor sensor, std::size_t newer) = 0;
  /// Writes a frame. With kLossless it first waits for room in the flow window. Once stop is
  /// requested, all frames that follow have the time of one StopBudget. An error: the frame was not
  /// sent and is counted.
  virtual Status Publish(const EncodedDepthFrame& frame, std::stop_token stop) = 0;
  virtual Status Publish(const EncodedThermalFrame& frame, std::stop_token stop) = 0;
  /// Sends a frame from the recording, which the ground lacks, reliably if it got lost `tries`
  /// times. Returns whether it had never been published before: it then counts as published. Waits
  /// for no window, but with kLive for what is live, and for the link.
  virtual Result<bool> Backfill(const EncodedDepthFrame& frame, int tries,
                                const std::stop_token& stop) = 0;
  virtual Result<bool> Backfill(const EncodedThermalFrame& frame, int tries,
                                const std::stop_token& stop) = 0;
  /// Never waits for the ground: a pose that comes late is worth little. Once stop is requested, it
  /// has its part of the time that frames have.
  virtual Status Publish(const ExternalOdometrySample& sample, std::stop_token stop) = 0;
  /// Writes the status; session, policy, the counts that the publisher knows and the echo of the
  /// ground's clock ping are filled in here.
  virtual Status Publish(EdgeStatus status) = 0;
  virtual Status Answer(const CommandResult& result) = 0;

  /// Waits until every reader has acknowledged all frames that went whole, and the ground has all
  /// that it will get of the others, so that nothing is lost when the process ends. False after
  /// `timeout` (also if the ground vanished); true at once if nobody listens. Works also when Run()
  /// has ended.
  virtual bool Drain(Nanoseconds timeout) = 0;

  virtual void SetPolicy(PublishPolicy policy) = 0;
  virtual PublisherStats stats() const = 0;
  /// Newest receipt of this session.
  virtual std::optional<Receipt> receipt() const = 0;
  /// Returns what a link that goes on with the session has to know of this one.
  virtual SessionBefore so_far() const = 0;
};

}  // namespace isotherm

#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "common/base/status.h"
#include "common/frame/frame.h"
#include "common/messages/messages.h"
#include "common/transport/participant.h"
#include "common/transport/refusal.h"

/// Typed ends of the topics of the link. Message is one of EncodedDepthFrame, EncodedThermalFrame,
/// both of them Backfilled, RigDescription, ExternalOdometrySample, EdgeStatus, Command,
/// CommandResult, Receipt, Feedback, Hello, RecordingRequest, RecordingPiece, FramePiece,
/// PieceReport; the topic and its QoS follow from it (qos.cc).
namespace isotherm {

/// A participant of the domain as this process knows it; 0 = none.
using PeerHandle = std::uint64_t;

/// Writes one topic. Thread-safe.
template <typename Message>
class Writer {
 public:
  /// To be called once before anything else. `participant` must outlive the writer.
  Status Open(const Participant& participant);

  /// Hands `message` of the rig `edge_id` to the middleware: a copy, and at most the topic's
  /// blocking time (see qos.cc). kUnavailable if the middleware's buffer stayed full;
  /// kInvalidArgument if the message is too large.
  Status Write(std::string_view edge_id, const Message& message);
  /// Drops what the middleware keeps of `edge_id` for readers that come later; those that are there
  /// still get it. May block as Write() does, and then fail with kUnavailable.
  Status ForgetPast(std::string_view edge_id);
  /// Readers of this topic that are there now.
  int matched_readers() const;
  /// Returns whether `peer` has such a reader, so that it gets what is written from now on.
  bool Reaches(PeerHandle peer) const;
  /// Bytes that were sent again so far because a reader had not got them.
  std::uint64_t repeated_bytes() const;
  /// Waits until all readers have acknowledged everything written. False after `timeout`.
  bool WaitForAcknowledgments(Nanoseconds timeout) const;

 private:
  DdsHandle topic_;
  DdsHandle writer_;
};

template <typename Message>
/// Holds a message and where it came from.
struct Received {
  std::string edge_id;
  Message message;
  std::uint64_t writer = 0;  ///< The writer that it came from, for Reader::PeerOf.
};

/// Reads one topic. What cannot be right is refused before it is unpacked, and counted; what the
/// middleware holds of it is bounded by its type. Thread-bound to the thread that takes.
template <typename Message>
class Reader {
 public:
  Reader();
  ~Reader();
  Reader(Reader&&) noexcept;
  Reader& operator=(Reader&&) noexcept;

  /// To be called once before anything else. `participant` and `refusals` must outlive the reader.
  Status Open(const Participant& participant, RefusalCounter* refusals);

  /// Calls `handle` for each sample that has arrived, in the writer's order, at most `max_samples`
  /// of them, and returns how many samples were taken (refused ones included).
  int Take(const std::function<void(Received<Message>&&)>& handle, int max_samples = 64);
  /// Living writers of this topic.
  int matched_writers() const;
  /// Whose writer it is; 0 if it is gone.
  PeerHandle PeerOf(std::uint64_t writer) const;
  /// For WaitSet, whose handle it takes.
  Status AttachTo(std::int32_t wait_set) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace isotherm

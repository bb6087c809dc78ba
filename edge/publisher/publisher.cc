#include "edge/publisher/publisher.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>

#include "common/base/host_name.h"
#include "common/base/log.h"
#include "common/base/mutex.h"
#include "common/concurrency/latest_value.h"
#include "common/transport/endpoints.h"
#include "common/transport/poll_interval.h"
#include "common/transport/qos.h"
#include "edge/publisher/edge_endpoints.h"
#include "edge/publisher/ground_watch.h"
#include "edge/publisher/outgoing_stream.h"
#include "edge/publisher/stop_budget.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr Nanoseconds kPresenceInterval = 100ms;  ///< To look whether the ground is there.

Status NoTimeLeft() { return Unavailable("not sent: told to stop, and the link is too slow"); }

class DdsPublisher final : public Publisher {
 public:
  DdsPublisher(const Clock& clock, const PublisherOptions& options)
      : clock_(clock),
        options_(options),
        own_hello_{
            .role = Role::kEdge, .software_version = options.software_version, .host = HostName()},
        policy_(options.policy),
        depth_(MakeStream(options)),
        thermal_(MakeStream(options)),
        grounds_(options.edge_id) {}

  Status Open(const Participant& participant);

  void Run(std::stop_token stop, const PublisherHandlers& handlers) override;
  bool WaitForGround(Nanoseconds timeout, std::stop_token stop) override;
  Status BeginSession(const RigDescription& rig) override;
  Status Announce(const RigDescription& rig) override;
  Status Publish(const EncodedDepthFrame& frame, std::stop_token stop) override {
    return PublishFrame(frame, &ends_.depth, &depth_, stop);
  }
  Status Publish(const EncodedThermalFrame& frame, std::stop_token stop) override {
    return PublishFrame(frame, &ends_.thermal, &thermal_, stop);
  }
  Status Publish(const ExternalOdometrySample& sample, std::stop_token stop) override {
    if (stop.stop_requested() && !HasTimeLeft()) return NoTimeLeft();
    return ends_.external_odometry.Write(options_.edge_id, sample);
  }
  Status Publish(EdgeStatus status) override;
  Status Answer(const CommandResult& result) override {
    return ends_.result.Write(options_.edge_id, result);
  }
  bool Drain(Nanoseconds timeout) override;
  void SetPolicy(PublishPolicy policy) override { policy_ = policy; }
  PublisherStats stats() const override;
  std::optional<Receipt> receipt() const override { return receipt_.Get(); }

 private:
  static OutgoingStream MakeStream(const PublisherOptions& options) {
    return {static_cast<std::size_t>(options.flow_window_frames), options.flow_timeout};
  }

  template <typename Frame>
  Status PublishFrame(const Frame& frame, Writer<Frame>* writer, OutgoingStream* stream,
                      const std::stop_token& stop);
  template <typename Frame>
  void WaitForRoom(const Writer<Frame>& writer, OutgoingStream* stream,
                   const std::stop_token& stop);
  /// After stop was requested.
  bool HasTimeLeft() {
    MutexLock lock(mutex_);
    return stop_budget_.MayWrite(clock_.SteadyNow());
  }
  /// Messages for other rigs share the topics.
  bool IsOurs(std::string_view edge_id) const { return edge_id == options_.edge_id; }
  void TakeReceipts();
  void OnReceipt(const Received<Receipt>& received) REQUIRES(receipts_mutex_);
  void OnFeedback(const Received<Feedback>& received, const PublisherHandlers& handlers);
  void OnPeer(const Received<Hello>& peer);
  void LookForGround();
  /// Says why the ground's word about this session cannot be true.
  std::optional<RefusalCause> RefusalOf(const Receipt& receipt) const REQUIRES(mutex_);
  std::optional<RefusalCause> RefusalOf(const Feedback& feedback, PeerHandle sender) const
      REQUIRES(mutex_);
  std::optional<std::uint64_t> session() const {
    MutexLock lock(mutex_);
    return session_;
  }
  bool IsGroundReady() const;
  /// Returns whether the ground that follows this rig, or may, reads what `writer` writes: an
  /// onlooker is not waited for.
  template <typename Frame>
  bool IsAwaited(const Writer<Frame>& writer) const REQUIRES(mutex_) {
    return grounds_.IsAwaited([&](PeerHandle peer) { return writer.Reaches(peer); },
                              clock_.SteadyNow());
  }
  /// Returns whether IsAwaited, or whether a reader has just come that may be the ground's.
  template <typename Frame>
  bool MayBeAwaited(const Writer<Frame>& writer, OutgoingStream* stream, SteadyTime now) const
      REQUIRES(mutex_) {
    if (grounds_.IsRefused(now)) return false;
    return stream->HasNewReader(writer.matched_readers(), now) || IsAwaited(writer);
  }
  bool HasNobodyToWaitFor() const;
  bool IsHandled() const;

  const Clock& clock_;
  const PublisherOptions options_;
  const Hello own_hello_;
  RefusalCounter refusals_;
  EdgeEndpoints ends_;
  // Run() takes receipts, and so does Drain(), before or after Run().
  Mutex receipts_mutex_;
  LatestValue<Receipt> receipt_;
  std::atomic<PublishPolicy> policy_;

  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  std::optional<std::uint64_t> session_ GUARDED_BY(mutex_);
  OutgoingStream depth_ GUARDED_BY(mutex_);
  OutgoingStream thermal_ GUARDED_BY(mutex_);
  std::uint64_t flow_waits_ GUARDED_BY(mutex_) = 0;
  std::uint64_t flow_timeouts_ GUARDED_BY(mutex_) = 0;
  std::optional<ClockEcho> clock_echo_ GUARDED_BY(mutex_);  // Not sent yet.
  GroundWatch grounds_ GUARDED_BY(mutex_);
  StopBudget stop_budget_ GUARDED_BY(mutex_);
};

Status DdsPublisher::Open(const Participant& participant) {
  ISOTHERM_RETURN_IF_ERROR(ends_.Open(participant, refusals_));
  return ends_.hello.Write(options_.edge_id, own_hello_);
}

void DdsPublisher::Run(std::stop_token stop, const PublisherHandlers& handlers) {
  const std::stop_callback wake(stop, [this] { ends_.wait_set.Wake(); });
  while (!stop.stop_requested()) {
    ends_.wait_set.Wait(kPresenceInterval);
    ends_.peers.Take([&](Received<Hello>&& peer) { OnPeer(peer); });
    TakeReceipts();
    ends_.feedback.Take([&](Received<Feedback>&& feedback) {
      if (IsOurs(feedback.edge_id)) OnFeedback(feedback, handlers);
    });
    ends_.commands.Take([&](Received<Command>&& command) {
      if (handlers.command && IsOurs(command.edge_id)) handlers.command(command.message);
    });
    LookForGround();
  }
}

void DdsPublisher::TakeReceipts() {
  MutexLock lock(receipts_mutex_);
  ends_.receipts.Take([&](Received<Receipt>&& receipt)
                          REQUIRES(receipts_mutex_) { OnReceipt(receipt); });
}

void DdsPublisher::OnPeer(const Received<Hello>& peer) {
  if (peer.message.role != Role::kGround) return;
  const Status compatible = CheckCompatible(own_hello_, peer.message);
  if (!compatible.ok()) {
    refusals_.Add(RefusalCause::kOtherVersion, compatible.message());
    return;
  }
  MutexLock lock(mutex_);
  grounds_.Add(peer.writer, ends_.peers.PeerOf(peer.writer));
}

void DdsPublisher::OnReceipt(const Received<Receipt>& received) {
  const Receipt& receipt = received.message;
  const ClockEcho echo{.ping = receipt.clock_ping, .received = clock_.Now()};
  const SteadyTime now = clock_.SteadyNow();
  const PeerHandle sender = ends_.receipts.PeerOf(received.writer);
  MutexLock lock(mutex_);
  const bool ours = IsOurs(received.edge_id);
  const bool accepted = receipt.verdict == SessionVerdict::kFollowed;
  const bool from_ground = grounds_.OnReceipt(sender, received.edge_id, receipt, session_, now);
  if (!ours) return;
  std::optional<RefusalCause> cause;
  if (!from_ground) {
    cause = RefusalCause::kNotTheGround;
  } else if (session_ == receipt.session) {
    cause = RefusalOf(receipt);
  }
  if (cause) {
    lock.unlock();
    refusals_.Add(
        *cause, fmt::format("topic={} depth.next={} thermal.next={}", TopicName(TopicId::kReceipt),
                            receipt.depth.next, receipt.thermal.next));
    return;
  }
  if (echo.ping != 0) clock_echo_ = echo;
  if (session_ == receipt.session && accepted) {
    receipt_.Set(receipt);
    depth_.window().OnReceipt(receipt.depth.handled, now);
    thermal_.window().OnReceipt(receipt.thermal.handled, now);
  }
  changed_.notify_all();
}

std::optional<RefusalCause> DdsPublisher::RefusalOf(const Receipt& receipt) const {
  if (const auto cause = depth_.sent().Check(receipt.depth)) return cause;
  return thermal_.sent().Check(receipt.thermal);
}

void DdsPublisher::OnFeedback(const Received<Feedback>& received,
                              const PublisherHandlers& handlers) {
  const Feedback& feedback = received.message;
  const PeerHandle sender = ends_.feedback.PeerOf(received.writer);
  std::optional<RefusalCause> cause;
  {
    MutexLock lock(mutex_);
    cause = RefusalOf(feedback, sender);
  }
  if (cause) {
    refusals_.Add(*cause,
                  fmt::format("topic={} session={} frame_number={}", TopicName(TopicId::kFeedback),
                              feedback.session, feedback.frame_number));
  } else if (handlers.feedback) {
    handlers.feedback(feedback, clock_.Now());
  }
}

std::optional<RefusalCause> DdsPublisher::RefusalOf(const Feedback& feedback,
                                                    PeerHandle sender) const {
  if (!grounds_.Knows(sender)) return RefusalCause::kNotTheGround;
  if (feedback.session != session_) return RefusalCause::kOtherSession;
  return depth_.sent().Check(feedback);
}

void DdsPublisher::LookForGround() {
  MutexLock lock(mutex_);
  // After one ground has left, the next may have another version, and other readers.
  const bool left = grounds_.Look(clock_.SteadyNow(), [this](std::uint64_t hello_writer) {
    return ends_.peers.PeerOf(hello_writer) != 0;
  });
  if (!left) return;
  depth_.ForgetReaders();
  thermal_.ForgetReaders();
}

bool DdsPublisher::IsGroundReady() const {
  MutexLock lock(mutex_);
  return grounds_.HasFollower(
      [this](PeerHandle peer) { return ends_.depth.Reaches(peer) && ends_.thermal.Reaches(peer); });
}

bool DdsPublisher::WaitForGround(Nanoseconds timeout, std::stop_token stop) {
  const SteadyTime deadline = clock_.SteadyNow() + timeout;
  while (!IsGroundReady()) {
    if (stop.stop_requested() || clock_.SteadyNow() >= deadline) return false;
    MutexLock lock(mutex_);
    changed_.wait_for(lock, kPollInterval);
  }
  return true;
}

Status DdsPublisher::BeginSession(const RigDescription& rig) {
  {
    MutexLock lock(mutex_);
    session_ = rig.session;
    depth_.BeginSession();
    thermal_.BeginSession();
    flow_waits_ = flow_timeouts_ = 0;
  }
  receipt_.Take();  // Of the session before.
  return Announce(rig);
}

Status DdsPublisher::Announce(const RigDescription& rig) {
  return ends_.rig.Write(options_.edge_id, rig);
}

template <typename Frame>
void DdsPublisher::WaitForRoom(const Writer<Frame>& writer, OutgoingStream* stream,
                               const std::stop_token& stop) {
  MutexLock lock(mutex_);
  bool waited = false;
  // An onlooker that sends no receipts must not stop the scan.
  while (!stream->window().HasRoom() && MayBeAwaited(writer, stream, clock_.SteadyNow())) {
    const SteadyTime now = clock_.SteadyNow();
    if (stop.stop_requested() && !stop_budget_.MayWait(now)) break;
    // Opens the window until the next receipt: a ground that is gone costs its timeout once.
    if (stream->window().GiveUp(now)) {
      ++flow_timeouts_;
      LOG(Publisher, Warning) << "no receipt from the ground, publishing without, timeout_s="
                              << ToSeconds(options_.flow_timeout);
    }
    waited = true;
    changed_.wait_for(lock, kPollInterval);
  }
  if (waited) ++flow_waits_;
}

template <typename Frame>
Status DdsPublisher::PublishFrame(const Frame& frame, Writer<Frame>* writer, OutgoingStream* stream,
                                  const std::stop_token& stop) {
  const std::uint64_t number = frame.header.frame_number;
  if (session() != frame.header.session) {
    return FailedPrecondition(
        fmt::format("frame of session {} without BeginSession", frame.header.session));
  }
  if (policy_ == PublishPolicy::kLossless) WaitForRoom(*writer, stream, stop);
  if (stop.stop_requested() && !HasTimeLeft()) {
    MutexLock lock(mutex_);
    stream->OnFailed();
    return NoTimeLeft();
  }
  {
    MutexLock lock(mutex_);
    stream->sent().Note(number, frame.header.capture_time);
  }
  const Status written = writer->Write(options_.edge_id, frame);
  MutexLock lock(mutex_);
  if (!written.ok()) {
    stream->OnFailed();
    return written;
  }
  stream->OnPublished(number);
  return OkStatus();
}

Status DdsPublisher::Publish(EdgeStatus status) {
  {
    MutexLock lock(mutex_);
    if (session_) status.session = *session_;
    status.depth.published = depth_.counts().published;
    status.depth.next_frame_number = depth_.counts().next_frame_number;
    status.thermal.published = thermal_.counts().published;
    status.thermal.next_frame_number = thermal_.counts().next_frame_number;
    status.clock_echo = clock_echo_;
  }
  status.publish_policy = policy_;
  if (status.clock_echo) status.clock_echo->sent = clock_.Now();
  return ends_.status.Write(options_.edge_id, status);
}

bool DdsPublisher::HasNobodyToWaitFor() const {
  MutexLock lock(mutex_);
  return !IsAwaited(ends_.depth) && !IsAwaited(ends_.thermal);
}

bool DdsPublisher::IsHandled() const {
  MutexLock lock(mutex_);
  const std::optional<Receipt> receipt = receipt_.Get();
  if (depth_.counts().published + thermal_.counts().published == 0) return true;
  return receipt && receipt->session == session_ &&
         receipt->depth.handled >= depth_.counts().next_frame_number &&
         receipt->thermal.handled >= thermal_.counts().next_frame_number;
}

bool DdsPublisher::Drain(Nanoseconds timeout) {
  const SteadyTime deadline = clock_.SteadyNow() + timeout;
  const auto left = [&] {
    return std::max(Nanoseconds(0), Nanoseconds(deadline - clock_.SteadyNow()));
  };
  // Acknowledged means delivered to the ground's reader, which may still refuse or drop it.
  if (!ends_.depth.WaitForAcknowledgments(left())) return false;
  if (!ends_.thermal.WaitForAcknowledgments(left())) return false;
  if (!ends_.status.WaitForAcknowledgments(left())) return false;
  // Only the ground's receipts say that it has used or counted everything.
  for (TakeReceipts(); !IsHandled(); TakeReceipts()) {
    if (HasNobodyToWaitFor()) return true;
    if (left() == Nanoseconds(0)) return false;
    MutexLock lock(mutex_);
    changed_.wait_for(lock, std::min(kPollInterval, left()));
  }
  return true;
}

PublisherStats DdsPublisher::stats() const {
  MutexLock lock(mutex_);
  return {.depth = depth_.counts(),
          .thermal = thermal_.counts(),
          .flow_waits = flow_waits_,
          .flow_timeouts = flow_timeouts_,
          .refused = refusals_.total(),
          .ground_present = grounds_.is_present(),
          .ground_problem = grounds_.Problem(clock_.SteadyNow())};
}

}  // namespace

Result<std::unique_ptr<Publisher>> Publisher::Create(const Participant& participant,
                                                     const Clock& clock,
                                                     const PublisherOptions& options) {
  if (const Status valid = Validate(options); !valid.ok()) return Err(valid);
  auto publisher = std::make_unique<DdsPublisher>(clock, options);
  if (const Status opened = publisher->Open(participant); !opened.ok()) return Err(opened);
  return publisher;
}

}  // namespace isotherm

#include "ground/subscriber/subscriber.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <mutex>

#include "common/base/log.h"
#include "common/transport/endpoints.h"
#include "common/transport/wait_set.h"
#include "ground/subscriber/clock_comparison.h"
#include "ground/subscriber/clock_watch.h"
#include "ground/subscriber/frame_lane.h"
#include "ground/subscriber/session_book.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

constexpr int kFramesPerTurn = 8;     // Of one stream before the other has its turn.
constexpr int kFramesPerReceipt = 8;  // A fast sender must not wait for the next interval.
constexpr Nanoseconds kMaxReorderWindow = 200ms;
constexpr Nanoseconds kIdleInterval = 100ms;  // How often presence is looked at.

std::string HostName() {
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) != 0) return "";
  return name.data();
}

/// The ends of all topics of a ground station.
struct GroundEndpoints {
  Reader<EncodedDepthFrame> depth;
  Reader<EncodedThermalFrame> thermal;
  Reader<OutsidePoseSample> outside_poses;
  Reader<RigDescription> rig;
  Reader<EdgeStatus> status;
  Reader<CommandResult> results;
  Reader<Hello> peers;
  Writer<Command> command;
  Writer<Receipt> receipt;
  Writer<Feedback> feedback;
  Writer<Hello> hello;
  WaitSet wait_set;
};

class DdsSubscriber final : public Subscriber {
 public:
  DdsSubscriber(const Clock& clock, const SubscriberOptions& options, SubscriberHandlers handlers);

  Status Open(const Participant& participant);

  void Run(std::stop_token stop) override;
  Status Publish(const Feedback& feedback) override;
  Result<std::uint64_t> Send(Command command) override;
  SubscriberStats stats() const override;
  const RefusalCounter& refusals() const override { return refusals_; }

 private:
  /// Takes some of what has arrived; false if there was nothing.
  bool TakeTurn();
  template <typename Item>
  void TakeFrames(Reader<typename FrameLane<Item>::Encoded>* reader, FrameLane<Item>* lane,
                  int* taken);
  int TakeMessages();
  /// What is due: deliveries, receipts, closed sessions, statistics.
  void Housekeep();
  void CloseSessions(SteadyTime now);
  void SendReceipt(SteadyTime now);
  Nanoseconds TimeToNextDuty(SteadyTime now) const;
  void OnPeer(const Received<Hello>& peer);
  void OnStatus(const EdgeStatus& status);
  /// True for the rig that is followed; without a choice that is the first one seen.
  bool IsFollowed(const std::string& edge_id);

  const Clock& clock_;
  const SubscriberOptions options_;
  const SubscriberHandlers handlers_;
  const Hello own_hello_;
  RefusalCounter refusals_;
  GroundEndpoints ends_;

  // Of the thread in Run().
  FrameLane<ReceivedDepth> depth_;
  FrameLane<ReceivedThermal> thermal_;
  SessionBook book_;
  ClockComparison clock_comparison_;
  ClockWatch clock_watch_;
  SteadyTime receipt_due_{};
  int frames_since_receipt_ = 0;

  mutable std::mutex mutex_;  // Guards what follows.
  std::string edge_id_;
  std::uint64_t next_command_;
  SubscriberStats stats_;
};

DdsSubscriber::DdsSubscriber(const Clock& clock, const SubscriberOptions& options,
                             SubscriberHandlers handlers)
    : clock_(clock),
      options_(options),
      handlers_(std::move(handlers)),
      own_hello_{
          .role = Role::kGround, .software_version = options.software_version, .host = HostName()},
      depth_("depth", options.reorder_window, &refusals_, handlers_.depth, handlers_.late_depth),
      thermal_("thermal", options.reorder_window, &refusals_, handlers_.thermal,
               handlers_.late_thermal),
      book_(options.end_grace),
      clock_comparison_(static_cast<std::uint64_t>(ToNanoseconds(clock.Now()))),
      clock_watch_(options.max_clock_offset),
      edge_id_(options.edge_id),
      // Not from 1, so that the result for an earlier run of this ground is not taken for ours.
      next_command_(static_cast<std::uint64_t>(ToNanoseconds(clock.Now()))) {}

Status DdsSubscriber::Open(const Participant& participant) {
  ISOTHERM_RETURN_IF_ERROR(ends_.depth.Open(participant, &refusals_));
  ISOTHERM_RETURN_IF_ERROR(ends_.thermal.Open(participant, &refusals_));
  ISOTHERM_RETURN_IF_ERROR(ends_.outside_poses.Open(participant, &refusals_));
  ISOTHERM_RETURN_IF_ERROR(ends_.rig.Open(participant, &refusals_));
  ISOTHERM_RETURN_IF_ERROR(ends_.status.Open(participant, &refusals_));
  ISOTHERM_RETURN_IF_ERROR(ends_.results.Open(participant, &refusals_));
  ISOTHERM_RETURN_IF_ERROR(ends_.peers.Open(participant, &refusals_));
  ISOTHERM_RETURN_IF_ERROR(ends_.command.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(ends_.receipt.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(ends_.feedback.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(ends_.hello.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(ends_.wait_set.Open(participant));
  ISOTHERM_RETURN_IF_ERROR(ends_.wait_set.Attach(ends_.depth));
  ISOTHERM_RETURN_IF_ERROR(ends_.wait_set.Attach(ends_.thermal));
  ISOTHERM_RETURN_IF_ERROR(ends_.wait_set.Attach(ends_.outside_poses));
  ISOTHERM_RETURN_IF_ERROR(ends_.wait_set.Attach(ends_.rig));
  ISOTHERM_RETURN_IF_ERROR(ends_.wait_set.Attach(ends_.status));
  ISOTHERM_RETURN_IF_ERROR(ends_.wait_set.Attach(ends_.results));
  ISOTHERM_RETURN_IF_ERROR(ends_.wait_set.Attach(ends_.peers));
  return ends_.hello.Write(options_.ground_id, own_hello_);
}

void DdsSubscriber::Run(std::stop_token stop) {
  const std::stop_callback wake(stop, [this] { ends_.wait_set.Wake(); });
  while (!stop.stop_requested()) {
    ends_.wait_set.Wait(TimeToNextDuty(clock_.SteadyNow()));
    while (TakeTurn() && !stop.stop_requested()) Housekeep();
    Housekeep();
  }
  TakeTurn();
  depth_.DeliverAll();
  thermal_.DeliverAll();
  Housekeep();
  SendReceipt(clock_.SteadyNow());
}

bool DdsSubscriber::TakeTurn() {
  int taken = TakeMessages();
  TakeFrames(&ends_.depth, &depth_, &taken);
  TakeFrames(&ends_.thermal, &thermal_, &taken);
  return taken > 0;
}

int DdsSubscriber::TakeMessages() {
  int taken = ends_.peers.Take([this](Received<Hello>&& peer) { OnPeer(peer); });
  taken += ends_.rig.Take([this](Received<RigDescription>&& rig) {
    if (IsFollowed(rig.edge_id) && handlers_.rig) handlers_.rig(rig.message);
  });
  taken += ends_.outside_poses.Take([this](Received<OutsidePoseSample>&& sample) {
    if (IsFollowed(sample.edge_id) && handlers_.outside_pose) {
      handlers_.outside_pose(sample.message);
    }
  });
  taken += ends_.status.Take([this](Received<EdgeStatus>&& status) {
    if (IsFollowed(status.edge_id)) OnStatus(status.message);
  });
  taken += ends_.results.Take([this](Received<CommandResult>&& result) {
    if (IsFollowed(result.edge_id) && handlers_.command_result) {
      handlers_.command_result(result.message);
    }
  });
  return taken;
}

void DdsSubscriber::OnStatus(const EdgeStatus& status) {
  const ClockReading now = ReadClocks(clock_);
  if (status.clock_echo) clock_comparison_.Add(*status.clock_echo, now.steady);
  clock_watch_.Update(status, clock_comparison_.Offset(now), ReadKernelClock(), now.steady);
  book_.OnStatus(status, now.steady);
  book_.SetClock(clock_watch_.account());
  if (handlers_.status) handlers_.status(status);
  if (handlers_.clock) handlers_.clock(clock_watch_.account());
}

template <typename Item>
void DdsSubscriber::TakeFrames(Reader<typename FrameLane<Item>::Encoded>* reader,
                               FrameLane<Item>* lane, int* taken) {
  using Encoded = typename FrameLane<Item>::Encoded;
  *taken += reader->Take(
      [this, lane](Received<Encoded>&& received) {
        if (!IsFollowed(received.edge_id)) return;
        const SteadyTime now = clock_.SteadyNow();
        const std::uint64_t session = received.message.header.session;
        if (!lane->Add(std::move(received.message), clock_.Now(), now)) return;
        book_.OnFrame(session, now);
        ++frames_since_receipt_;
        lane->DeliverDue(now);
      },
      kFramesPerTurn);
}

bool DdsSubscriber::IsFollowed(const std::string& edge_id) {
  std::scoped_lock lock(mutex_);
  if (edge_id_.empty()) {
    edge_id_ = edge_id;
    LOG(Subscriber, Info) << "following the first rig seen, edge_id=" << edge_id;
  }
  if (edge_id == edge_id_) return true;
  ++stats_.other_edge;
  return false;
}

void DdsSubscriber::OnPeer(const Received<Hello>& peer) {
  if (peer.message.role != Role::kEdge) return;
  const Status compatible = CheckCompatible(own_hello_, peer.message);
  if (!compatible.ok()) refusals_.Add(RefusalCause::kOtherVersion, compatible.message());
}

void DdsSubscriber::Housekeep() {
  const SteadyTime now = clock_.SteadyNow();
  depth_.DeliverDue(now);
  thermal_.DeliverDue(now);
  if (now >= receipt_due_ || frames_since_receipt_ >= kFramesPerReceipt) SendReceipt(now);
  CloseSessions(now);
  const bool edge_present = ends_.status.matched_writers() > 0;
  SessionAccount account;
  if (const auto session = book_.newest()) {
    account = book_.Account(depth_.stream().tally(*session), thermal_.stream().tally(*session));
  }
  account.refused_samples = refusals_.total();
  std::scoped_lock lock(mutex_);
  stats_.account = account;
  stats_.refused = refusals_.total();
  if (edge_present == stats_.edge_present) return;
  stats_.edge_present = edge_present;
  LOG(Subscriber, Info) << (edge_present ? "rig found" : "rig lost");
}

void DdsSubscriber::CloseSessions(SteadyTime now) {
  while (const auto session = book_.oldest_open()) {
    auto account =
        book_.TryClose(depth_.stream().tally(*session), thermal_.stream().tally(*session), now);
    if (!account) return;
    account->refused_samples = refusals_.total();
    // Complete, but perhaps waiting for numbers that were never published.
    depth_.DeliverAll();
    thermal_.DeliverAll();
    SendReceipt(now);
    if (handlers_.session_end) handlers_.session_end(*account);
  }
}

void DdsSubscriber::SendReceipt(SteadyTime now) {
  frames_since_receipt_ = 0;
  // From the deadline before, so that the rate does not drift; from now after a pause.
  receipt_due_ = std::max(receipt_due_ + options_.receipt_interval, now);
  const auto session = book_.newest();
  if (!session) return;
  Receipt receipt;
  receipt.session = *session;
  receipt.depth = depth_.stream().receipt(*session);
  receipt.thermal = thermal_.stream().receipt(*session);
  std::unique_lock lock(mutex_);
  const std::string edge_id = edge_id_;
  lock.unlock();
  receipt.clock_ping = clock_comparison_.Ping(clock_.SteadyNow());
  const Status sent = ends_.receipt.Write(edge_id, receipt);
  if (!sent.ok()) {
    LOG(Subscriber, Debug) << "receipt not sent: " << sent.message();
  }
}

Nanoseconds DdsSubscriber::TimeToNextDuty(SteadyTime now) const {
  SteadyTime next = now + kIdleInterval;
  if (book_.newest()) next = std::min(next, receipt_due_);
  for (const auto& deadline :
       {depth_.stream().deadline(), thermal_.stream().deadline(), book_.deadline()}) {
    if (deadline) next = std::min(next, *deadline);
  }
  return std::max(Nanoseconds(0), Nanoseconds(next - now));
}

Status DdsSubscriber::Publish(const Feedback& feedback) {
  std::unique_lock lock(mutex_);
  const std::string edge_id = edge_id_;
  lock.unlock();
  if (edge_id.empty()) return Unavailable("no rig seen yet");
  return ends_.feedback.Write(edge_id, feedback);
}

Result<std::uint64_t> DdsSubscriber::Send(Command command) {
  std::unique_lock lock(mutex_);
  const std::string edge_id = edge_id_;
  command.number = next_command_++;
  lock.unlock();
  if (edge_id.empty()) return Err(Unavailable("no rig seen yet"));
  command.time = clock_.Now();
  if (const Status sent = ends_.command.Write(edge_id, command); !sent.ok()) return Err(sent);
  return command.number;
}

SubscriberStats DdsSubscriber::stats() const {
  std::scoped_lock lock(mutex_);
  return stats_;
}

}  // namespace

Status Validate(const SubscriberOptions& options) {
  if (options.edge_id.size() > kMaxIdBytes) {
    return InvalidArgument(fmt::format("edge_id must have at most {} bytes", kMaxIdBytes));
  }
  if (options.ground_id.empty() || options.ground_id.size() > kMaxIdBytes) {
    return InvalidArgument(fmt::format("ground_id must have 1 to {} bytes", kMaxIdBytes));
  }
  if (options.reorder_window < Nanoseconds(0) || options.reorder_window > kMaxReorderWindow) {
    return InvalidArgument(fmt::format("reorder_window = {} s is outside 0..{}",
                                       ToSeconds(options.reorder_window),
                                       ToSeconds(kMaxReorderWindow)));
  }
  if (options.max_clock_offset < Nanoseconds(0)) {
    return InvalidArgument("max_clock_offset must not be negative");
  }
  if (options.receipt_interval <= Nanoseconds(0) || options.end_grace < Nanoseconds(0)) {
    return InvalidArgument("receipt_interval must be positive and end_grace not negative");
  }
  return OkStatus();
}

Result<std::unique_ptr<Subscriber>> Subscriber::Create(const Participant& participant,
                                                       const Clock& clock,
                                                       const SubscriberOptions& options,
                                                       SubscriberHandlers handlers) {
  if (const Status valid = Validate(options); !valid.ok()) return Err(valid);
  auto subscriber = std::make_unique<DdsSubscriber>(clock, options, std::move(handlers));
  if (const Status opened = subscriber->Open(participant); !opened.ok()) return Err(opened);
  return subscriber;
}

}  // namespace isotherm

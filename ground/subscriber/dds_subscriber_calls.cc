#include <memory>
#include <thread>
#include <utility>

#include "ground/subscriber/dds_subscriber.h"

// What other threads than the receiving one call.

namespace isotherm {
namespace {

/// While others let go of the endpoints.
constexpr Nanoseconds kTick = std::chrono::milliseconds(1);

Status NoNetwork() { return Unavailable("this computer's network is joined anew"); }

}  // namespace

Status DdsSubscriber::Join(const Participant& participant) {
  auto ends = std::make_shared<GroundEndpoints>();
  ISOTHERM_RETURN_IF_ERROR(ends->Open(participant, refusals_));
  ISOTHERM_RETURN_IF_ERROR(ends->hello.Write(options_.ground_id, own_hello_));
  MutexLock lock(mutex_);
  joined_ends_ = std::move(ends);
  return OkStatus();
}

bool DdsSubscriber::Leave(const std::function<bool()>& go_on) {
  std::shared_ptr<GroundEndpoints> left;
  {
    MutexLock lock(mutex_);
    left = std::exchange(joined_ends_, nullptr);
  }
  // The last one to let go of them deletes them: that must be here, before the participant goes.
  while (left && left.use_count() > 1) {
    if (!go_on()) return false;
    left->wait_set.Wake();
    std::this_thread::sleep_for(kTick);
  }
  return true;
}

void DdsSubscriber::AddRecorded(RecordedNumbers recorded) {
  {
    MutexLock lock(mutex_);
    recorded_.push_back(std::move(recorded));
  }
  if (const auto ends = joined_ends()) ends->wait_set.Wake();
}

Status DdsSubscriber::Publish(const Feedback& feedback) {
  const std::string edge_id = followed_.edge_id();
  if (edge_id.empty()) return Unavailable("no rig seen yet");
  const std::shared_ptr<GroundEndpoints> ends = joined_ends();
  if (!ends) return NoNetwork();
  return ends->feedback.Write(edge_id, feedback);
}

Result<std::uint64_t> DdsSubscriber::Send(Command command) {
  const std::string edge_id = followed_.edge_id();
  const std::shared_ptr<GroundEndpoints> ends = joined_ends();
  {
    MutexLock lock(mutex_);
    command.number = next_command_++;
  }
  if (edge_id.empty()) return Err(Unavailable("no rig seen yet"));
  if (!ends) return Err(NoNetwork());
  command.time = clock_.Now();
  if (const Status sent = ends->command.Write(edge_id, command); !sent.ok()) return Err(sent);
  return command.number;
}

SubscriberStats DdsSubscriber::stats() const {
  MutexLock lock(mutex_);
  return stats_;
}

SessionCounters DdsSubscriber::counters(std::uint64_t session) const {
  MutexLock lock(mutex_);
  return history_.Get(session);
}

Result<std::unique_ptr<Subscriber>> Subscriber::Create(const Participant& participant,
                                                       const Clock& clock,
                                                       const SubscriberOptions& options,
                                                       SubscriberHandlers handlers) {
  if (const Status valid = Validate(options); !valid.ok()) return Err(valid);
  auto subscriber = std::make_unique<DdsSubscriber>(clock, options, std::move(handlers));
  if (const Status opened = subscriber->Join(participant); !opened.ok()) return Err(opened);
  return subscriber;
}

}  // namespace isotherm

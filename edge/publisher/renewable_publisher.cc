#include "edge/publisher/renewable_publisher.h"

#include <algorithm>
#include <stop_token>
#include <thread>
#include <utility>

#include "common/base/log.h"
#include "common/base/pause.h"
#include "common/base/processor_time.h"
#include "common/transport/address_watch.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

/// To look at this computer's addresses.
constexpr Nanoseconds kLookInterval = 500ms;
/// A wait for the ground may not hold a link that is to be made anew for longer.
constexpr Nanoseconds kSlice = 200ms;
/// While others let go of a link.
constexpr Nanoseconds kTick = 1ms;
/// Whatever keeps a link from being made that was there before may pass.
constexpr Nanoseconds kRetry = 5s;

Status NoLink() { return Unavailable("the network is not there yet"); }

}  // namespace

void RenewablePublisher::Run(std::stop_token stop, const PublisherHandlers& handlers) {
  bool had_link = false;
  while (!stop.stop_requested()) {
    if (link() || MakeLink(stop)) {
      had_link = true;
      RunLink(stop, handlers);
      if (stop.stop_requested() || !DropLink(stop)) return;
    } else {
      if (!had_link) return;  // The configuration is wrong.
      Pause(stop, kRetry);
    }
  }
}

bool RenewablePublisher::MakeLink(const std::stop_token& stop) {
  std::string addresses = addresses_();
  Result<std::shared_ptr<Publisher>> connected = connect_(stop, [&](const Status& reason) {
    addresses = addresses_();
    MutexLock lock(mutex_);
    problem_ = reason.message();
  });
  if (connected) {
    Start(std::move(*connected), std::move(addresses));
    return true;
  }
  if (!stop.stop_requested()) {
    LOG(Publisher, Error) << "nothing will be published: " << connected.error().message();
    MutexLock lock(mutex_);
    problem_ = "nothing is published: " + connected.error().message();
  }
  return false;
}

void RenewablePublisher::Start(std::shared_ptr<Publisher> link, std::string addresses) {
  MutexLock lock(mutex_);
  problem_.clear();
  link_addresses_ = std::move(addresses);
  // What was asked for before the network was there is caught up on, under the lock: a
  // BeginSession in between would otherwise be lost or overtaken.
  if (policy_) link->SetPolicy(*policy_);
  if (rig_) {
    if (const Status begun = link->BeginSession(*rig_, before_); !begun.ok()) {
      LOG(Publisher, Warning) << "the session is not announced: " << begun.message();
    }
  }
  link_ = std::move(link);
  changed_.notify_all();
}

void RenewablePublisher::RunLink(const std::stop_token& stop, const PublisherHandlers& handlers) {
  std::stop_source ended;
  const std::stop_callback forward(stop, [&ended] { ended.request_stop(); });
  const std::jthread watch([this, &ended] {
    NameThread("addresses");
    AddressWatch addresses(link_addresses());
    while (!ended.stop_requested()) {
      Pause(ended.get_token(), kLookInterval);
      // Of a ground that follows this rig.
      const Nanoseconds silent_for = stats().receipt_age.value_or(AddressWatch::kSilence);
      if (addresses.HasMoved(addresses_(), silent_for, clock_.SteadyNow())) ended.request_stop();
    }
  });
  link()->Run(ended.get_token(), handlers);
  ended.request_stop();
}

bool RenewablePublisher::DropLink(const std::stop_token& stop) {
  std::shared_ptr<Publisher> old;
  {
    MutexLock lock(mutex_);
    old = std::exchange(link_, nullptr);
    problem_ = "this computer's addresses have changed";
    ending_since_ = clock_.SteadyNow();
  }
  LOG(Publisher, Warning) << "this computer's addresses have changed, and the ground is silent: "
                             "joining the network anew";
  // No receipt will come for a frame that waits for one.
  old->SetPolicy(PublishPolicy::kLive);
  while (old.use_count() > 1 && !stop.stop_requested()) std::this_thread::sleep_for(kTick);
  MutexLock lock(mutex_);
  if (stop.stop_requested()) {
    link_ = std::move(old);
    ending_since_.reset();
    return false;
  }
  if (old->stats().ground_present) {
    LOG(Publisher, Info) << "ground station lost";
  }
  before_ = old->so_far();
  lock.unlock();
  old.reset();
  lock.lock();
  ending_since_.reset();
  return true;
}

bool RenewablePublisher::WaitForGround(Nanoseconds timeout, std::stop_token stop) {
  const SteadyTime deadline = clock_.SteadyNow() + timeout;
  while (true) {
    const Nanoseconds left = std::max(Nanoseconds(0), Nanoseconds(deadline - clock_.SteadyNow()));
    {
      MutexLock lock(mutex_);
      changed_.wait_for(lock, stop, std::min(left, kSlice),
                        [this]() REQUIRES(mutex_) { return link_ != nullptr; });
    }
    const std::shared_ptr<Publisher> there = link();
    if (there && there->WaitForGround(std::min(left, kSlice), stop)) return true;
    if (left == Nanoseconds(0) || stop.stop_requested()) return false;
  }
}

Status RenewablePublisher::BeginSession(const RigDescription& rig, const SessionBefore& before) {
  MutexLock lock(mutex_);
  rig_ = rig;
  before_ = before;
  return link_ ? link_->BeginSession(rig, before) : OkStatus();
}

Status RenewablePublisher::Announce(const RigDescription& rig) {
  MutexLock lock(mutex_);
  rig_ = rig;
  return link_ ? link_->Announce(rig) : OkStatus();
}

bool RenewablePublisher::TakesNext(Sensor sensor, std::size_t newer) {
  const std::shared_ptr<Publisher> there = link();
  return !there || there->TakesNext(sensor, newer);
}

Status RenewablePublisher::Publish(const EncodedDepthFrame& frame, std::stop_token stop) {
  const std::shared_ptr<Publisher> there = link();
  return there ? there->Publish(frame, std::move(stop)) : NoLink();
}

Status RenewablePublisher::Publish(const EncodedThermalFrame& frame, std::stop_token stop) {
  const std::shared_ptr<Publisher> there = link();
  return there ? there->Publish(frame, std::move(stop)) : NoLink();
}

Result<bool> RenewablePublisher::Backfill(const EncodedDepthFrame& frame, int tries,
                                          const std::stop_token& stop) {
  const std::shared_ptr<Publisher> there = link();
  return there ? there->Backfill(frame, tries, stop) : Err(NoLink());
}

Result<bool> RenewablePublisher::Backfill(const EncodedThermalFrame& frame, int tries,
                                          const std::stop_token& stop) {
  const std::shared_ptr<Publisher> there = link();
  return there ? there->Backfill(frame, tries, stop) : Err(NoLink());
}

Status RenewablePublisher::Publish(const ExternalOdometrySample& sample, std::stop_token stop) {
  const std::shared_ptr<Publisher> there = link();
  return there ? there->Publish(sample, std::move(stop)) : NoLink();
}

Status RenewablePublisher::Publish(EdgeStatus status) {
  const std::shared_ptr<Publisher> there = link();
  return there ? there->Publish(std::move(status)) : NoLink();
}

Status RenewablePublisher::Answer(const CommandResult& result) {
  const std::shared_ptr<Publisher> there = link();
  return there ? there->Answer(result) : NoLink();
}

bool RenewablePublisher::Drain(Nanoseconds timeout) {
  const std::shared_ptr<Publisher> there = link();
  return !there || there->Drain(timeout);
}

void RenewablePublisher::SetPolicy(PublishPolicy policy) {
  MutexLock lock(mutex_);
  policy_ = policy;
  if (link_) link_->SetPolicy(policy);
}

PublisherStats RenewablePublisher::stats() const {
  if (const std::shared_ptr<Publisher> there = link()) return there->stats();
  MutexLock lock(mutex_);
  PublisherStats stats;
  stats.problem = problem_;
  if (ending_since_) stats.ending_for = clock_.SteadyNow() - *ending_since_;
  // Counts go on.
  stats.depth.published = before_.depth.frames;
  stats.thermal.published = before_.thermal.frames;
  return stats;
}

SessionBefore RenewablePublisher::so_far() const {
  const std::shared_ptr<Publisher> there = link();
  if (there) return there->so_far();
  MutexLock lock(mutex_);
  return before_;
}

std::optional<Receipt> RenewablePublisher::receipt() const {
  const std::shared_ptr<Publisher> there = link();
  return there ? there->receipt() : std::nullopt;
}

}  // namespace isotherm

#include "edge/publisher/late_publisher.h"

#include <utility>

#include "common/base/log.h"

namespace isotherm {
namespace {

Status NoLink() { return Unavailable("the network is not there yet"); }

}  // namespace

void LatePublisher::Run(std::stop_token stop, const PublisherHandlers& handlers) {
  if (link() != nullptr) return link()->Run(std::move(stop), handlers);  // Once more.
  Result<std::unique_ptr<Publisher>> connected = connect_(stop, [this](const Status& reason) {
    MutexLock lock(mutex_);
    problem_ = reason.message();
  });
  if (!connected) {
    if (!stop.stop_requested()) {
      LOG(Publisher, Error) << "nothing will be published: " << connected.error().message();
      MutexLock lock(mutex_);
      problem_ = "nothing is published: " + connected.error().message();
    }
    return;
  }
  {
    MutexLock lock(mutex_);
    owned_ = std::move(*connected);
    problem_.clear();
    // What was asked for before the network was there is caught up on, under the lock: a
    // BeginSession in between would otherwise be lost or overtaken.
    if (policy_) owned_->SetPolicy(*policy_);
    if (rig_) {
      if (const Status begun = owned_->BeginSession(*rig_, before_); !begun.ok()) {
        LOG(Publisher, Warning) << "the session is not announced: " << begun.message();
      }
    }
    // Last: from here on other threads use the link without the lock.
    link_ = owned_.get();
    changed_.notify_all();
  }
  link()->Run(std::move(stop), handlers);
}

bool LatePublisher::WaitForGround(Nanoseconds timeout, std::stop_token stop) {
  {
    MutexLock lock(mutex_);
    if (!changed_.wait_for(lock, stop, timeout, [this] { return link() != nullptr; })) return false;
  }
  return link()->WaitForGround(timeout, std::move(stop));
}

Status LatePublisher::BeginSession(const RigDescription& rig, const SessionBefore& before) {
  MutexLock lock(mutex_);
  rig_ = rig;
  before_ = before;
  return link() != nullptr ? link()->BeginSession(rig, before) : OkStatus();
}

Status LatePublisher::Announce(const RigDescription& rig) {
  MutexLock lock(mutex_);
  rig_ = rig;
  return link() != nullptr ? link()->Announce(rig) : OkStatus();
}

Status LatePublisher::Publish(const EncodedDepthFrame& frame, std::stop_token stop) {
  return link() != nullptr ? link()->Publish(frame, std::move(stop)) : NoLink();
}

Status LatePublisher::Publish(const EncodedThermalFrame& frame, std::stop_token stop) {
  return link() != nullptr ? link()->Publish(frame, std::move(stop)) : NoLink();
}

Result<bool> LatePublisher::Backfill(const EncodedDepthFrame& frame) {
  return link() != nullptr ? link()->Backfill(frame) : Err(NoLink());
}

Result<bool> LatePublisher::Backfill(const EncodedThermalFrame& frame) {
  return link() != nullptr ? link()->Backfill(frame) : Err(NoLink());
}

Status LatePublisher::Publish(const ExternalOdometrySample& sample, std::stop_token stop) {
  return link() != nullptr ? link()->Publish(sample, std::move(stop)) : NoLink();
}

Status LatePublisher::Publish(EdgeStatus status) {
  return link() != nullptr ? link()->Publish(std::move(status)) : NoLink();
}

Status LatePublisher::Answer(const CommandResult& result) {
  return link() != nullptr ? link()->Answer(result) : NoLink();
}

bool LatePublisher::Drain(Nanoseconds timeout) {
  return link() == nullptr || link()->Drain(timeout);
}

void LatePublisher::SetPolicy(PublishPolicy policy) {
  MutexLock lock(mutex_);
  policy_ = policy;
  if (link() != nullptr) link()->SetPolicy(policy);
}

PublisherStats LatePublisher::stats() const {
  if (link() != nullptr) return link()->stats();
  MutexLock lock(mutex_);
  PublisherStats stats;
  stats.problem = problem_;
  return stats;
}

std::optional<Receipt> LatePublisher::receipt() const {
  return link() != nullptr ? link()->receipt() : std::nullopt;
}

}  // namespace isotherm

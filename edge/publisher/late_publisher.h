#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/base/mutex.h"
#include "edge/publisher/publisher.h"

namespace isotherm {

/// The edge's end of a link whose network is not there yet: frames are refused, and counted, until
/// it is; then it takes up the session that has begun meanwhile. Thread-safe as any publisher.
class LatePublisher final : public Publisher {
 public:
  /// Called several times a second while it waits, with the reason.
  using Waiting = std::function<void(const Status& reason)>;
  /// Returns when there is a link, or an error when stop is requested.
  using Connect =
      std::function<Result<std::unique_ptr<Publisher>>(const std::stop_token&, const Waiting&)>;

  explicit LatePublisher(Connect connect) : connect_(std::move(connect)) {}

  /// Connects first.
  void Run(std::stop_token stop, const PublisherHandlers& handlers) override;
  bool WaitForGround(Nanoseconds timeout, std::stop_token stop) override;
  Status BeginSession(const RigDescription& rig, const SessionBefore& before) override;
  Status Announce(const RigDescription& rig) override;
  Status Publish(const EncodedDepthFrame& frame, std::stop_token stop) override;
  Status Publish(const EncodedThermalFrame& frame, std::stop_token stop) override;
  Result<bool> Backfill(const EncodedDepthFrame& frame) override;
  Result<bool> Backfill(const EncodedThermalFrame& frame) override;
  Status Publish(const ExternalOdometrySample& sample, std::stop_token stop) override;
  Status Publish(EdgeStatus status) override;
  Status Answer(const CommandResult& result) override;
  bool Drain(Nanoseconds timeout) override;
  void SetPolicy(PublishPolicy policy) override;
  PublisherStats stats() const override;
  std::optional<Receipt> receipt() const override;

 private:
  /// Null until there is a link.
  Publisher* link() const { return link_.load(); }

  const Connect connect_;
  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  std::unique_ptr<Publisher> owned_ GUARDED_BY(mutex_);
  std::optional<RigDescription> rig_ GUARDED_BY(mutex_);
  SessionBefore before_ GUARDED_BY(mutex_);
  std::optional<PublishPolicy> policy_ GUARDED_BY(mutex_);
  std::string problem_ GUARDED_BY(mutex_);
  std::atomic<Publisher*> link_{nullptr};
};

}  // namespace isotherm

#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "common/base/mutex.h"
#include "edge/publisher/publisher.h"

namespace isotherm {

/// The edge's end of a link whose network may not be there yet, or change under way: another
/// address, an interface that is pulled out and put back. Without a link frames are refused, and
/// counted. When there is one it takes up the session that has begun meanwhile, and one that is
/// made anew goes on with the counts of the one before. Thread-safe as any publisher.
class RenewablePublisher final : public Publisher {
 public:
  /// Called several times a second while it waits, with the reason.
  using Waiting = std::function<void(const Status& reason)>;
  /// Returns when there is a link, or an error when stop is requested. The one before is gone.
  using Connect =
      std::function<Result<std::shared_ptr<Publisher>>(const std::stop_token&, const Waiting&)>;
  /// Returns the addresses that this computer has.
  using Addresses = std::function<std::string()>;

  RenewablePublisher(Connect connect, Addresses addresses, const Clock& clock)
      : connect_(std::move(connect)), addresses_(std::move(addresses)), clock_(clock) {}

  /// Takes a link that is there; `addresses` are those of before it was made. Others call it before
  /// anything else, if at all.
  void Start(std::shared_ptr<Publisher> link, std::string addresses);

  /// Connects first, and again when the network has changed.
  void Run(std::stop_token stop, const PublisherHandlers& handlers) override;
  bool WaitForGround(Nanoseconds timeout, std::stop_token stop) override;
  Status BeginSession(const RigDescription& rig, const SessionBefore& before) override;
  Status Announce(const RigDescription& rig) override;
  bool TakesNext(Sensor sensor, std::size_t newer) override;
  Status Publish(const EncodedDepthFrame& frame, std::stop_token stop) override;
  Status Publish(const EncodedThermalFrame& frame, std::stop_token stop) override;
  Result<bool> Backfill(const EncodedDepthFrame& frame, int tries,
                        const std::stop_token& stop) override;
  Result<bool> Backfill(const EncodedThermalFrame& frame, int tries,
                        const std::stop_token& stop) override;
  Status Publish(const ExternalOdometrySample& sample, std::stop_token stop) override;
  Status Publish(EdgeStatus status) override;
  Status Answer(const CommandResult& result) override;
  bool Drain(Nanoseconds timeout) override;
  void SetPolicy(PublishPolicy policy) override;
  PublisherStats stats() const override;
  std::optional<Receipt> receipt() const override;
  SessionBefore so_far() const override;

 private:
  /// Null while there is no link. Whoever has it keeps it alive.
  std::shared_ptr<Publisher> link() const {
    MutexLock lock(mutex_);
    return link_;
  }
  std::string link_addresses() const {
    MutexLock lock(mutex_);
    return link_addresses_;
  }
  /// Waits for a link. Returns whether there is one.
  bool MakeLink(const std::stop_token& stop);
  /// Serves the ground until the network has changed, or stop is requested.
  void RunLink(const std::stop_token& stop, const PublisherHandlers& handlers);
  /// Gives the link up. Returns false if stop was requested before others had let go of it.
  bool DropLink(const std::stop_token& stop);

  const Connect connect_;
  const Addresses addresses_;
  const Clock& clock_;
  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  std::shared_ptr<Publisher> link_ GUARDED_BY(mutex_);
  std::string link_addresses_ GUARDED_BY(mutex_);  ///< As they were before it was made.
  std::optional<RigDescription> rig_ GUARDED_BY(mutex_);
  SessionBefore before_ GUARDED_BY(mutex_);
  std::optional<PublishPolicy> policy_ GUARDED_BY(mutex_);
  std::string problem_ GUARDED_BY(mutex_);
  std::optional<SteadyTime> ending_since_ GUARDED_BY(mutex_);  ///< A link that is dropped.
};

}  // namespace isotherm

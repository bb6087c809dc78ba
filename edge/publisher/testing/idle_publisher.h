#pragma once

#include <stop_token>

#include "edge/publisher/publisher.h"

namespace isotherm {

/// A link that takes everything and does nothing with it, for links that do some of it.
class IdlePublisher : public Publisher {
 public:
  void Run(std::stop_token, const PublisherHandlers&) override {}
  bool WaitForGround(Nanoseconds, std::stop_token) override { return true; }
  Status BeginSession(const RigDescription&, const SessionBefore&) override { return OkStatus(); }
  Status Announce(const RigDescription&) override { return OkStatus(); }
  bool TakesNext(Sensor, std::size_t) override { return true; }
  Status Publish(const EncodedDepthFrame&, std::stop_token) override { return OkStatus(); }
  Status Publish(const EncodedThermalFrame&, std::stop_token) override { return OkStatus(); }
  Status Publish(const ExternalOdometrySample&, std::stop_token) override { return OkStatus(); }
  Status Publish(EdgeStatus) override { return OkStatus(); }
  Status Answer(const CommandResult&) override { return OkStatus(); }
  bool Drain(Nanoseconds) override { return true; }
  void SetPolicy(PublishPolicy) override {}
  SessionBefore so_far() const override { return {}; }
};

}  // namespace isotherm

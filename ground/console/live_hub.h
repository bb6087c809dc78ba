#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>

#include "ground/console/client_mailbox.h"
#include "ground/console/live_message.h"

namespace isotherm {

/// A client of the hub: its mailbox, and how it hears that something is in it.
struct LiveClient {
  ClientMailbox mailbox;
  std::function<void()> wake;
};

/// Keeps what a client that comes now has to be told, and passes on what is new. Thread-bound to
/// the I/O thread.
class LiveHub {
 public:
  void Publish(const LiveMessagePtr& message);
  /// Offers everything that is kept; `client` stays until Leave.
  void Join(LiveClient& client);
  void Leave(LiveClient& client) { clients_.erase(&client); }
  /// Offers again what a client did not want so far.
  void OfferAll(LiveClient& client) const;

  std::size_t clients() const { return clients_.size(); }
  /// The newest message of a kind that there is one of; nullptr if there is none.
  LiveMessagePtr Kept(LiveKind kind) const {
    const auto found = kept_.find({kind, {}});
    return found == kept_.end() ? nullptr : found->second;
  }
  std::uint64_t model() const { return model_; }
  std::size_t kept() const { return kept_.size(); }

 private:
  std::uint64_t model_ = 0;
  std::map<LiveSlot, LiveMessagePtr> kept_;
  std::set<LiveClient*> clients_;
};

}  // namespace isotherm

#include "ground/console/live_hub.h"

namespace isotherm {

void LiveHub::Publish(const LiveMessagePtr& message) {
  if (message->slot.kind == LiveKind::kScan && message->model != model_) {
    kept_.clear();
    model_ = message->model;
  }
  if (message->is_kept) kept_[message->slot] = message;
  for (LiveClient* client : clients_) {
    client->mailbox.Offer(message);
    client->wake();
  }
}

void LiveHub::OfferAll(LiveClient& client) const {
  for (const auto& [slot, message] : kept_) client.mailbox.Offer(message);
  client.wake();
}

void LiveHub::Join(LiveClient& client) {
  clients_.insert(&client);
  OfferAll(client);
}

}  // namespace isotherm

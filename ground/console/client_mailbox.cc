#include "ground/console/client_mailbox.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace isotherm {
namespace {

/// Images get at most one byte for so many of surface, while surface waits.
constexpr double kSurfacePerImageByte = 3.0;
/// The sums of both forget by half at so many bytes.
constexpr double kMemory_bytes = 1e6;
/// How far ahead of its limit a client may be, seconds: a burst after silence.
constexpr double kBurst_s = 0.25;

bool IsSurface(LiveKind kind) { return kind == LiveKind::kGroup || kind == LiveKind::kDetails; }
bool IsImage(LiveKind kind) {
  return kind == LiveKind::kDepthImage || kind == LiveKind::kThermalImage;
}
bool IsRawImage(LiveKind kind) {
  return kind == LiveKind::kRawDepth || kind == LiveKind::kRawThermal;
}

}  // namespace

ClientMailbox::ClientMailbox(const Limits& limits, SteadyTime now)
    : limits_(limits), paid_until_(now - FromSeconds(kBurst_s)) {}

void ClientMailbox::Offer(const LiveMessagePtr& message) {
  if (message->slot.kind == LiveKind::kScan && message->model != model_) {
    replaced_ += waiting_.size();
    waiting_.clear();
    // The groups that a client says it has are of the model that it is shown first.
    if (model_ != 0) sent_.clear();
    model_ = message->model;
  }
  if (message->slot.kind == LiveKind::kGroup) {
    const auto sent = sent_.find(message->slot.group);
    if (sent != sent_.end() && sent->second == message->version) return;
  }
  if (!IsWanted(*message)) return;
  const auto [place, is_new] = waiting_.insert_or_assign(message->slot, message);
  if (!is_new) ++replaced_;
}

bool ClientMailbox::IsWanted(const LiveMessage& message) const {
  if (message.slot.kind == LiveKind::kDetails) return wants_details_;
  if (IsRawImage(message.slot.kind)) return wants_raw_;
  return wants_images_ || !IsImage(message.slot.kind);
}

bool ClientMailbox::Answer(LiveMessagePtr answer) {
  if (answers_.size() >= limits_.max_answers) return false;
  answers_.push_back(std::move(answer));
  return true;
}

bool ClientMailbox::set_wants(bool details, bool images) {
  const bool wants_more = (details && !wants_details_) || (images && !wants_images_);
  wants_details_ = details;
  wants_images_ = images;
  std::erase_if(waiting_, [this](const auto& slot) { return !IsWanted(*slot.second); });
  return wants_more;
}

void ClientMailbox::set_bytes_per_s(double bytes_per_s) {
  bytes_per_s_ =
      bytes_per_s > 0.0 ? std::min(bytes_per_s, limits_.bytes_per_s) : limits_.bytes_per_s;
}

ClientMailbox::Waiting::iterator ClientMailbox::Urgent() {
  const auto first = waiting_.begin();
  return first != waiting_.end() && first->first.kind < LiveKind::kGroup ? first : waiting_.end();
}

ClientMailbox::Waiting::iterator ClientMailbox::NearestGroup() {
  auto best = waiting_.end();
  std::pair best_rank(2, std::numeric_limits<double>::infinity());
  for (auto slot = waiting_.lower_bound({LiveKind::kGroup, {}});
       slot != waiting_.end() && IsSurface(slot->first.kind); ++slot) {
    const bool is_new = slot->first.kind == LiveKind::kGroup && !sent_.contains(slot->first.group);
    const std::pair rank(is_new ? 0 : 1, (slot->second->centre_world - eye_world_).squaredNorm());
    if (rank >= best_rank) continue;
    best_rank = rank;
    best = slot;
  }
  return best;
}

ClientMailbox::Waiting::iterator ClientMailbox::Image() {
  return std::ranges::find_if(waiting_, [](const auto& slot) {
    return IsImage(slot.first.kind) || IsRawImage(slot.first.kind);
  });
}

ClientMailbox::Waiting::iterator ClientMailbox::Next() {
  if (const auto urgent = Urgent(); urgent != waiting_.end()) return urgent;
  const auto group = NearestGroup();
  const auto image = Image();
  if (group == waiting_.end()) return image != waiting_.end() ? image : waiting_.begin();
  const bool image_is_due =
      image != waiting_.end() && image_bytes_ * kSurfacePerImageByte <= surface_bytes_;
  return image_is_due ? image : group;
}

LiveMessagePtr ClientMailbox::Remove(Waiting::iterator found) {
  LiveMessagePtr message = std::move(found->second);
  waiting_.erase(found);
  const auto bytes = static_cast<double>(message->bytes.size());
  if (message->slot.kind == LiveKind::kGroup) sent_[message->slot.group] = message->version;
  if (IsSurface(message->slot.kind)) surface_bytes_ += bytes;
  if (IsImage(message->slot.kind) || IsRawImage(message->slot.kind)) image_bytes_ += bytes;
  if (surface_bytes_ + image_bytes_ > kMemory_bytes) {
    surface_bytes_ /= 2.0;
    image_bytes_ /= 2.0;
  }
  return message;
}

void ClientMailbox::Pay(std::size_t bytes, SteadyTime now) {
  sent_bytes_ += bytes;
  const Nanoseconds cost = FromSeconds(static_cast<double>(bytes) / bytes_per_s_);
  paid_until_ = std::max(paid_until_, now - FromSeconds(kBurst_s)) + cost;
}

LiveMessagePtr ClientMailbox::Take(SteadyTime now) {
  LiveMessagePtr message;
  if (!answers_.empty()) {
    message = std::move(answers_.front());
    answers_.pop_front();
  } else if (const auto urgent = Urgent(); urgent != waiting_.end()) {
    message = Remove(urgent);
  } else if (now >= paid_until_) {
    if (const auto next = Next(); next != waiting_.end()) message = Remove(next);
  }
  if (message) Pay(message->bytes.size(), now);
  return message;
}

std::optional<SteadyTime> ClientMailbox::NextTake() const {
  if (!answers_.empty()) return SteadyTime{};
  if (waiting_.empty()) return std::nullopt;
  return waiting_.begin()->first.kind < LiveKind::kGroup ? SteadyTime{} : paid_until_;
}

}  // namespace isotherm

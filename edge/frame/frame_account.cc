#include "edge/frame/frame_account.h"

namespace isotherm {

std::int64_t SensorAccount::OnTheWayToDisk() const {
  return static_cast<std::int64_t>(captured - rejected - left_out - recorded - record_queue_full -
                                   record_failed);
}

std::int64_t SensorAccount::OnTheWayToGround() const {
  return static_cast<std::int64_t>(captured - rejected - left_out - published - publish_queue_full -
                                   publish_failed);
}

SensorAccount FrameAccount::Get(Sensor sensor) const {
  const auto& counts = counts_[static_cast<std::size_t>(sensor)];
  const auto count = [&counts](FrameFate fate) {
    return counts[static_cast<std::size_t>(fate)].load();
  };
  SensorAccount account;
  // Ends of the line before its beginning: a frame that moves on meanwhile is "on the way", never
  // negative.
  account.recorded = count(FrameFate::kRecorded);
  account.record_queue_full = count(FrameFate::kRecordQueueFull);
  account.record_failed = count(FrameFate::kRecordFailed);
  account.published = count(FrameFate::kPublished);
  account.publish_queue_full = count(FrameFate::kPublishQueueFull);
  account.publish_failed = count(FrameFate::kPublishFailed);
  account.rejected = count(FrameFate::kRejected);
  account.left_out = count(FrameFate::kLeftOut);
  account.lost_in_camera = count(FrameFate::kLostInCamera);
  account.captured = count(FrameFate::kCaptured);
  return account;
}

}  // namespace isotherm

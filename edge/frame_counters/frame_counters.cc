#include "edge/frame_counters/frame_counters.h"

namespace isotherm {

std::int64_t SensorCounters::OnTheWayToDisk() const {
  return static_cast<std::int64_t>(captured - rejected - left_out - recorded - record_queue_full -
                                   record_failed);
}

std::int64_t SensorCounters::OnTheWayToGround() const {
  return static_cast<std::int64_t>(captured - rejected - left_out - published - publish_queue_full -
                                   left_for_later - publish_failed);
}

void FrameCounters::CountPublishedAfterAll(Sensor sensor) {
  // First out of its old fate: between the two steps the frame is on the way.
  for (const FrameFate dropped :
       {FrameFate::kLeftForLater, FrameFate::kPublishQueueFull, FrameFate::kPublishFailed}) {
    std::atomic<std::uint64_t>& count = At(sensor, dropped);
    std::uint64_t before = count;
    while (before > 0 && !count.compare_exchange_weak(before, before - 1)) {
    }
    if (before == 0) continue;
    Count(sensor, FrameFate::kPublished);
    return;
  }
}

SensorCounters FrameCounters::Get(Sensor sensor) const {
  const auto& counts = counts_[static_cast<std::size_t>(sensor)];
  const auto count = [&counts](FrameFate fate) {
    return counts[static_cast<std::size_t>(fate)].load();
  };
  SensorCounters counters;
  // Ends of the line before its beginning: a frame that moves on meanwhile is "on the way", never
  // negative.
  counters.recorded = count(FrameFate::kRecorded);
  counters.record_queue_full = count(FrameFate::kRecordQueueFull);
  counters.record_failed = count(FrameFate::kRecordFailed);
  counters.published = count(FrameFate::kPublished);
  counters.publish_queue_full = count(FrameFate::kPublishQueueFull);
  counters.left_for_later = count(FrameFate::kLeftForLater);
  counters.publish_failed = count(FrameFate::kPublishFailed);
  counters.rejected = count(FrameFate::kRejected);
  counters.left_out = count(FrameFate::kLeftOut);
  counters.lost_in_camera = count(FrameFate::kLostInCamera);
  counters.lost_by_restart = count(FrameFate::kLostByRestart);
  counters.captured = count(FrameFate::kCaptured);
  return counters;
}

}  // namespace isotherm

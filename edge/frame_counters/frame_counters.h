#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "common/frame/frame.h"

namespace isotherm {

/// Says what becomes of a captured frame. Each frame has one fate on the way to the disk and one on
/// the way to the ground; a frame that was rejected or left out goes neither way.
enum class FrameFate : std::uint8_t {
  kCaptured,
  kRejected,      ///< Garbage, short, wrong size.
  kLeftOut,       ///< Its camera's process had no free slot: the edge did not take frames in time.
  kLostInCamera,  ///< Not captured: the camera counted it, and it never came.
  /// Not captured, as the edge was started again meanwhile; or so shortly before that nothing has
  /// it.
  kLostByRestart,
  kRecorded,
  kRecordQueueFull,  ///< The disk was slower than the cameras.
  kRecordFailed,     ///< The disk refused it (full, broken).
  kPublished,
  kPublishQueueFull,  ///< The link was slower than the cameras.
  kLeftForLater,   ///< The link is slower than the cameras, and the frame not its turn (LivePace).
  kPublishFailed,  ///< The link refused it.
  kCount
};

/// Counts of one sensor.
struct SensorCounters {
  std::uint64_t captured = 0;
  std::uint64_t rejected = 0;
  std::uint64_t left_out = 0;
  std::uint64_t lost_in_camera = 0;   ///< Not in `captured`.
  std::uint64_t lost_by_restart = 0;  ///< Not in `captured`; at most.
  std::uint64_t recorded = 0;
  std::uint64_t record_queue_full = 0;
  std::uint64_t record_failed = 0;
  std::uint64_t published = 0;
  std::uint64_t publish_queue_full = 0;
  std::uint64_t left_for_later = 0;
  std::uint64_t publish_failed = 0;

  /// Frames that are still on their way. The counters balance when both are 0:
  /// captured = recorded + dropped by reason, captured = published + dropped by reason.
  std::int64_t OnTheWayToDisk() const;
  std::int64_t OnTheWayToGround() const;
};

/// The counters of all frames of a session. Thread-safe.
class FrameCounters {
 public:
  void Count(Sensor sensor, FrameFate fate, std::uint64_t frames = 1) {
    At(sensor, fate).fetch_add(frames);
  }
  /// A frame that had been dropped before the link was sent from the recording after all.
  void CountPublishedAfterAll(Sensor sensor);
  /// For counts that somebody else keeps.
  void Set(Sensor sensor, FrameFate fate, std::uint64_t count) { At(sensor, fate) = count; }
  SensorCounters Get(Sensor sensor) const;

 private:
  static constexpr std::size_t kFates = static_cast<std::size_t>(FrameFate::kCount);
  std::atomic<std::uint64_t>& At(Sensor sensor, FrameFate fate) {
    return counts_[static_cast<std::size_t>(sensor)][static_cast<std::size_t>(fate)];
  }

  std::array<std::array<std::atomic<std::uint64_t>, kFates>, 2> counts_{};
};

}  // namespace isotherm

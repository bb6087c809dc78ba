#pragma once

#include <array>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <stop_token>

#include "common/base/mutex.h"
#include "common/concurrency/bounded_queue.h"
#include "edge/source/frame_source.h"

namespace isotherm {

/// Joins the threads of several cameras with one reader, with bounded memory: a queue for each
/// camera, so that one that floods cannot push out the frames of another. Of the oldest of each
/// queue the one that arrived first comes out first. Thread-safe.
class MergeQueue {
 public:
  /// A rig has a depth and a thermal camera.
  static constexpr std::size_t kMaxCameras = 2;

  /// `capacity` frames per camera. `on_drop` is called for each frame that makes room for a newer
  /// one, with the queue locked: it may count, no more.
  MergeQueue(std::size_t cameras, std::size_t capacity, OverflowPolicy policy,
             std::function<void(Sensor)> on_drop);

  /// Waits for room (kBlock) until stop is requested; takes `item` in any case.
  void Push(std::size_t camera, SourceItem item, const std::stop_token& stop);
  /// Nothing more comes from this camera.
  void End(std::size_t camera);
  /// Waits at most `timeout`: NothingYet after that, EndOfStream when all cameras have ended and
  /// nothing is left.
  SourceItem Pop(Nanoseconds timeout, const std::stop_token& stop);

 private:
  /// Holds what waits of one camera.
  struct CameraQueue {
    std::deque<SourceItem> items;
    bool ended = false;
  };
  /// Returns the camera's queue whose first item is next; nullptr if there is none.
  CameraQueue* Next() REQUIRES(mutex_);
  bool AllEnded() const REQUIRES(mutex_);

  const std::size_t cameras_;
  const std::size_t capacity_;
  const OverflowPolicy policy_;
  const std::function<void(Sensor)> on_drop_;
  Mutex mutex_;
  std::condition_variable_any changed_;
  std::array<CameraQueue, kMaxCameras> queues_ GUARDED_BY(mutex_);
};

}  // namespace isotherm

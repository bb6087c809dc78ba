#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <variant>
#include <vector>

#include "common/base/mutex.h"
#include "common/frame/frame.h"
#include "common/geometry/rigid_transform.h"
#include "common/messages/messages.h"
#include "common/time/time_types.h"
#include "ground/console/live.pb.h"
#include "ground/measuring/shape_measurer.h"
#include "ground/snapshot/block_batch.h"
#include "ground/snapshot/model_copy.h"

namespace isotherm {

/// A scan begins: what was shown before goes.
struct ScanBegun {
  std::uint64_t scan = 0;  ///< Counts the scans of this process, from 1.
  live::Scan description;
  std::filesystem::path folder;  ///< For shapes; empty: they are not kept.
  MeasuringOptions measuring;
};

/// Where the rig was at a depth frame.
struct FramePose {
  std::uint64_t scan = 0;
  std::uint64_t frame_number = 0;
  CaptureTime capture_time{};
  int map = 0;
  RigidTransform T_map_depth = RigidTransform::Identity();
  TrackingState tracking = TrackingState::kWaiting;
};

/// A scan has ended. Its model no longer changes and is handed over, if there is one.
struct ScanEnded {
  std::uint64_t scan = 0;
  std::vector<ReadableMap> maps;
  live::Scan::Phase phase = live::Scan::ENDED;
  std::vector<RigidTransform> path{};  ///< In the first map, if it was not seen live.
};

/// A client asks something that needs the model. `reply` may be called on any thread.
struct ClientQuery {
  live::ClientMessage message;
  std::function<void(live::Answer)> reply;
};

using ConsoleEvent =
    std::variant<ScanBegun, FramePose, ScanEnded, Feedback, CommandResult, ClientQuery>;

/// Hands over to the console's thread what others see and ask: copies of the model, events in
/// order, and the newest image of each camera. Nobody waits for the console: what finds no room is
/// left out and counted. Thread-safe.
class ConsoleInbox {
 public:
  /// A batch to fill; nullptr while the console has not taken in those before.
  std::unique_ptr<BlockBatch> TakeEmpty();
  /// Gives a batch back, filled or not.
  void GiveBack(std::unique_ptr<BlockBatch> batch, bool is_filled);
  void Add(ConsoleEvent event);
  void SetDepth(DepthFramePtr frame);
  void SetThermal(ThermalFramePtr frame);

  // For the console's thread.
  /// Waits until there is something, at most for `patience`.
  void Wait(Nanoseconds patience, const std::stop_token& stop);
  std::unique_ptr<BlockBatch> TakeFilled();
  std::vector<ConsoleEvent> TakeEvents();
  DepthFramePtr TakeDepth();
  ThermalFramePtr TakeThermal();

  /// How many clients look. Nothing is copied for nobody.
  std::atomic<int> viewers{0};
  /// A program that asks for a place looks on for a while, too. Returns whether anybody did before.
  bool LookOn(SteadyTime now) {
    const bool was_watched = IsWatched(now);
    watched_until_ = now + kLooksOn;
    return was_watched;
  }
  bool IsWatched(SteadyTime now) const { return viewers > 0 || now < watched_until_.load(); }
  /// How many of them want images with all their values.
  std::atomic<int> raw_viewers{0};
  /// Something of the model was not copied yet.
  std::atomic<bool> is_behind{false};

 private:
  static constexpr Nanoseconds kLooksOn = std::chrono::seconds(10);
  static constexpr std::size_t kBatches = 2;
  static constexpr std::size_t kMaxEvents = 4096;

  std::atomic<SteadyTime> watched_until_{SteadyTime::min()};
  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  std::size_t made_ GUARDED_BY(mutex_) = 0;
  std::vector<std::unique_ptr<BlockBatch>> empty_ GUARDED_BY(mutex_);
  std::vector<std::unique_ptr<BlockBatch>> filled_ GUARDED_BY(mutex_);  ///< Oldest first.
  std::vector<ConsoleEvent> events_ GUARDED_BY(mutex_);
  DepthFramePtr depth_ GUARDED_BY(mutex_);
  ThermalFramePtr thermal_ GUARDED_BY(mutex_);
  bool is_changed_ GUARDED_BY(mutex_) = false;
  std::uint64_t dropped_events_ GUARDED_BY(mutex_) = 0;
};

}  // namespace isotherm

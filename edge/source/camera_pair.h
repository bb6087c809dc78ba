#pragma once

#include <atomic>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <stop_token>
#include <string_view>
#include <thread>
#include <vector>

#include "common/concurrency/bounded_queue.h"
#include "edge/source/frame_source.h"
#include "edge/source/merge_queue.h"
#include "edge/source/supervised_source.h"

namespace isotherm {

/// The cameras of the rig as one source. Each is opened, read, supervised and closed on a thread of
/// its own, so that one that fails, hangs or is not there does not hold up the other.
///
///   depth camera   -> SupervisedSource -> queue -+
///   |------------ camera thread -------------|   +-> Read, in order of arrival
///   thermal camera -> SupervisedSource -> queue -+
///
/// The cameras run from Open on; what they deliver counts from the first Read on, unless the queue
/// makes them wait: then nothing is thrown away. A camera that is missing at the start is tried
/// again like one that is lost later. Thread-bound, as any source; the cameras' threads are its
/// own.
class CameraPair final : public FrameSource {
 public:
  /// An edge has one or two orders under way. A camera that answers none is refused more, so that
  /// neither queue can block the other's thread.
  static constexpr std::size_t kMaxOrders = 8;

  /// Holds one of the cameras that a pair reads.
  struct Camera {
    Sensor sensor = Sensor::kDepth;
    std::unique_ptr<SupervisedSource> source;
  };
  /// Says how frames wait for their turn; each camera has a queue of its own.
  struct Queue {
    std::size_t capacity = 8;  ///< Frames per camera.
    OverflowPolicy policy = OverflowPolicy::kDropOldest;
    std::function<void(Sensor)> on_drop;  ///< Called with the queue locked: may count, no more.
  };

  /// One or two cameras.
  CameraPair(std::vector<Camera> cameras, Queue queue);
  ~CameraPair() override;

  std::string_view name() const override { return "cameras"; }
  /// Fails if no camera can be opened, or if one is asked for something that it cannot do
  /// (kInvalidArgument): trying again would not help.
  Status Open() override;
  Result<SourceItem> Read(std::stop_token stop) override;
  void Close() override;
  std::optional<RawFrame> TakeUnread() override;
  /// For the thermal camera's thread, which passes it on within 0.1 s if the camera works. Refused
  /// while kMaxOrders have no answer.
  std::optional<Status> Control(const CameraControl& control) override;
  std::vector<ControlAnswer> TakeControlAnswers() override;
  /// Returns what the cameras said of themselves when they were opened at the start.
  std::optional<Rig> rig() const override { return rig_; }
  std::vector<CameraDescription> cameras() const override { return descriptions_; }

 private:
  /// Holds how a camera's first Open went.
  struct Opened {
    Status status;
    std::optional<Rig> rig;
    std::vector<CameraDescription> descriptions;
  };
  /// Holds a camera, the thread that reads it and what both exchange.
  struct Member {
    Camera camera;
    // Never full: no more than kMaxOrders are under way.
    BoundedQueue<CameraControl> orders{kMaxOrders, OverflowPolicy::kBlock};
    BoundedQueue<ControlAnswer> answers{kMaxOrders, OverflowPolicy::kBlock};
    std::promise<Opened> opened;
    std::promise<bool> may_run;      ///< False: the pair could not be opened, its threads end.
    std::atomic<bool> ended{false};  ///< Its thread takes no orders any more.
    std::jthread thread;
  };

  void Run(std::size_t index, const std::stop_token& stop);
  static void PassOrders(Member& member);
  Member* Thermal() const;
  /// Adds a camera to what is known of the rig and its cameras.
  void AddDescription(const Opened& opened);

  std::vector<std::unique_ptr<Member>> members_;
  std::size_t open_orders_ = 0;  ///< Given and not answered; only the reader's thread uses it.
  std::atomic<bool> reading_{false};
  const bool waits_;  ///< A full queue makes its camera wait (OverflowPolicy::kBlock).
  MergeQueue queue_;
  std::optional<Rig> rig_;
  std::vector<CameraDescription> descriptions_;
};

}  // namespace isotherm

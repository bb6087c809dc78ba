#pragma once

#include <condition_variable>
#include <cstdint>
#include <memory>
#include <optional>
#include <thread>
#include <vector>

#include "common/base/mutex.h"
#include "common/transport/announcement.h"
#include "ground/subscriber/subscriber.h"
#include "tests/link/edge_side.h"

namespace isotherm {

/// A ground station that only looks at what it gets.
class GroundSide {
 public:
  GroundSide(const TransportEnvironment& environment, const Clock& clock, int domain,
             Nanoseconds work_per_frame = Nanoseconds(0))
      : work_per_frame_(work_per_frame) {
    participant_ = std::move(
        *Participant::Create(environment, domain, Announcement{Role::kGround, "", "desk"}));
    SubscriberOptions options;
    options.edge_id = "test-edge";
    SubscriberHandlers handlers;
    handlers.depth = [this](const ReceivedDepth& item) { Take(*item.encoded, &depth_); };
    handlers.thermal = [this](const ReceivedThermal& item) { Take(*item.encoded, &thermal_); };
    handlers.late_depth = [this](const ReceivedDepth& item) { Take(*item.encoded, &late_depth_); };
    handlers.external_odometry = [this](const ExternalOdometrySample& sample) {
      Update([&]() REQUIRES(mutex_) { external_odometry_.push_back(sample.number); });
    };
    handlers.rig = [this](const RigDescription& rig) {
      Update([&]() REQUIRES(mutex_) { rig_session_ = rig.session; });
    };
    handlers.command_result = [this](const CommandResult& result) {
      Update([&]() REQUIRES(mutex_) { result_ = result; });
    };
    handlers.session_end = [this](const SessionCounters& counters) {
      Update([&]() REQUIRES(mutex_) { ended_.push_back(counters); });
    };
    subscriber_ = std::move(*Subscriber::Create(*participant_, clock, options, handlers));
    receiver_ = std::jthread([this](const std::stop_token& stop) { subscriber_->Run(stop); });
  }

  Subscriber& subscriber() { return *subscriber_; }
  void Stop() {
    receiver_.request_stop();
    receiver_.join();
  }

  /// The counters of the session that ended as number `count`.
  std::optional<SessionCounters> AwaitSessionEnd(std::size_t count = 1) {
    MutexLock lock(mutex_);
    if (!changed_.wait_for(lock, kLinkPatience,
                           [&]() REQUIRES(mutex_) { return ended_.size() >= count; }))
      return {};
    return ended_[count - 1];
  }
  bool AwaitDepth(std::size_t count) {
    MutexLock lock(mutex_);
    return changed_.wait_for(lock, kLinkPatience,
                             [&]() REQUIRES(mutex_) { return depth_.size() >= count; });
  }
  /// Waits for frames that come behind their place.
  bool AwaitLateDepth(std::size_t count) {
    MutexLock lock(mutex_);
    return changed_.wait_for(lock, kLinkPatience,
                             [&]() REQUIRES(mutex_) { return late_depth_.size() >= count; });
  }
  std::vector<std::uint64_t> late_depth() const {
    MutexLock lock(mutex_);
    return late_depth_;
  }
  std::vector<std::uint64_t> AwaitExternalOdometry(std::size_t count) {
    MutexLock lock(mutex_);
    changed_.wait_for(lock, kLinkPatience,
                      [&]() REQUIRES(mutex_) { return external_odometry_.size() >= count; });
    return external_odometry_;
  }
  std::optional<CommandResult> AwaitResult() {
    MutexLock lock(mutex_);
    changed_.wait_for(lock, kLinkPatience, [&]() REQUIRES(mutex_) { return result_.has_value(); });
    return result_;
  }
  std::vector<std::uint64_t> depth() const {
    MutexLock lock(mutex_);
    return depth_;
  }
  std::vector<std::uint64_t> thermal() const {
    MutexLock lock(mutex_);
    return thermal_;
  }
  int corrupt() const {
    MutexLock lock(mutex_);
    return corrupt_;
  }
  std::optional<std::uint64_t> rig_session() const {
    MutexLock lock(mutex_);
    return rig_session_;
  }

 private:
  template <typename Function>
  void Update(Function update) {
    MutexLock lock(mutex_);
    update();
    changed_.notify_all();
  }
  template <typename Encoded>
  void Take(const Encoded& frame, std::vector<std::uint64_t>* numbers) {
    const std::uint64_t number = frame.header.frame_number;
    // A consumer that is slower than the sender.
    if (work_per_frame_ > Nanoseconds(0)) std::this_thread::sleep_for(work_per_frame_);
    bool good = true;
    for (std::size_t i = 0; i < frame.image.payload.size(); i += kMarkEvery) {
      good = good && frame.image.payload[i] == Mark(number, i);
    }
    Update([&]() REQUIRES(mutex_) {
      numbers->push_back(number);
      if (!good) ++corrupt_;
    });
  }

  const Nanoseconds work_per_frame_;
  std::unique_ptr<Participant> participant_;
  std::unique_ptr<Subscriber> subscriber_;
  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  std::vector<std::uint64_t> depth_ GUARDED_BY(mutex_);
  std::vector<std::uint64_t> thermal_ GUARDED_BY(mutex_);
  std::vector<std::uint64_t> late_depth_ GUARDED_BY(mutex_);
  std::vector<std::uint64_t> external_odometry_ GUARDED_BY(mutex_);
  std::optional<std::uint64_t> rig_session_ GUARDED_BY(mutex_);
  std::optional<CommandResult> result_ GUARDED_BY(mutex_);
  std::vector<SessionCounters> ended_ GUARDED_BY(mutex_);
  int corrupt_ GUARDED_BY(mutex_) = 0;
  std::jthread receiver_;
};

inline std::vector<std::uint64_t> Range(std::uint64_t first, std::uint64_t end) {
  std::vector<std::uint64_t> numbers;
  for (std::uint64_t i = first; i < end; ++i) numbers.push_back(i);
  return numbers;
}

}  // namespace isotherm

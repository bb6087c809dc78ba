#pragma once

#include <atomic>
#include <condition_variable>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/mutex.h"
#include "edge/publisher/publisher.h"

namespace isotherm {

/// A link that keeps what is published. Can be broken, and can hold frames back until released.
/// Thread-safe.
class FakePublisher final : public Publisher {
 public:
  void Run(std::stop_token stop, const PublisherHandlers& handlers) override {
    for (const Command& command : commands) handlers.command(command);
    for (const auto& [message, arrival] : feedback) handlers.feedback(message, arrival, true);
    handed_over_ = true;
    MutexLock lock(mutex_);
    changed_.wait(lock, stop, [] { return false; });
  }
  bool WaitForGround(Nanoseconds, std::stop_token) override { return true; }
  Status BeginSession(const RigDescription& rig, const SessionBefore& /*before*/) override {
    MutexLock lock(mutex_);
    session_rig_ = rig;
    ++sessions_;
    return OkStatus();
  }
  Status Announce(const RigDescription& rig) override {
    MutexLock lock(mutex_);
    if (broken_) return Unavailable("no link");
    announced_.push_back(rig);
    return OkStatus();
  }
  bool TakesNext(Sensor sensor, std::size_t /*newer*/) override {
    return !leaves_all_of || *leaves_all_of != sensor;
  }
  Status Publish(const EncodedDepthFrame& frame, std::stop_token stop) override {
    return Take(frame, &depth_, stop);
  }
  Status Publish(const EncodedThermalFrame& frame, std::stop_token stop) override {
    return Take(frame, &thermal_, stop);
  }
  Result<bool> Backfill(const EncodedDepthFrame&, int, const std::stop_token&) override {
    return false;
  }
  Result<bool> Backfill(const EncodedThermalFrame&, int, const std::stop_token&) override {
    return false;
  }
  Status Publish(const ExternalOdometrySample& sample, std::stop_token) override {
    MutexLock lock(mutex_);
    if (broken_) return Unavailable("no link");
    external_odometry_.push_back(sample);
    return OkStatus();
  }
  Status Publish(EdgeStatus status) override {
    MutexLock lock(mutex_);
    statuses_.push_back(std::move(status));
    return OkStatus();
  }
  Status Answer(const CommandResult& result) override {
    MutexLock lock(mutex_);
    answers_.push_back(result);
    return OkStatus();
  }
  bool Drain(Nanoseconds) override { return true; }
  void SetPolicy(PublishPolicy policy) override { policy_ = policy; }
  PublisherStats stats() const override {
    PublisherStats stats;
    MutexLock lock(mutex_);
    stats.problem = problem_;
    return stats;
  }
  std::optional<Receipt> receipt() const override { return std::nullopt; }
  SessionBefore so_far() const override { return {}; }

  /// Frames of this camera are left for later.
  std::optional<Sensor> leaves_all_of;
  /// Commands and feedback, with its arrival, that the ground sends at the start of Run.
  std::vector<Command> commands;
  std::vector<std::pair<Feedback, CaptureTime>> feedback;

  /// Says whether Run has handed them over.
  bool handed_over() const { return handed_over_; }

  void Break() { broken_ = true; }
  void Mend() { broken_ = false; }
  /// Sets why there is no network; empty if there is one.
  void SetProblem(std::string problem) {
    MutexLock lock(mutex_);
    problem_ = std::move(problem);
  }
  /// Publish waits from now on until it is released or stop is requested.
  void Hold() {
    MutexLock lock(mutex_);
    held_ = true;
  }
  void Release() {
    MutexLock lock(mutex_);
    held_ = false;
    changed_.notify_all();
  }
  std::vector<EncodedDepthFrame> depth() const {
    MutexLock lock(mutex_);
    return depth_;
  }
  std::vector<EncodedThermalFrame> thermal() const {
    MutexLock lock(mutex_);
    return thermal_;
  }
  std::vector<ExternalOdometrySample> external_odometry() const {
    MutexLock lock(mutex_);
    return external_odometry_;
  }
  RigDescription session_rig() const {
    MutexLock lock(mutex_);
    return session_rig_;
  }
  /// Returns the rigs that were announced after the beginning of the session.
  std::vector<RigDescription> announced() const {
    MutexLock lock(mutex_);
    return announced_;
  }
  std::vector<CommandResult> answers() const {
    MutexLock lock(mutex_);
    return answers_;
  }
  std::vector<EdgeStatus> statuses() const {
    MutexLock lock(mutex_);
    return statuses_;
  }
  std::optional<PublishPolicy> policy() const { return policy_; }
  int sessions() const { return sessions_; }

 private:
  template <typename Frame>
  Status Take(const Frame& frame, std::vector<Frame>* frames, const std::stop_token& stop) {
    MutexLock lock(mutex_);
    if (broken_) return Unavailable("no link");
    changed_.wait(lock, stop, [this]() REQUIRES(mutex_) { return !held_; });
    frames->push_back(frame);
    return OkStatus();
  }

  mutable Mutex mutex_;
  std::condition_variable_any changed_;
  bool held_ GUARDED_BY(mutex_) = false;
  std::atomic<bool> broken_{false};
  std::atomic<bool> handed_over_{false};
  std::atomic<int> sessions_{0};
  std::optional<PublishPolicy> policy_;
  std::vector<EncodedDepthFrame> depth_ GUARDED_BY(mutex_);
  std::vector<EncodedThermalFrame> thermal_ GUARDED_BY(mutex_);
  std::vector<ExternalOdometrySample> external_odometry_ GUARDED_BY(mutex_);
  RigDescription session_rig_ GUARDED_BY(mutex_);
  std::vector<RigDescription> announced_ GUARDED_BY(mutex_);
  std::vector<CommandResult> answers_ GUARDED_BY(mutex_);
  std::vector<EdgeStatus> statuses_ GUARDED_BY(mutex_);
  std::string problem_ GUARDED_BY(mutex_);
};

}  // namespace isotherm

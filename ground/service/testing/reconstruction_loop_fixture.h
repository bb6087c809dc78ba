#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>
#include <vector>

#include "common/testing/temporary_directory.h"
#include "ground/options/option_geometry.h"
#include "ground/service/reconstruction_loop.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/surface/testing/small_volume.h"

namespace isotherm {

/// Keeps the feedback that goes to the rig.
class FakeSubscriber final : public Subscriber {
 public:
  void Run(std::stop_token /*stop*/) override {}
  bool Leave(const std::function<bool()>& /*go_on*/) override { return true; }
  Status Join(const Participant& /*participant*/) override { return OkStatus(); }
  Status Publish(const Feedback& feedback) override {
    published.push_back(feedback);
    if (on_publish) on_publish();
    return works ? OkStatus() : Unavailable("no link");
  }
  Result<std::uint64_t> Send(Command /*command*/) override { return 0; }
  void AddRecorded(RecordedNumbers numbers) override {
    told += numbers.frames.size();
    recorded.push_back(std::move(numbers));
  }
  SubscriberStats stats() const override { return {}; }
  SessionCounters counters(std::uint64_t session) const override {
    SessionCounters counters;
    counters.session = session;
    return counters;
  }
  const RefusalCounter& refusals() const override { return refusals_; }

  bool works = true;
  std::function<void()> on_publish;  ///< On the loop's thread.
  std::vector<Feedback> published;   ///< Not while the loop runs.
  std::vector<RecordedNumbers> recorded;
  std::atomic<std::size_t> told{0};  ///< Frames of these.

 private:
  RefusalCounter refusals_;
};

/// A loop on a thread of its own, and behind it a thread that writes results.
class ReconstructionLoopTest : public ::testing::Test {
 protected:
  ReconstructionLoopTest() {
    VolumeOptions& volume = *options_.mutable_volume();
    volume = testing::SmallVolume();
    *volume.mutable_expert()->mutable_initial_pose() = ToOptions(testing::FirstPose());
    options_.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(
        testing::kSmallTruncation_m);
    options_.mutable_calibration_check()->mutable_expert()->set_enabled(false);
    options_.mutable_live()->set_output_dir(folder_.path().string());
    options_.set_threads(1);
  }
  ~ReconstructionLoopTest() override { End(); }

  std::filesystem::path Folder(std::uint64_t session) const {
    return folder_.path() / std::to_string(session);
  }
  static Rig MakeRig() {
    Rig rig;
    rig.depth = testing::SmallDepthCamera();
    rig.thermal = rig.depth;
    rig.T_thermal_depth = MakeTransform({0.02, 0.0, 0.0}, Eigen::Quaterniond::Identity());
    return rig;
  }
  void Start(std::uint64_t session, const Rig& rig = MakeRig()) {
    SessionStart start;
    start.rig.session = session;
    start.rig.rig = rig;
    start.folder = Folder(session);
    start.recording = std::make_shared<RecordingTracker>();
    start.recording->Update([](RecordingProgress& progress) { progress.closed = true; });
    queue_.Push(start, {});
  }
  void Close(std::uint64_t session) {
    SessionCounters counters;
    counters.session = session;
    queue_.Push(counters, {});
  }
  static CaptureTime Time(double frame) { return CaptureTime(FromSeconds(100.0 + frame / 30.0)); }
  static DepthFramePtr MakeDepth(std::uint64_t session, int i) {
    auto depth = std::make_shared<DepthFrame>(testing::RenderDepth(
        testing::BallInCorner, *MakeRig().depth,
        testing::FirstPose() *
            MakeTransform({0.003 * i, 0.0015 * i, 0.0}, Eigen::Quaterniond::Identity())));
    depth->header = {
        .session = session, .frame_number = static_cast<std::uint64_t>(i), .capture_time = Time(i)};
    return depth;
  }
  static ThermalFramePtr MakeThermal(std::uint64_t session, int i) {
    auto thermal = std::make_shared<ThermalFrame>();
    thermal->header = {.session = session,
                       .frame_number = static_cast<std::uint64_t>(i),
                       .capture_time = Time(i - 0.5)};
    thermal->temperature_raw =
        Image<std::uint16_t>(MakeRig().thermal->width, MakeRig().thermal->height, 32'315);
    thermal->valid = true;
    return thermal;
  }
  /// Frames `first` .. `last` of a moving rig that have waited for `queued`, a thermal frame before
  /// each but the first of all.
  void FramesBetween(int first, int last, Nanoseconds queued = {}, std::uint64_t session = 0) {
    const CaptureTime arrival = clock_.Now() - queued;
    for (int i = first; i <= last; ++i) {
      if (i > 0)
        queue_.Push(ReceivedThermal{MakeThermal(session, i), nullptr, arrival, arrival}, {});
      queue_.Push(ReceivedDepth{MakeDepth(session, i), nullptr, arrival, arrival}, {});
    }
  }
  void Frames(int count, Nanoseconds queued = {}) { FramesBetween(0, count - 1, queued); }

  void Run() {
    loop_thread_ = std::jthread([this](const std::stop_token& stop) { loop_.Run(queue_, stop); });
    result_thread_ = std::jthread([this](const std::stop_token& stop) { results_.Run(stop); });
  }
  /// The test's own time limit is the bound.
  void AwaitResults(int scans) {
    while (written_ < scans) std::this_thread::yield();
  }
  void End() {
    loop_thread_.request_stop();
    if (loop_thread_.joinable()) loop_thread_.join();
    result_thread_.request_stop();
    if (result_thread_.joinable()) result_thread_.join();
  }
  nlohmann::json Stats(std::uint64_t session) const {
    return nlohmann::json::parse(std::ifstream(Folder(session) / "stats.json"), nullptr, false);
  }
  /// Feedback that went to the recording.
  std::vector<Feedback> Recorded() {
    std::vector<Feedback> recorded;
    std::optional<SessionItem> item;
    while (recording_.Pop(Nanoseconds(0), {}, item) == RecordingQueue::Outcome::kItem)
      recorded.push_back(std::get<Feedback>(*item));
    return recorded;
  }

  const testing::TemporaryDirectory folder_;
  FakeClock clock_{CaptureTime(FromSeconds(1000.0))};
  GroundOptions options_;
  FakeSubscriber subscriber_;
  RecordingQueue recording_{{.items = 1000, .bytes = 1U << 20}};
  ScanBoard board_;
  ThreadProgress progress_, reading_, result_progress_;
  std::atomic<int> written_{0};
  ResultWriter results_{
      options_,
      clock_,
      [this](std::uint64_t session) { return subscriber_.counters(session); },
      board_,
      result_progress_,
      {.written = [this](const std::unique_ptr<LiveScan>&) { ++written_; }, .completed = {}}};
  SessionQueue queue_{1000, OverflowPolicy::kBlock};
  ReconstructionLoop loop_{
      options_, clock_, {subscriber_, recording_, results_, board_, progress_, reading_}};
  std::jthread loop_thread_, result_thread_;
};

}  // namespace isotherm

// Two cameras, one of them in a process of its own that crashes or hangs when it is told to.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "edge/camera_process/testing/fake_process.h"
#include "edge/options/edge_options.pb.h"
#include "edge/source/camera_pair.h"

namespace isotherm {
namespace {

using std::chrono::milliseconds;

constexpr std::chrono::seconds kPatience{20};

/// Counts up in this process, a frame a millisecond.
class SteadyCamera final : public FrameSource {
 public:
  std::string_view name() const override { return "steady camera"; }
  Status Open() override { return OkStatus(); }
  Result<SourceItem> Read(std::stop_token) override {
    std::this_thread::sleep_for(milliseconds(1));  // The camera's period.
    RawFrame frame;
    frame.sensor = Sensor::kDepth;
    frame.frame_number = number_++;
    frame.arrival_wall = clock_.Now();
    frame.pixels = Image<std::uint16_t>(4, 3, 700);
    return frame;
  }
  void Close() override {}

 private:
  const SystemClock clock_{};
  std::uint64_t number_ = 0;
};

TEST(CameraProcessPairTest, F14WhileOneLibraryCrashesAndHangsTheOtherCameraLosesNoFrame) {
  const SystemClock clock{};
  FrameCheckOptions options;
  options.mutable_expert()->set_retry_min_s(0.05);
  for (const char* what : {"crash", "hang"}) {
    const auto ignore = [](Sensor) {};
    int dropped = 0;
    std::vector<CameraPair::Camera> cameras;
    cameras.push_back(
        {Sensor::kDepth, std::make_unique<SupervisedSource>(std::make_unique<SteadyCamera>(),
                                                            options, clock, ignore, ignore)});
    cameras.push_back({Sensor::kThermal, std::make_unique<SupervisedSource>(
                                             std::make_unique<CameraProcess>(Fake(what, 5), clock),
                                             options, clock, ignore, ignore)});
    CameraPair pair(std::move(cameras),
                    {1000, OverflowPolicy::kDropOldest, [&dropped](Sensor) { ++dropped; }});
    ASSERT_TRUE(pair.Open().ok());
    // Until the process has died, was started again, and has delivered: frames 5 and later.
    std::uint64_t next_depth = 0;
    std::uint64_t thermal = 0;
    const SteadyTime end = clock.SteadyNow() + kPatience;
    while (thermal < 5 && clock.SteadyNow() < end) {
      const Result<SourceItem> item = pair.Read({});
      const auto* frame = item ? std::get_if<RawFrame>(&*item) : nullptr;
      if (frame == nullptr) continue;
      if (frame->sensor == Sensor::kThermal) thermal = std::max(thermal, frame->frame_number);
      if (frame->sensor != Sensor::kDepth) continue;
      ASSERT_EQ(frame->frame_number, next_depth) << what;
      ++next_depth;
    }
    EXPECT_GE(thermal, 5U) << what << ": not started again";
    EXPECT_EQ(dropped, 0);
    EXPECT_GT(next_depth, 0U);
  }
}

}  // namespace
}  // namespace isotherm

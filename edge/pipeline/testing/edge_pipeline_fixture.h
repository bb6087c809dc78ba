#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <string_view>
#include <thread>
#include <utility>

#include "edge/options/edge_options.pb.h"
#include "edge/pipeline/edge_pipeline.h"
#include "edge/publisher/testing/fake_publisher.h"
#include "edge/source/supervised_source.h"
#include "edge/source/testing/fake_source.h"
#include "edge/spool/testing/fake_recording_writer.h"

namespace isotherm {

inline constexpr std::uint64_t kEdgeSession = 77;

/// An edge from a camera that does what a script says to a recording and a link that keep what they
/// are given.
class EdgePipelineFixture : public testing::Test {
 protected:
  EdgePipelineFixture() { options_.mutable_source()->set_rate(0); }

  void Start(std::string_view script, bool record = true) {
    auto camera = std::make_unique<FakeSource>(script);
    camera->control_answer = control_answer_;
    if (counts_only_) camera->DescribeThermal(true);
    camera->thermal_scale = thermal_scale_;
    camera_ = camera.get();
    source_ = std::make_unique<SupervisedSource>(
        std::move(camera), options_.frame_check(), clock_,
        [this](Sensor sensor) { counters_.Count(sensor, FrameFate::kCaptured); },
        [this](Sensor sensor) { counters_.Count(sensor, FrameFate::kRejected); }, Nanoseconds(0));
    ASSERT_TRUE(source_->Open().ok());
    std::unique_ptr<Spool> spool;
    if (record) {
      spool = MakeFakeSpool(recording_, options_.spool(), clock_, counters_, disk_room_);
    }
    pipeline_ = std::make_unique<EdgePipeline>(
        options_, EdgeParts{.source = *source_,
                            .publisher = publisher_,
                            .counters = counters_,
                            .health = health_,
                            .clock = clock_,
                            .spool = std::move(spool),
                            .session = kEdgeSession,
                            .rig_thermal_delay_s = rig_thermal_delay_s_});
    pipeline_->StartReceiving();
    pipeline_->StartCapture();
  }
  /// The test's own time limit is the bound.
  Status RunToTheEnd() {
    while (!pipeline_->finished()) std::this_thread::yield();
    return pipeline_->Stop();
  }
  void ExpectBalancedCounters() {
    for (const Sensor sensor : {Sensor::kDepth, Sensor::kThermal}) {
      const SensorCounters counters = counters_.Get(sensor);
      EXPECT_EQ(counters.OnTheWayToDisk(), 0);
      EXPECT_EQ(counters.OnTheWayToGround(), 0);
    }
  }

  EdgeOptions options_;
  FakeClock clock_;
  FakePublisher publisher_;
  FakeRecording recording_;
  std::uint64_t disk_room_ = UINT64_MAX;
  double rig_thermal_delay_s_ = 0.0;
  FrameCounters counters_;
  CameraHealth health_;
  Status control_answer_ = FailedPrecondition("no shutter");
  bool counts_only_ = false;
  RadiometricScale thermal_scale_;
  FakeSource* camera_ = nullptr;
  std::unique_ptr<SupervisedSource> source_;
  std::unique_ptr<EdgePipeline> pipeline_;
};

}  // namespace isotherm

#include "edge/daemon/rig_announcer.h"

#include <gtest/gtest.h>

#include "edge/options/edge_options.pb.h"
#include "edge/publisher/testing/fake_publisher.h"
#include "edge/source/supervised_source.h"
#include "edge/source/testing/fake_source.h"

namespace isotherm {
namespace {

constexpr RadiometricScale kHotScale{0.02, 0.0};

/// An edge that began with its depth camera alone.
class RigAnnouncerTest : public ::testing::Test {
 protected:
  RigAnnouncerTest() {
    CameraDescription depth;
    depth.sensor = Sensor::kDepth;
    depth.serial = "D1";
    start_.cameras = {depth};
    start_.rig.emplace().thermal.emplace().width = 382;
    health_.SetOpened(depth);
  }

  static CameraDescription HotCamera() {
    CameraDescription camera;
    camera.sensor = Sensor::kThermal;
    camera.driver = "optris-sdk";
    camera.serial = "T1";
    camera.width = 382;
    camera.thermal_scale = kHotScale;
    return camera;
  }
  RigAnnouncer Make() {
    return {options_, start_, health_, publisher_,
            [this](RigUpdate update) { recorded_.push_back(std::move(update)); }};
  }

  EdgeOptions options_;
  EdgeSession start_;
  CameraHealth health_;
  FakePublisher publisher_;
  std::vector<RigUpdate> recorded_;
};

TEST_F(RigAnnouncerTest, WhatWasThereAtTheStartIsNotAnnouncedAgain) {
  RigAnnouncer announcer = Make();
  announcer.Tick();
  EXPECT_TRUE(publisher_.announced().empty());
  EXPECT_TRUE(recorded_.empty());
}

TEST_F(RigAnnouncerTest, ACameraThatComesLateIsAnnouncedAndRecordedOnceWithItsOwnScale) {
  EXPECT_EQ(DescribeRig(options_, start_).thermal.encoding, Encoding::kThermalStrips)
      << "at the start nothing but the calibration is known";
  RigAnnouncer announcer = Make();
  FakeClock clock;
  auto late = std::make_unique<FakeSource>("t");
  late->FailToOpen(1);
  late->descriptions = {HotCamera()};
  FrameCheckOptions retries;
  SupervisedSource camera(
      std::move(late), retries, clock, [](Sensor) {}, [](Sensor) {}, Nanoseconds(0));
  camera.OnOpened([this](const CameraDescription& opened) { health_.SetOpened(opened); });
  camera.KeepTrying(camera.Open());
  announcer.Tick();
  EXPECT_TRUE(publisher_.announced().empty()) << "it is not there yet";

  clock.Advance(std::chrono::hours(1));
  static_cast<void>(camera.Read({}));
  for (int i = 0; i < 3; ++i) announcer.Tick();
  ASSERT_EQ(publisher_.announced().size(), 1U);
  const RigDescription announced = publisher_.announced()[0];
  EXPECT_EQ(announced.rig.thermal_scale, kHotScale);
  EXPECT_EQ(announced.thermal.encoding, Encoding::kScaledThermalStrips);
  EXPECT_EQ(announced.thermal.serial, "T1");
  EXPECT_EQ(announced.depth.serial, "D1") << "and what was known stays";
  EXPECT_EQ(announced.session, start_.session());
  ASSERT_EQ(recorded_.size(), 1U);
  EXPECT_EQ(recorded_[0].rig->thermal_scale, kHotScale);
  EXPECT_EQ(recorded_[0].cameras.at("thermal_serial"), "T1");
  EXPECT_EQ(recorded_[0].cameras.at("depth_serial"), "D1");
}

TEST_F(RigAnnouncerTest, WhatTheLinkDoesNotTakeIsTriedAgain) {
  RigAnnouncer announcer = Make();
  health_.SetOpened(HotCamera());
  publisher_.Break();
  announcer.Tick();
  announcer.Tick();
  EXPECT_TRUE(publisher_.announced().empty());
  publisher_.Mend();
  for (int i = 0; i < 3; ++i) announcer.Tick();
  ASSERT_EQ(publisher_.announced().size(), 1U);
  EXPECT_EQ(publisher_.announced()[0].rig.thermal_scale, kHotScale);
  EXPECT_EQ(recorded_.size(), 1U) << "the recording needs no link";
}

TEST_F(RigAnnouncerTest, ACameraOfCountsLeavesTheCalibrationsScale) {
  RigAnnouncer announcer = Make();
  CameraDescription counts = HotCamera();
  counts.counts_only = true;
  health_.SetOpened(counts);
  announcer.Tick();
  ASSERT_EQ(publisher_.announced().size(), 1U);
  EXPECT_EQ(publisher_.announced()[0].rig.thermal_scale, kCentikelvin);
  EXPECT_EQ(publisher_.announced()[0].thermal.encoding, Encoding::kCounts16);
}

}  // namespace
}  // namespace isotherm

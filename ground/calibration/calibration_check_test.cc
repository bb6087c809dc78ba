#include "ground/calibration/calibration_check.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <stop_token>
#include <vector>

#include "common/base/noise.h"
#include "common/options/text_proto.h"
#include "common/simulation/simulated_scan.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/testing/temporary_directory.h"
#include "ground/calibration/texture_consistency.h"
#include "ground/pipeline/ground_pipeline.h"
#include "ground/scan/scan_model.h"
#include "ground/tracker/trajectory.h"

namespace isotherm {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::uint64_t kSeed = 20;
// Small cameras, large voxels and one or two reversals: two standard deviations of the estimate.
constexpr double kTolerance_s = 0.006;

std::string TextOf(const CalibrationCheckReport& report) {
  return fmt::format("{}", fmt::join(Describe(report), "\n"));
}

/// A simulated scan with small cameras, reconstructed once. Its thermal stamps are the true
/// exposures, to which tests add an error.
class CalibrationCheckTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    const isotherm::testing::TemporaryDirectory folder;
    std::ofstream(folder.path() / "rig.textproto") << R"(
depth { width: 256 height: 192 fx: 227 fy: 227 cx: 128.4 cy: 96.9 }
thermal { width: 191 height: 144 fx: 185.7 fy: 186 cx: 102.5 cy: 75 k1: -0.44 k2: 0.29 k3: -0.11 }
T_thermal_depth { tx: 0.05 ty: 0.01 tz: 0 qx: 0 qy: 0 qz: 0 qw: 1 })";
    SimulationOptions simulation;
    const Status parsed = ParseTextProto(R"(
duration_s: 12
depth { expert { depth_scale: 4000 disparity_noise_px: 0.03 disparity_step_px: 0.03125 } }
shutter { first_s: 5 })",
                                         "simulation", simulation);
    ASSERT_TRUE(parsed.ok()) << parsed.message();
    simulation.set_seed(kSeed);
    simulation.set_rig_file(folder.path() / "rig.textproto");
    Result<std::unique_ptr<SimulatedScan>> scan = SimulatedScan::Create(simulation);
    ASSERT_TRUE(scan) << scan.error().message();
    rig_ = std::make_unique<Rig>((*scan)->rig());
    pipeline_ = MakePipeline((*scan)->PoseAt((*scan)->depth_times()[0].exposure));
    with_gaps_ = MakePipeline((*scan)->PoseAt((*scan)->depth_times()[0].exposure));
    Reconstruct(**scan);
  }
  static void TearDownTestSuite() {
    frames_.clear();
    pipeline_.reset();
    with_gaps_.reset();
    rig_.reset();
  }

  static std::unique_ptr<GroundPipeline> MakePipeline(const RigidTransform& initial_pose) {
    GroundOptions options;
    options.mutable_volume()->set_voxel_size_m(0.004);
    options.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(0.016);
    return GroundPipeline::Create(options, *rig_, initial_pose).value();
  }

  /// For 0.4 s of each second but the first.
  static bool IsDepthMissing(double scanned_s) {
    return scanned_s > 1.0 && scanned_s - std::floor(scanned_s) > 0.6;
  }

  static void Reconstruct(const SimulatedScan& scan) {
    SimulatedScan::Scratch scratch;
    for (std::uint64_t i = 0; i < scan.depth_times().size(); ++i) {
      RawFrame raw = scan.RenderDepth(i, scratch);
      DepthFrame frame;
      frame.header.frame_number = i;
      frame.header.capture_time = scan.depth_times()[i].exposure;
      frame.depth_raw = std::move(raw.pixels);
      frame.depth_scale = raw.depth_scale;
      pipeline_->ProcessDepth(frame);
      if (!IsDepthMissing(ToSeconds(frame.header.capture_time - scan.depth_times()[0].exposure)))
        with_gaps_->ProcessDepth(frame);
    }
    pipeline_->Finish();
    with_gaps_->Finish();
    for (std::uint64_t i = 0; i < scan.thermal_times().size(); i += 2) {
      auto frame = std::make_shared<ThermalFrame>();
      frame->header.frame_number = i;
      frame->header.capture_time = scan.thermal_times()[i].exposure;
      frame->valid = !scan.IsShutterClosed(frame->header.capture_time);
      frame->temperature_raw = scan.RenderThermal(i, scratch).pixels;
      frames_.push_back(std::move(frame));
    }
  }

  /// A third of the usual frames, for the test's time.
  static CalibrationCheckOptions Quick() {
    CalibrationCheckOptions options;
    options.mutable_expert()->set_max_frames(80);
    return options;
  }

  /// With thermal stamps late by `late_s`, each off by some more.
  static CalibrationCheck CheckOf(double late_s, std::optional<double> calibrated_s,
                                  const ScanModel& scan, const Rig& rig) {
    constexpr double kJitter_s = 0.001;
    CalibrationCheck check(Quick(), rig, calibrated_s);
    for (const std::shared_ptr<ThermalFrame>& frame : frames_) {
      auto late = std::make_shared<ThermalFrame>(*frame);
      late->header.capture_time +=
          FromSeconds(late_s + kJitter_s * NormalNoise(kSeed, frame->header.frame_number));
      check.Add(std::move(late), scan);
    }
    return check;
  }
  static CalibrationCheckReport Check(double late_s, std::optional<double> calibrated_s,
                                      const ScanModel& scan = pipeline_->model(),
                                      const Rig& rig = *rig_) {
    const CalibrationCheckReport report = CheckOf(late_s, calibrated_s, scan, rig).Finish(scan, {});
    std::printf("seed %d, stamps late by %+.1f ms, %.2f s:\n%s\n", static_cast<int>(kSeed),
                1e3 * late_s, report.elapsed_s, TextOf(report).c_str());
    return report;
  }

  inline static std::unique_ptr<Rig> rig_;
  inline static std::unique_ptr<GroundPipeline> pipeline_;
  inline static std::unique_ptr<GroundPipeline> with_gaps_;
  inline static std::vector<std::shared_ptr<ThermalFrame>> frames_;
};

TEST_F(CalibrationCheckTest, GivesUpWhileItLooksAtTheSurface) {
  std::stop_source stop;
  int reports_after = 0;
  const CalibrationCheckReport report = CheckOf(0.0, {}, pipeline_->model(), *rig_)
                                            .Finish(
                                                pipeline_->model(),
                                                [&](double) {
                                                  reports_after += stop.stop_requested() ? 1 : 0;
                                                  stop.request_stop();
                                                },
                                                stop.get_token());
  EXPECT_EQ(report.reason, "told to stop");
  EXPECT_FALSE(report.refinement);
  EXPECT_EQ(reports_after, 0);
}

TEST_F(CalibrationCheckTest, WhatIsRightAgrees) {
  const CalibrationCheckReport report = Check(0.0, -0.03);
  ASSERT_TRUE(report.verdict.Agrees()) << TextOf(report);
  EXPECT_EQ(Overall(report), CheckVerdict::kAgrees);
  EXPECT_EQ(WhatHasMoved(report), "");
  EXPECT_NEAR(report.refinement->correction[kDelay], 0.0, kTolerance_s);
  // Estimates of such scans, one reversal or two, spread by 2.8 ms (docs/timing.md).
  EXPECT_GT(report.refinement->Sigma(kDelay), 0.002);
  EXPECT_LT(report.refinement->Sigma(kDelay), 0.004);
  EXPECT_THAT(TextOf(report),
              AllOf(HasSubstr("calibrated -30.0 ms"), HasSubstr("delay ok, within")));
}

TEST_F(CalibrationCheckTest, AWrongDelayHasMoved) {
  const CalibrationCheckReport report = Check(-0.06, 0.0);
  ASSERT_EQ(report.verdict.delay, CheckVerdict::kMoved) << report.reason;
  EXPECT_NEAR(report.refinement->correction[kDelay], 0.06, kTolerance_s);
  EXPECT_THAT(TextOf(report),
              AllOf(HasSubstr("delay moved by"), HasSubstr("isotherm calibrate refine")));
  EXPECT_THAT(WhatHasMoved(report), HasSubstr("delay moved by"));
}

/// By half a degree, 1.6 pixels; and after the shutter closed, at 5 s, all is warmer by two
/// kelvin.
TEST_F(CalibrationCheckTest, ATurnedCameraAndAnOffsetBetweenNucsAreSaid) {
  Rig turned = *rig_;
  turned.T_thermal_depth->linear() =
      Eigen::AngleAxisd(0.0087, Eigen::Vector3d(1.0, 1.0, 0.0).normalized()).toRotationMatrix() *
      rig_->T_thermal_depth->linear();
  const std::vector<std::shared_ptr<ThermalFrame>> all = frames_;
  bool was_shut = false;
  for (std::shared_ptr<ThermalFrame>& frame : frames_) {
    was_shut = was_shut || !frame->valid;
    if (!was_shut) continue;
    frame = std::make_shared<ThermalFrame>(*frame);
    for (std::uint16_t& pixel : frame->temperature_raw.pixels()) pixel += 200;
  }
  const CalibrationCheckReport report = Check(0.0, 0.0, pipeline_->model(), turned);
  frames_ = all;
  ASSERT_TRUE(was_shut);
  ASSERT_TRUE(report.refinement) << report.reason;
  EXPECT_EQ(report.verdict.pose, CheckVerdict::kMoved);
  EXPECT_NEAR(report.refinement->shift.rms_px, 1.6, 0.5);
  EXPECT_EQ(report.verdict.delay, CheckVerdict::kAgrees);
  EXPECT_EQ(report.verdict.offset, CheckVerdict::kMoved);
  EXPECT_NEAR(report.refinement->epoch_offset->kelvin, 2.0, 0.2);
  EXPECT_THAT(WhatHasMoved(report), AllOf(HasSubstr("pose moved by"), Not(HasSubstr("delay"))));
}

TEST_F(CalibrationCheckTest, GapsOfTheDepthStreamDoNotMoveADelayThatIsRight) {
  const CalibrationCheckReport report = Check(0.0, 0.0, with_gaps_->model());
  EXPECT_FALSE(report.verdict.Moved()) << "may be told, or not assessed";
  EXPECT_TRUE(report.refinement || !report.reason.empty());
}

/// In each third second depth frames are missing for 0.4 s. Behind that the tracker slides along
/// what it cannot tell, and says how uncertain it is.
TEST_F(CalibrationCheckTest, PosesThatSlideBehindAGapAreNotUsed) {
  const ScanModel scan = pipeline_->model();
  const std::vector<StampedPose>& poses = scan.trajectory.poses();
  constexpr PoseSigma kCertain{.translation_m = 0.0002, .rotation_rad = 0.0003};
  constexpr PoseSigma kSlides{.translation_m = 0.012, .rotation_rad = 0.02};
  constexpr double kLags_s = 0.04;
  Trajectory trajectory;
  for (const StampedPose& pose : poses) {
    const double scanned_s = ToSeconds(pose.time - poses.front().time);
    const double in_third_s = std::fmod(scanned_s, 3.0) - 2.0;
    if (in_third_s > 0.0 && in_third_s < 0.4) continue;
    const bool slides = in_third_s >= 0.4;
    const auto T_map_depth = slides
                                 ? InterpolatePose(poses, pose.time - FromSeconds(kLags_s)).value()
                                 : pose.T_world_depth;
    trajectory.Add({pose.time, T_map_depth}, slides ? kSlides : kCertain, 0, scan.atlas);
  }
  const ScanModel with_slides{scan.rig,
                              scan.atlas,
                              trajectory,
                              scan.view,
                              scan.motion,
                              scan.uncertainty,
                              scan.external_odometry,
                              scan.counts,
                              scan.stages,
                              scan.spiller,
                              scan.thermal_status,
                              scan.is_continued,
                              scan.pool};
  const CalibrationCheckReport report = Check(0.0, 0.0, with_slides);
  ASSERT_EQ(report.verdict.delay, CheckVerdict::kAgrees) << report.reason;
  // With the slides it is 9 ms off, without them 2 to 4 ms, depending on how the compiler rounds.
  constexpr double kFarFromSlides_s = 0.006;
  EXPECT_NEAR(report.refinement->correction[kDelay], 0.0, kFarFromSlides_s);
}

TEST_F(CalibrationCheckTest, AFewFramesDoNotDecide) {
  const std::vector<std::shared_ptr<ThermalFrame>> all = frames_;
  frames_.resize(60);  // Three seconds.
  const CalibrationCheckReport report = Check(0.02, 0.0);
  frames_ = all;
  EXPECT_EQ(report.verdict.delay, CheckVerdict::kNotAssessed);
  EXPECT_FALSE(report.verdict.Moved());
  EXPECT_THAT(TextOf(report),
              ::testing::AnyOf(HasSubstr("cannot tell here"), HasSubstr("could not")));
}

TEST_F(CalibrationCheckTest, ASceneWithoutThermalContrastIsNotAssessed) {
  const std::vector<std::shared_ptr<ThermalFrame>> all = frames_;
  for (std::shared_ptr<ThermalFrame>& frame : frames_) {
    frame = std::make_shared<ThermalFrame>(*frame);
    const std::uint64_t stream = NoiseStream(kSeed, 9, frame->header.frame_number);
    std::uint64_t counter = 0;
    for (std::uint16_t& pixel : frame->temperature_raw.pixels())
      pixel = static_cast<std::uint16_t>(30'000.0F + 4.0F * NormalNoise(stream, counter++));
  }
  const CalibrationCheckReport report = Check(0.02, 0.0);
  frames_ = all;
  EXPECT_EQ(report.verdict.delay, CheckVerdict::kNotAssessed);
  EXPECT_THAT(report.reason, HasSubstr("warm and cold parts"));
}

TEST_F(CalibrationCheckTest, FramesWithoutACertainStampAreNotUsed) {
  const std::vector<std::shared_ptr<ThermalFrame>> all = frames_;
  for (std::shared_ptr<ThermalFrame>& frame : frames_) {
    frame = std::make_shared<ThermalFrame>(*frame);
    frame->header.capture_sigma = std::chrono::milliseconds(20);
  }
  const CalibrationCheckReport report = Check(0.02, 0.0);
  frames_ = all;
  EXPECT_EQ(report.verdict.delay, CheckVerdict::kNotAssessed);
  EXPECT_THAT(report.reason, HasSubstr("0 thermal frames"));
}

TEST_F(CalibrationCheckTest, OffKeepsAndSaysNothing) {
  CalibrationCheckOptions options;
  options.mutable_expert()->set_enabled(false);
  CalibrationCheck check(options, *rig_, 0.0);
  check.Add(frames_.front(), pipeline_->model());
  EXPECT_EQ(frames_.front().use_count(), 1);
  EXPECT_EQ(Overall(check.Finish(pipeline_->model(), {})), CheckVerdict::kOff);
}

TEST_F(CalibrationCheckTest, ABoundedNumberOfFramesIsKept) {
  CalibrationCheckOptions options;
  options.mutable_expert()->set_max_frames(50);
  CalibrationCheck check(options, *rig_, 0.0);
  for (const std::shared_ptr<ThermalFrame>& frame : frames_) check.Add(frame, pipeline_->model());
  long kept = 0;
  for (const std::shared_ptr<ThermalFrame>& frame : frames_) kept += frame.use_count() - 1;
  EXPECT_GE(kept, 25);
  EXPECT_LE(kept, 50);
}

TEST(CalibrationCheckReportTest, ACalibratedDelayIsClaimedOnlyWhereItIsKnown) {
  CalibrationCheckReport report;
  report.is_on = true;
  report.verdict.delay = CheckVerdict::kMoved;
  report.refinement.emplace();
  report.refinement->correction[kDelay] = -0.02;
  EXPECT_THAT(TextOf(report),
              AllOf(HasSubstr("delay moved by -20.0 ms"), Not(HasSubstr("calibrated +"))));
  report.calibrated_delay_s = 0.03;
  EXPECT_THAT(TextOf(report), HasSubstr("calibrated +30.0 ms"));
}

TEST(CalibrationCheckOptionsTest, OptionsAreChecked) {
  EXPECT_TRUE(Validate(CalibrationCheckOptions()).ok());
  const auto message = [](const auto& set) {
    CalibrationCheckOptions options;
    set(*options.mutable_expert());
    return Validate(options).message();
  };
  using Expert = CalibrationCheckExpertOptions;
  EXPECT_THAT(message([](Expert& o) { o.set_max_shift_s(0.0); }),
              HasSubstr("calibration_check.expert.max_shift_s"));
  EXPECT_THAT(message([](Expert& o) { o.set_max_shift_px(-1.0); }),
              HasSubstr("calibration_check.expert.max_shift_px"));
  EXPECT_THAT(message([](Expert& o) { o.set_max_influence(1.0); }),
              HasSubstr("calibration_check.expert.max_influence"));
  EXPECT_THAT(message([](Expert& o) { o.set_max_epoch_offset_k(NAN); }),
              HasSubstr("calibration_check.expert.max_epoch_offset_k"));
  EXPECT_THAT(message([](Expert& o) { o.set_max_frames(10); }),
              HasSubstr("calibration_check.expert.max_frames"));
}

}  // namespace
}  // namespace isotherm

// Thermal alignment on simulated heated walls with truth: what they add where the
// geometry leaves directions free, and that they add nothing where they say nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>
#include <vector>

#include "common/base/noise.h"
#include "common/simulation/depth_sensor.h"
#include "common/simulation/options.h"
#include "common/simulation/scene_builder.h"
#include "common/simulation/simulation_options.pb.h"
#include "common/simulation/thermal_sensor.h"
#include "ground/pipeline/ground_pipeline.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kSeed = 21;
constexpr double kPi = std::numbers::pi;
constexpr double kSeconds = 5.0;
constexpr double kDepthPeriod = 1.0 / 30.0;
constexpr double kThermalPeriod = 1.0 / 40.0;
constexpr double kThermalPhase = 0.0043;

enum class Pattern { kUniform, kStripes, kSpots };

/// A wall at z = 0.9 m, 45 °C, with warm spots or upright stripes every half metre.
Scene HeatedWall(Pattern pattern, double contrast_k, double cold_celsius = 45.0) {
  constexpr double kSpacing = 0.5;
  SceneBuilder builder(23.0);
  builder.UseMaterial({});
  for (int i = -3; i <= 6; ++i) {
    for (int j = -3; j <= 4; ++j) {
      const Eigen::Vector3d low(i * kSpacing, j * kSpacing, 0.9);
      const Eigen::Vector3d high = low + Eigen::Vector3d(kSpacing, kSpacing, 0.1);
      const Eigen::Vector3d middle(low.x() + kSpacing / 2, low.y() + kSpacing / 2, 0.9);
      Primitive& part = builder.Box("wall", low, high);
      part.temperature = pattern == Pattern::kUniform
                             ? Uniform(cold_celsius)
                             : Radial(part, middle,
                                      pattern == Pattern::kSpots ? Eigen::Vector3d::UnitZ()
                                                                 : Eigen::Vector3d::UnitY(),
                                      cold_celsius + contrast_k, kSpacing / 2, cold_celsius);
    }
  }
  return builder.Build("heated wall");
}

/// Along the wall at about 0.2 m/s, never at the same speed or in the same direction, turning about
/// the line of sight; from rest.
class Walk {
 public:
  Walk() {
    Eigen::Vector2d position(0.0, 0.5);
    const int steps = static_cast<int>(std::ceil((kSeconds + 1.0) / kStep));
    for (int i = 0; i < steps; ++i) {
      const double t = kStep * i;
      positions_.push_back(position);
      const double start = std::min(1.0, t / 0.3);
      const double speed = 0.2 * start * (0.75 + 0.25 * std::sin(2.0 * kPi * t / 1.7));
      const double heading = 0.8 * std::sin(2.0 * kPi * t / 2.3);
      position += kStep * speed * Eigen::Vector2d(std::cos(heading), std::sin(heading));
    }
  }
  RigidTransform PoseAt(double seconds) const {
    const double i = std::max(0.0, seconds) / kStep;
    const auto whole = static_cast<std::size_t>(i);
    const double part = i - static_cast<double>(whole);
    const Eigen::Vector2d p = (1.0 - part) * positions_[whole] + part * positions_[whole + 1];
    const double roll = 0.08 * std::sin(2.0 * kPi * std::max(0.0, seconds) / 3.1);
    return MakeTransform({p.x(), p.y(), 0.3},
                         Eigen::Quaterniond(Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ())));
  }

 private:
  static constexpr double kStep = 0.001;
  std::vector<Eigen::Vector2d> positions_;
};

struct Outcome {
  double end_m = 0.0;  ///< Off along the wall, at the end ...
  double rms_x_m = 0.0, rms_y_m = 0.0;
  double end_deg = 0.0;  ///< and about the normal.
  double across_m = 0.0;
  double sigma_m = 0.0;  ///< The pipeline's own sigma.
  int degraded = 0;
  int min_unobservable = 6;
  int max_unobservable = 0;
  int lost = 0;
  std::uint64_t fused = 0;
  double track_ms = 0.0;
};

struct Setting {
  bool use_thermal = true;
  double netd_k = 0.1;
  std::uint64_t seed = kSeed;
  double nuc_from =
      1e9;  ///< Frames from here on for 0.4 s repeat the last image and are not valid.
  double min_gradient_k_m = TrackerOptions().expert().thermal_min_gradient_k_m();
};

Rig MakeRig() {
  Rig rig = DefaultSimulatedRig();
  rig.depth = rig.depth->WithoutDistortion().Downscaled(1);
  return rig;
}

/// A depth image of half the size has half the disparity.
SimulatedDepthOptions DepthNoise() {
  SimulatedDepthOptions options = IdealDepthCamera({});
  options.mutable_expert()->set_disparity_noise_px(0.5 * options.expert().disparity_noise_px());
  options.mutable_expert()->set_disparity_step_px(0.5 * options.expert().disparity_step_px());
  return options;
}

SimulatedThermalOptions ThermalNoise(double netd_k) {
  SimulatedThermalOptions options = IdealThermalCamera({});
  options.mutable_expert()->set_rays_per_pixel_side(1);
  options.mutable_expert()->set_netd_kelvin(netd_k);
  return options;
}

GroundOptions MakeOptions(const Setting& setting) {
  GroundOptions options;
  VolumeOptions& volume = *options.mutable_volume();
  volume.set_voxel_size_m(0.004);
  volume.set_size_x_m(2.4);
  volume.mutable_expert()->set_min_x_m(-0.6);
  options.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(0.016);
  options.mutable_tracker()->set_use_thermal(setting.use_thermal);
  options.mutable_tracker()->mutable_expert()->set_thermal_min_gradient_k_m(
      setting.min_gradient_k_m);
  options.set_threads(2);
  return options;
}

/// A walk along the wall through the pipeline.
class WallScan {
 public:
  WallScan(const Scene& scene, const Setting& setting) : scene_(scene), setting_(setting) {
    auto created = GroundPipeline::Create(MakeOptions(setting), rig_, walk_.PoseAt(0.0));
    EXPECT_TRUE(created) << created.error().message();
    pipeline_ = std::move(*created);
  }

  Outcome Run() {
    const int frames = static_cast<int>(kSeconds / kDepthPeriod);
    for (int i = 0; i <= frames; ++i) {
      ShowThermalUntil(kDepthPeriod * i);
      ShowDepth(i);
    }
    outcome_.rms_x_m = std::sqrt(squares_.x() / frames);
    outcome_.rms_y_m = std::sqrt(squares_.y() / frames);
    const ScanModel& model = pipeline_->model();
    outcome_.sigma_m = model.uncertainty.surface_sigma_m();
    outcome_.fused = model.counts.thermal_fused;
    outcome_.track_ms = model.stages[Stage::kTrack]->Percentile(50);
    return outcome_;
  }

 private:
  static CaptureTime TimeAt(double seconds) { return CaptureTime(FromSeconds(100.0 + seconds)); }

  /// Shows the thermal frames that were taken by `now`.
  void ShowThermalUntil(double now) {
    for (;; ++thermal_number_) {
      const auto number = static_cast<double>(thermal_number_);
      const double taken = kThermalPeriod * number - kThermalPhase;
      if (taken > now) return;
      const bool shutter = taken >= setting_.nuc_from && taken < setting_.nuc_from + 0.4;
      if (!shutter) {
        image_ = thermal_sensor_.Render(
            scene_, walk_.PoseAt(taken) * rig_.T_thermal_depth->inverse(),
            NoiseStream(setting_.seed, 1, thermal_number_), thermal_scratch_);
      }
      auto frame = std::make_shared<ThermalFrame>();
      frame->header.frame_number = thermal_number_;
      frame->header.capture_time = TimeAt(taken);
      frame->temperature_raw = image_;
      frame->valid = !shutter;
      pipeline_->ProcessThermal(frame);
    }
  }

  void ShowDepth(int i) {
    const auto number = static_cast<std::uint64_t>(i);
    const RigidTransform truth = walk_.PoseAt(kDepthPeriod * i);
    DepthFrame frame;
    frame.header.frame_number = number;
    frame.header.capture_time = TimeAt(kDepthPeriod * i);
    frame.depth_raw =
        depth_sensor_.Render(scene_, truth, NoiseStream(setting_.seed, 0, number), depth_scratch_);
    const DepthReport report = pipeline_->ProcessDepth(frame);
    if (!report.tracked) {
      ++outcome_.lost;
      return;
    }
    if (i > 0) {
      const int unobservable = report.tracking.motion.unobservable_axes;
      outcome_.min_unobservable = std::min(outcome_.min_unobservable, unobservable);
      outcome_.max_unobservable = std::max(outcome_.max_unobservable, unobservable);
    }
    outcome_.degraded += report.tracking.quality() == TrackingQuality::kDegraded ? 1 : 0;
    Compare(report.pose.T_map_depth, truth);
  }

  void Compare(const RigidTransform& pose, const RigidTransform& truth) {
    const Eigen::Vector3d off = pose.translation() - truth.translation();
    squares_ += off.head<2>().cwiseAbs2();
    outcome_.end_m = off.head<2>().norm();
    outcome_.across_m = std::abs(off.z());
    outcome_.end_deg = RotationAngle(pose, truth) * 180.0 / kPi;
  }

  const Scene& scene_;
  const Setting setting_;
  const Rig rig_ = MakeRig();
  const DepthSensor depth_sensor_{*rig_.depth, DepthNoise()};
  const ThermalSensor thermal_sensor_{*rig_.thermal, ThermalNoise(setting_.netd_k)};
  const Walk walk_;
  DepthSensor::Scratch depth_scratch_;
  ThermalSensor::Scratch thermal_scratch_;
  std::unique_ptr<GroundPipeline> pipeline_;
  std::uint64_t thermal_number_ = 0;
  Image<std::uint16_t> image_;  ///< The newest that was not of the shutter.
  Outcome outcome_;
  Eigen::Vector2d squares_ =
      Eigen::Vector2d::Zero();  ///< Squares of the deviation along x and y, m2.
};

Outcome Show(const char* what, const Scene& scene, const Setting& setting) {
  const Outcome o = WallScan(scene, setting).Run();
  std::cout << what << (setting.use_thermal ? " with" : " without") << ": off at the end "
            << 1e3 * o.end_m << " mm and " << o.end_deg << " degrees, on the way "
            << 1e3 * o.rms_x_m << " mm along x, " << 1e3 * o.rms_y_m << " mm along y (rms), across "
            << 1e3 * o.across_m << " mm, sigma " << 1e3 * o.sigma_m << " mm, free "
            << o.min_unobservable << " to " << o.max_unobservable << ", degraded " << o.degraded
            << ", lost " << o.lost << ", thermal fused " << o.fused << ", track " << o.track_ms
            << " ms\n";
  return o;
}

class HeatedWallTest : public ::testing::Test {
 protected:
  /// The geometry is the same with any pattern.
  static void SetUpTestSuite() {
    std::cout << "seed " << kSeed << '\n';
    Setting setting;
    setting.use_thermal = false;
    geometry_alone_ = Show("wall", HeatedWall(Pattern::kSpots, 10.0), setting);
    EXPECT_GT(geometry_alone_.end_m, 0.5) << "the motion before, rest, is held";
    EXPECT_EQ(geometry_alone_.min_unobservable, 3);
  }
  static Outcome geometry_alone_;
};
Outcome HeatedWallTest::geometry_alone_;

TEST_F(HeatedWallTest, SpotsMeasureTheMotionAlongABareWall) {
  const Outcome outcome = Show("spots of 10 K", HeatedWall(Pattern::kSpots, 10.0), {});
  EXPECT_EQ(outcome.lost, 0);
  EXPECT_EQ(outcome.degraded, 0);
  // A chain of some eight references, each within 0.3 mm.
  EXPECT_LT(outcome.end_m, 0.003);
  EXPECT_LT(outcome.end_deg, 0.3);
  EXPECT_LT(std::hypot(outcome.rms_x_m, outcome.rms_y_m), 0.002);
  EXPECT_LT(outcome.across_m, 0.001);
  EXPECT_LT(outcome.end_m, 3.0 * outcome.sigma_m) << "no false certainty";
  EXPECT_GT(outcome.fused, 150U) << "temperatures are fused where the pose is certain";
}

TEST_F(HeatedWallTest, FaintSpotsMeasureItLessWell) {
  // One scan is a draw: it drifts by 8 to 18 mm, by its noise.
  constexpr int kScans = 5;
  double sum_m = 0.0;
  for (std::uint64_t i = 0; i < kScans; ++i) {
    Setting setting;
    setting.seed = kSeed + i;
    const Outcome outcome = Show("spots of 3 K", HeatedWall(Pattern::kSpots, 3.0), setting);
    EXPECT_EQ(outcome.lost, 0);
    EXPECT_LT(outcome.end_m, 3.0 * outcome.sigma_m);
    sum_m += outcome.end_m;
  }
  EXPECT_LT(sum_m / kScans, 0.025 * geometry_alone_.end_m);
}

TEST_F(HeatedWallTest, StripesLeaveTheMotionAlongThemToTheMotionBefore) {
  const Outcome outcome = Show("stripes of 10 K", HeatedWall(Pattern::kStripes, 10.0), {});
  EXPECT_EQ(outcome.min_unobservable, 1);
  EXPECT_EQ(outcome.max_unobservable, 1);
  EXPECT_LT(outcome.rms_x_m, 0.002);
  EXPECT_LT(outcome.rms_y_m, 1.02 * geometry_alone_.rms_y_m) << "no worse along them";
  EXPECT_GT(outcome.sigma_m, 0.1);
}

/// Hot, so that the emissivity's change with the angle shows: a pattern that goes with the camera.
TEST_F(HeatedWallTest, AnEquallyHotWallGainsNothingAndLosesNothing) {
  const Outcome outcome = Show("150 °C everywhere", HeatedWall(Pattern::kUniform, 0.0, 150.0), {});
  EXPECT_EQ(outcome.min_unobservable, 3);
  EXPECT_EQ(outcome.max_unobservable, 3);
  EXPECT_EQ(outcome.end_m, geometry_alone_.end_m);
  EXPECT_EQ(outcome.end_deg, geometry_alone_.end_deg);
  EXPECT_EQ(outcome.sigma_m, geometry_alone_.sigma_m);
}

TEST_F(HeatedWallTest, AnImageThatIsFrozenByTheShutterIsNotUsed) {
  Setting setting;
  setting.nuc_from = 2.0;
  const Outcome outcome =
      Show("spots of 10 K, shutter", HeatedWall(Pattern::kSpots, 10.0), setting);
  EXPECT_EQ(outcome.lost, 0);
  EXPECT_EQ(outcome.max_unobservable, 3) << "for a while the motion before is all there is";
  EXPECT_GE(outcome.degraded, 10);
  EXPECT_LE(outcome.degraded, 15);
  // Used, it would hold the rig for 0.4 s: 6 cm and more.
  EXPECT_LT(outcome.end_m, 0.006);
}

TEST(HeatedWallOptionsTest, WhatTheRigOrTheOptionsLackIsSaid) {
  GroundOptions options;
  options.mutable_tracker()->set_use_thermal(true);
  Rig rig = DefaultSimulatedRig();
  rig.thermal.reset();
  auto pipeline = GroundPipeline::Create(options, rig, {});
  ASSERT_FALSE(pipeline);
  EXPECT_NE(pipeline.error().message().find("tracker.use_thermal"), std::string::npos);
  options.mutable_tracker()->mutable_expert()->set_thermal_min_gradient_k_m(0.0);
  pipeline = GroundPipeline::Create(options, DefaultSimulatedRig(), {});
  ASSERT_FALSE(pipeline);
  EXPECT_NE(pipeline.error().message().find("tracker.expert.thermal_min_gradient_k_m"),
            std::string::npos);
}

}  // namespace
}  // namespace isotherm

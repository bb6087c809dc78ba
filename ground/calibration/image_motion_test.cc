#include "ground/calibration/image_motion.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "common/base/noise.h"
#include "ground/calibration/texture_consistency.h"

namespace isotherm {
namespace {

constexpr CaptureTime kBegin{std::chrono::seconds(50)};
constexpr double kMemory_s = 4.0;  // As documented: a drift is forgotten within seconds.
constexpr double kWholeScan_s = std::numeric_limits<double>::infinity();
constexpr double kFocal_px = 200.0, kDistance_m = 0.5;

/// `count` velocities along u, `step_s` apart.
std::vector<StampedVelocity> Swing(double amplitude_px_s, double period_s, double step_s,
                                   int count) {
  std::vector<StampedVelocity> motion;
  for (int i = 0; i < count; ++i) {
    const double phase = 2.0 * std::numbers::pi * i * step_s / period_s;
    motion.push_back({kBegin + FromSeconds(i * step_s), {amplitude_px_s * std::cos(phase), 0.0}});
  }
  return motion;
}

TEST(ImageMotionTest, ManySwingsAverageADriftOutAsItsSpectrumSays) {
  constexpr double kAmplitude_px_s = 30.0, kPeriod_s = 2.0, kLength_s = 200.0, kDrift_px = 0.2;
  const std::vector<StampedVelocity> motion = Swing(kAmplitude_px_s, kPeriod_s, 0.2, 1000);
  // The density of a drift that is forgotten exponentially, over the motion's energy.
  const double omega_tau = 2.0 * std::numbers::pi / kPeriod_s * kMemory_s;
  const double density = 2.0 * kMemory_s / (1.0 + omega_tau * omega_tau);
  const double energy = kLength_s * kAmplitude_px_s * kAmplitude_px_s / 2.0;
  const double expected_s = kDrift_px * std::sqrt(density / energy);
  EXPECT_NEAR(DelaySigmaOfDrift(motion, kDrift_px, kWholeScan_s), expected_s, 0.05 * expected_s);
}

/// Drifts are drawn, and what of each goes along with the velocity is taken for a delay: over the
/// whole scan, and by parts of it.
class DrawnDriftTest : public ::testing::TestWithParam<double> {};

TEST_P(DrawnDriftTest, SigmaIsTheSpreadOfTheDelaysTheyMake) {
  constexpr double kStep_s = 0.1, kDrift_px = 0.3;
  constexpr int kDraws = 2000, kCount = 120;
  const double part_s = GetParam();
  const std::vector<StampedVelocity> motion = Swing(20.0, 9.0, kStep_s, kCount);
  const int in_part = std::isinf(part_s) ? kCount : static_cast<int>(std::lround(part_s / kStep_s));
  std::vector<double> changes;
  for (int i = 0; i < kCount; ++i) {
    const int first = i - i % in_part;
    double mean = 0.0;
    for (int k = first; k < first + in_part; ++k)
      mean += motion[static_cast<std::size_t>(k)].velocity_px_s.x() / in_part;
    changes.push_back(motion[static_cast<std::size_t>(i)].velocity_px_s.x() - mean);
  }
  const double kept = std::exp(-kStep_s / kMemory_s);
  double squares_of_delay = 0.0;
  for (std::uint64_t draw = 0; draw < kDraws; ++draw) {
    const std::uint64_t stream = NoiseStream(draw, 3, 0);
    double drift_px = kDrift_px * NormalNoise(stream, 0), along = 0.0, energy = 0.0;
    for (std::uint64_t i = 0; i < changes.size(); ++i) {
      along += drift_px * changes[i];
      energy += changes[i] * changes[i];
      drift_px =
          kept * drift_px + kDrift_px * std::sqrt(1.0 - kept * kept) * NormalNoise(stream, i + 1);
    }
    squares_of_delay += along / energy * along / energy;
  }
  const double spread_s = std::sqrt(squares_of_delay / kDraws);
  EXPECT_NEAR(DelaySigmaOfDrift(motion, kDrift_px, part_s), spread_s, 0.05 * spread_s);
}

INSTANTIATE_TEST_SUITE_P(Parts, DrawnDriftTest, ::testing::Values(kWholeScan_s, 4.0, 2.0));

TEST(ImageMotionTest, WithinPartsASlowSwingIsNoChangeThatDriftCouldBeTakenFor) {
  std::vector<StampedVelocity> motion = Swing(20.0, 2.0, 0.05, 240);
  const std::vector<StampedVelocity> slow = Swing(60.0, 25.0, 0.05, 240);
  const double fast_alone_s = DelaySigmaOfDrift(motion, 0.1, 2.0);
  for (std::size_t i = 0; i < motion.size(); ++i) motion[i].velocity_px_s += slow[i].velocity_px_s;
  EXPECT_NEAR(DelaySigmaOfDrift(motion, 0.1, 2.0), fast_alone_s, 0.3 * fast_alone_s);
  EXPECT_GT(DelaySigmaOfDrift(motion, 0.1, kWholeScan_s), 2.0 * fast_alone_s);
}

TEST(ImageMotionTest, AConstantVelocitySaysNothing) {
  EXPECT_TRUE(std::isinf(DelaySigmaOfDrift(Swing(0.0, 1.0, 0.1, 50), 0.1, kWholeScan_s)));
  std::vector<StampedVelocity> steady;
  for (int i = 0; i < 333; ++i) steady.push_back({kBegin + FromSeconds(0.025 * i), {30.1, -7.3}});
  EXPECT_TRUE(std::isinf(DelaySigmaOfDrift(steady, 0.1, kWholeScan_s)));
  EXPECT_TRUE(std::isinf(DelaySigmaOfDrift({}, 0.1, kWholeScan_s)));
  EXPECT_EQ(RmsSpeed({}), 0.0);
}

TEST(ImageMotionTest, VelocitiesAreThoseOfTheSurfaceInTheImage) {
  constexpr double kSpeed_m_s = 0.1;
  ScanViews views;
  views.thermal_camera = {
      .width = 160, .height = 120, .fx = kFocal_px, .fy = kFocal_px, .cx = 80, .cy = 60};
  views.points.push_back({{0.0, 0.0, kDistance_m}, -Eigen::Vector3d::UnitZ()});
  for (int i = 0; i < 60; ++i) {
    RigidTransform pose = RigidTransform::Identity();
    pose.translation().x() = kSpeed_m_s * (i / 30.0 - 1.0);
    views.trajectory.push_back({kBegin + FromSeconds(i / 30.0), pose});
  }
  // The last one is beyond the trajectory.
  for (const double time_s : {0.5, 1.0, 5.0})
    views.frames.push_back({kBegin + FromSeconds(time_s), nullptr, kCentikelvin, {}});
  const std::vector<StampedVelocity> motion = ImageVelocities(views);
  ASSERT_EQ(motion.size(), 2U);
  // The rig goes right, the image left.
  const double expected_px_s = -kFocal_px * kSpeed_m_s / kDistance_m;
  for (const StampedVelocity& at : motion) {
    EXPECT_NEAR(at.velocity_px_s.x(), expected_px_s, 1e-6);
    EXPECT_NEAR(at.velocity_px_s.y(), 0.0, 1e-9);
  }
  EXPECT_NEAR(RmsSpeed(motion), -expected_px_s, 1e-6);
  EXPECT_NEAR(PixelsPerMetre(views).value(), kFocal_px / kDistance_m, 1e-9);
  views.points.front().p_world.z() = -kDistance_m;
  EXPECT_FALSE(PixelsPerMetre(views)) << "behind the camera";
}

}  // namespace
}  // namespace isotherm

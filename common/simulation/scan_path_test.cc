#include "common/simulation/scan_path.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "common/base/units.h"
#include "common/simulation/options.h"
#include "common/simulation/ray_caster.h"
#include "common/simulation/scenes.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

// Thesis 6.1.3: the fastest scan whose steps between frames at 30 Hz are still integrated, and the
// smallest step.
constexpr double kMaxSpeed_m_s = 0.3;
constexpr double kMaxRotation_rad_s = 17.0 * kRadPerDeg;
constexpr double kMinStep_m = 0.001;
constexpr double kMinStep_rad = 0.06 * kRadPerDeg;
constexpr double kFrame_s = 1.0 / 30.0;

class ScanPathTest : public ::testing::TestWithParam<int> {
 protected:
  ScanPathTest() {
    SceneOptions options;
    options.set_scene(static_cast<SimulatedScene>(GetParam()));
    staged_.emplace(MakeScene(options));
  }
  std::optional<StagedScene> staged_;
};

TEST_P(ScanPathTest, StaysWithinTheLimitsOfTheMethodAndKeepsMoving) {
  constexpr int kFrames = 180 * 30;
  int still = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const double t = frame * kFrame_s;
    const RigidTransform a = staged_->path.PoseAt(t), b = staged_->path.PoseAt(t + kFrame_s);
    ASSERT_TRUE(IsRigid(a));
    ASSERT_LE(TranslationDistance(a, b), kMaxSpeed_m_s * kFrame_s) << t;
    ASSERT_LE(RotationAngle(a, b), kMaxRotation_rad_s * kFrame_s) << t;
    if (TranslationDistance(a, b) < kMinStep_m && RotationAngle(a, b) < kMinStep_rad) ++still;
  }
  EXPECT_LE(still, kFrames / 50);
}

TEST_P(ScanPathTest, StartsFromRest) {
  const RigidTransform a = staged_->path.PoseAt(0.0), b = staged_->path.PoseAt(0.005);
  EXPECT_LT(TranslationDistance(a, b), 5e-5);
  EXPECT_TRUE(staged_->path.PoseAt(-1.0).isApprox(a));
}

TEST_P(ScanPathTest, KeepsMostOfTheImageInWorkingRange) {
  const CameraModel camera = DefaultSimulatedRig().depth->Downscaled(3);
  const RayGrid grid(camera);
  HitImage hits;
  for (int t = 0; t < 60; ++t) {
    CastRays(staged_->scene, grid, staged_->path.PoseAt(t), hits);
    int in_range = 0;
    for (const float z : hits.z_m.pixels()) in_range += z > 0.36F && z < 1.2F;
    EXPECT_GT(in_range, 0.55 * static_cast<double>(hits.z_m.size())) << t;
  }
}

INSTANTIATE_TEST_SUITE_P(ScannedScenes, ScanPathTest,
                         ::testing::Values(FURNACE_DOOR, CALIBRATOR, CORNER_SPHERE, FLAT_WALL));

}  // namespace
}  // namespace isotherm

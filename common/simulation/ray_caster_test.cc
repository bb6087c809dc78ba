#include "common/simulation/ray_caster.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/simulation/options.h"
#include "common/simulation/scenes.h"
#include "common/simulation/simulation_options.pb.h"

namespace isotherm {
namespace {

constexpr double kDepth_m =
    1e-5;  // Float rounding at 1 m, on surfaces that are not seen at a grazing angle.
constexpr double kEdgeFraction = 0.002;  // Pixels whose ray passes an edge within rounding.
constexpr double kCosine = 1e-3;
constexpr double kTemperature_k = 0.02;  // Steep fields times kDepth_m.

class RayCasterTest : public ::testing::TestWithParam<int> {
 protected:
  RayCasterTest() { options_.set_scene(static_cast<SimulatedScene>(GetParam())); }

  void Compare(const CameraModel& camera, double time_s) {
    const StagedScene staged = MakeScene(options_);
    const RigidTransform T_world_camera = staged.path.PoseAt(time_s);
    const RayGrid grid(camera);
    HitImage hits;
    CastRays(staged.scene, grid, T_world_camera, hits);
    const CameraView view(staged.scene, T_world_camera);
    int compared = 0, different = 0;
    for (int y = 0; y < camera.height; y += 3) {
      for (int x = 0; x < camera.width; x += 3) {
        ++compared;
        const Eigen::Vector2d ray = Unproject(camera, Eigen::Vector2d(x, y));
        const Eigen::Vector3d direction = T_world_camera.linear() * ray.homogeneous();
        const auto truth = staged.scene.Intersect(T_world_camera.translation(), direction);
        const int primitive = hits.primitive.At(x, y);
        if (primitive != (truth ? truth->point.primitive : -1)) {
          ++different;
          continue;
        }
        if (!truth) {
          EXPECT_TRUE(std::isinf(hits.z_m.At(x, y)));
          continue;
        }
        const double cosine = std::abs(truth->point.n_world.dot(direction.normalized()));
        if (cosine < 0.05) continue;
        const float z_m = hits.z_m.At(x, y);
        // The direction has a depth of 1, so its multiple is the depth.
        EXPECT_NEAR(z_m, truth->distance, kDepth_m / cosine);
        const CameraView::Surface surface = view.At(primitive, grid.Ray(x, y), z_m);
        if (std::abs(static_cast<double>(surface.cosine) - cosine) > kCosine) ++different;
        EXPECT_NEAR(surface.celsius, truth->point.celsius, kTemperature_k / cosine);
        EXPECT_EQ(surface.cosine, view.CosineAt(primitive, grid.Ray(x, y), z_m));
      }
    }
    EXPECT_LE(different, kEdgeFraction * compared);
  }

  SceneOptions options_;
};

TEST_P(RayCasterTest, SeesWhatTheExactSceneSays) {
  for (const double time_s : {0.0, 7.0, 13.0}) Compare(*DefaultSimulatedRig().depth, time_s);
}

TEST_P(RayCasterTest, SeesTheSameThroughADistortingLens) {
  Compare(*DefaultSimulatedRig().thermal, 4.0);
}

INSTANTIATE_TEST_SUITE_P(AllScenes, RayCasterTest,
                         ::testing::Range(0, static_cast<int>(SimulatedScene_ARRAYSIZE)));

TEST(CastRaysTest, PartsBehindAndBesideTheCameraAreNoTrouble) {
  SceneOptions options;
  options.set_scene(CORNER_SPHERE);
  const StagedScene staged = MakeScene(options);
  RigidTransform T_world_camera = RigidTransform::Identity();
  T_world_camera.translation() = Eigen::Vector3d(0.48, 0.30, 0.60);  // Between the walls.
  const CameraModel camera = DefaultSimulatedRig().depth->Downscaled(2);
  const RayGrid grid(camera);
  HitImage hits;
  for (const double rotation_rad : {0.0, 1.5, 3.1}) {
    T_world_camera.linear() =
        Eigen::AngleAxisd(rotation_rad, Eigen::Vector3d::UnitY()).toRotationMatrix();
    CastRays(staged.scene, grid, T_world_camera, hits);
    for (int y = 0; y < camera.height; y += 5) {
      for (int x = 0; x < camera.width; x += 5) {
        const Eigen::Vector3d direction =
            T_world_camera.linear() * Unproject(camera, Eigen::Vector2d(x, y)).homogeneous();
        const auto truth = staged.scene.Intersect(T_world_camera.translation(), direction);
        EXPECT_EQ(hits.primitive.At(x, y), truth ? truth->point.primitive : -1);
      }
    }
  }
}

}  // namespace
}  // namespace isotherm

#include "ground/tsdf/view_raycaster.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/testing/volume_shapes.h"
#include "ground/options/ground_options.pb.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/surface/testing/small_volume.h"
#include "ground/tsdf/raycaster.h"

namespace isotherm {
namespace {

using testing::kSmallTruncation_m;
using testing::kSmallVoxel_m;

Eigen::Vector3d VertexAt(const SurfaceMaps& maps, int u, int v) {
  return {maps.vx.At(u, v), maps.vy.At(u, v), maps.vz.At(u, v)};
}

Eigen::Vector3d NormalAt(const SurfaceMaps& maps, int u, int v) {
  return {maps.nx.At(u, v), maps.ny.At(u, v), maps.nz.At(u, v)};
}

class ViewRaycasterTest : public ::testing::Test {
 protected:
  SurfaceMaps Cast() {
    ThreadPool pool(2);
    SurfaceMaps maps;
    ViewRaycaster(options_).Cast(volume_, camera_, pose_, pool, maps);
    return maps;
  }
  SurfaceMaps CastEachRay() {
    ThreadPool pool(1);
    SurfaceMaps maps;
    Raycaster().Cast(volume_, camera_, pose_, 0.0F, pool, maps);
    return maps;
  }
  /// A wall at `far_m`, and before its left half one at kNear_m.
  void FillStep(double far_m) {
    pose_ = testing::FirstPose();
    testing::FillVolume(volume_, [&](const Eigen::Vector3d& p) {
      const double step = std::max(kNear_m - p.z(), p.x() - pose_.translation().x());
      return std::min(step, far_m - p.z());
    });
  }
  Eigen::Vector3d Ray(int u, int v) const {
    const Eigen::Vector2d xy = Unproject(camera_, {u, v});
    return (pose_.linear() * Eigen::Vector3d(xy.x(), xy.y(), 1.0)).normalized();
  }

  static constexpr double kNear_m = 0.40;
  RaycastOptions options_ = [] {
    RaycastOptions options;
    options.mutable_expert()->set_interpolate(true);
    return options;
  }();
  const VoxelGrid grid_ = MakeVoxelGrid(testing::SmallVolume()).value();
  TsdfVolume volume_{grid_, kSmallTruncation_m, MaxBlocks(testing::SmallVolume(), grid_)};
  CameraModel camera_ = testing::SmallDepthCamera();
  RigidTransform pose_ =
      MakeTransform({0.28, 0.33, -0.1}, Eigen::Quaterniond(0.995, 0.02, 0.08, -0.03));
};

TEST_F(ViewRaycasterTest, InterpolatedPixelsLieOnTheirOwnRaysAndOnTheSphere) {
  const Eigen::Vector3d centre(0.33, 0.31, 0.40);
  constexpr double kRadius = 0.15;
  testing::FillSphere(volume_, centre, kRadius);
  constexpr double kMaxError = 0.1 * kSmallVoxel_m;  // As where each ray is cast.
  constexpr double kMinCosine = 0.9986;              // 3 degrees.
  constexpr double kGrazing = 0.4;                   // Cosine below which vertices are far apart.
  for (const int smaller : {0, 1}) {
    camera_ = testing::SmallDepthCamera();
    camera_.width -= smaller;
    camera_.height -= smaller;
    const SurfaceMaps maps = Cast();
    int hits = 0;
    for (int v = 0; v < camera_.height; ++v) {
      for (int u = 0; u < camera_.width; ++u) {
        const Eigen::Vector3d ray = Ray(u, v);
        const double along = (centre - pose_.translation()).dot(ray);
        const double squared =
            kRadius * kRadius - ((centre - pose_.translation()).squaredNorm() - along * along);
        if (squared < 0.0) continue;
        const Eigen::Vector3d truth = pose_.translation() + ray * (along - std::sqrt(squared));
        const Eigen::Vector3d normal = (truth - centre) / kRadius;
        if (-normal.dot(ray) < kGrazing) continue;
        ++hits;
        ASSERT_NEAR((VertexAt(maps, u, v) - truth).norm(), 0.0, kMaxError / -normal.dot(ray))
            << u << " " << v;
        ASSERT_GT(NormalAt(maps, u, v).dot(normal), kMinCosine) << u << " " << v;
      }
    }
    EXPECT_GT(hits, 10'000);
  }
}

TEST_F(ViewRaycasterTest, NothingIsMadeUpAcrossAStepOfMoreThanTheTruncationDistance) {
  constexpr double kFar_m = kNear_m + 2.0 * kSmallTruncation_m;
  FillStep(kFar_m);
  const SurfaceMaps maps = Cast();
  const SurfaceMaps cast = CastEachRay();
  int near = 0, far = 0;
  for (int v = 0; v < camera_.height; v += 7) {
    int left_out = 0;
    for (int u = 40; u < camera_.width - 40; ++u) {
      const double z_m = VertexAt(maps, u, v).z();
      if (std::isnan(z_m)) {
        left_out += std::isnan(VertexAt(cast, u, v).z()) ? 0 : 1;
        continue;
      }
      // The edge is rounded by a voxel or two, as where each ray is cast.
      const bool is_near = std::abs(z_m - kNear_m) < 2.0 * kSmallVoxel_m;
      ASSERT_TRUE(is_near || std::abs(z_m - kFar_m) < 2.0 * kSmallVoxel_m) << u << " " << v;
      ++(is_near ? near : far);
    }
    EXPECT_GE(left_out, 1) << v;  // Else each ray was cast.
    EXPECT_LE(left_out, 4) << v;
  }
  EXPECT_GT(near, 1000);
  EXPECT_GT(far, 1000);
}

TEST_F(ViewRaycasterTest, SmallerStepsAreBridged) {
  FillStep(kNear_m + 0.5 * kSmallTruncation_m);
  const SurfaceMaps maps = Cast();
  for (int v = 40; v < camera_.height - 40; ++v) {
    for (int u = 40; u < camera_.width - 40; ++u)
      ASSERT_FALSE(std::isnan(VertexAt(maps, u, v).z())) << u << " " << v;
  }
}

TEST_F(ViewRaycasterTest, InFoldsVerticesAreOffByHalfTheToleranceAtMost) {
  testing::FillVolume(volume_, testing::BallInCorner);
  pose_ = testing::FirstPose();
  const SurfaceMaps maps = Cast();
  int vertices = 0;
  for (int v = 0; v < camera_.height; ++v) {
    for (int u = 0; u < camera_.width; ++u) {
      const Eigen::Vector3d p = VertexAt(maps, u, v);
      if (std::isnan(p.z())) continue;
      ++vertices;
      ASSERT_LT(std::abs(testing::BallInCorner(p)), 0.5 * kSmallTruncation_m + kSmallVoxel_m)
          << u << " " << v;
    }
  }
  EXPECT_GT(vertices, 50'000);
}

TEST_F(ViewRaycasterTest, WithoutInterpolationEachPixelIsCast) {
  testing::FillVolume(volume_, testing::BallInCorner);
  pose_ = testing::FirstPose();
  options_.mutable_expert()->clear_interpolate();
  const SurfaceMaps maps = Cast();
  const SurfaceMaps expected = CastEachRay();
  for (const auto plane : {&SurfaceMaps::vx, &SurfaceMaps::vz, &SurfaceMaps::ny}) {
    const Image<float>& image = maps.*plane;
    ASSERT_EQ(std::memcmp(image.data(), (expected.*plane).data(), image.size() * sizeof(float)), 0);
  }
}

TEST_F(ViewRaycasterTest, VoxelsLighterThanTheLeastWeightShowNothing) {
  testing::FillVolume(volume_, testing::BallInCorner, /*weight=*/2.0F);
  pose_ = testing::FirstPose();
  const auto count = [&] {
    const SurfaceMaps maps = Cast();
    return std::ranges::count_if(maps.vx.pixels(), [](float x) { return !std::isnan(x); });
  };
  EXPECT_GT(count(), 50'000);
  options_.mutable_expert()->set_min_weight(3.0);
  EXPECT_EQ(count(), 0);
}

TEST_F(ViewRaycasterTest, AnEmptyVolumeShowsNothing) {
  const SurfaceMaps maps = Cast();
  for (const float x : maps.vx.pixels()) ASSERT_TRUE(std::isnan(x));
}

}  // namespace
}  // namespace isotherm

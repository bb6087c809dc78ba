#include "ground/tsdf/raycast_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "common/testing/kernel_checks.h"
#include "common/testing/volume_shapes.h"
#include "ground/options/ground_options.pb.h"
#include "ground/tsdf/raycaster.h"
#include "ground/tsdf/reference/raycast_reference.h"

namespace isotherm {
namespace {

constexpr double kVoxel = 0.004;
constexpr double kTruncation = 0.016;
constexpr double kSide = 0.32;
constexpr double kMaxErrorVox = 0.1;

using Hits = std::vector<std::optional<reference::Raycaster::Hit>>;

/// A surface of random waves across the middle of a small volume.
class RaycastTileTest : public ::testing::Test {
 protected:
  RaycastTileTest() {
    VolumeOptions options;
    options.set_size_x_m(kSide);
    options.set_size_y_m(kSide);
    options.set_size_z_m(kSide);
    options.set_voxel_size_m(kVoxel);
    const VoxelGrid grid = MakeVoxelGrid(options).value();
    volume_ = std::make_unique<TsdfVolume>(grid, kTruncation, MaxBlocks(options, grid));
    struct Wave {
      Eigen::Vector2d k;
      double amplitude, phase;
    };
    std::array<Wave, 4> waves;
    for (Wave& wave : waves) {
      wave.k = {random_.Uniform(-60.0F, 60.0F), random_.Uniform(-60.0F, 60.0F)};
      wave.amplitude = 0.3 / wave.k.norm() * random_.Uniform(0.2F, 1.0F);  // Slopes up to 0.3.
      wave.phase = random_.Uniform(0.0F, 6.0F);
    }
    testing::FillVolume(*volume_, [&](const Eigen::Vector3d& p) {
      double height = 0.6 * kSide;
      Eigen::Vector2d slope = Eigen::Vector2d::Zero();
      for (const Wave& wave : waves) {
        const double angle = wave.k.dot(p.head<2>()) + wave.phase;
        height += wave.amplitude * std::sin(angle);
        slope += wave.amplitude * std::cos(angle) * wave.k;
      }
      return (height - p.z()) / std::sqrt(1.0 + slope.squaredNorm());
    });
    MarkBlocks();
  }

  /// As integration does.
  void MarkBlocks() {
    for (std::int32_t block = 0; block < volume_->block_count(); ++block) {
      const auto voxels = volume_->voxels(block);
      volume_->set_may_end_rays(block, std::any_of(voxels.begin(), voxels.end(), [](TsdfVoxel v) {
                                  return v.observed() && v.tsdf() <= 0.0F;
                                }));
    }
  }

  /// Looks at the surface from before it, from anywhere within 40 degrees.
  RigidTransform RandomPose() {
    const auto uniform = [&] { return random_.Uniform(-1.0F, 1.0F); };
    const Eigen::Quaterniond orientation(1.0, 0.3 * uniform(), 0.3 * uniform(), uniform());
    const Eigen::Vector3d aim(0.5 * kSide + 0.05 * uniform(), 0.5 * kSide + 0.05 * uniform(),
                              0.6 * kSide);
    const RigidTransform rotation = MakeTransform(Eigen::Vector3d::Zero(), orientation);
    return MakeTransform(aim - rotation * Eigen::Vector3d(0.0, 0.0, random_.Uniform(0.1F, 0.5F)),
                         orientation);
  }
  static CameraModel Camera(int width, int height) {
    CameraModel camera;
    camera.width = width;
    camera.height = height;
    camera.fx = 1.05 * width + 20.0;
    camera.fy = 0.95 * width + 20.0;
    camera.cx = 0.48 * width;
    camera.cy = 0.53 * height;
    return camera;
  }
  SurfaceMaps Cast(const CameraModel& camera, const RigidTransform& pose, float min_weight = 0.0F,
                   RaycastPrecision precision = RaycastPrecision::kSurface) const {
    ThreadPool pool(1);
    SurfaceMaps maps;
    Raycaster(precision).Cast(*volume_, camera, pose, min_weight, pool, maps);
    return maps;
  }
  static Hits CastScalar(const reference::Raycaster& caster, const CameraModel& camera,
                         const RigidTransform& pose) {
    Hits hits;
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector2d xy = Unproject(camera, {u, v});
        hits.push_back(
            caster.Cast(pose.translation(), pose.linear() * Eigen::Vector3d(xy.x(), xy.y(), 1.0)));
      }
    }
    return hits;
  }

  /// How casts differ from the scalar ones, in pixels.
  struct Difference {
    int pixels = 0;
    int hits = 0;
    int hit_or_miss = 0;
    int far_off = 0;
    int turned = 0;      ///< By more than half a degree,
    int turned_off = 0;  ///< by more than 3 degrees.
  };
  static void Add(const SurfaceMaps& maps, const Hits& truth, double max_error_vox,
                  Difference& sum) {
    constexpr double kCosineHalfDegree = 0.999962;
    constexpr double kCosineThreeDegrees = 0.99863;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      ++sum.pixels;
      const Eigen::Vector3d p(maps.vx.data()[i], maps.vy.data()[i], maps.vz.data()[i]);
      const Eigen::Vector3d n(maps.nx.data()[i], maps.ny.data()[i], maps.nz.data()[i]);
      const bool hit = p.allFinite() && n.allFinite();
      ASSERT_TRUE(hit || (p.array().isNaN().all() && n.array().isNaN().all())) << "pixel " << i;
      if (hit != truth[i].has_value()) {
        ++sum.hit_or_miss;
      } else if (hit) {
        ++sum.hits;
        ASSERT_NEAR(n.norm(), 1.0, 1e-5);
        if ((p - truth[i]->p).norm() > max_error_vox * kVoxel) ++sum.far_off;
        if (n.dot(truth[i]->n) < kCosineHalfDegree) ++sum.turned;
        if (n.dot(truth[i]->n) < kCosineThreeDegrees) ++sum.turned_off;
      }
    }
  }
  struct View {
    CameraModel camera;
    RigidTransform pose;
    Hits truth;
  };
  std::vector<View> RandomViews(const std::vector<CameraModel>& cameras, float min_weight = 0.0F) {
    const reference::Raycaster caster(*volume_, min_weight);
    std::vector<View> views;
    for (const CameraModel& camera : cameras) {
      const RigidTransform pose = RandomPose();
      views.push_back({camera, pose, CastScalar(caster, camera, pose)});
    }
    return views;
  }
  /// Over all views.
  Difference Compare(const std::vector<View>& views, double max_error_vox, float min_weight = 0.0F,
                     RaycastPrecision precision = RaycastPrecision::kSurface) const {
    Difference sum;
    for (const View& view : views) {
      Add(Cast(view.camera, view.pose, min_weight, precision), view.truth, max_error_vox, sum);
    }
    return sum;
  }

  const std::vector<CameraModel> kFiveCameras = std::vector<CameraModel>(5, Camera(73, 59));
  testing::Random random_;
  std::unique_ptr<TsdfVolume> volume_;
};

TEST_F(RaycastTileTest, MeetsABumpySurfaceWhereTheScalarMarchDoes) {
  const std::vector<View> views = RandomViews(kFiveCameras);
  testing::ForEachInstructionSet([&] {
    const Difference difference = Compare(views, kMaxErrorVox);
    EXPECT_GT(difference.hits, difference.pixels / 2);
    EXPECT_LE(difference.hit_or_miss, difference.pixels / 200) << "at silhouettes";
    EXPECT_EQ(difference.far_off, 0);
    EXPECT_LE(difference.turned_off, difference.hits / 400) << "at the faces of cells";
    EXPECT_LE(difference.turned, difference.hits / 100);
  });
}

TEST_F(RaycastTileTest, MeetsItInImagesThatAreNoMultipleOfATile) {
  std::vector<CameraModel> cameras;
  for (int width = 1; width <= 2 * kRaycastTile + 3; ++width) {
    for (const int height : {1, kRaycastTile - 1, kRaycastTile + 1})
      cameras.push_back(Camera(width, height));
  }
  const std::vector<View> views = RandomViews(cameras);
  testing::ForEachInstructionSet([&] {
    const Difference difference = Compare(views, kMaxErrorVox);
    EXPECT_GT(difference.hits, difference.pixels / 2);
    EXPECT_LE(difference.hit_or_miss, difference.pixels / 200);
    EXPECT_EQ(difference.far_off, 0);
  });
}

TEST_F(RaycastTileTest, MeetsItAroundHolesAndVoxelsThatAreTooLight) {
  for (std::int32_t block = 0; block < volume_->block_count(); ++block) {
    for (TsdfVoxel& voxel : volume_->voxels(block)) {
      if (random_.Chance(0.003)) voxel.bits = 0;
      if (voxel.observed() && random_.Chance(0.003)) voxel.bits = (voxel.bits & 0xFFFF0000U) | 32U;
    }
  }
  for (const float min_weight : {0.0F, 1.0F}) {
    const std::vector<View> views = RandomViews(kFiveCameras, min_weight);
    testing::ForEachInstructionSet([&] {
      const Difference difference = Compare(views, kMaxErrorVox, min_weight);
      // The kernel's refinement may stop before or in a cell with a hole, or step over it.
      EXPECT_LE(difference.hit_or_miss, difference.pixels / 67);
      EXPECT_EQ(difference.far_off, 0);
    });
  }
}

/// From inside a ball before the waves.
TEST_F(RaycastTileTest, WhatIsMetFromBehindHidesTheRest) {
  constexpr double kBall = 0.03;  // Radius in metres; its shell is all that was seen of it.
  const Eigen::Vector3d centre(0.5 * kSide, 0.5 * kSide, 0.3 * kSide);
  testing::ForEachBlockOfGrid(volume_->grid(), [&](const GridIndex& b) {
    testing::ForEachVoxel(volume_->voxels(volume_->FindOrAllocate(b)), volume_->grid(), b,
                          [&](TsdfVoxel& voxel, const Eigen::Vector3d& p) {
                            const double distance = ((p - centre).norm() - kBall) / kTruncation;
                            if (std::abs(distance) > 1.0) return;
                            voxel.bits = 0;
                            voxel.Update(static_cast<float>(distance), 1.0F, 1.0F);
                          });
  });
  MarkBlocks();
  const CameraModel camera = Camera(40, 30);
  const RigidTransform pose = MakeTransform(centre, Eigen::Quaterniond::Identity());
  testing::ForEachInstructionSet([&] {
    const SurfaceMaps maps = Cast(camera, pose);
    EXPECT_TRUE(std::all_of(maps.vz.pixels().begin(), maps.vz.pixels().end(),
                            [](float z) { return std::isnan(z); }));
  });
}

TEST_F(RaycastTileTest, ForVisibilityATenthOfAVoxelIsEnough) {
  const std::vector<View> views = RandomViews(kFiveCameras);
  testing::ForEachInstructionSet([&] {
    const Difference difference = Compare(views, kMaxErrorVox, 0.0F, RaycastPrecision::kVisibility);
    EXPECT_LE(difference.hit_or_miss, difference.pixels / 100);
    EXPECT_LE(difference.far_off, difference.hits / 100);
  });
}

TEST_F(RaycastTileTest, DoesNotDependOnTheInstructionSet) {
  constexpr float kMaxDifference = 0.02F * static_cast<float>(kVoxel);
  const CameraModel camera = Camera(160, 120);
  for (int view = 0; view < 5; ++view) {
    const RigidTransform pose = RandomPose();
    const SurfaceMaps first = Cast(camera, pose);
    testing::ForEachInstructionSet([&] {
      const SurfaceMaps maps = Cast(camera, pose);
      int hit_or_miss = 0;
      float most = 0.0F;
      for (std::size_t i = 0; i < maps.vz.size(); ++i) {
        const float z = maps.vz.data()[i];
        const float first_z = first.vz.data()[i];
        if (std::isnan(z) != std::isnan(first_z)) ++hit_or_miss;
        if (!std::isnan(z - first_z)) most = std::max(most, std::abs(z - first_z));
      }
      EXPECT_LE(hit_or_miss, camera.width * camera.height / 500);
      EXPECT_LT(most, kMaxDifference);
    });
  }
}

}  // namespace
}  // namespace isotherm

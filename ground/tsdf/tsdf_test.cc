#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "common/testing/volume_shapes.h"
#include "ground/surface/depth_preprocessor.h"
#include "ground/surface/testing/analytic_views.h"
#include "ground/tsdf/raycaster.h"
#include "ground/tsdf/tsdf_integrator.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

constexpr double kVoxel = 0.004;
constexpr double kTruncation = 0.016;

VolumeOptions SmallVolume() {
  VolumeOptions options;
  options.set_size_x_m(0.64);
  options.set_size_y_m(0.64);
  options.set_size_z_m(0.64);
  options.set_voxel_size_m(kVoxel);
  return options;
}

TsdfVolume MakeVolume() {
  const VoxelGrid grid = MakeVoxelGrid(SmallVolume()).value();
  return {grid, kTruncation, MaxBlocks(SmallVolume(), grid)};
}

TEST(VoxelGridTest, CoversTheVolumeWithWholeBlocks) {
  VolumeOptions options;
  EXPECT_EQ(MakeVoxelGrid(options)->blocks, GridIndex(60, 60, 60));  // 0.96 m / 16 mm.
  options.set_size_x_m(0.961);
  EXPECT_EQ(MakeVoxelGrid(options)->blocks.x(), 61);
}

TEST(VoxelGridTest, F71HugeVolumeIsRefusedWithWhatWouldFit) {
  VolumeOptions options;
  for (const double size_m : {100.0, 1e9, 1e300}) {
    options.set_size_x_m(size_m);
    options.set_size_y_m(size_m);
    options.set_size_z_m(size_m);
    options.set_voxel_size_m(0.001);
    const auto grid = MakeVoxelGrid(options);
    ASSERT_FALSE(grid.has_value()) << size_m;
    EXPECT_EQ(grid.error().code(), StatusCode::kResourceExhausted);
    EXPECT_NE(grid.error().message().find("GiB"), std::string::npos);
    EXPECT_NE(grid.error().message().find("use voxels of"), std::string::npos);
  }
}

TEST(VoxelGridTest, F71WhatIsSaidToFitFits) {
  for (const auto& [x_m, y_m, z_m] : {std::array{100.0, 100.0, 100.0}, std::array{1e6, 0.01, 0.01},
                                      std::array{3e3, 2e2, 0.1}, std::array{1e12, 1e12, 1e12}}) {
    SCOPED_TRACE(::testing::Message() << x_m << " x " << y_m << " x " << z_m << " m");
    VolumeOptions options;
    options.set_size_x_m(x_m);
    options.set_size_y_m(y_m);
    options.set_size_z_m(z_m);
    options.set_voxel_size_m(1e-4);
    options.mutable_expert()->set_max_memory_bytes(1 << 20);
    const std::string message = MakeVoxelGrid(options).error().message();
    const std::string_view before = "use voxels of ";
    const std::size_t at = message.find(before);
    ASSERT_NE(at, std::string::npos) << message;
    const double voxel_m = std::stod(message.substr(at + before.size()));
    options.set_voxel_size_m(voxel_m);
    EXPECT_TRUE(MakeVoxelGrid(options).has_value()) << message;
    options.set_voxel_size_m(0.9 * voxel_m);
    EXPECT_FALSE(MakeVoxelGrid(options).has_value()) << message;
  }
}

/// Whatever memory there is: kernels number the table's entries with 31 bits.
TEST(VoxelGridTest, F71MoreBlocksThanCanBeNumberedAreRefused) {
  constexpr double kBlock = 0.008;
  VolumeOptions options;
  options.set_voxel_size_m(0.001);
  options.mutable_expert()->set_max_memory_bytes(std::uint64_t{1} << 50);
  const auto make = [&](int blocks) {
    options.set_size_x_m(blocks * kBlock);
    options.set_size_y_m(blocks * kBlock);
    options.set_size_z_m(blocks * kBlock);
    return MakeVoxelGrid(options);
  };
  EXPECT_TRUE(make(1288).has_value());  // 1290^3 with the border, below 2^31 = 1290.2^3.
  EXPECT_EQ(make(1289).error().code(), StatusCode::kResourceExhausted);
}

TEST(VoxelGridTest, F71WithoutMemoryNothingFits) {
  VolumeOptions options;
  options.mutable_expert()->set_max_memory_bytes(0);
  EXPECT_EQ(MakeVoxelGrid(options).error().code(), StatusCode::kResourceExhausted);
}

TEST(VoxelGridTest, NonFiniteAndEmptyVolumesAreRefused) {
  for (const double bad : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    VolumeOptions options;
    options.set_size_y_m(bad);
    EXPECT_FALSE(Validate(options).ok()) << bad;
    options = VolumeOptions();
    options.set_voxel_size_m(bad);
    EXPECT_FALSE(Validate(options).ok()) << bad;
  }
}

TEST(TsdfVoxelTest, HoldsTheWeightedMeanOfItsObservations) {
  TsdfVoxel voxel;
  EXPECT_FALSE(voxel.observed());
  voxel.Update(0.5F, 1.0F, 100.0F);
  voxel.Update(-0.25F, 3.0F, 100.0F);
  EXPECT_NEAR(voxel.tsdf(), (0.5 - 0.75) / 4.0, 2.0 / TsdfVoxel::kTsdfScale);
  EXPECT_FLOAT_EQ(voxel.weight(), 4.0F);
  for (int i = 0; i < 200; ++i) voxel.Update(1.0F, 1.0F, 100.0F);
  EXPECT_FLOAT_EQ(voxel.weight(), 100.0F);
}

TEST(TsdfVolumeTest, RefusesAndCountsBlocksBeyondItsLimit) {
  const VoxelGrid grid = MakeVoxelGrid(SmallVolume()).value();
  TsdfVolume volume(grid, kTruncation, 2);
  EXPECT_EQ(volume.FindOrAllocate({0, 0, 0}), 0);
  EXPECT_EQ(volume.FindOrAllocate({1, 0, 0}), 1);
  EXPECT_EQ(volume.FindOrAllocate({0, 0, 0}), 0);
  EXPECT_EQ(volume.FindOrAllocate({2, 0, 0}), TsdfVolume::kNoBlock);
  EXPECT_EQ(volume.refused_blocks(), 1U);
  EXPECT_EQ(volume.Find({-1, 0, 0}), TsdfVolume::kNoBlock);
}

class RaycasterTest : public ::testing::Test {
 protected:
  RaycasterTest() : volume_(MakeVolume()) { testing::FillSphere(volume_, kCentre, kRadius); }
  SurfaceMaps Cast(int threads) {
    ThreadPool pool(threads);
    SurfaceMaps maps;
    Raycaster().Cast(volume_, camera_, pose_, 0.0F, pool, maps);
    return maps;
  }

  const Eigen::Vector3d kCentre{0.33, 0.31, 0.40};
  static constexpr double kRadius = 0.15;
  TsdfVolume volume_;
  CameraModel camera_ = testing::SmallDepthCamera();
  RigidTransform pose_ =
      MakeTransform({0.28, 0.33, -0.1}, Eigen::Quaterniond(0.995, 0.02, 0.08, -0.03));
};

TEST_F(RaycasterTest, MeetsTheSphereWhereTheClosedFormDoes) {
  constexpr double kMaxError = 0.1 * kVoxel;  // Trilinear interpolation of a curved distance.
  constexpr double kMinCosine = 0.9986;       // 3 degrees.
  constexpr double kGrazing = 0.35;           // Cosine below which a ray only scrapes the sphere.
  const SurfaceMaps maps = Cast(2);
  int hits = 0;
  for (int v = 0; v < camera_.height; ++v) {
    for (int u = 0; u < camera_.width; ++u) {
      const Eigen::Vector2d xy = Unproject(camera_, {u, v});
      const Eigen::Vector3d ray =
          (pose_.linear() * Eigen::Vector3d(xy.x(), xy.y(), 1.0)).normalized();
      const Eigen::Vector3d to_centre = kCentre - pose_.translation();
      const double along = to_centre.dot(ray);
      const double squared = kRadius * kRadius - (to_centre.squaredNorm() - along * along);
      const Eigen::Vector3d p(maps.vx.At(u, v), maps.vy.At(u, v), maps.vz.At(u, v));
      if (squared < 0.0) {
        // A ray that misses by less than a voxel may meet the interpolated surface.
        if (squared < -2.0 * kRadius * kVoxel) {
          EXPECT_TRUE(std::isnan(p.x())) << u << " " << v;
        }
        continue;
      }
      const Eigen::Vector3d truth = pose_.translation() + ray * (along - std::sqrt(squared));
      const Eigen::Vector3d normal = (truth - kCentre) / kRadius;
      if (-normal.dot(ray) < kGrazing) continue;
      ++hits;
      ASSERT_NEAR((p - truth).norm(), 0.0, kMaxError / -normal.dot(ray)) << u << " " << v;
      const Eigen::Vector3d n(maps.nx.At(u, v), maps.ny.At(u, v), maps.nz.At(u, v));
      ASSERT_GT(n.dot(normal), kMinCosine) << u << " " << v;
    }
  }
  EXPECT_GT(hits, 10'000);
}

TEST_F(RaycasterTest, GivesTheSameBitsForAnyNumberOfThreads) {
  const SurfaceMaps one = Cast(1);
  const SurfaceMaps three = Cast(3);
  EXPECT_EQ(std::memcmp(one.vx.data(), three.vx.data(), one.vx.size() * sizeof(float)), 0);
  EXPECT_EQ(std::memcmp(one.nz.data(), three.nz.data(), one.nz.size() * sizeof(float)), 0);
}

TEST_F(RaycasterTest, AnEmptyVolumeShowsNothing) {
  TsdfVolume empty = MakeVolume();
  ThreadPool pool(1);
  SurfaceMaps maps;
  Raycaster().Cast(empty, camera_, pose_, 0.0F, pool, maps);
  for (const float x : maps.vx.pixels()) ASSERT_TRUE(std::isnan(x));
}

TEST_F(RaycasterTest, ASurfaceSeenFromBehindIsNone) {
  pose_ = MakeTransform(kCentre, Eigen::Quaterniond::Identity());  // Inside the sphere.
  const SurfaceMaps maps = Cast(1);
  for (const float x : maps.vx.pixels()) ASSERT_TRUE(std::isnan(x));
}

TEST_F(RaycasterTest, FromAPoseThatIsNoneNothingIsSeen) {
  const RigidTransform pose = pose_;
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300, 1e30}) {
    for (int i = 0; i < 12; ++i) {
      pose_ = pose;
      pose_.matrix()(i % 3, i / 3) = bad;
      const SurfaceMaps maps = Cast(1);
      for (const float x : maps.vx.pixels()) ASSERT_TRUE(std::isnan(x)) << bad << " at " << i;
    }
  }
}

class TsdfIntegratorTest : public ::testing::Test {
 protected:
  TsdfIntegratorTest() : volume_(MakeVolume()) {
    preprocessing_.mutable_expert()->set_bilateral_radius_px(0);
  }
  void Integrate(const DepthFrame& frame, const RigidTransform& pose) {
    DepthPreprocessor preprocessor(preprocessing_, camera_, DepthSensorModel());
    TsdfIntegrator(options_).Integrate(preprocessor.Process(frame, pool_), pose, pool_, volume_);
  }

  PreprocessorOptions preprocessing_;
  TsdfOptions options_;
  CameraModel camera_ = testing::SmallDepthCamera();
  ThreadPool pool_{2};
  TsdfVolume volume_;
};

TEST_F(TsdfIntegratorTest, DistancesToATiltedPlaneDoNotDependOnTheViewingRay) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.4, -0.2, -1.0).normalized();
  const Eigen::Vector3d point(0.32, 0.32, 0.45);
  const auto plane = [&](const Eigen::Vector3d& p) { return normal.dot(p - point); };
  Integrate(testing::RenderDepth(plane, camera_, testing::FirstPose()), testing::FirstPose());
  constexpr double kTolerance = 0.0001;  // 10 um depth steps over normals of +-3 pixels, metres.
  int checked = 0;
  for (std::int32_t block = 0; block < volume_.block_count(); ++block) {
    testing::ForEachVoxel(volume_.voxels(block), volume_.grid(), volume_.block_coordinates(block),
                          [&](const TsdfVoxel& voxel, const Eigen::Vector3d& p) {
                            if (!voxel.observed() || std::abs(voxel.tsdf()) > 0.9F) return;
                            const Eigen::Vector3d c = testing::FirstPose().inverse() * p;
                            const auto pixel = Project(camera_, c);
                            constexpr double kBorder = 8.0;  // No normals there.
                            if (!pixel || pixel->x() < kBorder || pixel->y() < kBorder ||
                                pixel->x() > camera_.width - kBorder ||
                                pixel->y() > camera_.height - kBorder) {
                              return;
                            }
                            ++checked;
                            EXPECT_NEAR(voxel.tsdf() * kTruncation, plane(p), kTolerance);
                          });
  }
  EXPECT_GT(checked, 10'000);
}

TEST_F(TsdfIntegratorTest, F12PixelsWithoutReturnLeaveNoTrace) {
  DepthFrame frame;
  frame.depth_raw = Image<std::uint16_t>(camera_.width, camera_.height, kNoDepthSaturated);
  for (int x = 0; x < camera_.width; ++x) frame.depth_raw.At(x, 10) = kNoDepth;
  Integrate(frame, testing::FirstPose());
  EXPECT_EQ(volume_.block_count(), 0);
}

TEST_F(TsdfIntegratorTest, APoseThatIsNoneLeavesTheModelAlone) {
  const auto wall = [](const Eigen::Vector3d& p) { return 0.5 - p.z(); };
  const DepthFrame frame = testing::RenderDepth(wall, camera_, testing::FirstPose());
  Integrate(frame, testing::FirstPose());
  const auto model = [&] {
    std::vector<std::uint32_t> bits;
    for (std::int32_t block = 0; block < volume_.block_count(); ++block) {
      for (const TsdfVoxel& voxel : volume_.voxels(block)) bits.push_back(voxel.bits);
    }
    return bits;
  };
  const std::vector<std::uint32_t> before = model();
  ASSERT_FALSE(before.empty());
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300, 1e30}) {
    for (int i = 0; i < 12; ++i) {
      RigidTransform pose = testing::FirstPose();
      pose.matrix()(i % 3, i / 3) = bad;
      Integrate(frame, pose);
      ASSERT_EQ(model(), before) << bad << " at " << i;
    }
  }
}

TEST_F(TsdfIntegratorTest, SeeingThroughAStrayVoxelClearsIt) {
  const auto wall = [](const Eigen::Vector3d& p) { return 0.6 - p.z(); };
  const std::int32_t block = volume_.FindOrAllocate({10, 10, 10});  // In the air before the wall.
  for (TsdfVoxel& voxel : volume_.voxels(block)) voxel.Update(-0.2F, 1.0F, 100.0F);
  const DepthFrame frame = testing::RenderDepth(wall, camera_, testing::FirstPose());
  for (int i = 0; i < 20; ++i) Integrate(frame, testing::FirstPose());
  for (const TsdfVoxel& voxel : volume_.voxels(block)) EXPECT_GT(voxel.tsdf(), 0.5F);
}

TEST(TruncationDistanceTest, FollowsTheVoxelsUnlessItIsGiven) {
  TsdfOptions options;
  VolumeOptions volume;
  for (const double voxel_m : {0.001, 0.002, 0.005, 0.02}) {
    volume.set_voxel_size_m(voxel_m);
    EXPECT_DOUBLE_EQ(TruncationDistance(options, volume), 4.0 * voxel_m);
    EXPECT_TRUE(Validate(options, volume).ok()) << voxel_m;
  }
  options.mutable_expert()->set_truncation_distance_m(0.03);
  EXPECT_EQ(TruncationDistance(options, volume), 0.03);
  EXPECT_THAT(Validate(options, volume).message(), HasSubstr("at least two voxels"));
  volume.set_voxel_size_m(0.015);
  EXPECT_TRUE(Validate(options, volume).ok());
  options.mutable_expert()->set_truncation_distance_m(8.0);
  EXPECT_THAT(Validate(options, volume).message(), HasSubstr("at most 1 m"));
}

TEST(IntegrationGateTest, AcceptsMotionWithinBoundsAfterTheFirstFrames) {
  TsdfOptions options;
  options.mutable_expert()->set_bootstrap_frames(1);
  IntegrationGate gate(options);
  const auto at = [](double x_m, double angle_deg = 0.0) {
    return MakeTransform({x_m, 0, 0}, Eigen::Quaterniond(Eigen::AngleAxisd(
                                          angle_deg * M_PI / 180.0, Eigen::Vector3d::UnitY())));
  };
  EXPECT_TRUE(gate.Accepts(std::nullopt, at(0.0)));
  EXPECT_FALSE(gate.Accepts(at(0.0), at(0.0005))) << "less than 1 mm and 0.06 degrees";
  EXPECT_TRUE(gate.Accepts(at(0.0005), at(0.0011)));
  EXPECT_FALSE(gate.Accepts(at(0.0011), at(0.0121))) << "more than 10 mm since the frame before";
  EXPECT_TRUE(gate.Accepts(at(0.0121), at(0.0141)));
  EXPECT_FALSE(gate.Accepts(at(0.0141), at(0.0151, 0.7))) << "more than 0.6 degrees";
  EXPECT_TRUE(gate.Accepts(at(0.0151, 0.7), at(0.0151, 0.8)));
  EXPECT_FALSE(gate.Accepts(std::nullopt, at(0.03))) << "motion unknown after a loss";
  EXPECT_EQ(gate.accepted(), 4U);
}

}  // namespace
}  // namespace isotherm

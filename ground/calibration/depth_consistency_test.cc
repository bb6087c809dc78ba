#include "ground/calibration/depth_consistency.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "common/geometry/camera.h"

namespace isotherm {
namespace {

using ::testing::HasSubstr;

CameraModel SmallCamera() {
  CameraModel camera;
  camera.width = 320;
  camera.height = 240;
  camera.fx = camera.fy = 280.0;
  camera.cx = 159.5;
  camera.cy = 119.5;
  return camera;
}

/// Returns what a camera at the origin sees of a wall at `z_m`, turned about y.
SurfaceMaps Wall(const CameraModel& camera, double z_m, double turned_rad) {
  SurfaceMaps maps;
  maps.Resize(camera.width, camera.height);
  const Eigen::Vector3d normal(std::sin(turned_rad), 0.0, -std::cos(turned_rad));
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector3d ray((x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1.0);
      const Eigen::Vector3d p = ray * (-z_m * std::cos(turned_rad) / normal.dot(ray));
      maps.vx.At(x, y) = static_cast<float>(p.x());
      maps.vy.At(x, y) = static_cast<float>(p.y());
      maps.vz.At(x, y) = static_cast<float>(p.z());
      maps.nx.At(x, y) = static_cast<float>(normal.x());
      maps.ny.At(x, y) = static_cast<float>(normal.y());
      maps.nz.At(x, y) = static_cast<float>(normal.z());
    }
  return maps;
}

/// Assesses a camera whose distances are wrong by `error` (fractions of the image from its middle,
/// -0.5..0.5), with noise and poses that are off by a millimetre or two.
DepthAssessment Assess(const std::function<double(double x, double y)>& error, int frames = 100) {
  const CameraModel camera = SmallCamera();
  std::mt19937 engine(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  DepthConsistency consistency;
  for (int i = 0; i < frames; ++i) {
    const SurfaceMaps maps = Wall(camera, 0.7 + 0.1 * std::sin(0.3 * i), 0.2 * std::cos(0.2 * i));
    const double off_m = 0.002 * normal(engine), tilt = 0.002 * normal(engine);
    Image<float> depth_m(camera.width, camera.height, 0.0F);
    for (int y = 0; y < camera.height; ++y)
      for (int x = 0; x < camera.width; ++x) {
        const double u = static_cast<double>(x) / camera.width - 0.5;
        const double v = static_cast<double>(y) / camera.height - 0.5;
        const auto z = static_cast<double>(maps.vz.At(x, y));
        depth_m.At(x, y) = static_cast<float>((z + off_m + tilt * u) * (1.0 + error(u, v)) +
                                              0.001 * normal(engine));
      }
    consistency.Add(depth_m, maps, RigidTransform::Identity(),
                    i * DepthConsistency::kBlocks / frames);
  }
  return consistency.Assess();
}

TEST(DepthConsistencyTest, WhatSwellsIsFound) {
  const auto bowl = [](double u, double v) { return 0.02 * (u * u + v * v); };
  const DepthAssessment found = Assess(bowl);
  // Of a bowl over cells, without the plane that a pose takes: closed form by the cells' means.
  double mean = 0.0, squares = 0.0;
  const auto cell = [](int i, int cells) { return (i + 0.5) / cells - 0.5; };
  constexpr int kCells = DepthConsistency::kColumns * DepthConsistency::kRows;
  for (const bool is_second : {false, true})
    for (int c = 0; c < DepthConsistency::kColumns; ++c)
      for (int r = 0; r < DepthConsistency::kRows; ++r) {
        const double value =
            bowl(cell(c, DepthConsistency::kColumns), cell(r, DepthConsistency::kRows));
        if (is_second) {
          squares += (value - mean) * (value - mean) / kCells;
        } else {
          mean += value / kCells;
        }
      }
  EXPECT_EQ(found.verdict, CheckVerdict::kMoved);
  EXPECT_NEAR(found.uneven, std::sqrt(squares), 0.05 * std::sqrt(squares));
  EXPECT_LT(found.sigma, 0.1 * found.uneven);
  EXPECT_NEAR(found.distance_m, 0.7, 0.05);
  EXPECT_THAT(DescribeDepth(found), HasSubstr("uneven over the image by 0.2"));
}

TEST(DepthConsistencyTest, NoiseAndPosesAreNoUnevenness) {
  const DepthAssessment found = Assess([](double, double) { return 0.0; });
  EXPECT_EQ(found.verdict, CheckVerdict::kAgrees);
  EXPECT_LT(found.uneven, 0.5 * kMaxUneven);
  EXPECT_THAT(DescribeDepth(found), HasSubstr("ok, the same surface looks the same"));
}

TEST(DepthConsistencyTest, TooLittleTellsNothing) {
  EXPECT_EQ(DepthConsistency().Assess().verdict, CheckVerdict::kNotAssessed);
  // Of a few frames noise is as large.
  EXPECT_EQ(Assess([](double, double) { return 0.0; }, 3).verdict, CheckVerdict::kNotAssessed);
  EXPECT_THAT(DescribeDepth(DepthAssessment()), HasSubstr("cannot tell"));
}

}  // namespace
}  // namespace isotherm

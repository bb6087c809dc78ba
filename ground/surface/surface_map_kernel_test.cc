#include "ground/surface/surface_map_kernel.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>

#include "common/testing/kernel_checks.h"
#include "ground/surface/reference/surface_map_reference.h"

namespace isotherm {
namespace {

using testing::Random;
using testing::Tribool;

constexpr double kSinglePrecision = 1e-6;

std::array<Image<float>*, 6> Planes(SurfaceMaps& maps) {
  return {&maps.vx, &maps.vy, &maps.vz, &maps.nx, &maps.ny, &maps.nz};
}

class SurfaceMapRowTest : public ::testing::Test {
 protected:
  /// A slanted, noisy plane with holes and steps.
  void Rearrange(int width, int height) {
    depth_ = Image<float>(width, height);
    const float slope_x = random_.Uniform(-0.01F, 0.01F);
    const float slope_y = random_.Uniform(-0.01F, 0.01F);
    const float noise = random_.Uniform(0.0F, 0.004F);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        float z = 2.0F + slope_x * static_cast<float>(x) + slope_y * static_cast<float>(y);
        z += random_.Uniform(-noise, noise);
        if (random_.Chance(0.02)) z = random_.Chance(0.7) ? 0.0F : z + 0.5F;
        if (random_.Chance(0.01)) z = std::numeric_limits<float>::quiet_NaN();
        depth_.At(x, y) = z;
      }
    }
    maps_ = {};
    maps_.Resize(width, height);
    args_ = {&depth_,
             random_.Uniform(100.0F, 300.0F),
             random_.Uniform(100.0F, 300.0F),
             random_.Uniform(0.0F, 80.0F),
             random_.Uniform(0.0F, 60.0F),
             random_.Integer(1, 3),
             random_.Uniform(0.01F, 0.4F),
             random_.Chance(0.2) ? 0.0F : 0.006F};
  }

  void CompareRow(int y) {
    const int width = maps_.width();
    for (Image<float>* plane : Planes(maps_)) plane->Fill(static_cast<float>(testing::kCanary));
    SurfaceMapRow(args_, y, maps_);
    for (Image<float>* plane : Planes(maps_)) {
      for (int other = 0; other < maps_.height(); ++other) {
        for (int x = 0; x < width && other != y; ++x)
          ASSERT_EQ(plane->At(x, other), static_cast<float>(testing::kCanary)) << "row " << other;
      }
    }
    bool any = false;
    for (int x = 0; x < width; ++x) any = any || !std::isnan(maps_.vz.At(x, y));
    // Images narrower than a vector have no surface at all.
    if (!any && width - 2 * args_.reach < testing::kMaxLanes) return;
    for (int x = 0; x < width && !HasFatalFailure(); ++x) {
      SCOPED_TRACE(::testing::Message() << "pixel " << x << ", " << y << " of " << width);
      ComparePixel(x, y);
    }
  }
  void ComparePixel(int x, int y) {
    const reference::MapPixel truth = reference::MakeMapPixel(args_, x, y);
    const Eigen::Vector3d p(maps_.vx.At(x, y), maps_.vy.At(x, y), maps_.vz.At(x, y));
    const Eigen::Vector3d n(maps_.nx.At(x, y), maps_.ny.At(x, y), maps_.nz.At(x, y));
    const bool has_normal = p.allFinite() && n.allFinite();
    ASSERT_TRUE(has_normal || (p.array().isNaN().all() && n.array().isNaN().all()));
    if (truth.has_normal != Tribool::kEither) {
      ASSERT_EQ(has_normal, truth.has_normal == Tribool::kYes);
    }
    if (!has_normal) return;
    ASSERT_LT((p - truth.p).norm(), 3.0 * kSinglePrecision);
    ASSERT_LT((n - truth.n).norm(), truth.n_slack);
    ASSERT_NEAR(n.norm(), 1.0, 1e-5);
    ASSERT_LT(n.dot(p), 0.0) << "turned away from the camera";
    ++with_normal_;
  }

  Random random_;
  Image<float> depth_;
  SurfaceMaps maps_;
  SurfaceMapArgs args_{};
  int with_normal_ = 0;
};

TEST_F(SurfaceMapRowTest, MatchesTheScalarReferenceForAnyWidth) {
  testing::ForEachInstructionSet([&] {
    with_normal_ = 0;
    for (int width = 1; width <= 5 * testing::kMaxLanes; ++width) {
      Rearrange(width, random_.Integer(1, 12));
      for (int y = 0; y < maps_.height() && !HasFatalFailure(); ++y) CompareRow(y);
    }
    EXPECT_GT(with_normal_, 3000);
  });
}

TEST_F(SurfaceMapRowTest, WithoutDepthThereIsNoSurface) {
  testing::ForEachInstructionSet([&] {
    Rearrange(61, 9);
    depth_.Fill(0.0F);
    with_normal_ = 0;
    for (int y = 0; y < 9 && !HasFatalFailure(); ++y) CompareRow(y);
    EXPECT_EQ(with_normal_, 0);
  });
}

/// However far apart neighbours may be on a steep surface.
TEST_F(SurfaceMapRowTest, NoReturnIsNoNeighbour) {
  testing::ForEachInstructionSet([&] {
    Rearrange(61, 9);
    args_.max_step = 3.0F;
    for (float& z : depth_.pixels())
      z = static_cast<float>(random_.Integer(0, 2));  // 0, 1, 2 m is an even slope.
    for (int y = 0; y < 9 && !HasFatalFailure(); ++y) CompareRow(y);
  });
}

}  // namespace
}  // namespace isotherm

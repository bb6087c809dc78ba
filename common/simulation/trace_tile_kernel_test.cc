#include "common/simulation/trace_tile_kernel.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>

#include "common/simulation/reference/trace_tile_reference.h"
#include "common/testing/kernel_checks.h"

namespace isotherm {
namespace {

constexpr Shape kShapes[] = {Shape::kBox,      Shape::kRectangle, Shape::kSphere,
                             Shape::kCylinder, Shape::kTube,      Shape::kDisc};
constexpr std::int32_t kBefore = 3;  ///< The index of an earlier primitive's hits.
constexpr std::int32_t kTarget = 7;
/// Rays that graze hit or miss, or meet the near or the far wall, by rounding: about one in a
/// thousand.
constexpr double kMaxGrazing = 0.005;

/// A primitive of some centimetres that is half a metre to a metre away, turned at random.
TileTarget AtRandom(testing::Random& random) {
  const Eigen::Vector3f axis(random.Uniform(-1.0F, 1.0F), random.Uniform(-1.0F, 1.0F),
                             random.Uniform(0.1F, 1.0F));
  const Eigen::Matrix3f R =
      Eigen::AngleAxisf(random.Uniform(-3.0F, 3.0F), axis.normalized()).toRotationMatrix();
  const Eigen::Vector3f p_camera(random.Uniform(-0.1F, 0.1F), random.Uniform(-0.05F, 0.05F),
                                 random.Uniform(0.5F, 1.0F));
  const Eigen::Vector3f origin = -(R * p_camera);
  TileTarget target;
  target.index = kTarget;
  std::copy_n(R.data(), 9, target.R_primitive_camera);
  std::copy_n(origin.data(), 3, target.camera_in_primitive);
  const float outer = random.Uniform(0.05F, 0.2F);
  const float sizes[] = {outer, random.Uniform(0.3F, 0.9F) * outer, random.Uniform(0.03F, 0.1F)};
  std::copy_n(sizes, 3, target.size);
  return target;
}

/// A tile whose rays spread a quarter of the image.
std::unique_ptr<RayGrid::Tile> MakeTile() {
  auto tile = std::make_unique<RayGrid::Tile>();
  for (int i = 0; i < RayGrid::kTilePixels; ++i) {
    tile->ray_x[i] = 0.02F * static_cast<float>(i % RayGrid::kTileWidth - RayGrid::kTileWidth / 2);
    tile->ray_y[i] = 0.04F * static_cast<float>(i / RayGrid::kTileWidth - RayGrid::kTileHeight / 2);
  }
  tile->SetBounds();
  return tile;
}

TEST(TraceTileTest, KeepsTheNearerOfTwoHitsForEachShapeAndInstructionSet) {
  const auto tile = MakeTile();
  testing::ForEachInstructionSet([&] {
    testing::Random random;
    for (const Shape shape : kShapes) {
      int hits_of_target = 0, misses = 0, grazing = 0, all = 0;
      for (int round = 0; round < 200; ++round) {
        const TileTarget target = AtRandom(random);
        const float before_m = random.Uniform(0.5F, 1.1F);
        TileHits hits;
        std::fill_n(hits.z, RayGrid::kTilePixels, before_m);
        std::fill_n(hits.index, RayGrid::kTilePixels, kBefore);
        TraceTile(shape, target, *tile, hits);
        for (int i = 0; i < RayGrid::kTilePixels; ++i, ++all) {
          const double traced_m =
              reference::TraceRay(shape, target, tile->ray_x[i], tile->ray_y[i]);
          const double expected_m = std::min(traced_m, double{before_m});
          constexpr double kFloat_m = 1e-5;
          if (std::abs(double{hits.z[i]} - expected_m) > kFloat_m) {
            ++grazing;
            continue;
          }
          if (std::abs(traced_m - double{before_m}) > kFloat_m) {
            EXPECT_EQ(hits.index[i], traced_m < double{before_m} ? kTarget : kBefore);
          }
          ++(hits.index[i] == kTarget ? hits_of_target : misses);
        }
        EXPECT_EQ(hits.farthest, *std::max_element(hits.z, hits.z + RayGrid::kTilePixels));
      }
      EXPECT_GT(hits_of_target, all / 50);
      EXPECT_GT(misses, all / 10);
      EXPECT_LT(grazing, kMaxGrazing * all);
    }
  });
}

}  // namespace
}  // namespace isotherm

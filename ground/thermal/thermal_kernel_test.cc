#include "ground/thermal/thermal_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/frame/image.h"
#include "common/testing/kernel_checks.h"
#include "ground/thermal/reference/thermal_row_reference.h"

namespace isotherm {
namespace {

using testing::Random;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kSinglePrecision = 2e-6;  ///< Relative error of a sum of a few products.

/// For `width` pixels, and memory behind them for a whole vector.
std::vector<float> Row(int width, float value) {
  return std::vector<float>(static_cast<std::size_t>(width + testing::kMaxLanes), value);
}

std::vector<float> Output(int width) { return Row(width, static_cast<float>(testing::kCanary)); }

void ExpectCanary(const std::vector<float>& output, int width) {
  ASSERT_TRUE(
      std::all_of(output.begin() + width, output.end(),
                  [](float value) { return value == static_cast<float>(testing::kCanary); }))
      << "wrote beyond a row of " << width;
}

TEST(ResampleRowTest, MatchesTheScalarReferenceForAnyWidth) {
  constexpr int kWidth = 37;
  constexpr int kHeight = 5;
  Random random;
  Image<float> image(kWidth, kHeight);
  for (float& value : image.pixels()) {
    value = random.Uniform(-100.0F, 500.0F);
    if (random.Chance(0.05)) value = random.Chance(0.8) ? kNan : kInfinity;
  }
  testing::ForEachInstructionSet([&] {
    int values = 0;
    for (int width = 0; width <= 5 * testing::kMaxLanes; ++width) {
      std::vector<std::int32_t> source(static_cast<std::size_t>(width + testing::kMaxLanes), -1);
      std::vector<float> fx = Row(width, 0.0F);
      std::vector<float> fy = Row(width, 0.0F);
      for (std::size_t x = 0; x < source.size(); ++x) {
        if (random.Chance(0.8))
          source[x] = random.Integer(0, kHeight - 2) * kWidth + random.Integer(0, kWidth - 2);
        fx[x] = random.Chance(0.1) ? 1.0F : random.Uniform(0.0F, 1.0F);
        fy[x] = random.Chance(0.1) ? 0.0F : random.Uniform(0.0F, 1.0F);
      }
      std::vector<float> out = Output(width);
      const ResampleRowArgs args{image.data(), kWidth, source.data(), fx.data(), fy.data(), width};
      ResampleRow(args, out.data());
      ASSERT_NO_FATAL_FAILURE(ExpectCanary(out, width));
      for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
        const double truth = reference::ResamplePixel(args, static_cast<int>(x));
        ASSERT_EQ(std::isnan(out[x]), std::isnan(truth)) << "pixel " << x << " of " << width;
        if (!std::isfinite(truth)) continue;
        ASSERT_NEAR(out[x], truth, 500.0 * kSinglePrecision);
        ++values;
      }
    }
    EXPECT_GT(values, 1000);
  });
}

TEST(DistanceRowTest, MatchesTheScalarReferenceForAnyWidth) {
  constexpr double kHuge = 1e18;  // Squares beyond this may overflow.
  Random random;
  testing::ForEachInstructionSet([&] {
    for (int width = 0; width <= 5 * testing::kMaxLanes; ++width) {
      std::vector<float> planes[3];
      float position[3];
      for (int axis = 0; axis < 3; ++axis) {
        planes[axis] = Row(width, 0.0F);
        position[axis] = random.Chance(0.02) ? kNan : random.Uniform(-3.0F, 3.0F);
        for (float& value : planes[axis]) {
          value = random.Uniform(-3.0F, 3.0F);
          if (random.Chance(0.1)) value = kNan;
          if (random.Chance(0.02)) value = random.Chance(0.5) ? -kInfinity : 1e30F;
          if (random.Chance(0.1)) value = position[axis];
        }
      }
      std::vector<float> out = Output(width);
      DistanceRow(planes[0].data(), planes[1].data(), planes[2].data(), position, width,
                  out.data());
      ASSERT_NO_FATAL_FAILURE(ExpectCanary(out, width));
      for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
        const float vertex[3] = {planes[0][x], planes[1][x], planes[2][x]};
        const double truth = reference::Distance(vertex, position);
        if (truth > kHuge) {
          ASSERT_GT(out[x], kHuge) << "pixel " << x << " of " << width;
        } else {
          ASSERT_NEAR(out[x], truth, 5.0 * kSinglePrecision) << "pixel " << x << " of " << width;
        }
      }
    }
  });
}

}  // namespace
}  // namespace isotherm

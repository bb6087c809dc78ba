#include "ground/surface/filter_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/frame/image.h"
#include "common/testing/kernel_checks.h"
#include "ground/surface/reference/filter_reference.h"

namespace isotherm {
namespace {

using testing::Random;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kSinglePrecision = 1e-6;
constexpr int kMaxPixels = 5 * testing::kMaxLanes;

/// A row to write to, with a canary behind it.
class Output {
 public:
  explicit Output(int width)
      : width_(static_cast<std::size_t>(width)),
        values_(width_ + testing::kMaxLanes, static_cast<float>(testing::kCanary)) {}
  std::span<float> row() { return std::span(values_).first(width_); }
  float operator[](int x) const { return values_[static_cast<std::size_t>(x)]; }
  bool CanaryLives() const {
    return std::all_of(values_.begin() + static_cast<std::ptrdiff_t>(width_), values_.end(),
                       [](float v) { return v == static_cast<float>(testing::kCanary); });
  }

 private:
  const std::size_t width_;
  std::vector<float> values_;
};

class BilateralRowTest : public ::testing::Test {
 protected:
  /// An image of two walls, noisy and with holes, and the spatial weights.
  void Rearrange(int width) {
    radius_ = random_.Integer(1, 8);
    image_ = Image<float>(width, 2 * radius_ + 1);
    for (float& z : image_.pixels()) {
      z = (random_.Chance(0.8) ? 0.8F : 0.9F) + random_.Uniform(-0.01F, 0.01F);
      if (random_.Chance(0.2)) z = 0.0F;
      if (random_.Chance(0.02)) z = 65.0F;
    }
    rows_.clear();
    for (int y = 0; y < image_.height(); ++y) {
      const bool outside = y != radius_ && random_.Chance(0.15);
      rows_.push_back(outside ? nullptr : image_.Row(y).data());
    }
    const int side = 2 * radius_ + 1;
    spatial_.clear();
    for (int i = 0; i < side * side; ++i) spatial_.push_back(random_.Uniform(0.05F, 1.0F));
    args_ = {rows_.data(), spatial_.data(), radius_, width, random_.Uniform(0.01F, 0.2F)};
  }

  void CompareRow() {
    Output filtered(args_.width);
    BilateralRow(args_, filtered.row());
    ASSERT_TRUE(filtered.CanaryLives()) << "wrote beyond a row of " << args_.width;
    for (int x = 0; x < args_.width; ++x) {
      const double truth = reference::FilterPixel(args_, x);
      ASSERT_NEAR(filtered[x], truth, 20.0 * kSinglePrecision * truth)
          << "pixel " << x << " of " << args_.width << ", radius " << radius_;
      if (truth > 0.0) ++compared_;
    }
  }

  Random random_;
  int radius_ = 0;
  Image<float> image_;
  std::vector<const float*> rows_;
  std::vector<float> spatial_;
  BilateralRowArgs args_{};
  int compared_ = 0;
};

TEST_F(BilateralRowTest, MatchesTheScalarReferenceForAnyWidth) {
  testing::ForEachInstructionSet([&] {
    compared_ = 0;
    for (int width = 0; width <= kMaxPixels && !HasFatalFailure(); ++width) {
      for (int round = 0; round < 3 && !HasFatalFailure(); ++round) {
        Rearrange(width);
        CompareRow();
      }
    }
    EXPECT_GT(compared_, 5000);
  });
}

/// However far the weights reach in depth: at a long range or with a large sigma it is to zero.
TEST_F(BilateralRowTest, NoReturnNeverCounts) {
  testing::ForEachInstructionSet([&] {
    for (const float reach : {1.0F, 1.5F, 30.0F}) {
      for (const int width : {3, 40, 61}) {
        Rearrange(width);
        args_.tau_at_1m = reach;
        CompareRow();
      }
    }
  });
}

TEST(MetresRowTest, MatchesTheScalarReferenceForAnyWidth) {
  Random random;
  testing::ForEachInstructionSet([&] {
    for (int width = 0; width <= kMaxPixels; ++width) {
      std::vector<std::uint16_t> raw(static_cast<std::size_t>(width));
      for (std::uint16_t& value : raw) {
        value = static_cast<std::uint16_t>(random.Integer(0, 65535));
        if (random.Chance(0.3)) value = random.Chance(0.5) ? 0 : 65535;
        if (random.Chance(0.2)) value = static_cast<std::uint16_t>(random.Integer(299, 301));
      }
      const float scale = random.Chance(0.5) ? 0.001F : random.Uniform(1e-5F, 1.0F);
      const float least = random.Chance(0.2) ? 0.0F : 300 * scale;  // Itself still a depth.
      const MetresRowArgs args{raw.data(), scale, least, random.Uniform(1.0F, 80.0F)};
      Output depth_m(width);
      const int valid = MetresRow(args, depth_m.row());
      ASSERT_TRUE(depth_m.CanaryLives()) << "wrote beyond a row of " << width;
      int valid_truth = 0;
      for (int x = 0; x < width; ++x) {
        const std::uint16_t value = raw[static_cast<std::size_t>(x)];
        const double truth = reference::Metres(args, value);
        valid_truth += truth > 0.0 ? 1 : 0;
        ASSERT_NEAR(depth_m[x], truth, 65.0 * kSinglePrecision)
            << "pixel " << x << " of " << width << ", raw " << value;
        ASSERT_EQ(depth_m[x] > 0.0F, truth > 0.0);
      }
      ASSERT_EQ(valid, valid_truth);
    }
  });
}

TEST(MetresRowTest, AScaleThatIsNoneGivesNoDepth) {
  const std::vector<std::uint16_t> raw(37, 1000);
  testing::ForEachInstructionSet([&] {
    for (const float bad : {kNan, kInfinity, -kInfinity, -0.001F}) {
      Output depth_m(37);
      EXPECT_EQ(MetresRow({raw.data(), bad, 0.0F, 4.0F}, depth_m.row()), 0) << bad;
      for (int x = 0; x < 37; ++x) EXPECT_EQ(depth_m[x], 0.0F);
    }
  });
}

TEST(HalfRowTest, MatchesTheScalarReferenceForAnyWidth) {
  Random random;
  testing::ForEachInstructionSet([&] {
    for (int width = 0; width <= kMaxPixels; ++width) {
      std::vector<float> rows[2];
      for (std::vector<float>& row : rows) {
        row.resize(static_cast<std::size_t>(2 * width));
        for (float& z : row) {
          z = 0.8F * (1.0F + random.Uniform(-0.05F, 0.05F));
          if (random.Chance(0.3)) z = 0.0F;
          if (random.Chance(0.05)) z = random.Chance(0.5) ? kNan : -1.0F;
        }
      }
      const HalfRowArgs args{rows[0].data(), rows[1].data(), random.Uniform(0.0F, 0.1F)};
      Output half(width);
      HalfRow(args, half.row());
      ASSERT_TRUE(half.CanaryLives()) << "wrote beyond a row of " << width;
      for (int x = 0; x < width; ++x) {
        const reference::HalfPixel truth = reference::HalvePixel(args, x);
        const auto near = [&](double mean) { return std::abs(half[x] - mean) <= kSinglePrecision; };
        ASSERT_TRUE(std::any_of(truth.means.begin(), truth.means.end(), near))
            << "pixel " << x << " of " << width << ": " << half[x] << ", not "
            << truth.means.front();
      }
    }
  });
}

}  // namespace
}  // namespace isotherm

#include "ground/surface/filter_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
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

/// An image with a depth in some pixels, and the rows around its middle one.
class FillRowTest : public ::testing::Test {
 protected:
  static constexpr int kRadius = 2;
  static constexpr float kFocalLength = 300.0F;

  void Resize(int width) {
    image_ = Image<float>(width, 2 * kRadius + 1, 0.0F);
    rows_.clear();
    for (int y = 0; y < image_.height(); ++y) rows_.push_back(image_.Row(y).data());
    args_ = {rows_.data(), kRadius, width, 0.2F, 0.002F};
  }

  /// Noisy slopes with steps, of which any fraction is there.
  void Rearrange(int width) {
    Resize(width);
    const float noise = random_.Uniform(0.0F, 0.004F);
    const float slope_x = random_.Uniform(-0.01F, 0.01F);
    const float slope_y = random_.Uniform(-0.01F, 0.01F);
    const double there = random_.Uniform(0.1F, 1.0F);
    for (int y = 0; y < image_.height(); ++y) {
      for (int x = 0; x < width; ++x) {
        if (!random_.Chance(there)) continue;
        image_.At(x, y) = 0.8F + slope_x * static_cast<float>(x) + slope_y * static_cast<float>(y) +
                          random_.Uniform(-noise, noise) + (random_.Chance(0.02) ? 0.2F : 0.0F);
        if (random_.Chance(0.005)) image_.At(x, y) = random_.Chance(0.5) ? kNan : -1.0F;
      }
    }
    for (const float*& row : rows_) {
      if (&row != &rows_[kRadius] && random_.Chance(0.1)) row = nullptr;
    }
    args_.max_step_ratio = random_.Uniform(0.01F, 0.3F);
    args_.noise_at_1m = random_.Uniform(0.0F, 0.01F);
  }

  /// The depth of the plane n . p = distance along the ray of a pixel.
  static float PlaneDepth(const Eigen::Vector3d& n, double distance_m, double x, double y) {
    return static_cast<float>(
        distance_m / n.dot(Eigen::Vector3d((x - 30.0) / kFocalLength, y / kFocalLength, 1.0)));
  }

  Random random_;
  Image<float> image_;
  std::vector<const float*> rows_;
  FillRowArgs args_{};
};

TEST_F(FillRowTest, MatchesTheScalarReferenceForAnyWidth) {
  testing::ForEachInstructionSet([&] {
    int filled = 0, left = 0;
    for (int width = 0; width <= kMaxPixels; ++width) {
      for (int round = 0; round < 4; ++round) {
        Rearrange(width);
        Output row(width);
        FillRow(args_, row.row());
        ASSERT_TRUE(row.CanaryLives()) << "wrote beyond a row of " << width;
        const float* const measured = rows_[kRadius];
        const bool any = !std::equal(
            measured, measured + width, row.row().begin(),
            [](float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); });
        // Rows narrower than a vector are not filled at all.
        if (!any && width - 2 * kRadius < testing::kMaxLanes) continue;
        for (int x = 0; x < width; ++x) {
          if (!(measured[x] >= 0.0F)) continue;
          const std::optional<double> truth = reference::FillPixel(args_, x);
          if (!truth) continue;
          ASSERT_NEAR(row[x], *truth, 1e-4) << "pixel " << x << " of " << width;
          if (measured[x] == 0.0F) ++(*truth > 0.0 ? filled : left);
        }
      }
    }
    EXPECT_GT(filled, 1000);
    EXPECT_GT(left, 1000);
  });
}

TEST_F(FillRowTest, HolesInAPlaneGetItsDepth) {
  testing::ForEachInstructionSet([&] {
    for (const double tilt_deg : {0.0, 30.0, 60.0, 75.0}) {
      const double tilt = tilt_deg * M_PI / 180.0;
      const Eigen::Vector3d n(std::sin(tilt), 0.0, std::cos(tilt));
      Resize(61);
      args_.noise_at_1m = 1e-5F;
      for (int y = 0; y < image_.height(); ++y) {
        for (int x = 0; x < 61; ++x) {
          const bool is_hole = x % 3 == 2 || (y + 1) % 3 == 0 || random_.Chance(0.19);
          if (!is_hole) image_.At(x, y) = PlaneDepth(n, 0.5, x, y);
        }
      }
      Output row(61);
      FillRow(args_, row.row());
      int filled = 0;
      for (int x = kRadius; x < 61 - kRadius; ++x) {
        if (row[x] == 0.0F) continue;
        ASSERT_NEAR(row[x], PlaneDepth(n, 0.5, x, kRadius), 1e-5) << tilt_deg << " degrees, " << x;
        ++filled;
      }
      EXPECT_GE(filled, 50) << tilt_deg << " degrees";
    }
  });
}

TEST_F(FillRowTest, NothingIsFilledBesideASurfaceNorAcrossAnEdge) {
  testing::ForEachInstructionSet([&] {
    Resize(61);
    for (int y = 0; y < image_.height(); ++y) {
      for (int x = 10; x < 50; ++x) {
        const bool is_hole = x >= 29 && x <= 30;
        image_.At(x, y) = is_hole ? 0.0F : x < 30 ? 0.8F : 0.9F;
      }
    }
    Output row(61);
    FillRow(args_, row.row());
    for (int x = 0; x < 61; ++x) EXPECT_EQ(row[x], image_.At(x, kRadius)) << x;
  });
}

TEST(CountGapsTest, CountsWhatHasADepthAndWhatLacksANeighbour) {
  Random random;
  testing::ForEachInstructionSet([&] {
    for (int width = 0; width <= kMaxPixels; ++width) {
      Image<float> image(width, 2);
      for (float& z : image.pixels()) z = random.Chance(0.5) ? 0.0F : 0.8F;
      GapCount truth;
      for (int x = 0; x + 1 < width; ++x) {
        const bool seen = image.At(x, 0) > 0.0F;
        truth.pixels += seen ? 1 : 0;
        truth.beside_gap += seen && (image.At(x + 1, 0) == 0.0F || image.At(x, 1) == 0.0F) ? 1 : 0;
      }
      const GapCount count = CountGaps(image.Row(0).data(), image.Row(1).data(), width);
      ASSERT_EQ(count.pixels, truth.pixels) << width;
      ASSERT_EQ(count.beside_gap, truth.beside_gap) << width;
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

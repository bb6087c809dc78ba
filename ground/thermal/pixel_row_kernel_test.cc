#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/frame/image.h"
#include "common/testing/kernel_checks.h"
#include "ground/thermal/reference/pixel_row_reference.h"
#include "ground/thermal/thermal_kernel.h"

namespace isotherm {
namespace {

using testing::Both;
using testing::Random;
using testing::Tribool;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kFar = std::numeric_limits<float>::max();
constexpr double kSinglePrecision = 2e-6;  ///< Relative error of a sum of a few products.

/// For `width` pixels, and memory behind them for a whole vector.
std::vector<float> Row(int width, float value) {
  return std::vector<float>(static_cast<std::size_t>(width + testing::kMaxLanes), value);
}

class MakePixelRowTest : public ::testing::Test {
 protected:
  /// A wavy surface with gaps before both cameras, and things before it.
  void FillRow(int width) {
    const auto uniform = [&] { return random_.Uniform(-1.0F, 1.0F); };
    args_ = {};
    args_.width = width;
    args_.margin = random_.Integer(0, 3);
    for (std::vector<float>& plane : planes_) plane = Row(width, kNan);
    for (std::size_t x = 0; x < planes_[0].size(); ++x) {
      if (random_.Chance(0.2)) continue;
      const Eigen::Vector3f n = Eigen::Vector3f(uniform(), uniform(), -1.0F).normalized();
      const float p[6] = {
          0.6F * uniform(), 0.5F * uniform(), 0.7F + 0.4F * uniform(), n.x(), n.y(), n.z()};
      for (std::size_t k = 0; k < 6; ++k) planes_[k][x] = p[k];
      if (random_.Chance(0.1)) planes_[2][x] = -planes_[2][x];
    }
    distances_ = Image<float>(width + 2 * args_.margin, 1 + 2 * args_.margin, kFar);
    for (float& distance : distances_.pixels()) {
      if (random_.Chance(0.9)) distance = 0.7F + 0.02F * uniform();
    }
    celsius_ = Image<float>(width + 2, 3);
    for (float& value : celsius_.pixels()) {
      value = 20.0F * uniform();
      if (random_.Chance(0.1)) value = random_.Chance(0.8) ? kNan : 1e30F * uniform();
    }
    args_.distance_stride = distances_.width();
    args_.celsius_stride = celsius_.width();
    args_.distance_m = distances_.Row(args_.margin).data() + args_.margin;
    args_.celsius = celsius_.Row(1).data() + 1;
    for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) SetDistance(x);
    PointAtPlanes();
    Aim();
  }
  /// As DistanceRow and the cast make it, but for pixels beside a nearer one.
  void SetDistance(std::size_t x) {
    const Eigen::Vector3f p(planes_[0][x], planes_[1][x], planes_[2][x]);
    if (random_.Chance(0.5) && p.allFinite())
      distances_.Row(args_.margin)[x + static_cast<std::size_t>(args_.margin)] = p.norm();
  }
  void PointAtPlanes() {
    const float** const targets[6] = {&args_.vx, &args_.vy, &args_.vz,
                                      &args_.nx, &args_.ny, &args_.nz};
    for (std::size_t k = 0; k < 6; ++k) *targets[k] = planes_[k].data();
  }
  void Aim() {
    const auto uniform = [&] { return random_.Uniform(-1.0F, 1.0F); };
    const auto rotation = [&] {
      return Eigen::Quaternionf(1.0F, 0.1F * uniform(), 0.1F * uniform(), 0.1F * uniform())
          .normalized()
          .toRotationMatrix();
    };
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> R = rotation();
    std::copy_n(R.data(), 9, args_.R_depth);
    const Eigen::Matrix3f z = rotation();
    for (int i = 0; i < 3; ++i) {
      args_.x_axis[i] = z(i, 0);
      args_.y_axis[i] = z(i, 1);
      args_.z_axis[i] = z(i, 2);
      args_.t_depth[i] = 0.05F * uniform();
      args_.position[i] = 0.05F * uniform();
    }
    args_.z_axis[3] = 0.05F * uniform();
    args_.depth_fx = args_.depth_fy = 285.0F;
    args_.depth_cx = 159.5F;
    args_.depth_cy = 119.5F;
    args_.depth_width = 320.0F;
    args_.depth_height = 240.0F;
    args_.occlusion_tolerance_m = 0.02F;
    args_.distance_min_m = 0.3F;
    args_.distance_good_m = 0.7F;
    args_.distance_max_m = 0.9F;
    args_.cosine_min_angle = 0.999F;
    args_.cosine_good_angle = 0.8F;
    args_.cosine_max_angle = 0.5F;
    args_.max_footprint_m = random_.Chance(0.5) ? 1e18F : 0.004F;
    args_.max_error_k = random_.Chance(0.5) ? 1e18F : 12.0F;
    args_.uncertainty_px = random_.Chance(0.5) ? 0.5F : 0.9F;
    args_.fx = 250.0F;
    args_.fy = 260.0F;
    args_.cx = 30.0F;
    args_.y = 0.5F * uniform();
    for (int i = 0; i < 3; ++i) {
      args_.velocity_m_s[i] = 0.4F * uniform();
      args_.rate_rad_s[i] = 0.5F * uniform();
    }
    args_.smear_s = 0.01F;
    args_.smear_good_px = 0.8F;
    args_.smear_max_px = 1.8F;
    FillSigma();
  }
  /// Each term is at times all that there is, and at times nothing.
  void FillSigma() {
    noise_gain_ = Row(args_.width, 1.0F);
    for (float& gain : noise_gain_) gain = random_.Uniform(0.25F, 1.0F);
    args_.noise_gain = noise_gain_.data();
    const auto term = [&](float largest) {
      return random_.Chance(0.5) ? 0.0F : random_.Uniform(0.0F, largest);
    };
    constexpr float kResolution_k2 = 0.025F * 0.025F / 12.0F;
    args_.sigma = {.noise_k2 = term(0.01F),
                   .even_k2 = kResolution_k2 + term(0.04F),
                   .place_px2 = 1.0F / 12.0F + term(0.5F),
                   .voxel_px2_m2 = term(0.1F),
                   .time_s2 = term(1e-5F),
                   .scene_influence = term(0.05F),
                   .scene_celsius = random_.Uniform(-20.0F, 20.0F)};
  }

  void CompareRow() {
    const auto width = static_cast<std::size_t>(args_.width);
    std::vector<ThermalPixel> pixels(width + 1);
    std::vector<std::int32_t> planes(width + 1);
    pixels.back().flags = planes.back() = testing::kCanary;
    const PixelRowCounts counts = MakePixelRow(args_, pixels.data(), planes.data());
    ASSERT_EQ(pixels.back().flags, testing::kCanary) << "wrote beyond a row of " << width;
    ASSERT_EQ(planes.back(), testing::kCanary) << "wrote beyond a row of " << width;
    PixelRowCounts least, most;
    const auto tally = [](Tribool v, std::int64_t& low, std::int64_t& high) {
      low += v == Tribool::kYes ? 1 : 0;
      high += v != Tribool::kNo ? 1 : 0;
    };
    for (int x = 0; x < args_.width && !HasFatalFailure(); ++x) {
      SCOPED_TRACE(::testing::Message() << "pixel " << x << " of " << args_.width);
      const reference::Pixel truth = reference::MakePixel(args_, x);
      const Tribool visible = Both(truth.seen, reference::Not(truth.occluded));
      tally(Both(truth.seen, truth.occluded), least.occluded, most.occluded);
      tally(Both(visible, reference::Not(truth.sharp)), least.smeared, most.smeared);
      tally(Both(Both(visible, truth.sharp), reference::Not(truth.even)), least.steep, most.steep);
      ComparePixel(pixels[static_cast<std::size_t>(x)], truth, args_.celsius[x]);
      ComparePlane(planes[static_cast<std::size_t>(x)], truth);
    }
    for (const auto reason :
         {&PixelRowCounts::occluded, &PixelRowCounts::smeared, &PixelRowCounts::steep}) {
      ASSERT_GE(counts.*reason, least.*reason);
      ASSERT_LE(counts.*reason, most.*reason);
      counts_.*reason += counts.*reason;
    }
  }
  static void CompareFlag(const ThermalPixel& pixel, std::int32_t flag, Tribool truth) {
    if (truth != Tribool::kEither) {
      ASSERT_EQ((pixel.flags & flag) != 0, truth == Tribool::kYes) << "flag " << flag;
    }
  }
  static void ComparePlane(std::int32_t plane, const reference::Pixel& truth) {
    if (truth.surface == Tribool::kNo) {
      ASSERT_EQ(plane, 0);
    }
    constexpr double kNearEdgeOn = 1e-3;  // Cosine; the sign may go either way.
    if (truth.surface != Tribool::kYes || std::abs(truth.cosine) < kNearEdgeOn) return;
    ASSERT_NEAR(static_cast<std::int16_t>(plane & 0xFFFF), truth.plane_u, 0.51 + truth.plane_slack);
    ASSERT_NEAR(plane >> 16, truth.plane_v, 0.51 + truth.plane_slack);
  }
  void ComparePixel(const ThermalPixel& pixel, const reference::Pixel& truth, float celsius) {
    constexpr double kStep = 0.51;  // Codes.
    ASSERT_EQ(pixel.celsius, std::isnan(celsius) ? 0.0F : celsius);
    ASSERT_NEAR(static_cast<std::int16_t>(pixel.slopes & 0xFFFF), truth.slope_u, kStep);
    ASSERT_NEAR(pixel.slopes >> 16, truth.slope_v, kStep);
    ASSERT_NO_FATAL_FAILURE(CompareFlag(pixel, ThermalPixel::kSeen, truth.seen));
    ASSERT_NO_FATAL_FAILURE(CompareFlag(pixel, ThermalPixel::kAssignable, truth.assignable));
    if (truth.surface == Tribool::kNo) {
      ASSERT_EQ(pixel.depth_m, 0.0F);
    }
    if (truth.surface != Tribool::kYes) return;
    ASSERT_NEAR(pixel.depth_m, truth.depth_m, 3.0 * kSinglePrecision);
    if (truth.certain_distance) {
      ASSERT_EQ((pixel.flags >> 4) & 0xF, truth.distance_class);
    }
    if (truth.sharp != Tribool::kEither && truth.still != Tribool::kEither) {
      ASSERT_EQ((pixel.flags >> 12) & 0xF, truth.still == Tribool::kYes   ? 3
                                           : truth.sharp == Tribool::kYes ? 2
                                                                          : 1);
    }
    ASSERT_NEAR((pixel.flags >> ThermalPixel::kCosineShift) & 0xFF,
                255.0 * std::max(truth.cosine, 0.0), kStep);
    if (truth.certain_angle) {
      ASSERT_EQ(pixel.flags & 0xF, truth.angle_class);
    }
    ASSERT_NO_FATAL_FAILURE(CompareSigma(pixel, truth));
    assignable_ += (pixel.flags & ThermalPixel::kAssignable) != 0 ? 1 : 0;
  }
  static void CompareSigma(const ThermalPixel& pixel, const reference::Pixel& truth) {
    const std::uint8_t code = ThermalPixel::Sigma(pixel.flags);
    if ((pixel.flags & ThermalPixel::kAssignable) == 0) {
      ASSERT_EQ(code, 0);
      return;
    }
    constexpr double kRelative = 1e-3;  // A reciprocal, products and a root.
    const auto of = [&](double factor) {
      return SigmaCode::Of(static_cast<float>(factor * truth.sigma_k));
    };
    ASSERT_GE(code, of(1.0 - kRelative));
    ASSERT_LE(code, of(1.0 + kRelative));
  }

  Random random_;
  PixelRowArgs args_{};
  std::vector<float> planes_[6];
  Image<float> distances_, celsius_;
  std::vector<float> noise_gain_;
  PixelRowCounts counts_;
  int assignable_ = 0;
};

TEST_F(MakePixelRowTest, MatchesTheScalarReferenceForAnyWidth) {
  testing::ForEachInstructionSet([&] {
    counts_ = {};
    assignable_ = 0;
    for (int width = 0; width <= 5 * testing::kMaxLanes; ++width) {
      for (int round = 0; round < 5 && !HasFatalFailure(); ++round) {
        FillRow(width);
        CompareRow();
      }
    }
    EXPECT_GT(counts_.occluded, 500);
    EXPECT_GT(counts_.smeared, 500);
    EXPECT_GT(counts_.steep, 100);
    EXPECT_GT(assignable_, 500);
  });
}

TEST_F(MakePixelRowTest, NothingIsSeenFromAPoseThatIsNone) {
  testing::ForEachInstructionSet([&] {
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
      FillRow(70);
      for (int i = 0; i < 3; ++i) args_.t_depth[i] = args_.z_axis[i] = bad;
      std::vector<ThermalPixel> pixels(70);
      std::vector<std::int32_t> planes(70);
      EXPECT_EQ(MakePixelRow(args_, pixels.data(), planes.data()).occluded, 0);
      for (const ThermalPixel& pixel : pixels)
        ASSERT_EQ(pixel.flags & (ThermalPixel::kSeen | ThermalPixel::kAssignable), 0) << bad;
    }
  });
}

TEST_F(MakePixelRowTest, AVertexAtInfinityIsNotSeen) {
  testing::ForEachInstructionSet([&] {
    FillRow(70);
    for (std::vector<float>& plane : planes_) {
      for (float& value : plane) value = random_.Chance(0.5) ? kInfinity : -kInfinity;
    }
    std::vector<ThermalPixel> pixels(70);
    std::vector<std::int32_t> planes(70);
    EXPECT_EQ(MakePixelRow(args_, pixels.data(), planes.data()).occluded, 0);
    for (const ThermalPixel& pixel : pixels)
      ASSERT_EQ(pixel.flags & (ThermalPixel::kSeen | ThermalPixel::kAssignable), 0);
  });
}

}  // namespace
}  // namespace isotherm

#include "ground/thermal/thermal_kernel.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/frame/image.h"
#include "common/testing/kernel_checks_for_test.h"

namespace isotherm {
namespace {

using testing::AtLeastZero;
using testing::Both;
using testing::Random;
using testing::Verdict;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kFar = std::numeric_limits<float>::max();
constexpr double kSinglePrecision = 2e-6;  ///< Of a sum of a few products.

/// For `width` pixels, and memory behind them for a whole vector.
std::vector<float> Row(int width, float value) {
  return std::vector<float>(static_cast<std::size_t>(width + testing::kMostLanes), value);
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
  Image<float> picture(kWidth, kHeight);
  for (float& value : picture.pixels()) {
    value = random.Uniform(-100.0F, 500.0F);
    if (random.Chance(0.05)) value = random.Chance(0.8) ? kNan : kInfinity;
  }
  testing::ForEachInstructionSet([&] {
    int values = 0;
    for (int width = 0; width <= 5 * testing::kMostLanes; ++width) {
      std::vector<std::int32_t> source(static_cast<std::size_t>(width + testing::kMostLanes), -1);
      std::vector<float> fx = Row(width, 0.0F);
      std::vector<float> fy = Row(width, 0.0F);
      for (std::size_t x = 0; x < source.size(); ++x) {
        if (random.Chance(0.8))
          source[x] = random.Integer(0, kHeight - 2) * kWidth + random.Integer(0, kWidth - 2);
        fx[x] = random.Chance(0.1) ? 1.0F : random.Uniform(0.0F, 1.0F);
        fy[x] = random.Chance(0.1) ? 0.0F : random.Uniform(0.0F, 1.0F);
      }
      std::vector<float> out = Output(width);
      ResampleRow({picture.data(), kWidth, source.data(), fx.data(), fy.data(), width}, out.data());
      ASSERT_NO_FATAL_FAILURE(ExpectCanary(out, width));
      for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
        double truth = kNan;
        if (source[x] >= 0) {
          const float* p = picture.data() + source[x];
          const double above = p[0] + double{fx[x]} * (double{p[1]} - p[0]);
          const double below = p[kWidth] + double{fx[x]} * (double{p[kWidth + 1]} - p[kWidth]);
          truth = above + double{fy[x]} * (below - above);
        }
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
    for (int width = 0; width <= 5 * testing::kMostLanes; ++width) {
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
        double squared = 0.0;
        for (int axis = 0; axis < 3; ++axis)
          squared += std::pow(double{planes[axis][x]} - position[axis], 2);
        const double truth = std::isnan(squared) ? kFar : std::sqrt(squared);
        if (truth > kHuge) {
          ASSERT_GT(out[x], kHuge) << "pixel " << x << " of " << width;
        } else {
          ASSERT_NEAR(out[x], truth, 5.0 * kSinglePrecision) << "pixel " << x << " of " << width;
        }
      }
    }
  });
}

/// What MakePixelRow must make of a pixel.
struct ScalarPixel {
  double depth_m = 0.0;
  double slope_u = 0.0, slope_v = 0.0;  ///< Codes.
  Verdict surface = Verdict::kNo, seen = Verdict::kNo;
  Verdict occluded = Verdict::kNo, assignable = Verdict::kNo;
  int distance_class = 0;
  int angle_class = 0;
  bool certain_angle = true;
};

Verdict Not(Verdict v) {
  if (v == Verdict::kEither) return v;
  return v == Verdict::kYes ? Verdict::kNo : Verdict::kYes;
}

int ScalarClass(double value, double good_low, double good_high, double low, double high) {
  if (value >= good_low && value <= good_high) return 1;
  return value >= low && value <= high ? 2 : 0;
}

double ScalarSlope(float before, float after) {
  const double half = 0.5 * (double{after} - before) * double{ThermalPixel::kSlopeScale};
  return std::isnan(half) ? 0.0 : std::clamp(half, -32767.0, 32767.0);
}

ScalarPixel MakeScalarPixel(const PixelRowArgs& a, int x) {
  ScalarPixel result;
  const Eigen::Vector3d p(a.vx[x], a.vy[x], a.vz[x]);
  result.slope_u = ScalarSlope(a.celsius[x - 1], a.celsius[x + 1]);
  result.slope_v = ScalarSlope(a.celsius[x - a.celsius_stride], a.celsius[x + a.celsius_stride]);
  const Eigen::Vector3d z_axis = Eigen::Map<const Eigen::Vector3f>(a.z_axis).cast<double>();
  result.depth_m = z_axis.dot(p) + a.z_axis[3];
  const double reach = z_axis.cwiseAbs().dot(p.cwiseAbs()) + std::abs(a.z_axis[3]);
  result.surface = AtLeastZero(result.depth_m, kSinglePrecision * reach);

  const Eigen::Matrix3d R =
      Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(a.R_depth).cast<double>();
  const Eigen::Vector3d q = R * p + Eigen::Map<const Eigen::Vector3f>(a.t_depth).cast<double>();
  const double q_slack = kSinglePrecision * (p.cwiseAbs().sum() + 1.0);
  result.seen = Both(result.surface, AtLeastZero(q.z(), q_slack));
  const auto in_image = [&](double along, double f, double c, double size) {
    const double pixel = f * along / q.z() + c + 0.5;
    const double slack = 1e-4 + f * q_slack * (1.0 + std::abs(along / q.z())) / std::abs(q.z());
    return Both(AtLeastZero(pixel, slack), AtLeastZero(size - pixel, slack));
  };
  result.seen =
      Both(result.seen, Both(in_image(q.x(), a.depth_fx, a.depth_cx, double{a.depth_width}),
                             in_image(q.y(), a.depth_fy, a.depth_cy, double{a.depth_height})));

  const double distance = a.distance_m[x];
  double nearest = distance;
  for (int row = -a.margin; row <= a.margin; ++row) {
    for (int column = -a.margin; column <= a.margin; ++column)
      nearest = std::min(nearest, double{a.distance_m[x + row * a.distance_stride + column]});
  }
  result.occluded = AtLeastZero(distance - nearest - double{a.occlusion_tolerance_m},
                                kSinglePrecision * distance);
  result.distance_class = ScalarClass(distance, a.distance_min_m, a.distance_good_m,
                                      a.distance_min_m, a.distance_max_m);
  const Eigen::Vector3d to_camera =
      Eigen::Map<const Eigen::Vector3f>(a.position).cast<double>() - p;
  const Eigen::Vector3d n(a.nx[x], a.ny[x], a.nz[x]);
  const double cosine = std::min(n.dot(to_camera) / distance, 1.0);
  result.angle_class = ScalarClass(cosine, a.cosine_good_angle, a.cosine_min_angle,
                                   a.cosine_max_angle, a.cosine_min_angle);
  for (const float limit : {a.cosine_good_angle, a.cosine_min_angle, a.cosine_max_angle})
    result.certain_angle = result.certain_angle && std::abs(cosine - double{limit}) > 1e-5;
  result.assignable = Both(result.seen, Not(result.occluded));
  result.assignable = Both(result.assignable, AtLeastZero(cosine, 1e-5));
  if (std::isnan(a.celsius[x])) result.assignable = Verdict::kNo;
  return result;
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
    const auto turn = [&] {
      return Eigen::Quaternionf(1.0F, 0.1F * uniform(), 0.1F * uniform(), 0.1F * uniform())
          .normalized()
          .toRotationMatrix();
    };
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> R = turn();
    std::copy_n(R.data(), 9, args_.R_depth);
    const Eigen::Matrix3f z = turn();
    for (int i = 0; i < 3; ++i) {
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
  }

  void CompareRow() {
    const auto width = static_cast<std::size_t>(args_.width);
    std::vector<ThermalPixel> pixels(width + 1);
    pixels.back().flags = testing::kCanary;
    const std::int64_t hidden = MakePixelRow(args_, pixels.data());
    ASSERT_EQ(pixels.back().flags, testing::kCanary) << "wrote beyond a row of " << width;
    std::int64_t least_hidden = 0;
    std::int64_t most_hidden = 0;
    for (int x = 0; x < args_.width && !HasFatalFailure(); ++x) {
      SCOPED_TRACE(::testing::Message() << "pixel " << x << " of " << args_.width);
      const ScalarPixel truth = MakeScalarPixel(args_, x);
      const Verdict is_hidden = Both(truth.seen, truth.occluded);
      least_hidden += is_hidden == Verdict::kYes ? 1 : 0;
      most_hidden += is_hidden != Verdict::kNo ? 1 : 0;
      ComparePixel(pixels[static_cast<std::size_t>(x)], truth, args_.celsius[x]);
    }
    ASSERT_GE(hidden, least_hidden);
    ASSERT_LE(hidden, most_hidden);
    hidden_ += hidden;
  }
  static void CompareFlag(const ThermalPixel& pixel, std::int32_t flag, Verdict truth) {
    if (truth != Verdict::kEither) {
      ASSERT_EQ((pixel.flags & flag) != 0, truth == Verdict::kYes) << "flag " << flag;
    }
  }
  void ComparePixel(const ThermalPixel& pixel, const ScalarPixel& truth, float celsius) {
    constexpr double kStep = 0.51;  // Codes.
    ASSERT_EQ(pixel.celsius, std::isnan(celsius) ? 0.0F : celsius);
    ASSERT_NEAR(static_cast<std::int16_t>(pixel.slopes & 0xFFFF), truth.slope_u, kStep);
    ASSERT_NEAR(pixel.slopes >> 16, truth.slope_v, kStep);
    ASSERT_NO_FATAL_FAILURE(CompareFlag(pixel, ThermalPixel::kSeen, truth.seen));
    ASSERT_NO_FATAL_FAILURE(CompareFlag(pixel, ThermalPixel::kAssignable, truth.assignable));
    if (truth.surface == Verdict::kNo) {
      ASSERT_EQ(pixel.depth_m, 0.0F);
    }
    if (truth.surface != Verdict::kYes) return;
    ASSERT_NEAR(pixel.depth_m, truth.depth_m, 3.0 * kSinglePrecision);
    ASSERT_EQ((pixel.flags >> 4) & 0xF, truth.distance_class);
    if (truth.certain_angle) {
      ASSERT_EQ(pixel.flags & 0xF, truth.angle_class);
    }
    assignable_ += (pixel.flags & ThermalPixel::kAssignable) != 0 ? 1 : 0;
  }

  Random random_;
  PixelRowArgs args_{};
  std::vector<float> planes_[6];
  Image<float> distances_, celsius_;
  std::int64_t hidden_ = 0;
  int assignable_ = 0;
};

TEST_F(MakePixelRowTest, MatchesTheScalarReferenceForAnyWidth) {
  testing::ForEachInstructionSet([&] {
    hidden_ = assignable_ = 0;
    for (int width = 0; width <= 5 * testing::kMostLanes; ++width) {
      for (int round = 0; round < 5 && !HasFatalFailure(); ++round) {
        FillRow(width);
        CompareRow();
      }
    }
    EXPECT_GT(hidden_, 500);
    EXPECT_GT(assignable_, 500);
  });
}

TEST_F(MakePixelRowTest, NothingIsSeenFromAPoseThatIsNone) {
  testing::ForEachInstructionSet([&] {
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
      FillRow(70);
      for (int i = 0; i < 3; ++i) args_.t_depth[i] = args_.z_axis[i] = bad;
      std::vector<ThermalPixel> pixels(70);
      EXPECT_EQ(MakePixelRow(args_, pixels.data()), 0);
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
    EXPECT_EQ(MakePixelRow(args_, pixels.data()), 0);
    for (const ThermalPixel& pixel : pixels)
      ASSERT_EQ(pixel.flags & (ThermalPixel::kSeen | ThermalPixel::kAssignable), 0);
  });
}

}  // namespace
}  // namespace isotherm

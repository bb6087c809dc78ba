#include "ground/icp/icp_kernel.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/testing/kernel_checks.h"
#include "ground/icp/reference/icp_reference.h"

namespace isotherm {
namespace {

using testing::Random;
using testing::Tribool;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

using RowMajor = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

std::array<Image<float>*, 6> Planes(SurfaceMaps& maps) {
  return {&maps.vx, &maps.vy, &maps.vz, &maps.nx, &maps.ny, &maps.nz};
}

class AccumulateIcpRowsTest : public ::testing::Test {
 protected:
  /// A bumpy wall seen from two poses near each other, with holes, edges and outliers.
  void Rearrange(int width, int height) {
    const int model_width = random_.Integer(1, 90);
    const int model_height = random_.Integer(1, 40);
    args_ = {};
    const RowMajor R = Rotation(0.02F);
    const RowMajor R_map = Rotation(1.0F);
    const Eigen::Vector3f t_map(Uniform(), Uniform(), Uniform());
    const Eigen::Vector3f t = 0.005F * Eigen::Vector3f(Uniform(), Uniform(), Uniform());
    // The model's camera is the world's turned and moved by what leads from the current one.
    const RowMajor R_model = R_map * R.transpose();
    const Eigen::Vector3f t_model = t_map - R_model * t;
    std::copy_n(R_map.data(), 9, args_.R_map_depth);
    std::copy_n(t_map.data(), 3, args_.t_map_depth);
    std::copy_n(R.data(), 9, args_.R_model_depth);
    std::copy_n(t.data(), 3, args_.t_model_depth);
    args_.fx = args_.fy = random_.Uniform(30.0F, 100.0F);
    args_.cx = 0.5F * static_cast<float>(model_width) + Uniform();
    args_.cy = 0.5F * static_cast<float>(model_height) + Uniform();
    FillWall(width, height, RowMajor::Identity(), Eigen::Vector3f::Zero(), current_);
    FillWall(model_width, model_height, R_model, t_model, model_);
    args_.current = &current_;
    args_.model = &model_;
    const Eigen::Vector3f middle = t_map + R_map * Eigen::Vector3f(0.0F, 0.0F, 0.7F);
    for (int axis = 0; axis < 3; ++axis) {
      args_.volume_min[axis] = middle[axis] - 0.3F;
      args_.volume_max[axis] = middle[axis] + 0.3F;
    }
    args_.max_squared_distance_m2 = 0.03F * 0.03F;
    args_.min_normal_cosine = 0.9F;
    args_.reference_depth_m = 0.5F;
    RemoveUncertain();
  }
  void FillWall(int width, int height, const RowMajor& R, const Eigen::Vector3f& t,
                SurfaceMaps& maps) {
    maps = {};
    maps.Resize(width, height);
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const float z = 0.7F + (random_.Chance(0.1) ? 0.5F : 0.01F) * Uniform();
        const Eigen::Vector3f ray(
            (static_cast<float>(x) - 0.5F * static_cast<float>(width)) / args_.fx,
            (static_cast<float>(y) - 0.5F * static_cast<float>(height)) / args_.fy, 1.0F);
        const Eigen::Vector3f p = R * (z * ray) + t;
        const Eigen::Vector3f n =
            R * Eigen::Vector3f(0.3F * Uniform(), 0.3F * Uniform(), -1.0F).normalized();
        const float values[6] = {p.x(), p.y(), p.z(), n.x(), n.y(), n.z()};
        const bool hole = random_.Chance(0.15);
        for (std::size_t k = 0; k < 6; ++k) Planes(maps)[k]->At(x, y) = hole ? kNan : values[k];
      }
    }
  }
  /// Pixels whose part in the sums rounding would decide.
  void RemoveUncertain() {
    for (int y = 0; y < current_.height(); ++y) {
      for (int x = 0; x < current_.width(); ++x) {
        const reference::Pair pair = reference::MakePair(args_, x, y);
        if (pair.candidate != Tribool::kEither && pair.inlier != Tribool::kEither) continue;
        for (Image<float>* plane : Planes(current_)) plane->At(x, y) = kNan;
      }
    }
  }

  void Compare(int first_row, int last_row) {
    IcpKernelSums truth_counts;
    std::array<double, 28> truth{}, magnitude{};
    for (int y = first_row; y < last_row; ++y) {
      for (int x = 0; x < current_.width(); ++x) {
        const reference::Pair pair = reference::MakePair(args_, x, y);
        truth_counts.candidates += pair.candidate == Tribool::kYes ? 1 : 0;
        if (pair.inlier != Tribool::kYes) continue;
        ++truth_counts.inliers;
        for (std::size_t k = 0; k < 28; ++k) {
          truth[k] += pair.terms[k];
          magnitude[k] += std::abs(pair.terms[k]);
        }
      }
    }
    IcpKernelSums sums;
    for (float& sum : sums.sums) sum = 1.0F;  // What is there is added to.
    sums.candidates = sums.inliers = 1000;
    AccumulateIcpRows(args_, first_row, last_row, sums);
    ASSERT_EQ(sums.candidates, truth_counts.candidates + 1000);
    ASSERT_EQ(sums.inliers, truth_counts.inliers + 1000);
    // Terms with a residual: differences of coordinates of up to two metres.
    const double residual_slack = 1e-6 * static_cast<double>(truth_counts.inliers);
    for (std::size_t k = 0; k < 28; ++k) {
      const double slack = 1e-5 * (magnitude[k] + 1.0) + (k >= 21 ? residual_slack : 0.0);
      ASSERT_NEAR(sums.sums[k] - 1.0F, truth[k], slack) << "sum " << k;
    }
    inliers_ += truth_counts.inliers;
    outliers_ += truth_counts.candidates - truth_counts.inliers;
  }

  float Uniform() { return random_.Uniform(-1.0F, 1.0F); }
  RowMajor Rotation(float most) {
    return Eigen::Quaternionf(1.0F, most * Uniform(), most * Uniform(), most * Uniform())
        .normalized()
        .toRotationMatrix();
  }

  Random random_;
  SurfaceMaps current_, model_;
  IcpKernelArgs args_{};
  std::int64_t inliers_ = 0;
  std::int64_t outliers_ = 0;
};

TEST_F(AccumulateIcpRowsTest, MatchesTheScalarReferenceForAnyWidth) {
  testing::ForEachInstructionSet([&] {
    inliers_ = outliers_ = 0;
    for (int width = 1; width <= 5 * testing::kMaxLanes && !HasFatalFailure(); ++width) {
      Rearrange(width, random_.Integer(1, 12));
      SCOPED_TRACE(::testing::Message() << width << " x " << current_.height() << " pixels");
      Compare(0, current_.height());
      const int first = random_.Integer(0, current_.height());
      if (!HasFatalFailure()) Compare(first, random_.Integer(first, current_.height()));
    }
    EXPECT_GT(inliers_, 3000);
    EXPECT_GT(outliers_, 3000);
  });
}

TEST_F(AccumulateIcpRowsTest, APoseThatIsNoneHasNoInliers) {
  testing::ForEachInstructionSet([&] {
    for (const float bad : {kNan, kInfinity, -kInfinity, 1e30F}) {
      for (float* const place :
           {args_.R_map_depth, args_.t_map_depth, args_.R_model_depth, args_.t_model_depth}) {
        Rearrange(70, 9);
        for (int i = 0; i < 3; ++i) place[i] = bad;
        IcpKernelSums sums;
        AccumulateIcpRows(args_, 0, 9, sums);
        EXPECT_EQ(sums.inliers, 0) << bad;
        for (const float sum : sums.sums) EXPECT_EQ(sum, 0.0F) << bad;
      }
    }
  });
}

TEST_F(AccumulateIcpRowsTest, AModelThatWasNeverCastHasNoInliers) {
  testing::ForEachInstructionSet([&] {
    Rearrange(70, 9);
    const SurfaceMaps empty;
    args_.model = &empty;
    IcpKernelSums sums;
    AccumulateIcpRows(args_, 0, 9, sums);
    EXPECT_GT(sums.candidates, 0);
    EXPECT_EQ(sums.inliers, 0);
  });
}

}  // namespace
}  // namespace isotherm

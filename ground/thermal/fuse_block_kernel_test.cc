#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "common/testing/kernel_checks.h"
#include "ground/thermal/reference/fuse_block_reference.h"
#include "ground/thermal/thermal_fuser.h"
#include "ground/thermal/thermal_kernel.h"

namespace isotherm {
namespace {

using testing::Random;
using testing::Tribool;

class FuseBlockTest : public ::testing::Test {
 protected:
  static constexpr std::size_t kVoxels = 512;
  static constexpr float kVoxel = 0.004F;
  using Words = std::array<std::uint32_t, kVoxels + 1>;
  /// Unchecked, acceptable, good: smeared pixels are never assignable.
  static constexpr std::int32_t kAllGood = 0x3011;  ///< As docs/model-format.md has it.
  static constexpr std::array kMotionCodes = {0, 2 << 12, 3 << 12};

  /// A camera of any size before a bumpy wall half a metre away, of which a part is not seen.
  void RearrangeImage(int width, int height) {
    pixels_.assign(static_cast<std::size_t>(width * height) + 1, ThermalPixel{});
    planes_.assign(pixels_.size(), 0);
    for (std::int32_t& plane : planes_) {
      const int limit = random_.Chance(0.1) ? 32767 : 500;
      plane = (random_.Integer(-limit, limit) << 16) | (random_.Integer(-limit, limit) & 0xFFFF);
    }
    for (std::size_t i = 0; i + 1 < pixels_.size(); ++i) {
      if (random_.Chance(0.1)) continue;
      ThermalPixel& pixel = pixels_[i];
      pixel.depth_m = 0.5F + 0.01F * Uniform();
      pixel.celsius = random_.Chance(0.1) ? 3000.0F * Uniform() : 60.0F * Uniform();
      pixel.slopes = (random_.Integer(-2000, 2000) << 16) | (random_.Integer(-2000, 2000) & 0xFFFF);
      pixel.flags = kMotionCodes[random_.Integer(0, 2)] | (random_.Integer(0, 2) << 4) |
                    random_.Integer(0, 2);
      if (random_.Chance(0.3)) pixel.flags = kAllGood;
      if (random_.Chance(0.9)) pixel.flags |= ThermalPixel::kSeen;
      if ((pixel.flags & ThermalPixel::kSeen) != 0 && random_.Chance(0.8))
        pixel.flags |= ThermalPixel::kAssignable;
      // Few values, so that some are the same.
      pixel.flags |= random_.Integer(1, 4) * (random_.Chance(0.5) ? 1 : 63)
                     << ThermalPixel::kSigmaShift;
    }
    args_.pixels = pixels_.data();
    args_.planes = planes_.data();
    args_.width = width;
    args_.height = height;
    args_.fx = random_.Uniform(50.0F, 300.0F);
    args_.fy = random_.Uniform(50.0F, 300.0F);
    args_.cx = random_.Uniform(0.0F, static_cast<float>(width));
    args_.cy = random_.Uniform(0.0F, static_cast<float>(height));
    args_.max_distance_m = random_.Uniform(0.5F, 3.0F) * kVoxel;
    args_.max_tsdf_code = random_.Integer(1000, 32767);
    args_.validate = random_.Chance(0.7);
    args_.keep_bad = random_.Chance(0.5);
    args_.keep_lowest = random_.Chance(0.3);
  }

  void RearrangeBlock() {
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> axes =
        kVoxel * Eigen::Quaternionf(Uniform(), Uniform(), Uniform(), Uniform())
                     .normalized()
                     .toRotationMatrix();
    std::copy_n(axes.data(), 9, args_.axes);
    const float z = random_.Chance(0.1) ? random_.Uniform(-0.6F, 0.05F) : 0.5F;
    const float u = random_.Uniform(0.0F, static_cast<float>(args_.width));
    const float v = random_.Uniform(0.0F, static_cast<float>(args_.height));
    first_ = z * Eigen::Vector3f((u - args_.cx) / args_.fx, (v - args_.cy) / args_.fy, 1.0F) -
             axes * Eigen::Vector3f::Constant(3.5F);
    for (std::size_t i = 0; i < kVoxels; ++i) {
      const auto tsdf = static_cast<std::uint32_t>(random_.Integer(-32767, 32767) / 2);
      tsdf_[i] = (tsdf << 16) |
                 static_cast<std::uint32_t>(random_.Chance(0.2) ? 0 : random_.Integer(1, 65535));
      const auto code = static_cast<std::uint32_t>(random_.Integer(1, 65535));
      int classes = kMotionCodes[random_.Integer(0, 2)] | (random_.Integer(0, 2) << 4) |
                    random_.Integer(0, 2);
      if (random_.Chance(0.3)) classes = kAllGood;
      classes |= random_.Integer(0, 3) << 8;
      thermal_[i] = random_.Chance(0.4) ? 0 : (code << 16) | static_cast<std::uint32_t>(classes);
    }
    thermal_.back() = static_cast<std::uint32_t>(testing::kCanary);
    ArrangeSigmas();
  }

  /// Some rows have none, and in others some voxels.
  void ArrangeSigmas() {
    for (std::size_t i = 0; i < kVoxels; ++i) {
      sigmas_[i] =
          static_cast<std::uint8_t>(random_.Integer(0, 4) * (random_.Chance(0.5) ? 1 : 63));
    }
    for (std::size_t row = 0; row < block_sigmas_.rows.size(); ++row) {
      const bool known = random_.Chance(0.7);
      block_sigmas_.rows[row] = known ? &sigmas_[8 * row] : nullptr;
      if (!known) std::fill_n(&sigmas_[8 * row], 8, std::uint8_t{0});
    }
  }

  void CompareBlock() {
    const Words before = thermal_;
    FusionKernelCounts counts;
    BlockMeasurements measured;
    FuseBlock(args_, {first_.data(), tsdf_.data(), block_sigmas_, thermal_.data()}, counts,
              &measured);
    ASSERT_EQ(thermal_.back(), before.back()) << "wrote beyond the block";
    const Eigen::Matrix3d axes =
        Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(args_.axes).cast<double>();
    FusionKernelCounts least, most;
    const auto count = [](Tribool v, std::int64_t& low, std::int64_t& high) {
      low += v == Tribool::kYes ? 1 : 0;
      high += v != Tribool::kNo ? 1 : 0;
    };
    for (std::size_t i = 0; i < kVoxels && !HasFatalFailure(); ++i) {
      const auto index = static_cast<int>(i);
      const Eigen::Vector3d p =
          first_.cast<double>() + axes * Eigen::Vector3d(index & 7, (index >> 3) & 7, index >> 6);
      const reference::VoxelFusion truth =
          reference::FuseVoxel(args_, p, {tsdf_[i]}, {before[i]}, sigmas_[i]);
      count(truth.considered, least.considered, most.considered);
      // Bad conditions leave no temperature (code 0).
      const bool takes = truth.code > 0.0 || truth.assigned == Tribool::kEither;
      count(takes ? truth.assigned : Tribool::kNo, least.assigned, most.assigned);
      CompareVoxel(truth, before[i], thermal_[i]);
    }
    ASSERT_GE(counts.considered, least.considered);
    ASSERT_LE(counts.considered, most.considered);
    ASSERT_GE(counts.assigned, least.assigned);
    ASSERT_LE(counts.assigned, most.assigned);
    CompareMeasurements(before, measured, counts.assigned);
    assigned_ += counts.assigned;
    kept_ += counts.considered - counts.assigned;
  }
  /// The noted measurements are those that the block shows, and no temperature under good
  /// conditions is missed.
  void CompareMeasurements(const Words& before, const BlockMeasurements& measured,
                           std::int64_t assigned) {
    ASSERT_LE(measured.count, static_cast<int>(kVoxels));
    std::int64_t noted = 0;
    for (int i = 0; i < measured.count; ++i) {
      const auto word = static_cast<std::uint32_t>(measured.words[i]);
      const auto voxel = static_cast<std::size_t>(measured.voxels[i]) & 511;
      if (i > 0) {
        ASSERT_GT(voxel, static_cast<std::size_t>(measured.voxels[i - 1]) & 511) << "in order";
      }
      ASSERT_EQ(static_cast<std::int32_t>(word & 0xFFFFU), measured.flags[i] & 0xF0FF);
      if ((measured.voxels[i] & BlockMeasurements::kAssigned) != 0) {
        ++noted;
        ASSERT_EQ(thermal_[voxel], word | (before[voxel] & 0x0F00U)) << "disagreement stays";
      } else {
        ASSERT_EQ(word & 0xFFFFU, 0x3011U) << "good, but not taken";
        ASSERT_EQ(thermal_[voxel], before[voxel]);
      }
    }
    ASSERT_EQ(noted, assigned);
    good_not_taken_ += measured.count - noted;
  }
  static void CompareVoxel(const reference::VoxelFusion& truth, std::uint32_t before,
                           std::uint32_t after) {
    if (truth.assigned == Tribool::kNo) {
      ASSERT_EQ(after, before);
    }
    if (truth.assigned != Tribool::kYes) return;
    ASSERT_NEAR(static_cast<double>(after >> 16), truth.code, truth.slack);
    ASSERT_EQ(static_cast<std::int32_t>(after & 0xF0FFU), truth.classes);
    ASSERT_EQ(after & 0x0F00U, before & 0x0F00U);
  }

  float Uniform() { return random_.Uniform(-1.0F, 1.0F); }

  Random random_;
  std::vector<ThermalPixel> pixels_;
  std::vector<std::int32_t> planes_;
  FusionKernelArgs args_{};
  Eigen::Vector3f first_;
  Words tsdf_{}, thermal_{};
  std::array<std::uint8_t, kVoxels> sigmas_{};
  BlockSigmas block_sigmas_;
  std::int64_t assigned_ = 0;
  std::int64_t kept_ = 0;
  std::int64_t good_not_taken_ = 0;
};

TEST_F(FuseBlockTest, MatchesTheScalarReferenceForAnyImageAndPose) {
  testing::ForEachInstructionSet([&] {
    assigned_ = kept_ = good_not_taken_ = 0;
    for (int width = 1; width <= 70; ++width) {
      RearrangeImage(width, random_.Integer(1, 50));
      for (int round = 0; round < 6 && !HasFatalFailure(); ++round) {
        RearrangeBlock();
        CompareBlock();
      }
    }
    EXPECT_GT(assigned_, 5000);
    EXPECT_GT(kept_, 5000);
    EXPECT_GT(good_not_taken_, 10);
  });
}

TEST_F(FuseBlockTest, UnderEqualClassesTheSmallerUncertaintyStaysIfTheyAgree) {
  testing::ForEachInstructionSet([&] {
    RearrangeImage(64, 48);
    args_.validate = true;
    args_.keep_lowest = false;
    constexpr std::uint8_t kNew = 0x80;  // The sign of the flags must not matter.
    for (ThermalPixel& pixel : pixels_) {
      if (&pixel == &pixels_.back()) break;
      pixel = {.depth_m = 0.5F, .celsius = 20.0F, .slopes = 0, .flags = kAllGood};
      pixel.flags |= ThermalPixel::kSeen | ThermalPixel::kAssignable |
                     static_cast<std::int32_t>(std::uint32_t{kNew} << ThermalPixel::kSigmaShift);
    }
    const auto assigned_over = [&](std::uint8_t old_sigma, float old_celsius = 20.0F) {
      const ThermalVoxel old = ThermalVoxel::Make(old_celsius, ConditionClass::kGood,
                                                  ConditionClass::kGood, ConditionClass::kGood);

      std::int64_t assigned = 0;
      for (int round = 0; round < 20; ++round) {
        RearrangeBlock();
        for (std::size_t i = 0; i < kVoxels; ++i) thermal_[i] = old.bits;
        sigmas_.fill(old_sigma);
        for (std::size_t row = 0; row < block_sigmas_.rows.size(); ++row)
          block_sigmas_.rows[row] = &sigmas_[8 * row];
        FusionKernelCounts counts;
        FuseBlock(args_, {first_.data(), tsdf_.data(), block_sigmas_, thermal_.data()}, counts,
                  nullptr);
        assigned += counts.assigned;
      }
      return assigned;
    };
    EXPECT_EQ(assigned_over(kNew - 1), 0) << "what is known better stays";
    EXPECT_GT(assigned_over(kNew), 100);
    EXPECT_GT(assigned_over(kNew + 1), 100);
    EXPECT_GT(assigned_over(0), 100) << "not known";
    const double allowed_k = 3.0 * std::hypot(SigmaCode::Kelvin(kNew), SigmaCode::Kelvin(kNew - 1));
    const auto apart = [&](double part) { return 20.0F + static_cast<float>(part * allowed_k); };
    EXPECT_EQ(assigned_over(kNew - 1, apart(0.98)), 0);
    EXPECT_GT(assigned_over(kNew - 1, apart(1.02)), 100) << "one of them is wrong";
    EXPECT_GT(assigned_over(kNew - 1, apart(-1.02)), 100);
  });
}

TEST_F(FuseBlockTest, LeavesTheBlockAloneAtAPositionThatIsNone) {
  testing::ForEachInstructionSet([&] {
    RearrangeImage(64, 48);
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
          -std::numeric_limits<float>::infinity(), 1e30F}) {
      for (int axis = 0; axis < 3; ++axis) {
        RearrangeBlock();
        first_[axis] = bad;
        const Words before = thermal_;
        FusionKernelCounts counts;
        FuseBlock(args_, {first_.data(), tsdf_.data(), block_sigmas_, thermal_.data()}, counts,
                  nullptr);
        EXPECT_EQ(thermal_, before) << bad << " along axis " << axis;
        EXPECT_EQ(counts.assigned, 0);
      }
    }
  });
}

TEST_F(FuseBlockTest, AnImageThatShowsNothingChangesNothing) {
  testing::ForEachInstructionSet([&] {
    RearrangeImage(64, 48);
    std::fill(pixels_.begin(), pixels_.end(), ThermalPixel{});
    RearrangeBlock();
    const Words before = thermal_;
    FusionKernelCounts counts;
    FuseBlock(args_, {first_.data(), tsdf_.data(), block_sigmas_, thermal_.data()}, counts,
              nullptr);
    EXPECT_EQ(thermal_, before);
    EXPECT_EQ(counts.considered, 0);
  });
}

}  // namespace
}  // namespace isotherm

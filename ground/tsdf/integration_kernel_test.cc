#include "ground/tsdf/integration_kernel.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <vector>

#include "common/testing/kernel_checks.h"
#include "ground/tsdf/reference/integration_reference.h"

namespace isotherm {
namespace {

using testing::Random;
using testing::Tribool;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Eigen::Matrix3f RandomRotation(Random& random) {
  const auto uniform = [&] { return random.Uniform(-1.0F, 1.0F); };
  return Eigen::Quaternionf(uniform(), uniform(), uniform(), uniform())
      .normalized()
      .toRotationMatrix();
}

/// A row of depth with gaps, near and far, and memory behind it for a whole vector.
std::vector<float> RandomDepths(Random& random, int width) {
  std::vector<float> depths(static_cast<std::size_t>(width + testing::kMaxLanes));
  for (float& z : depths) {
    z = random.Chance(0.3) ? 0.0F : random.Uniform(0.3F, random.Chance(0.1) ? 65.0F : 1.2F);
  }
  return depths;
}

class MakeSampleRowTest : public ::testing::Test {
 protected:
  /// Normals towards the camera, from it, and none.
  void FillRow(int width) {
    depths_ = RandomDepths(random_, width);
    for (std::vector<float>* plane : {&nx_, &ny_, &nz_}) plane->assign(depths_.size(), kNan);
    for (std::size_t x = 0; x < depths_.size(); ++x) {
      if (random_.Chance(0.3)) continue;
      const Eigen::Vector3f n = RandomRotation(random_).col(0);
      nx_[x] = n.x();
      ny_[x] = n.y();
      nz_[x] = n.z();
    }
    args_.depth_m = depths_.data();
    args_.nx = nx_.data();
    args_.ny = ny_.data();
    args_.nz = nz_.data();
    args_.width = width;
    args_.fx = 285.0F;
    args_.cx = random_.Uniform(-10.0F, 80.0F);
    args_.ray_y = random_.Uniform(-0.4F, 0.4F);
    args_.along_ray = random_.Chance(0.2);
  }

  void CompareRow() {
    std::vector<DepthSample> samples(static_cast<std::size_t>(args_.width) + 1);
    samples.back().normal_xy = testing::kCanary;
    MakeSampleRow(args_, samples.data());
    ASSERT_EQ(samples.back().normal_xy, testing::kCanary) << "wrote beyond the row";
    for (int x = 0; x < args_.width && !HasFatalFailure(); ++x)
      ComparePixel(samples[static_cast<std::size_t>(x)], x);
  }

  void ComparePixel(const DepthSample& sample, int x) {
    constexpr double kStep = 1.01;  // Codes: rounding may choose the neighbour.
    SCOPED_TRACE(::testing::Message() << "pixel " << x << " of " << args_.width);
    const reference::Sample truth = reference::MakeSample(args_, x);
    const int weight_code = sample.normal_z_weight & 0xFFFF;
    if (truth.weight == 0.0) {
      ASSERT_EQ(weight_code, 0);
      return;
    }
    if (truth.has_normal == Tribool::kEither) return;
    const Eigen::Vector3d n(static_cast<std::int16_t>(sample.normal_xy & 0xFFFF),
                            sample.normal_xy >> 16, sample.normal_z_weight >> 16);
    ASSERT_EQ(sample.depth_m, depths_[static_cast<std::size_t>(x)]);
    ASSERT_NEAR(weight_code, truth.weight * DepthSample::kWeightScale, kStep);
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(n[axis], truth.n[axis] * DepthSample::kNormalScale, kStep) << "axis " << axis;
    ASSERT_NEAR(sample.scaled_offset, n.dot(truth.p),
                testing::kSinglePrecision * n.cwiseAbs().dot(truth.p.cwiseAbs()));
    ++compared_;
  }

  Random random_;
  std::vector<float> depths_, nx_, ny_, nz_;
  SampleRowArgs args_{};
  int compared_ = 0;
};

TEST_F(MakeSampleRowTest, MatchesTheScalarReferenceForAnyWidth) {
  testing::ForEachInstructionSet([&] {
    compared_ = 0;
    for (int width = 0; width <= 5 * testing::kMaxLanes; ++width) {
      FillRow(width);
      CompareRow();
    }
    EXPECT_GT(compared_, 1000);
  });
}

TEST_F(MakeSampleRowTest, AgreesWithTheSampleMadeOfOnePoint) {
  testing::ForEachInstructionSet([&] {
    FillRow(1);
    depths_[0] = 0.5F;
    nx_[0] = 0.6F;
    ny_[0] = 0.0F;
    nz_[0] = -0.8F;
    args_.cx = 0.0F;
    args_.ray_y = 0.0F;
    args_.along_ray = false;
    DepthSample row;
    MakeSampleRow(args_, &row);
    const float n[3] = {0.6F, 0.0F, -0.8F};
    const float p[3] = {0.0F, 0.0F, 0.5F};
    const DepthSample one = DepthSample::Make(n, p, 0.8F);
    EXPECT_EQ(row.normal_xy, one.normal_xy);
    EXPECT_EQ(row.normal_z_weight, one.normal_z_weight);
    EXPECT_FLOAT_EQ(row.scaled_offset, one.scaled_offset);
  });
}

class FindMissingBlocksTest : public ::testing::Test {
 protected:
  FindMissingBlocksTest() {
    args_.stride_y = kBlocks[0] + 2;
    args_.stride_z = args_.stride_y * (kBlocks[1] + 2);
    std::copy_n(kBlocks, 3, args_.blocks);
    args_.fx = 285.0F;
    args_.truncation_m = 0.016F;
    table_.resize(static_cast<std::size_t>(args_.stride_z * (kBlocks[2] + 2)));
    args_.table = table_.data();
  }

  /// A pose that looks at the volume from outside or inside, and a table half full.
  void Rearrange(int width) {
    for (std::int32_t& block : table_) block = random_.Chance(0.5) ? -1 : random_.Integer(0, 99);
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> R = RandomRotation(random_) / kBlockSize;
    const Eigen::Vector3f centre = 0.5F * Eigen::Vector3f(kBlocks[0], kBlocks[1], kBlocks[2]);
    const Eigen::Vector3f aim(0.0F, 0.0F, random_.Uniform(0.0F, 1.0F));
    const Eigen::Vector3f t = centre + Eigen::Vector3f::Ones() - R * aim;
    std::copy_n(R.data(), 9, args_.R);
    std::copy_n(t.data(), 3, args_.t);
    args_.width = width;
    args_.cx = random_.Uniform(0.0F, static_cast<float>(width));
    args_.ray_y = random_.Uniform(-0.4F, 0.4F);
    args_.half_steps = random_.Integer(1, 5);
    depths_ = RandomDepths(random_, width);
    for (float& z : depths_) {
      if (z > 0.0F) z = std::max(0.001F, aim.z() + random_.Uniform(-0.15F, 0.15F));
    }
    args_.depth_m = depths_.data();
  }

  /// The kernel's entries without repetitions.
  std::set<std::int32_t> Find() {
    const auto capacity = static_cast<std::size_t>(BandRowCapacity(args_));
    std::vector<std::int32_t> missing(capacity + 1, testing::kCanary);
    const std::int32_t found = FindMissingBlocks(args_, missing.data());
    EXPECT_EQ(missing.back(), testing::kCanary) << "wrote beyond the capacity";
    return {missing.begin(), missing.begin() + found};
  }

  static constexpr std::int32_t kBlocks[3] = {7, 5, 6};
  static constexpr float kBlockSize = 0.032F;
  Random random_;
  std::vector<std::int32_t> table_;
  std::vector<float> depths_;
  BandRowArgs args_{};
};

TEST_F(FindMissingBlocksTest, NamesExactlyTheMissingBlocksOfTheBand) {
  testing::ForEachInstructionSet([&] {
    std::size_t found = 0;
    for (int round = 0; round < 10; ++round) {
      for (int width = 0; width <= 5 * testing::kMaxLanes; ++width) {
        Rearrange(width);
        std::set<std::int32_t> truth;
        for (int x = 0; x < width; ++x) {
          const auto of_pixel = reference::MissingBlocks(args_, x);
          if (of_pixel) {
            truth.insert(of_pixel->begin(), of_pixel->end());
          } else {
            depths_[static_cast<std::size_t>(x)] = 0.0F;  // Rounding would decide.
          }
        }
        ASSERT_EQ(Find(), truth) << "width " << width;
        found += truth.size();
      }
    }
    EXPECT_GT(found, 1000U);
  });
}

TEST_F(FindMissingBlocksTest, ARowOfNoReturnsMissesNothing) {
  testing::ForEachInstructionSet([&] {
    Rearrange(70);
    std::fill(depths_.begin(), depths_.end(), 0.0F);
    EXPECT_TRUE(Find().empty());
  });
}

TEST_F(FindMissingBlocksTest, APoseThatIsNoPoseMissesNothing) {
  testing::ForEachInstructionSet([&] {
    for (const float bad : {kNan, kInfinity, -kInfinity, 1e30F}) {
      for (int i = 0; i < 12; ++i) {
        Rearrange(33);
        (i < 9 ? args_.R[i] : args_.t[i - 9]) = bad;
        for (const std::int32_t entry : Find()) {
          ASSERT_GE(entry, 0);
          ASSERT_LT(entry, static_cast<std::int32_t>(table_.size()));
        }
        args_.t[0] = bad;
        EXPECT_TRUE(Find().empty()) << bad;
      }
    }
  });
}

class IntegrateBlockTest : public ::testing::Test {
 protected:
  static constexpr std::size_t kVoxels = 512;
  using Words = std::array<std::uint32_t, kVoxels + 1>;

  /// A camera of any size, and samples of which a third saw nothing.
  void RearrangeImage(int width, int height) {
    samples_.clear();
    for (int i = 0; i < width * height; ++i) {
      const Eigen::Vector3f n =
          Eigen::Vector3f(Uniform(1.0F), Uniform(1.0F), -1.5F + Uniform(1.0F)).normalized();
      const Eigen::Vector3f p(0.3F * Uniform(1.0F), 0.3F * Uniform(1.0F), 0.5F + Uniform(0.1F));
      samples_.push_back(DepthSample::Make(n.data(), p.data(), std::max(0.0F, Uniform(1.0F))));
      if (random_.Chance(0.2)) samples_.back() = DepthSample{};
    }
    samples_.push_back(DepthSample{});
    args_.samples = samples_.data();
    args_.width = width;
    args_.height = height;
    args_.fx = random_.Uniform(50.0F, 300.0F);
    args_.fy = random_.Uniform(50.0F, 300.0F);
    args_.cx = random_.Uniform(0.0F, static_cast<float>(width));
    args_.cy = random_.Uniform(0.0F, static_cast<float>(height));
    args_.truncation_m = 0.016F;
    args_.max_weight = random_.Uniform(1.0F, 255.0F);
    args_.noise_at_1m = random_.Uniform(0.0F, 0.05F);
  }

  void RearrangeBlock() {
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> axes = kVoxel * RandomRotation(random_);
    std::copy_n(axes.data(), 9, args_.axes);
    // Most blocks are in the image or at its border; some lie behind the camera or around it.
    const float z = random_.Chance(0.2) ? random_.Uniform(-0.6F, 0.05F) : 0.5F + Uniform(0.1F);
    const float u = random_.Uniform(0.0F, static_cast<float>(args_.width));
    const float v = random_.Uniform(0.0F, static_cast<float>(args_.height));
    first_ = z * Eigen::Vector3f((u - args_.cx) / args_.fx, (v - args_.cy) / args_.fy, 1.0F) -
             axes * Eigen::Vector3f::Constant(3.5F);
    for (std::uint32_t& word : words_) {
      const auto tsdf = static_cast<std::uint32_t>(random_.Integer(-32767, 32767));
      const int most = static_cast<int>(args_.max_weight * 64.0F);
      const int weight = random_.Integer(1, random_.Chance(0.5) ? 3 : most);
      word = random_.Chance(0.4) ? 0 : (tsdf << 16) | static_cast<std::uint32_t>(weight);
    }
  }

  /// Updates the block and compares each voxel.
  void CompareBlock() {
    const Words before = words_;
    const bool behind = IntegrateBlock(args_, first_.data(), words_.data());
    ASSERT_EQ(words_.back(), before.back()) << "wrote beyond the block";
    const Eigen::Matrix3d axes =
        Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(args_.axes).cast<double>();
    bool any_behind = false;
    for (std::size_t i = 0; i < kVoxels && !HasFatalFailure(); ++i) {
      const auto index = static_cast<int>(i);
      const TsdfVoxel voxel{words_[i]};
      any_behind = any_behind || (voxel.observed() && voxel.tsdf() <= 0.0F);
      const Eigen::Vector3d p =
          first_.cast<double>() + axes * Eigen::Vector3d(index & 7, (index >> 3) & 7, index >> 6);
      CompareVoxel(p, {before[i]}, voxel);
    }
    ASSERT_EQ(behind, any_behind);
    (behind ? with_surface_ : without_surface_) += 1;
  }

  /// The new value lies between those that the kernel may reach with its rounding of the distance.
  void CompareVoxel(const Eigen::Vector3d& p, TsdfVoxel before, TsdfVoxel after) {
    constexpr double kRounding = 3e-7;  // Metres, in single precision at half a metre.
    constexpr int kStep = 1;            // Of both codes: the kernel's mean is rounded as well.
    std::vector<int> tsdf, weight;
    for (const double error : {-kRounding, 0.0, kRounding}) {
      const reference::VoxelUpdate truth = reference::UpdateVoxel(args_, p, before, error);
      if (!truth.certain) return;
      tsdf.push_back(static_cast<int>(truth.voxel.bits) >> 16);
      weight.push_back(static_cast<int>(truth.voxel.bits & 0xFFFFU));
    }
    const auto [min_tsdf, max_tsdf] = std::minmax_element(tsdf.begin(), tsdf.end());
    const auto [min_weight, max_weight] = std::minmax_element(weight.begin(), weight.end());
    const int new_tsdf = static_cast<int>(after.bits) >> 16;
    const int new_weight = static_cast<int>(after.bits & 0xFFFFU);
    ASSERT_GE(new_tsdf, *min_tsdf - kStep);
    ASSERT_LE(new_tsdf, *max_tsdf + kStep);
    ASSERT_GE(new_weight, *min_weight - kStep);
    ASSERT_LE(new_weight, *max_weight + kStep);
    if (after.bits != before.bits) ++updated_;
  }

  float Uniform(float bound) { return random_.Uniform(-bound, bound); }

  static constexpr float kVoxel = 0.004F;
  Random random_;
  std::vector<DepthSample> samples_;
  IntegrationKernelArgs args_{};
  Eigen::Vector3f first_;
  Words words_{};
  int updated_ = 0;
  int with_surface_ = 0;
  int without_surface_ = 0;
};

TEST_F(IntegrateBlockTest, MatchesTheScalarReferenceForAnyImageAndPose) {
  testing::ForEachInstructionSet([&] {
    updated_ = 0;
    for (int width = 1; width <= 70; ++width) {
      RearrangeImage(width, random_.Integer(1, 50));
      for (int round = 0; round < 6; ++round) {
        RearrangeBlock();
        CompareBlock();
      }
    }
    EXPECT_GT(updated_, 10'000);
  });
}

TEST_F(IntegrateBlockTest, SaysWhetherARayCanEndInTheBlock) {
  testing::ForEachInstructionSet([&] {
    with_surface_ = without_surface_ = 0;
    RearrangeImage(64, 48);
    for (int round = 0; round < 200; ++round) {
      RearrangeBlock();
      const bool empty = round % 2 == 0;
      const int single = random_.Integer(0, 511);
      for (int i = 0; i < 512; ++i) {
        std::uint32_t& word = words_[static_cast<std::size_t>(i)];
        const bool behind = !empty && i == single;
        // Distance +1 code at least, or exactly 0 in one voxel.
        if (word != 0) word = (word & 0xFFFFU) | (behind ? 0U : 0x10000U + (word & 0x7FF0000U));
      }
      for (DepthSample& sample : samples_) sample = DepthSample{};
      CompareBlock();
    }
    EXPECT_GT(with_surface_, 30);
    EXPECT_GT(without_surface_, 90);
  });
}

TEST_F(IntegrateBlockTest, LeavesTheBlockAloneAtAPositionThatIsNone) {
  testing::ForEachInstructionSet([&] {
    RearrangeImage(64, 48);
    for (const float bad : {kNan, kInfinity, -kInfinity}) {
      for (int axis = 0; axis < 3; ++axis) {
        RearrangeBlock();
        first_[axis] = bad;
        const Words before = words_;
        IntegrateBlock(args_, first_.data(), words_.data());
        EXPECT_EQ(words_, before) << bad << " along axis " << axis;
      }
    }
  });
}

}  // namespace
}  // namespace isotherm

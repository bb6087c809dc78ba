#include "ground/thermal/temperature_review.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/testing/volume_shapes.h"

namespace isotherm {
namespace {

constexpr double kVoxel_m = 0.004;
constexpr double kFront_m =
    0.30;  ///< z of the box's face towards the camera, which looks along +z.
constexpr double kHalfSide_m = 0.10;  ///< Half the side of the box around (0.32, 0.32).

double Box(const Eigen::Vector3d& p) {
  const Eigen::Vector3d outside(std::abs(p.x() - 0.32) - kHalfSide_m,
                                std::abs(p.y() - 0.32) - kHalfSide_m, kFront_m - p.z());
  return outside.cwiseMax(0.0).norm() + std::min(0.0, outside.maxCoeff());
}

/// A box whose front face has temperatures measured from `degrees` beside its normal, towards +x.
class EdgeReviewTest : public ::testing::Test {
 protected:
  EdgeReviewTest() : tsdf_(MakeGrid(), 4.0 * kVoxel_m, 8000), thermal_(8000) {
    testing::FillVolume(tsdf_, Box);
  }
  /// How far from the front face's border.
  static double InsideM(const Eigen::Vector3d& p) {
    return kHalfSide_m - std::max(std::abs(p.x() - 0.32), std::abs(p.y() - 0.32));
  }
  static VoxelGrid MakeGrid() {
    VolumeOptions volume;
    for (auto set : {&VolumeOptions::set_size_x_m, &VolumeOptions::set_size_y_m,
                     &VolumeOptions::set_size_z_m}) {
      (volume.*set)(0.64);
    }
    volume.set_voxel_size_m(kVoxel_m);
    return MakeVoxelGrid(volume).value();
  }
  template <typename Visit>
  void ForFrontVoxels(const Visit& visit) {
    for (std::int32_t block = 0; block < tsdf_.block_count(); ++block) {
      for (int i = 0; i < kBlockVoxels; ++i) {
        const GridIndex local(i % kBlockSide, i / kBlockSide % kBlockSide,
                              i / (kBlockSide * kBlockSide));
        const Eigen::Vector3d p =
            tsdf_.grid().VoxelCentre(tsdf_.block_coordinates(block) * kBlockSide + local);
        if (std::abs(p.z() - kFront_m) > 0.6 * kVoxel_m || InsideM(p) < 0.0) continue;
        visit(block, i, p);
      }
    }
  }
  void Measure(double degrees) {
    const double angle = degrees * kRadPerDeg;
    const Eigen::Vector3f to_camera(static_cast<float>(std::sin(angle)), 0.0F,
                                    static_cast<float>(-std::cos(angle)));
    ForFrontVoxels([&](std::int32_t block, int i, const Eigen::Vector3d&) {
      thermal_.voxels(block)[static_cast<std::size_t>(i)] =
          ThermalVoxel::Make(40.0F, ConditionClass::kGood, ConditionClass::kGood);
      ConditionRecord& record =
          thermal_.records()->Row(block, i / RecordRow::kVoxels).conditions[i % RecordRow::kVoxels];
      record.direction = EncodeDirection(to_camera);
      record.cosine = static_cast<std::uint8_t>(std::lround(255.0 * std::cos(angle)));
      record.distance = 1000;
    });
  }
  std::int64_t ReviewAll(bool is_final) {
    const TemperatureReview review{ThermalOptions(), ThermalSensorModel()};
    std::int64_t dropped = 0;
    for (std::int32_t block = 0; block < tsdf_.block_count(); ++block)
      dropped += review.Review(block, tsdf_, thermal_, is_final);
    return dropped;
  }
  bool IsMeasured(std::int32_t block, int i) {
    return thermal_.voxels(block)[static_cast<std::size_t>(i)].measured();
  }

  TsdfVolume tsdf_;
  ThermalVolume thermal_;
};

TEST_F(EdgeReviewTest, BesideASteepFaceTheFinalReviewDropsAndNoOther) {
  Measure(0.0);  // All four side faces are seen at 90 degrees.
  ReviewAll(/*is_final=*/false);
  ForFrontVoxels([&](std::int32_t block, int i, const Eigen::Vector3d& p) {
    if (InsideM(p) > kVoxel_m) {
      ASSERT_TRUE(IsMeasured(block, i)) << p.transpose();
    }
  });
  EXPECT_GT(ReviewAll(/*is_final=*/true), 100);
  int kept = 0, dropped = 0;
  ForFrontVoxels([&](std::int32_t block, int i, const Eigen::Vector3d& p) {
    const double inside_m = InsideM(p);
    // Two voxels from within the box, less from outside, where distances go around the edge; a
    // gradient reaches one further.
    if (p.z() > kFront_m && inside_m < 2.0 * kVoxel_m) {
      ASSERT_FALSE(IsMeasured(block, i)) << p.transpose();
      ++dropped;
    } else if (inside_m > 3.5 * kVoxel_m) {
      ASSERT_TRUE(IsMeasured(block, i)) << p.transpose();
      ++kept;
    }
  });
  EXPECT_GT(dropped, 100);
  EXPECT_GT(kept, 1000);
}

TEST_F(EdgeReviewTest, AnEdgeBetweenFacesThatWereBothSeenWellStays) {
  Measure(45.0);  // The face at +x is seen at 45 degrees, too; limits end at 50.7.
  ReviewAll(/*is_final=*/true);
  int beside_seen = 0, beside_hidden = 0;
  ForFrontVoxels([&](std::int32_t block, int i, const Eigen::Vector3d& p) {
    const bool is_second_row =
        p.z() > kFront_m && InsideM(p) > kVoxel_m && InsideM(p) < 2.0 * kVoxel_m;
    if (!is_second_row || std::abs(p.y() - 0.32) > 0.05) return;
    if (p.x() > 0.32) {
      ASSERT_TRUE(IsMeasured(block, i)) << p.transpose();
      ++beside_seen;
    } else {
      ASSERT_FALSE(IsMeasured(block, i)) << p.transpose();
      ++beside_hidden;
    }
  });
  EXPECT_GT(beside_seen, 10);
  EXPECT_GT(beside_hidden, 10);
}

}  // namespace
}  // namespace isotherm

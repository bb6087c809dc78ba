#include "ground/snapshot/model_copier.h"

#include <gtest/gtest.h>

#include <array>
#include <numeric>
#include <vector>

#include "common/simulation/options.h"
#include "ground/atlas/testing/volumes.h"
#include "ground/snapshot/model_copy.h"

namespace isotherm {
namespace {

using testing::SmallGrid;
using testing::SphereDistance;

constexpr std::uint64_t kScan = 3;
/// The clock stands still: only the number of blocks limits.
constexpr CopyBudget kAll{.time = std::chrono::seconds(1), .max_blocks = 1000};

class ModelCopierTest : public ::testing::Test {
 protected:
  ModelCopierTest() : atlas_(MakeAtlas()), copier_(clock_) {
    copier_.Begin(kScan);
    SubMap& map = atlas_.active();
    testing::FillVolume(
        *map.tsdf,
        [](const auto& p) {
          return SphereDistance(p, {0.08, 0.08, 0.08});
        },
        1.0F);
    EXPECT_TRUE(map.thermal->Commit(map.tsdf->block_count()));
    for (std::int32_t block = 0; block < count(); ++block)
      Measure(block, 20.0F + 0.1F * static_cast<float>(block));
    map.versions.NoteAll(count());
  }
  static Atlas MakeAtlas() {
    GroundOptions options;
    options.mutable_tsdf()->mutable_expert()->set_truncation_distance_m(testing::kTruncation_m);
    return Atlas(options, DefaultSimulatedRig().depth->WithoutDistortion(), SmallGrid());
  }
  std::int32_t count() const { return atlas_.active().tsdf->block_count(); }
  /// Gives a voxel of a block a temperature with all its records.
  void Measure(std::int32_t block, float celsius) {
    ThermalVolume& thermal = *atlas_.active().thermal;
    thermal.voxels(block)[9] =
        ThermalVoxel::Make(celsius, ConditionClass::kGood, ConditionClass::kAcceptable);
    RecordRow& row = thermal.records()->Row(block, 1);
    row.conditions[1].distance =
        (1000U + static_cast<std::uint32_t>(block)) & ConditionRecord::kMaxDistance;
    row.disagreement[1].highest = 77;
    thermal.records()->Sigmas(block, 1)[1] = 42;
  }
  /// Copies with `budget` until nothing is left; returns how many blocks there were.
  std::size_t CopyAll(const CopyBudget& budget = kAll) {
    std::size_t blocks = 0;
    while (copier_.Copy(atlas_, RigidTransform::Identity(), budget, batch_)) {
      EXPECT_TRUE(copy_.Apply(batch_));
      blocks += batch_.blocks.size();
    }
    return blocks;
  }
  void ExpectSameModel() const {
    const TsdfVolume& tsdf = *atlas_.active().tsdf;
    const ThermalVolume& thermal = *atlas_.active().thermal;
    const ReadableMap& map = copy_.map(0);
    ASSERT_EQ(map.tsdf->block_count(), count());
    for (std::int32_t block = 0; block < count(); ++block) {
      const std::int32_t own = map.tsdf->Find(tsdf.block_coordinates(block));
      ASSERT_NE(own, TsdfVolume::kNoBlock);
      for (int v = 0; v < kBlockVoxels; ++v) {
        ASSERT_EQ(map.tsdf->voxels(own)[v].bits, tsdf.voxels(block)[v].bits);
        ASSERT_EQ(map.thermal->voxels(own)[v].bits, std::as_const(thermal).voxels(block)[v].bits);
        ASSERT_EQ(map.thermal->sigma_code(own, v), thermal.sigma_code(block, v));
      }
      const RecordRow* row = map.thermal->records()->Find(own, 1);
      ASSERT_NE(row, nullptr);
      EXPECT_EQ(row->conditions[1].distance, 1000U + static_cast<std::uint32_t>(block));
      EXPECT_EQ(row->disagreement[1].highest, 77);
      EXPECT_EQ(map.thermal->records()->Find(own, 2), nullptr);
      EXPECT_EQ(map.tsdf->may_end_rays(own), tsdf.may_end_rays(block));
    }
  }

  FakeClock clock_;
  Atlas atlas_;
  ModelCopier copier_;
  BlockBatch batch_;
  ModelCopy copy_;
};

TEST_F(ModelCopierTest, TheCopyIsTheModelBitForBit) {
  atlas_.active().tsdf->set_may_end_rays(2, false);
  EXPECT_EQ(CopyAll(), static_cast<std::size_t>(count()));
  EXPECT_EQ(copy_.scan(), kScan);
  ExpectSameModel();
}

TEST_F(ModelCopierTest, ASmallBudgetOnlyTakesMoreTurns) {
  CopyBudget small = kAll;
  small.max_blocks = 3;
  EXPECT_EQ(CopyAll(small), static_cast<std::size_t>(count()));
  ExpectSameModel();
}

TEST_F(ModelCopierTest, OnlyWhatHasChangedIsCopiedAgain) {
  CopyAll();
  EXPECT_FALSE(copier_.Copy(atlas_, RigidTransform::Identity(), kAll, batch_));
  Measure(4, 90.0F);
  atlas_.active().versions.Note(std::array<std::int32_t, 2>{4, 7});
  ASSERT_TRUE(copier_.Copy(atlas_, RigidTransform::Identity(), kAll, batch_));
  EXPECT_EQ(batch_.blocks.size(), 2U);
  EXPECT_TRUE(copy_.Apply(batch_));
  ExpectSameModel();
  EXPECT_FALSE(copier_.Copy(atlas_, RigidTransform::Identity(), kAll, batch_));
}

TEST_F(ModelCopierTest, NewBlocksComeFirstAndTheNewestOfThemFirst) {
  CopyAll();
  atlas_.active().versions.NoteAll(count());  // All have changed ...
  const std::int32_t block = atlas_.active().tsdf->FindOrAllocate({0, 0, 0});
  const std::int32_t newer = atlas_.active().tsdf->FindOrAllocate({4, 0, 0});
  ASSERT_EQ(newer, block + 1);
  ASSERT_TRUE(atlas_.active().thermal->Commit(count()));
  atlas_.active().versions.Note(std::array<std::int32_t, 2>{block, newer});  // ... two are new.
  ASSERT_TRUE(copier_.Copy(atlas_, RigidTransform::Identity(), kAll, batch_));
  ASSERT_GE(batch_.blocks.size(), 3U);
  EXPECT_EQ(batch_.blocks[0].coordinates, GridIndex(4, 0, 0));
  EXPECT_EQ(batch_.blocks[1].coordinates, GridIndex(0, 0, 0));
}

TEST_F(ModelCopierTest, BlocksThatHaveChangedTakeTurns) {
  CopyAll();
  CopyBudget one = kAll;
  one.max_blocks = 1;
  std::vector<bool> seen(static_cast<std::size_t>(count()), false);
  for (std::int32_t i = 0; i < count(); ++i) {  // All change each time, one is copied.
    atlas_.active().versions.NoteAll(count());
    ASSERT_TRUE(copier_.Copy(atlas_, RigidTransform::Identity(), one, batch_));
    ASSERT_EQ(batch_.blocks.size(), 1U);
    seen[static_cast<std::size_t>(atlas_.active().tsdf->Find(batch_.blocks.front().coordinates))] =
        true;
  }
  EXPECT_EQ(std::accumulate(seen.begin(), seen.end(), 0), count());
}

TEST_F(ModelCopierTest, BlocksBeyondReachAreLeftForLater) {
  CopyBudget near = kAll;
  near.reach_m = 0.06;
  const RigidTransform corner(Eigen::Translation3d(0.0, 0.0, 0.0));
  const std::size_t copied = copier_.Copy(atlas_, corner, near, batch_) ? batch_.blocks.size() : 0;
  EXPECT_GT(copied, 0U);
  EXPECT_LT(copied, static_cast<std::size_t>(count()));
  EXPECT_TRUE(copy_.Apply(batch_));
  EXPECT_EQ(copied + CopyAll(), static_cast<std::size_t>(count()));
  ExpectSameModel();
}

TEST_F(ModelCopierTest, ASplitOffSubMapIsCopiedBesideTheFirst) {
  CopyAll();
  const std::vector<std::int32_t> in_view = {1, 3};
  ASSERT_TRUE(atlas_.Split(RigidTransform::Identity(), in_view));
  EXPECT_EQ(CopyAll(), in_view.size());
  ASSERT_EQ(copy_.size(), 2);
  EXPECT_EQ(copy_.active_map(), 1);
  EXPECT_EQ(copy_.map(1).tsdf->block_count(), 2);
  EXPECT_TRUE(copy_.map(1).place.joined);
}

TEST_F(ModelCopierTest, AnotherScanBeginsAnew) {
  CopyAll();
  copier_.Begin(kScan + 1);
  EXPECT_EQ(CopyAll(), static_cast<std::size_t>(count()));
  EXPECT_EQ(copy_.scan(), kScan + 1);
  ExpectSameModel();
}

}  // namespace
}  // namespace isotherm

#include "ground/thermal/thermal_records.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/base/units.h"
#include "common/testing/temporary_directory.h"
#include "ground/thermal/thermal_volume.h"

namespace isotherm {
namespace {

constexpr std::uint64_t kSeed = 11;

TEST(EncodeDirectionTest, ComesBackToLessThanADegree) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<float> normal;
  double worst = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    const Eigen::Vector3f v =
        Eigen::Vector3f(normal(random), normal(random), normal(random)).normalized();
    worst = std::max(worst, double{(DecodeDirection(EncodeDirection(v)) - v).norm()});
  }
  EXPECT_LT(worst, kRadPerDeg);
}

TEST(DisagreementRecordTest, KeepsExtremesExactlyAndTheSpreadNearly) {
  std::mt19937_64 random(kSeed);
  for (const double sigma_codes : {4.0, 40.0, 400.0}) {
    std::normal_distribution<double> normal(20'000.0, sigma_codes);
    DisagreementRecord record;
    std::uint16_t lowest = 65535, highest = 0;
    constexpr int kCount = 500;
    for (int i = 0; i < kCount; ++i) {
      const auto code = static_cast<std::uint16_t>(std::lround(normal(random)));
      lowest = std::min(lowest, code);
      highest = std::max(highest, code);
      record.Add(code, std::min(i, static_cast<int>(ConditionRecord::kMaxGoodCount)));
    }
    EXPECT_EQ(record.lowest, lowest);
    EXPECT_EQ(record.highest, highest);
    EXPECT_EQ(record.range_k(), ThermalVoxel::kStep_k * static_cast<float>(highest - lowest));
    // Of 63 remembered values: their own spread varies by a tenth.
    const double truth_k = sigma_codes * static_cast<double>(ThermalVoxel::kStep_k);
    EXPECT_NEAR(record.spread_k(63), truth_k, 0.35 * truth_k);
  }
  EXPECT_EQ(DisagreementRecord().spread_k(1), 0.0F);
}

TEST(ThermalRecordsTest, RowsExistOnlyWhereTheyWereWritten) {
  ThermalRecords records(1000, {});
  EXPECT_EQ(std::as_const(records).Find(999, 63), nullptr);
  EXPECT_EQ(records.FindSigmas(999, 63), nullptr);
  EXPECT_EQ(records.memory_bytes(), 0U);
  std::mt19937_64 random(kSeed);
  const auto place = [&] {
    return std::pair(static_cast<std::int32_t>(random() % 1000), static_cast<int>(random() % 64));
  };
  for (int i = 0; i < 5000; ++i) {
    const auto [block, row] = place();
    records.Row(block, row).conditions[3].epoch = static_cast<std::uint8_t>(block + row);
    records.Sigmas(block, row)[block % 8] = static_cast<std::uint8_t>(block - row);
  }
  random.seed(kSeed);
  for (int i = 0; i < 5000; ++i) {
    const auto [block, row] = place();
    ASSERT_NE(std::as_const(records).Find(block, row), nullptr);
    ASSERT_EQ(records.Row(block, row).conditions[3].epoch, static_cast<std::uint8_t>(block + row));
    ASSERT_EQ(records.FindSigmas(block, row)[block % 8], static_cast<std::uint8_t>(block - row));
  }
  constexpr std::size_t kRowBytes = 137;  // 17 per voxel, and what a page has left over.
  EXPECT_LE(records.memory_bytes(), 5000 * kRowBytes + 16 * 4096) << "a page per part";
}

TEST(ThermalRecordsTest, EveryRowOfEveryBlockHasRoom) {
  constexpr std::int32_t kBlocks = 130;  // Two parts and a bit.
  ThermalRecords records(kBlocks, {});
  ASSERT_TRUE(records.Commit(kBlocks));
  for (std::int32_t block = 0; block < kBlocks; ++block) {
    for (int row = 0; row < ThermalRecords::kRowsPerBlock; ++row) {
      records.Row(block, row).disagreement[7].squares =
          static_cast<std::uint16_t>(64 * block + row);
      records.Sigmas(block, row)[7] = static_cast<std::uint8_t>(row);
    }
  }
  for (std::int32_t block = 0; block < kBlocks; ++block) {
    for (int row = 0; row < ThermalRecords::kRowsPerBlock; ++row) {
      ASSERT_EQ(records.Row(block, row).disagreement[7].squares, 64 * block + row);
      ASSERT_EQ(records.Sigmas(block, row)[7], row);
    }
  }
}

TEST(ThermalRecordsTest, ComeBackFromTheSpillFile) {
  const testing::TemporaryDirectory folder;
  ThermalRecords records(256, folder.path());
  ASSERT_TRUE(records.Commit(256));
  for (int row = 0; row < 64; ++row) records.Row(70, row).conditions[row % 8].direction = 700;
  records.Decommit(64, 64);
  for (int row = 0; row < 64; ++row)
    EXPECT_EQ(records.Row(70, row).conditions[row % 8].direction, 700);
}

}  // namespace
}  // namespace isotherm

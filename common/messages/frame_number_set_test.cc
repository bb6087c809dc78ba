#include "common/messages/frame_number_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <set>

#include "common/testing/test_seed.h"

namespace isotherm {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(FrameNumberSetTest, HolesAreFilledFromBothEndsAndFromTheMiddle) {
  FrameNumberSet receipts;
  receipts.Add(0);
  receipts.Add(10);
  for (const std::uint64_t number : {1, 9, 5}) EXPECT_TRUE(receipts.Add(number));
  EXPECT_THAT(receipts.NewestHoles(9), ElementsAre(FrameRange{2, 4}, FrameRange{6, 8}));
  for (const std::uint64_t number : {2, 3, 4, 6, 7, 8}) EXPECT_TRUE(receipts.Add(number));
  EXPECT_EQ(receipts.missing(), 0U);
  EXPECT_THAT(receipts.NewestHoles(9), IsEmpty());
}

TEST(FrameNumberSetTest, TheOldestHoleIsGivenUpWhenThereAreTooMany) {
  FrameNumberSet receipts(3);
  for (std::uint64_t number = 1; number <= 9; number += 2) receipts.Add(number);
  EXPECT_THAT(receipts.NewestHoles(9),
              ElementsAre(FrameRange{4, 4}, FrameRange{6, 6}, FrameRange{8, 8}));
  EXPECT_FALSE(receipts.Add(0));
  EXPECT_EQ(receipts.size() + receipts.missing(), receipts.next());
  EXPECT_EQ(receipts.missing(), 5U);
}

TEST(FrameNumberSetTest, KnowsWhichNumbersItWouldTake) {
  FrameNumberSet receipts(1);
  for (const std::uint64_t number : {1, 3, 5}) receipts.Add(number);
  EXPECT_TRUE(receipts.IsNew(6)) << "above all";
  EXPECT_FALSE(receipts.IsNew(3)) << "here";
  EXPECT_TRUE(receipts.IsNew(4)) << "in the hole";
  EXPECT_FALSE(receipts.IsNew(2)) << "in a hole that was given up";
  EXPECT_FALSE(receipts.IsNew(0));
}

TEST(FrameNumberSetTest, AgreesWithASetOfNumbersWhateverTheOrder) {
  std::mt19937 random(testing::Seed());
  FrameNumberSet receipts;
  std::set<std::uint64_t> here;
  for (int i = 0; i < 3000; ++i) {
    const std::uint64_t number = random() % 1000;
    const bool is_new = !here.contains(number);
    ASSERT_EQ(receipts.IsNew(number), is_new) << number;
    ASSERT_EQ(receipts.Add(number), is_new) << number;
    here.insert(number);
    ASSERT_EQ(receipts.size(), here.size());
    ASSERT_EQ(receipts.next(), *here.rbegin() + 1);
  }
  std::set<std::uint64_t> missing;
  for (const FrameRange& hole : receipts.NewestHoles(1000)) {
    for (std::uint64_t number = hole.first; number <= hole.last; ++number) missing.insert(number);
  }
  for (std::uint64_t number = 0; number < receipts.next(); ++number) {
    EXPECT_NE(missing.contains(number), here.contains(number)) << number;
  }
}

}  // namespace
}  // namespace isotherm

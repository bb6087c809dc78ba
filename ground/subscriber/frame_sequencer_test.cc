#include "ground/subscriber/frame_sequencer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>
#include <vector>

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ArrivalOrder = FrameSequencer<int>::ArrivalOrder;

constexpr Nanoseconds kWindow = 200ms;

class FrameSequencerTest : public ::testing::Test {
 protected:
  ArrivalOrder Add(std::uint64_t number) {
    return sequencer_.Add(number, static_cast<int>(number), now_);
  }
  std::vector<int> TakeAll() {
    std::vector<int> taken;
    while (const auto item = sequencer_.Next(now_)) taken.push_back(*item);
    return taken;
  }

  FrameSequencer<int> sequencer_{kWindow};
  SteadyTime now_{1h};
};

TEST_F(FrameSequencerTest, FramesInOrderPassAtOnce) {
  for (const std::uint64_t number : {0, 1, 2}) EXPECT_EQ(Add(number), ArrivalOrder::kInOrder);
  EXPECT_THAT(TakeAll(), ElementsAre(0, 1, 2));
  EXPECT_EQ(sequencer_.handled(), 3U);
  EXPECT_EQ(sequencer_.deadline(), std::nullopt);
}

TEST_F(FrameSequencerTest, F20DuplicateIsDroppedWhetherItWaitsOrHasPassed) {
  EXPECT_EQ(Add(0), ArrivalOrder::kInOrder);
  EXPECT_EQ(Add(0), ArrivalOrder::kDuplicate);
  EXPECT_THAT(TakeAll(), ElementsAre(0));
  EXPECT_EQ(Add(0), ArrivalOrder::kDuplicate);
  EXPECT_EQ(Add(2), ArrivalOrder::kInOrder);
  EXPECT_EQ(Add(2), ArrivalOrder::kDuplicate);
  EXPECT_EQ(sequencer_.receipts().size(), 2U);
}

TEST_F(FrameSequencerTest, F21FramesOutOfOrderAreSortedWithinTheWindow) {
  Add(0);
  Add(2);
  EXPECT_THAT(TakeAll(), ElementsAre(0));
  now_ += kWindow - 1ns;
  EXPECT_THAT(TakeAll(), IsEmpty());
  EXPECT_EQ(Add(1), ArrivalOrder::kInOrder);
  EXPECT_THAT(TakeAll(), ElementsAre(1, 2));
}

TEST_F(FrameSequencerTest, F21AfterTheWindowTheMissingFrameIsLate) {
  Add(0);
  Add(2);
  TakeAll();
  ASSERT_EQ(sequencer_.deadline(), now_ + kWindow);
  now_ += kWindow;
  EXPECT_THAT(TakeAll(), ElementsAre(2));
  EXPECT_EQ(Add(1), ArrivalOrder::kLate);
  EXPECT_THAT(TakeAll(), IsEmpty());
  EXPECT_EQ(sequencer_.receipts().missing(), 0U);  // Late, but here.
  EXPECT_EQ(Add(1), ArrivalOrder::kDuplicate);
}

TEST_F(FrameSequencerTest, F19LostFramesAreCountedAndNamed) {
  for (const std::uint64_t number : {0, 1, 4, 5, 9}) Add(number);
  EXPECT_EQ(sequencer_.receipts().missing(), 5U);
  EXPECT_THAT(sequencer_.receipts().NewestHoles(10),
              ElementsAre(FrameRange{2, 3}, FrameRange{6, 8}));
  EXPECT_THAT(sequencer_.receipts().NewestHoles(1), ElementsAre(FrameRange{6, 8}));
}

TEST_F(FrameSequencerTest, WaitingFramesAreBounded) {
  constexpr auto kMax = FrameSequencer<int>::kMaxWaiting;
  for (std::uint64_t number = 1; number <= kMax; ++number) Add(number);
  EXPECT_THAT(TakeAll(), IsEmpty());
  Add(kMax + 1);
  EXPECT_EQ(TakeAll().size(), kMax + 1);
}

TEST_F(FrameSequencerTest, AfterAResyncTheLineGoesOnThere) {
  Add(1'000'000);
  EXPECT_EQ(sequencer_.Flush(), 1'000'000);
  EXPECT_EQ(Add(1), ArrivalOrder::kLate);
  sequencer_.Resync(2);
  EXPECT_EQ(Add(2), ArrivalOrder::kInOrder);
  EXPECT_THAT(TakeAll(), ElementsAre(2));
}

TEST_F(FrameSequencerTest, FlushDeliversWhatWaits) {
  Add(3);
  Add(7);
  EXPECT_EQ(sequencer_.Flush(), 3);
  EXPECT_EQ(sequencer_.Flush(), 7);
  EXPECT_EQ(sequencer_.Flush(), std::nullopt);
}

TEST_F(FrameSequencerTest, AnyMixtureIsDeliveredInOrderOnceAndAddsUp) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::vector<std::uint64_t> sent;
  std::set<std::uint64_t> distinct;
  for (std::uint64_t number = 0; number < 5000; ++number) {
    if (random() % 10 == 0) continue;  // Lost.
    sent.push_back(number);
    distinct.insert(number);
    if (random() % 10 == 0) sent.push_back(number);  // Duplicated.
  }
  for (std::size_t i = 0; i + 5 < sent.size(); ++i) std::swap(sent[i], sent[i + random() % 5]);

  std::vector<int> delivered;
  std::uint64_t late = 0;
  for (const std::uint64_t number : sent) {
    now_ += 1ms * (random() % 60);
    late += Add(number) == ArrivalOrder::kLate ? 1 : 0;
    for (const int item : TakeAll()) delivered.push_back(item);
  }
  while (const auto item = sequencer_.Flush()) delivered.push_back(*item);

  EXPECT_TRUE(std::ranges::is_sorted(delivered, std::less_equal<>{}));  // Strictly ascending.
  EXPECT_EQ(delivered.size() + late, distinct.size());
  const FrameNumberSet& receipts = sequencer_.receipts();
  EXPECT_EQ(receipts.size(), distinct.size());
  EXPECT_EQ(receipts.size() + receipts.missing(), receipts.next());
  std::uint64_t in_holes = 0;
  for (const FrameRange& hole : receipts.NewestHoles(5000)) {
    in_holes += hole.last - hole.first + 1;
    EXPECT_FALSE(distinct.contains(hole.first));
    EXPECT_FALSE(distinct.contains(hole.last));
  }
  EXPECT_EQ(in_holes, receipts.missing());
}

}  // namespace
}  // namespace isotherm

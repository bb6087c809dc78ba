#include "ground/pipeline/load_shedding_history.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Change = LoadSheddingHistory::Change;

TEST(LoadSheddingHistoryTest, WithoutAFrameThereIsNoLevel) {
  EXPECT_THAT(LoadSheddingHistory().Changes(), IsEmpty());
}

TEST(LoadSheddingHistoryTest, TheHighestLevelOfEachPeriodCounts) {
  LoadSheddingHistory history;
  history.Add(20ms, LoadShedding::kNone);
  history.Add(480ms, LoadShedding::kNone);
  history.Add(500ms, LoadShedding::kHalfThermal);
  history.Add(700ms, LoadShedding::kEverySecond);
  history.Add(900ms, LoadShedding::kNone);
  history.Add(1100ms, LoadShedding::kEverySecond);
  history.Add(1600ms, LoadShedding::kNone);
  EXPECT_THAT(history.Changes(), ElementsAre(Change{0ms, LoadShedding::kNone},
                                             Change{500ms, LoadShedding::kEverySecond},
                                             Change{1500ms, LoadShedding::kNone}));
  EXPECT_EQ(history.last(), 1600ms);
}

TEST(LoadSheddingHistoryTest, ThePeriodThatIsNotOverMayStillRise) {
  LoadSheddingHistory history;
  history.Add(100ms, LoadShedding::kNone);
  EXPECT_THAT(history.Changes(), ElementsAre(Change{0ms, LoadShedding::kNone}));
  history.Add(200ms, LoadShedding::kEveryFourth);
  EXPECT_THAT(history.Changes(), ElementsAre(Change{0ms, LoadShedding::kEveryFourth}));
}

TEST(LoadSheddingHistoryTest, ALevelHoldsOverAGapWithoutFrames) {
  LoadSheddingHistory history;
  history.Add(0ms, LoadShedding::kHalfThermal);
  history.Add(7300ms, LoadShedding::kHalfThermal);
  history.Add(7600ms, LoadShedding::kNone);
  EXPECT_THAT(history.Changes(), ElementsAre(Change{0ms, LoadShedding::kHalfThermal},
                                             Change{7500ms, LoadShedding::kNone}));
}

TEST(LoadSheddingHistoryTest, TheNewestChangesAreKept) {
  constexpr int kPeriods = 2 * static_cast<int>(LoadSheddingHistory::kMaxChanges);
  LoadSheddingHistory history;
  for (int i = 0; i < kPeriods; ++i) {
    history.Add(i * LoadSheddingHistory::kPeriod,
                i % 2 == 0 ? LoadShedding::kNone : LoadShedding::kHalfThermal);
  }
  const auto changes = history.Changes();
  ASSERT_EQ(changes.size(), LoadSheddingHistory::kMaxChanges);
  EXPECT_EQ(changes.back().since, (kPeriods - 1) * LoadSheddingHistory::kPeriod);
}

}  // namespace
}  // namespace isotherm

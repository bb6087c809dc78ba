#include "ground/subscriber/session_history.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

SessionCounters Counters(std::uint64_t session, std::uint64_t received) {
  SessionCounters counters;
  counters.session = session;
  counters.depth.received = received;
  return counters;
}

TEST(SessionHistoryTest, TheNewestCountersOfASessionReplaceThoseBefore) {
  SessionHistory history;
  history.Keep(Counters(1, 10), true, 0);
  history.Keep(Counters(1, 20), true, 0);
  EXPECT_EQ(history.Get(1).depth.received, 20U);
  EXPECT_EQ(history.Newest().session, 1U);
}

TEST(SessionHistoryTest, RefusedSamplesGoToTheNewestSession) {
  SessionHistory history;
  history.Keep(Counters(1, 0), true, 5);
  history.Keep(Counters(1, 0), false, 9);
  history.Keep(Counters(2, 0), true, 9);
  EXPECT_EQ(history.Get(1).refused_samples, 5U);
  EXPECT_EQ(history.Get(2).refused_samples, 9U);
}

TEST(SessionHistoryTest, TheOldestIsForgottenAndOfAnUnknownOneOnlyTheNumberIsSet) {
  SessionHistory history;
  for (std::uint64_t i = 1; i <= SessionHistory::kMaxSessions + 1; ++i)
    history.Keep(Counters(i, i), true, 0);
  EXPECT_EQ(history.Get(1).session, 1U);
  EXPECT_EQ(history.Get(1).depth.received, 0U);
  EXPECT_EQ(history.Get(2).depth.received, 2U);
}

}  // namespace
}  // namespace isotherm

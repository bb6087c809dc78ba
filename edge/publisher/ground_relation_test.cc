#include "edge/publisher/ground_relation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr std::uint64_t kOurs = 7;

class GroundRelationTest : public ::testing::Test {
 protected:
  void Receive(const std::string& edge_id, std::uint64_t session,
               SessionVerdict verdict = SessionVerdict::kFollowed) {
    Receipt receipt;
    receipt.session = session;
    receipt.verdict = verdict;
    relation_.OnReceipt(edge_id, receipt, kOurs, now_);
  }
  GroundRelation relation_{"drone"};
  SteadyTime now_{1h};
};

TEST_F(GroundRelationTest, AGroundThatFollowsThisRigIsNoProblem) {
  EXPECT_EQ(relation_.Problem(now_), "");
  Receive("drone", 0);
  Receive("drone", kOurs);
  Receive("cart", 5);  // Another ground, which follows another rig.
  EXPECT_EQ(relation_.Problem(now_), "");
  EXPECT_EQ(relation_.News(now_), std::nullopt);
}

TEST_F(GroundRelationTest, AGroundThatFollowsAnotherRigIsNamedOnce) {
  Receive("rig7", 0);
  EXPECT_THAT(relation_.News(now_),
              testing::Optional(HasSubstr("follows \"rig7\", not \"drone\"")));
  EXPECT_EQ(relation_.News(now_), std::nullopt);
  now_ += GroundRelation::kMemory;
  EXPECT_EQ(relation_.News(now_), "") << "it has left";
}

TEST_F(GroundRelationTest, F36ARefusalOfThisSessionIsToldUntilItIsOver) {
  Receive("drone", 99, SessionVerdict::kOtherRig);  // That of another one.
  Receive("drone", 5);                              // The first rig's.
  EXPECT_FALSE(relation_.IsRefused(now_));
  Receive("drone", kOurs, SessionVerdict::kOtherRig);
  Receive("drone", 5);
  EXPECT_TRUE(relation_.IsRefused(now_));
  EXPECT_THAT(relation_.News(now_), testing::Optional(HasSubstr("refuses this scan")));
  Receive("drone", kOurs, SessionVerdict::kOtherRig);
  EXPECT_EQ(relation_.News(now_), std::nullopt);
  Receive("drone", kOurs);
  EXPECT_FALSE(relation_.IsRefused(now_));
  EXPECT_EQ(relation_.News(now_), "");
}

}  // namespace
}  // namespace isotherm

#include "edge/publisher/ground_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::uint64_t kOurs = 7;   // The session of the rig that is called "drone".
constexpr std::uint64_t kHello = 1;  // Writer of kGround's hellos.
constexpr PeerHandle kGround = 100;
constexpr PeerHandle kOnlooker = 200;

class GroundWatchTest : public ::testing::Test {
 protected:
  static bool Everybody(PeerHandle /*peer*/) { return true; }
  static bool Nobody(PeerHandle /*peer*/) { return false; }

  bool Receive(PeerHandle sender, const std::string& edge_id, std::uint64_t session,
               SessionVerdict verdict = SessionVerdict::kFollowed) {
    Receipt receipt;
    receipt.session = session;
    receipt.verdict = verdict;
    return watch_.OnReceipt(sender, edge_id, receipt, kOurs, now_);
  }
  bool Look(bool is_there) {
    return watch_.Look(now_,
                       [is_there](std::uint64_t writer) { return is_there && writer == kHello; });
  }

  GroundWatch watch_{"drone"};
  SteadyTime now_{1h};
};

TEST_F(GroundWatchTest, WhoSaysNoHelloIsNoGroundStation) {
  watch_.Add(kHello, kGround);
  EXPECT_FALSE(Receive(kOnlooker, "drone", kOurs));
  EXPECT_FALSE(watch_.Knows(kOnlooker));
  EXPECT_FALSE(watch_.HasFollower(Everybody));
  EXPECT_TRUE(Receive(kGround, "drone", kOurs));
}

TEST_F(GroundWatchTest, AnOnlookersReceiptIsNoRefusal) {
  watch_.Add(kHello, kGround);
  Receive(kOnlooker, "drone", kOurs, SessionVerdict::kOtherRig);
  EXPECT_FALSE(watch_.IsRefused(now_));
  EXPECT_THAT(watch_.Problem(now_), IsEmpty());
}

TEST_F(GroundWatchTest, WhoHasNotSaidWhomItFollowsIsAwaitedAndNoFollower) {
  EXPECT_FALSE(watch_.IsAwaited(Everybody, now_));
  watch_.Add(kHello, kGround);
  EXPECT_TRUE(watch_.IsAwaited(Everybody, now_));
  EXPECT_FALSE(watch_.IsAwaited(Nobody, now_)) << "it does not read";
  EXPECT_FALSE(watch_.HasFollower(Everybody));
}

TEST_F(GroundWatchTest, AFollowerIsOneThatReads) {
  watch_.Add(kHello, kGround);
  Receive(kGround, "drone", kOurs);
  EXPECT_TRUE(watch_.HasFollower(Everybody));
  EXPECT_FALSE(watch_.HasFollower(Nobody));
}

TEST_F(GroundWatchTest, WhoFollowsAnotherRigIsNotAwaitedAndAProblem) {
  watch_.Add(kHello, kGround);
  Receive(kGround, "cart", 5);
  EXPECT_FALSE(watch_.HasFollower(Everybody));
  EXPECT_FALSE(watch_.IsAwaited(Everybody, now_));
  EXPECT_THAT(watch_.Problem(now_), HasSubstr("follows \"cart\", not \"drone\""));
}

TEST_F(GroundWatchTest, ARefusalOfAnotherSessionTakesNothingBack) {
  watch_.Add(kHello, kGround);
  Receive(kGround, "drone", kOurs);
  Receive(kGround, "drone", 99, SessionVerdict::kOtherRig);
  EXPECT_TRUE(watch_.HasFollower(Everybody));
  EXPECT_FALSE(watch_.IsRefused(now_));
}

TEST_F(GroundWatchTest, NobodyIsAwaitedWhileOurSessionIsRefused) {
  constexpr PeerHandle kSecondGround = 101;
  watch_.Add(kHello, kGround);
  watch_.Add(kHello, kSecondGround);  // It has not said whom it follows.
  Receive(kGround, "drone", kOurs, SessionVerdict::kOtherRig);
  EXPECT_TRUE(watch_.IsRefused(now_));
  EXPECT_FALSE(watch_.HasFollower(Everybody));
  EXPECT_FALSE(watch_.IsAwaited(Everybody, now_));
  now_ += GroundRelation::kMemory;
  EXPECT_TRUE(watch_.IsAwaited(Everybody, now_)) << "what was said so long ago is over";
}

TEST_F(GroundWatchTest, AGroundIsThereFromTheNextLookUntilItsHellosEnd) {
  EXPECT_FALSE(Look(true));
  EXPECT_FALSE(watch_.is_present());
  watch_.Add(kHello, kGround);
  EXPECT_FALSE(Look(true));
  EXPECT_TRUE(watch_.is_present());
  EXPECT_TRUE(Look(false)) << "it has left";
  EXPECT_FALSE(watch_.is_present());
  EXPECT_FALSE(watch_.Knows(kGround));
  EXPECT_FALSE(Look(false)) << "told once";
}

TEST_F(GroundWatchTest, F29WhichDirectionIsDeadIsSaid) {
  const std::map<PeerHandle, Announcement> announced = {{kGround, {Role::kGround, "", "desk"}}};
  const auto look = [&](Nanoseconds duration, PeerHandle unheard_by) {
    for (const SteadyTime end = now_ + duration; now_ < end; now_ += 100ms)
      watch_.LookAtWays(now_, announced, unheard_by);
  };
  look(4s, 0);
  EXPECT_THAT(watch_.Problem(now_), IsEmpty());
  look(2s, 0);
  EXPECT_THAT(watch_.Problem(now_), HasSubstr("on \"desk\" announces itself"));
  watch_.Add(kHello, kGround);
  look(1s, 0);
  EXPECT_THAT(watch_.Problem(now_), IsEmpty());
  look(1s, kGround);
  EXPECT_THAT(watch_.Problem(now_), HasSubstr("nothing that this rig sends arrives"));
  watch_.LookAtWays(now_, {}, kGround);
  EXPECT_THAT(watch_.Problem(now_), IsEmpty()) << "it is switched off";
}

}  // namespace
}  // namespace isotherm

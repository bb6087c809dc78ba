#include "ground/subscriber/rig_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr PeerHandle kFirst = 11;
constexpr PeerHandle kSecond = 22;

class RigWatchTest : public ::testing::Test {
 protected:
  void Announce(PeerHandle peer, std::uint64_t session) {
    RigDescription rig;
    rig.session = session;
    gate_.Add(peer, {.content = rig}, now_);
  }
  RigSighting Look(Nanoseconds later = 100ms) {
    now_ += later;
    const auto is_present = [this](PeerHandle peer) { return present_.contains(peer); };
    gate_.Update(now_, is_present);
    return watch_.Look(now_, "edge", has_status_writer_, is_present);
  }

  std::set<PeerHandle> present_{kFirst, kSecond};
  bool has_status_writer_ = true;
  SteadyTime now_{1h};
  RigGate gate_{[](RigSample&&) {}, [](const RigSample&, RefusalCause) {}};
  RigWatch watch_{gate_};
};

TEST_F(RigWatchTest, TheRigIsPresentWhileItsProcessAndAStatusWriterAre) {
  EXPECT_FALSE(Look().present);
  watch_.Add(kFirst, "edge", "rig-1");
  EXPECT_TRUE(Look().present);
  has_status_writer_ = false;
  EXPECT_FALSE(Look().present);
  has_status_writer_ = true;
  present_.clear();
  EXPECT_FALSE(Look().present);
}

TEST_F(RigWatchTest, AnotherRigIsAProblemOnlyWhileTheFollowedOneIsMissing) {
  watch_.Add(kSecond, "other", "rig-2");
  EXPECT_THAT(Look().problem, HasSubstr("other"));
  watch_.Add(kFirst, "edge", "rig-1");
  EXPECT_EQ(Look().problem, "");
}

TEST_F(RigWatchTest, ARivalIsToldAtOnceAndThenOnceASecond) {
  Announce(kFirst, 1);
  EXPECT_THAT(Look().sessions_to_refuse, IsEmpty());
  Announce(kSecond, 2);
  now_ += RigGate::kTrial;
  Announce(kFirst, 1);  // The owner is heard after the trial.
  const RigSighting first = Look();
  EXPECT_THAT(first.sessions_to_refuse, ElementsAre(2));
  EXPECT_THAT(first.problem, HasSubstr("1 MORE of the name \"edge\""));
  EXPECT_THAT(Look().sessions_to_refuse, IsEmpty());
  Announce(kFirst, 1);
  EXPECT_THAT(Look(RigWatch::kRivalInterval).sessions_to_refuse, ElementsAre(2));
}

TEST_F(RigWatchTest, F29WhichDirectionIsDeadIsSaid) {
  std::map<PeerHandle, Announcement> announced = {{kFirst, {Role::kEdge, "edge", "rig-1"}},
                                                  {kSecond, {Role::kEdge, "other", "rig-2"}}};
  const auto look = [&](Nanoseconds duration, PeerHandle deaf_rig) {
    std::string problem;
    for (const SteadyTime end = now_ + duration; now_ < end; now_ += 100ms)
      problem = watch_.LookAtWays(now_, "edge", announced, deaf_rig);
    return problem;
  };
  EXPECT_THAT(look(4s, 0), IsEmpty());
  EXPECT_THAT(look(2s, 0), HasSubstr("\"edge\" on \"rig-1\" announces itself"));
  watch_.Add(kFirst, "edge", "rig-1");
  EXPECT_THAT(look(10s, 0), IsEmpty()) << "the other rig is not ours";
  EXPECT_THAT(look(1s, kFirst), HasSubstr("DOES NOT HEAR"));
  announced.erase(kFirst);
  EXPECT_THAT(look(1s, kFirst), IsEmpty()) << "it is switched off";
}

}  // namespace
}  // namespace isotherm

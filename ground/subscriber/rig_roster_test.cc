#include "ground/subscriber/rig_roster.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;

TEST(RigRosterTest, NamesEachOtherRigOnceUntilItLeaves) {
  RigRoster roster;
  roster.Add(1, "drone", "pi-1");
  roster.Add(2, "drone", "pi-2");
  roster.Add(3, "cart", "pi-3");
  EXPECT_TRUE(roster.Has("drone"));
  EXPECT_THAT(roster.Others("cart"), ElementsAre("drone"));
  EXPECT_THAT(roster.Others("rig7"), ElementsAre("cart", "drone"));
  EXPECT_EQ(roster.HostOf(2), "pi-2");
  roster.Update([](PeerHandle peer) { return peer == 3; });
  EXPECT_FALSE(roster.Has("drone"));
  EXPECT_EQ(roster.HostOf(2), "");
}

TEST(RigRosterTest, IsBounded) {
  RigRoster roster;
  for (PeerHandle peer = 1; peer <= 1000; ++peer) roster.Add(peer, std::to_string(peer), "");
  EXPECT_EQ(roster.Others("").size(), RigRoster::kMaxRigs);
}

TEST(OtherRigsTest, SaysWhatToType) {
  EXPECT_EQ(OtherRigsText("rig7", {"drone"}),
            "a rig \"drone\" is here, this ground follows \"rig7\"; start with --edge-id drone");
  EXPECT_EQ(OtherRigsText("rig7", {"cart", "drone"}),
            "rigs \"cart\", \"drone\" are here, this ground follows \"rig7\"; start with --edge-id "
            "NAME");
  EXPECT_EQ(OtherRigsText("rig7", {}), "");
}

TEST(OtherRigsTest, IsToldOncePerChangeAndNotWhileRigsAppear) {
  OtherRigsNotice notice;
  SteadyTime now{1h};
  EXPECT_FALSE(notice.Update(true, now));
  EXPECT_FALSE(notice.Update(false, now += 1s)) << "the right one came a little later";
  EXPECT_FALSE(notice.Update(true, now += 1s));
  EXPECT_TRUE(notice.Update(true, now += OtherRigsNotice::kPatience));
  EXPECT_FALSE(notice.Update(true, now += 1h));
  EXPECT_FALSE(notice.Update(false, now));
  EXPECT_FALSE(notice.Update(true, now));
  EXPECT_TRUE(notice.Update(true, now + OtherRigsNotice::kPatience));
}

}  // namespace
}  // namespace isotherm

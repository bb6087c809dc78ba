#include "edge/publisher/ground_register.h"

#include <gtest/gtest.h>

namespace isotherm {
namespace {

bool Reads(PeerHandle) { return true; }
bool ReadsNothing(PeerHandle) { return false; }

TEST(GroundRegisterTest, OnlyWhoSaidHelloIsAGround) {
  GroundRegister grounds;
  EXPECT_TRUE(grounds.empty());
  EXPECT_FALSE(grounds.NoteReceipt(5, true));
  EXPECT_FALSE(grounds.MayHaveFollower(Reads));
  grounds.Add(50, 5);
  EXPECT_TRUE(grounds.Knows(5));
  EXPECT_FALSE(grounds.Knows(6));
  grounds.Add(60, 0);  // Has left already.
  EXPECT_FALSE(grounds.Knows(0));
}

TEST(GroundRegisterTest, AGroundMayFollowThisRigUntilItSaysWhichOne) {
  GroundRegister grounds;
  grounds.Add(50, 5);
  EXPECT_FALSE(grounds.HasFollower(Reads));
  EXPECT_TRUE(grounds.MayHaveFollower(Reads));
  EXPECT_FALSE(grounds.MayHaveFollower(ReadsNothing));
  EXPECT_TRUE(grounds.NoteReceipt(5, false));
  EXPECT_FALSE(grounds.MayHaveFollower(Reads));
  EXPECT_TRUE(grounds.NoteReceipt(5, true));
  EXPECT_TRUE(grounds.HasFollower(Reads));
  EXPECT_FALSE(grounds.HasFollower(ReadsNothing));
  EXPECT_TRUE(grounds.NoteReceipt(5, false, /*certain=*/false));
  EXPECT_TRUE(grounds.HasFollower(Reads));
}

TEST(GroundRegisterTest, AGroundThatHasLeftIsForgotten) {
  GroundRegister grounds;
  grounds.Add(50, 5);
  grounds.Add(70, 7);
  grounds.RemoveIf([](const GroundRegister::Ground& ground) { return ground.hello_writer == 50; });
  EXPECT_FALSE(grounds.Knows(5));
  EXPECT_TRUE(grounds.Knows(7));
}

TEST(GroundRegisterTest, AGroundThatIsBackIsThereByItsNewWriter) {
  GroundRegister grounds;
  grounds.Add(50, 5);
  grounds.Add(51, 5);
  grounds.RemoveIf([](const GroundRegister::Ground& ground) { return ground.hello_writer == 50; });
  EXPECT_TRUE(grounds.Knows(5));
}

TEST(GroundRegisterTest, F62AFloodOfHellosDoesNotGrowIt) {
  GroundRegister grounds;
  for (PeerHandle peer = 1; peer < 10'000; ++peer) grounds.Add(peer, peer);
  int known = 0;
  for (PeerHandle peer = 1; peer < 10'000; ++peer) known += grounds.Knows(peer) ? 1 : 0;
  EXPECT_LE(known, 64);
}

}  // namespace
}  // namespace isotherm

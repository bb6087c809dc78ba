#include "ground/subscriber/rig_gate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <vector>

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr PeerHandle kFirst = 11;
constexpr PeerHandle kSecond = 22;
constexpr PeerHandle kThird = 33;

RigSample Rig(std::uint64_t session) {
  RigDescription rig;
  rig.session = session;
  return {.content = rig};
}

RigSample Frame(std::uint64_t session, std::uint64_t number, std::size_t bytes = 100) {
  EncodedDepthFrame frame;
  frame.header.session = session;
  frame.header.frame_number = number;
  frame.image.payload.resize(bytes);
  return {.content = std::move(frame)};
}

RigSample StatusOf(std::uint64_t session, ScanState state) {
  EdgeStatus status;
  status.session = session;
  status.scan_state = state;
  return {.content = status};
}

class RigGateTest : public ::testing::Test {
 protected:
  void Add(PeerHandle peer, RigSample sample) { gate_.Add(peer, std::move(sample), now_); }
  /// Time passes; whoever is not in gone_ is there.
  void Wait(Nanoseconds time) {
    now_ += time;
    gate_.Update(now_, [this](PeerHandle peer) { return !gone_.contains(peer); });
  }
  /// "rig 1", "frame 1/0", "status 1", ...
  static std::string Text(const RigSample& sample) {
    const std::string session = std::to_string(SessionOf(sample));
    if (std::holds_alternative<RigDescription>(sample.content)) return "rig " + session;
    if (std::holds_alternative<EdgeStatus>(sample.content)) return "status " + session;
    if (const auto* frame = std::get_if<EncodedDepthFrame>(&sample.content))
      return "frame " + session + "/" + std::to_string(frame->header.frame_number);
    return "other";
  }
  std::uint64_t refused(RefusalCause cause) const {
    const auto found = refused_.find(cause);
    return found == refused_.end() ? 0 : found->second;
  }

  std::vector<std::string> passed_;
  std::map<RefusalCause, std::uint64_t> refused_;
  std::set<PeerHandle> gone_;
  RigGate gate_{[this](RigSample&& sample) { passed_.push_back(Text(sample)); },
                [this](const RigSample&, RefusalCause cause) { ++refused_[cause]; }};
  SteadyTime now_{1h};
};

TEST_F(RigGateTest, TheOwnersSamplesPassInTheirOrder) {
  Add(kFirst, Rig(1));
  Add(kFirst, StatusOf(1, ScanState::kScanning));
  Add(kFirst, Frame(1, 0));
  Add(kFirst, StatusOf(1, ScanState::kEnded));
  EXPECT_THAT(passed_, ElementsAre("rig 1", "status 1", "frame 1/0", "status 1"));
  EXPECT_THAT(refused_, IsEmpty());
}

TEST_F(RigGateTest, FramesAndStatusThatOvertakeTheRigAreKeptForIt) {
  Add(kFirst, StatusOf(1, ScanState::kEnded));
  Add(kFirst, Frame(1, 0));
  Add(kFirst, Frame(1, 1));
  EXPECT_THAT(passed_, IsEmpty());
  Add(kFirst, Rig(1));
  EXPECT_THAT(passed_, ElementsAre("rig 1", "frame 1/0", "frame 1/1", "status 1"));
}

TEST_F(RigGateTest, F60FramesOfASessionThatNobodyAnnouncedAreRefusedAfterAWhile) {
  Add(kFirst, Rig(1));
  for (std::uint64_t i = 0; i < 1000; ++i) Add(kFirst, Frame(77, i));
  Add(kFirst, Frame(1, 0));
  EXPECT_EQ(refused(RefusalCause::kUnannounced), 1000 - RigGate::kMaxHeldSamples);
  EXPECT_EQ(gate_.overflowed(), 1000 - RigGate::kMaxHeldSamples);
  Wait(RigGate::kPatience);
  EXPECT_EQ(gate_.overflowed(), 1000 - RigGate::kMaxHeldSamples) << "the others had their time";
  EXPECT_EQ(refused(RefusalCause::kUnannounced), 1000U);
  EXPECT_THAT(passed_, ElementsAre("rig 1", "frame 1/0"));
}

TEST_F(RigGateTest, WhatIsKeptIsBoundedInBytes) {
  for (std::uint64_t i = 0; i < 10; ++i) Add(kFirst, Frame(1, i, RigGate::kMaxHeldBytes / 4));
  EXPECT_EQ(refused(RefusalCause::kUnannounced), 7U);
  EXPECT_EQ(gate_.overflowed(), 7U);
}

TEST_F(RigGateTest, F36ASecondProcessNeitherEndsNorAltersTheSession) {
  Add(kFirst, Rig(1));
  Add(kFirst, Frame(1, 0));
  passed_.clear();
  Add(kSecond, Rig(1));       // A duplicate rig, perhaps another calibration.
  Add(kSecond, Rig(2));       // A session of its own.
  Add(kSecond, Frame(1, 1));  // The first one's number.
  Add(kSecond, Frame(2, 0));
  Add(kSecond, StatusOf(1, ScanState::kEnded));  // Forged.
  Add(kFirst, Frame(1, 1));
  EXPECT_THAT(passed_, ElementsAre("frame 1/1"));
  for (int i = 2; i < 40; ++i) {
    Wait(33ms);
    Add(kFirst, Frame(1, static_cast<std::uint64_t>(i)));
    Add(kSecond, Frame(2, static_cast<std::uint64_t>(i)));
  }
  EXPECT_EQ(passed_.size(), 39U);
  EXPECT_EQ(gate_.owner(), kFirst);
  Wait(0s);
  EXPECT_THAT(gate_.rivals(), ElementsAre(RigGate::Rival{.peer = kSecond, .session = 2}));
  EXPECT_EQ(refused(RefusalCause::kOtherWriter), 41U) << "all frames, and the first rig";
}

TEST_F(RigGateTest, ASilentOwnerThatIsThereKeepsItsSessionForAWhile) {
  Add(kFirst, Rig(1));
  Add(kSecond, Rig(2));
  Wait(RigGate::kSilence - 1ms);
  EXPECT_EQ(gate_.owner(), kFirst);
  Wait(1ms);
  EXPECT_EQ(gate_.owner(), kSecond);
  EXPECT_THAT(passed_, ElementsAre("rig 1", "rig 2"));
}

TEST_F(RigGateTest, F33WhatIsLeftOfAKilledEdgeIsNoRivalUntilItIsHeardAgain) {
  Add(kFirst, Rig(1));
  Add(kFirst, Frame(1, 0));
  Wait(100ms);
  Add(kSecond, Rig(2));
  for (int i = 0; i < 50; ++i) {
    Add(kSecond, Frame(2, static_cast<std::uint64_t>(i)));
    Wait(100ms);
    EXPECT_THAT(gate_.rivals(), IsEmpty()) << i;
  }
  ASSERT_EQ(gate_.owner(), kSecond);
  // It was only cut off, and is there after all.
  Add(kFirst, Frame(1, 1));
  Wait(100ms);
  EXPECT_THAT(gate_.rivals(), ElementsAre(RigGate::Rival{kFirst, 1}));
}

TEST_F(RigGateTest, F33AnEdgeThatWasKilledIsFollowedByItsSuccessorWithoutLoss) {
  Add(kFirst, Rig(1));
  Add(kFirst, Frame(1, 0));
  Add(kSecond, Rig(2));  // Started again before anybody knows that the first one is dead.
  for (std::uint64_t i = 0; i < 30; ++i) {
    Add(kSecond, Frame(2, i));
    Wait(33ms);
  }
  EXPECT_EQ(gate_.owner(), kFirst);
  gone_ = {kFirst};
  Wait(RigGate::kTrial);
  EXPECT_EQ(gate_.owner(), kSecond);
  EXPECT_EQ(passed_.size(), 2U + 1U + 30U);
  EXPECT_EQ(passed_.back(), "frame 2/29");
  EXPECT_THAT(refused_, IsEmpty());
}

TEST_F(RigGateTest, F37AnEdgeThatIsKilledTwiceWithinASecondLosesNoFrame) {
  Add(kFirst, Rig(1));
  Add(kFirst, Frame(1, 0));
  Wait(100ms);
  Add(kSecond, Rig(2));  // The first one was killed, which nobody knows yet.
  Add(kSecond, Frame(2, 0));
  Wait(400ms);
  Add(kThird, Rig(3));  // And so was the second one.
  for (std::uint64_t i = 0; i < 100; ++i) {
    Add(kThird, Frame(3, i));
    Wait(33ms);
    // A process that is gone is known to be so a second later.
    if (i == 20) gone_ = {kFirst};
    if (i == 40) gone_ = {kFirst, kSecond};
  }
  EXPECT_EQ(gate_.owner(), kThird);
  EXPECT_THAT(std::vector(passed_.begin(), passed_.begin() + 6),
              ElementsAre("rig 1", "frame 1/0", "rig 2", "frame 2/0", "rig 3", "frame 3/0"));
  EXPECT_EQ(passed_.size(), 4U + 1U + 100U);
  EXPECT_THAT(refused_, IsEmpty());
}

TEST_F(RigGateTest, OfManyOtherProcessesOnlySoManyAreKept) {
  Add(kFirst, Rig(1));
  constexpr PeerHandle kStranger = 100;
  for (PeerHandle i = 0; i < 10; ++i) Add(kStranger + i, Frame(50 + i, 0));
  EXPECT_EQ(refused(RefusalCause::kOtherWriter), 10U - RigGate::kMaxOthersHeld);
}

TEST_F(RigGateTest, AfterAnOutageTheFirstOneThatIsHeardIsNotTheOwner) {
  Add(kFirst, Rig(1));
  Add(kSecond, Rig(2));
  Wait(RigGate::kTrial);
  Add(kFirst, Frame(1, 0));
  Wait(0s);
  EXPECT_EQ(gate_.rivals().size(), 1U);
  gone_ = {kFirst, kSecond};
  Wait(10s);
  gone_ = {kFirst};  // The second one is back a little sooner.
  Add(kSecond, Rig(2));
  Wait(RigGate::kTrial - 1ms);
  gone_ = {};
  Add(kFirst, Frame(1, 1));
  Wait(1s);
  EXPECT_EQ(gate_.owner(), kFirst);
}

TEST_F(RigGateTest, TheNextEdgeFollowsAtOnceWhenTheSessionIsClosed) {
  Add(kFirst, Rig(1));
  Add(kFirst, StatusOf(1, ScanState::kEnded));
  Add(kSecond, Rig(2));
  Add(kFirst, Frame(1, 0));  // Was still under way.
  EXPECT_EQ(passed_.back(), "frame 1/0");
  gate_.OnClosed(1);
  Wait(0s);
  EXPECT_EQ(passed_.back(), "rig 2");
  Add(kFirst, Frame(1, 1));
  Add(kFirst, Rig(1));
  EXPECT_EQ(passed_.back(), "rig 2") << "what is over does not come back";
  EXPECT_EQ(gate_.owner(), kSecond);
}

TEST_F(RigGateTest, F60ASessionThatTheOwnerHasLeftDoesNotComeBack) {
  Add(kFirst, Rig(1));
  Add(kFirst, Rig(2));
  Add(kFirst, Frame(1, 0));  // Was still under way.
  Add(kFirst, Rig(1));       // Repeated, for instance after an outage.
  Add(kFirst, Frame(2, 0));
  EXPECT_THAT(passed_, ElementsAre("rig 1", "rig 2", "frame 2/0"));
  EXPECT_EQ(refused(RefusalCause::kOtherSession), 2U);
}

TEST_F(RigGateTest, WhoAnnouncesComesBeforeWhoOnlySentSomething) {
  Add(kSecond, Frame(5, 0));
  Add(kSecond, StatusOf(5, ScanState::kEnded));
  Add(kFirst, Rig(1));
  Add(kFirst, Frame(1, 0));
  EXPECT_THAT(passed_, ElementsAre("rig 1", "frame 1/0"));
}

TEST_F(RigGateTest, AFloodOfProcessesIsBoundedAndTheOwnerGoesOn) {
  Add(kFirst, Rig(1));
  for (PeerHandle peer = 100; peer < 1100; ++peer) Add(peer, Rig(peer));
  Add(kFirst, Frame(1, 0));
  EXPECT_EQ(passed_.back(), "frame 1/0");
  EXPECT_EQ(refused(RefusalCause::kOtherWriter), 1000 - (RigGate::kMaxProcesses - 1));
}

TEST_F(RigGateTest, AnUnknownWriterIsRefused) {
  Add(0, Rig(1));
  EXPECT_THAT(passed_, IsEmpty());
  EXPECT_EQ(refused(RefusalCause::kOtherWriter), 1U);
}

}  // namespace
}  // namespace isotherm

#include "ground/service/distributor.h"

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ground/service/scan_board.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;

/// Plays a session, and collects what comes out on both sides.
class DistributorTest : public ::testing::Test {
 protected:
  static constexpr std::uint64_t kSession = 7;

  void Start(bool single_scan = false, std::size_t recording_items = 100) {
    recording_ = std::make_unique<RecordingQueue>(
        RecordingQueue::Limits{.items = recording_items, .bytes = 1'000'000});
    distributor_ = std::make_unique<Distributor>(
        options_, single_scan, clock_,
        DistributorSinks{reconstruction_, *recording_, board_, progress_});
  }
  void Rig(std::uint64_t session = kSession) {
    RigDescription rig;
    rig.session = session;
    distributor_->OnRig(rig);
  }
  void End(std::uint64_t session = kSession) {
    SessionCounters counters;
    counters.session = session;
    distributor_->OnSessionEnd(counters);
  }
  static ReceivedDepth Frame(std::uint64_t number, std::uint64_t session = kSession) {
    auto frame = std::make_shared<DepthFrame>();
    frame->header.session = session;
    frame->header.frame_number = number;
    auto encoded = std::make_shared<EncodedDepthFrame>();
    encoded->header = frame->header;
    return {frame, encoded, {}, {}};
  }
  void Depth(std::uint64_t number, std::uint64_t session = kSession) {
    distributor_->OnItem(Frame(number, session));
  }

  /// S<session> for a beginning, R<session> for a rig described anew, E<session> for an end, and
  /// numbers of frames.
  static std::string Name(const SessionItem& item) {
    if (const auto* start = std::get_if<SessionStart>(&item))
      return "S" + std::to_string(start->rig.session);
    if (const auto* rig = std::get_if<RigDescription>(&item))
      return "R" + std::to_string(rig->session);
    if (const auto* end = std::get_if<SessionCounters>(&item))
      return "E" + std::to_string(end->session);
    if (const auto* depth = std::get_if<ReceivedDepth>(&item))
      return std::to_string(depth->encoded->header.frame_number);
    return "?";
  }
  std::vector<SessionItem> Reconstructed() {
    std::vector<SessionItem> items;
    while (auto item = reconstruction_.PopFor(0ns, {})) items.push_back(std::move(*item));
    return items;
  }
  std::vector<SessionItem> Recorded() {
    std::vector<SessionItem> items;
    std::optional<SessionItem> item;
    while (recording_->Pop(0ns, {}, item) == RecordingQueue::Outcome::kItem)
      items.push_back(std::move(*item));
    return items;
  }
  static std::string Names(const std::vector<SessionItem>& items) {
    std::string names;
    for (const SessionItem& item : items) names += (names.empty() ? "" : " ") + Name(item);
    return names;
  }

  FakeClock clock_{CaptureTime(FromSeconds(1000.0))};
  GroundOptions options_;
  SessionQueue reconstruction_{1000, OverflowPolicy::kBlock};
  std::unique_ptr<RecordingQueue> recording_;
  ScanBoard board_;
  ThreadProgress progress_;
  std::unique_ptr<Distributor> distributor_;
};

TEST_F(DistributorTest, BothConsumersGetTheSessionInOrder) {
  Start();
  Rig();
  for (int i = 0; i < 3; ++i) Depth(i);
  End();
  EXPECT_EQ(Names(Reconstructed()), "S7 0 1 2 E7");
  EXPECT_EQ(Names(Recorded()), "S7 0 1 2 E7");
}

TEST_F(DistributorTest, ThePixelsAreForTheReconstructionOnly) {
  Start();
  Rig();
  clock_.Advance(5ms);
  Depth(0);
  const auto recorded = std::get<ReceivedDepth>(Recorded().at(1));
  EXPECT_EQ(recorded.frame, nullptr);
  EXPECT_NE(recorded.encoded, nullptr);
  const auto reconstructed = std::get<ReceivedDepth>(Reconstructed().at(1));
  EXPECT_NE(reconstructed.frame, nullptr);
  EXPECT_EQ(reconstructed.queued, clock_.Now());
}

TEST_F(DistributorTest, FramesBeforeTheirRigAreKeptForIt) {
  Start();
  Depth(0);
  Depth(50, kSession + 1);
  Depth(1);
  EXPECT_TRUE(Reconstructed().empty());
  Rig();
  Depth(2);
  EXPECT_EQ(Names(Reconstructed()), "S7 0 1 2") << "those of another session are of no use";
}

TEST_F(DistributorTest, OfTooManyFramesWithoutARigTheNewestAreKept) {
  constexpr std::uint64_t kKept = 128;
  Start();
  ::testing::internal::CaptureStderr();
  for (std::uint64_t i = 0; i < kKept + 2; ++i) Depth(i);
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("no rig description"), std::string::npos);
  Rig();
  const std::vector<SessionItem> items = Reconstructed();
  ASSERT_EQ(items.size(), 1 + kKept);
  EXPECT_EQ(Name(items.at(1)), "2");
}

TEST_F(DistributorTest, ARigThatSaysTheSameAgainChangesNothing) {
  Start();
  Rig();
  Rig();
  EXPECT_EQ(Names(Reconstructed()), "S7");
}

TEST_F(DistributorTest, ACameraThatComesLateIsToldToBoth) {
  Start();
  Rig();
  Depth(0);
  RigDescription rig;
  rig.session = kSession;
  rig.thermal = {.width = 382, .height = 288, .serial = "T1"};
  rig.rig.thermal_scale = {0.02, 0.0};
  for (int i = 0; i < 2; ++i) distributor_->OnRig(rig);
  Depth(1);
  const std::vector<SessionItem> recorded = Recorded();
  EXPECT_EQ(Names(recorded), "S7 0 R7 1") << "once";
  EXPECT_EQ(std::get<RigDescription>(recorded.at(2)).thermal.serial, "T1");
  EXPECT_EQ(Names(Reconstructed()), "S7 0 R7 1");
}

TEST_F(DistributorTest, ASessionThatFollowsHasAFolderOfItsOwn) {
  Start();
  Rig();
  End();
  Rig(kSession + 1);
  const std::vector<SessionItem> items = Reconstructed();
  ASSERT_EQ(Names(items), "S7 E7 S8");
  EXPECT_NE(std::get<SessionStart>(items[0]).folder, std::get<SessionStart>(items[2]).folder);
  EXPECT_EQ(*board_.recording.Get(), std::get<SessionStart>(items[2]).recording);
}

TEST_F(DistributorTest, TheEndOfAnotherSessionIsNotTheEndOfThisOne) {
  Start();
  Rig();
  End(kSession + 1);
  Depth(0);
  EXPECT_EQ(Names(Reconstructed()), "S7 0");
}

TEST_F(DistributorTest, ASingleScanEndsWithItsSession) {
  Start(/*single_scan=*/true);
  Rig();
  End();
  Rig(kSession + 1);
  Depth(0, kSession + 1);
  End();
  EXPECT_EQ(Names(Reconstructed()), "S7 E7");
}

TEST_F(DistributorTest, ASingleScanEndsWhenTheEdgeIsStartedAnew) {
  Start(/*single_scan=*/true);
  Rig();
  Depth(0);
  Rig(kSession + 1);
  Depth(0, kSession + 1);
  EXPECT_EQ(Names(Reconstructed()), "S7 0 E7");
  EXPECT_EQ(Names(Recorded()), "S7 0 E7");
}

TEST_F(DistributorTest, F42WhatTheDiskDoesNotTakeIsCountedAndStillReconstructed) {
  Start(/*single_scan=*/false, /*recording_items=*/2);
  Rig();
  ::testing::internal::CaptureStderr();
  for (int i = 0; i < 4; ++i) Depth(i);
  EXPECT_NE(::testing::internal::GetCapturedStderr().find("does not take the recording"),
            std::string::npos);
  const std::vector<SessionItem> items = Reconstructed();
  EXPECT_EQ(Names(items), "S7 0 1 2 3");
  const std::size_t kept = Recorded().size() - 1;  // Without the beginning.
  const RecordingProgress counters = std::get<SessionStart>(items[0]).recording->Get();
  EXPECT_EQ(counters.depth_left_out[NotRecorded::kDiskTooSlow], 4 - kept);
  EXPECT_LT(kept, 4U);
  End();
  EXPECT_EQ(Names(Recorded()), "E7") << "an end is never left out";
}

TEST_F(DistributorTest, F22LateFramesAreRecordedOnly) {
  Start();
  Rig();
  distributor_->OnLate(Frame(3));
  EXPECT_EQ(Names(Reconstructed()), "S7");
  EXPECT_EQ(Names(Recorded()), "S7 3");
}

TEST_F(DistributorTest, WithoutARecordingFramesAreReconstructedOnly) {
  options_.mutable_live()->set_record(false);
  Start();
  Rig();
  Depth(0);
  End();
  EXPECT_EQ(Names(Reconstructed()), "S7 0 E7");
  EXPECT_EQ(Names(Recorded()), "S7 E7");
}

}  // namespace
}  // namespace isotherm

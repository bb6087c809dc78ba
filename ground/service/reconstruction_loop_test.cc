#include "ground/service/reconstruction_loop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ground/service/testing/reconstruction_loop_fixture.h"

namespace isotherm {
namespace {

using namespace std::chrono_literals;
using ::testing::Each;
using ::testing::IsEmpty;

TEST_F(ReconstructionLoopTest, ASessionGivesFeedbackOnTheWayAndResultsAtItsEnd) {
  Start(5);
  Frames(4);
  Close(5);
  Run();
  AwaitResults(1);
  End();
  EXPECT_TRUE(loop_.status().ok());
  EXPECT_EQ(Stats(5)["frames"]["depth"]["tracked"], 4);
  EXPECT_EQ(Stats(5)["frames"]["thermal"]["fused"], 3);
  ASSERT_FALSE(subscriber_.published.empty());
  for (const Feedback& feedback : subscriber_.published) EXPECT_EQ(feedback.session, 5U);
  const std::vector<Feedback> recorded = Recorded();
  ASSERT_EQ(recorded.size(), subscriber_.published.size()) << "what was sent is recorded";
  EXPECT_EQ(recorded.back().frame_number, subscriber_.published.back().frame_number);
  EXPECT_FALSE(board_.feedback.Take().has_value()) << "nothing of a scan that is over";
}

TEST_F(ReconstructionLoopTest, RoomOnTheDiskIsAskedForAsTheModelGrows) {
  std::vector<std::uint64_t> asked;
  subscriber_.on_publish = [&] { asked.push_back(board_.result_bytes); };
  Start(1);
  Frames(10);
  Close(1);
  Run();
  AwaitResults(1);
  End();
  // Each feedback comes before the estimate with it.
  ASSERT_GE(asked.size(), 3U);
  EXPECT_EQ(asked[0], 0U);
  std::uint64_t bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(Folder(1)))
    bytes += entry.is_regular_file() ? entry.file_size() : 0;
  EXPECT_GT(asked.back(), bytes / 2) << "it has to do with what the results take";
  EXPECT_LT(asked.back(), 20 * bytes);
}

TEST_F(ReconstructionLoopTest, F39WhoIsStuckAtAFrameIsSeenToBe) {
  std::vector<Nanoseconds> at_it;
  subscriber_.on_publish = [&] { at_it.push_back(progress_.AtItFor(clock_.SteadyNow() + 11s)); };
  Start(1);
  Frames(4);
  Close(1);
  Run();
  AwaitResults(1);
  End();
  EXPECT_FALSE(at_it.empty());
  EXPECT_THAT(at_it, Each(Nanoseconds(11s)));
  EXPECT_EQ(progress_.AtItFor(clock_.SteadyNow() + 1h), 0ns);
}

TEST_F(ReconstructionLoopTest, ANewSessionEndsTheOneBefore) {
  Start(1);
  Frames(2);
  Start(2);
  Frames(3);
  Close(2);
  Run();
  AwaitResults(2);
  End();
  EXPECT_EQ(Stats(1)["frames"]["depth"]["in"], 2);
  EXPECT_EQ(Stats(2)["frames"]["depth"]["in"], 3);
}

TEST_F(ReconstructionLoopTest, F38FramesThatWaitAtTheStopAreCountedAndTheScanIsWritten) {
  Start(1);
  Frames(3);
  std::stop_source stopped;
  stopped.request_stop();
  loop_.Run(queue_, stopped.get_token());
  results_.Run(stopped.get_token());
  EXPECT_EQ(Stats(1)["frames"]["depth"]["in"], 0);
  EXPECT_EQ(Stats(1)["link"]["not_processed_at_stop"], 5) << "three depth, two thermal frames";
  EXPECT_THAT(subscriber_.published, IsEmpty());
}

TEST_F(ReconstructionLoopTest, ASessionThatCannotBeReconstructedEndsNothing) {
  Start(1, Rig());
  Frames(2);
  Close(1);
  Start(2);
  Frames(2);
  Close(2);
  Run();
  AwaitResults(2);
  End();
  EXPECT_FALSE(loop_.status().ok());
  EXPECT_EQ(Stats(2)["frames"]["depth"]["tracked"], 2);
  for (const Feedback& feedback : subscriber_.published) EXPECT_EQ(feedback.session, 2U);
}

TEST_F(ReconstructionLoopTest, WithoutALinkTheScanGoesOnAndItsFeedbackIsRecorded) {
  subscriber_.works = false;
  Start(1);
  Frames(3);
  Close(1);
  Run();
  AwaitResults(1);
  End();
  EXPECT_EQ(Stats(1)["frames"]["depth"]["tracked"], 3);
  EXPECT_FALSE(Recorded().empty());
  EXPECT_TRUE(loop_.status().ok());
}

TEST_F(ReconstructionLoopTest, TheRigsOperatorIsToldWhatWasLeftOutToKeepUp) {
  options_.mutable_live()->mutable_expert()->set_max_wait_s(0.1);
  Start(1);
  Frames(12, 150ms);
  Close(1);
  Run();
  AwaitResults(1);
  End();
  ASSERT_GE(subscriber_.published.size(), 2U);
  EXPECT_GT(subscriber_.published.back().frames_left_out, 0U);
}

}  // namespace
}  // namespace isotherm

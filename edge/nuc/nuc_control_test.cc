// Orders on their way to a camera that answers at once, later or not at all.

#include "edge/nuc/nuc_control.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "edge/options/edge_options.pb.h"
#include "edge/source/testing/fake_source.h"

namespace isotherm {
namespace {

using testing::HasSubstr;

class NucControlTest : public ::testing::Test {
 protected:
  NucControlTest() {
    options_.mutable_nuc()->set_warm_up(NucOptions::IGNORE);
    options_.mutable_nuc()->set_before_scan(false);
    EXPECT_TRUE(camera_.Open().ok());
  }

  void Start() { control_.emplace(options_, camera_); }
  /// So many frames; the state at the last one.
  NucStatus Frames(int count) {
    NucStatus status;
    for (int i = 0; i < count; ++i) {
      const Result<SourceItem> item = camera_.Read({});
      const RawFrame& frame = std::get<RawFrame>(*item);
      status = control_->Process(frame, frame.arrival_wall);
    }
    return status;
  }
  /// The answer to command `number`, if it has come.
  std::optional<CommandResult> AnswerTo(std::uint64_t number) {
    std::ranges::move(control_->TakeAnswers(), std::back_inserter(answers_));
    const auto found = std::ranges::find(answers_, number, &CommandResult::number);
    return found == answers_.end() ? std::nullopt : std::optional(*found);
  }
  void Trigger(std::uint64_t number) {
    control_->Execute({.number = number, .kind = CommandKind::kTriggerNuc});
  }
  long Triggers() const {
    return std::ranges::count_if(camera_.controls, [](const CameraControl& control) {
      return std::holds_alternative<TriggerNuc>(control);
    });
  }

  static constexpr int kFramesPerSecond = 40;  // Of FakeSource.

  EdgeOptions options_;
  FakeSource camera_{"100000*t"};
  std::optional<NucControl> control_;
  std::vector<CommandResult> answers_;
};

TEST_F(NucControlTest, ACommandIsAnsweredWhenTheCameraHasAnswered) {
  camera_.control_answer = OkStatus();
  camera_.answers_after_reads = 8;
  Start();
  Frames(kFramesPerSecond);
  Trigger(1);
  Frames(8);
  EXPECT_EQ(Triggers(), 1);
  EXPECT_FALSE(AnswerTo(1)) << "the camera has said nothing yet";
  Frames(2);
  ASSERT_TRUE(AnswerTo(1));
  EXPECT_EQ(AnswerTo(1)->outcome, CommandOutcome::kDone);
}

TEST_F(NucControlTest, ARefusalIsPassedOnInTheCamerasWords) {
  for (const int reads : {0, 8}) {
    camera_.control_answer = FailedPrecondition("the shutter is glued");
    camera_.answers_after_reads = reads;
    Start();
    Frames(kFramesPerSecond);
    Trigger(1);
    Frames(12);
    ASSERT_TRUE(AnswerTo(1)) << reads;
    EXPECT_EQ(AnswerTo(1)->outcome, CommandOutcome::kRefused);
    EXPECT_EQ(AnswerTo(1)->text, "the shutter is glued");
    answers_.clear();
  }
}

TEST_F(NucControlTest, ACameraThatFailsIsNotOneThatRefuses) {
  camera_.control_answer = IoError("the request stalled");
  camera_.answers_after_reads = 3;
  Start();
  Frames(kFramesPerSecond);
  Trigger(1);
  Frames(6);
  ASSERT_TRUE(AnswerTo(1));
  EXPECT_EQ(AnswerTo(1)->outcome, CommandOutcome::kFailed);
}

TEST_F(NucControlTest, CommandsThatComeBeforeTheAnswerShareIt) {
  camera_.control_answer = OkStatus();
  camera_.answers_after_reads = 10;
  Start();
  Frames(kFramesPerSecond);
  Trigger(1);
  Frames(5);
  Trigger(2);
  Frames(8);
  ASSERT_TRUE(AnswerTo(1) && AnswerTo(2));
  EXPECT_EQ(AnswerTo(2)->outcome, CommandOutcome::kDone);
  EXPECT_EQ(Triggers(), 1);
}

TEST_F(NucControlTest, WithoutAnAnswerItHasFailedInTimeAndALateOneChangesNothing) {
  camera_.control_answer = OkStatus();
  camera_.answers_after_reads = 5 * kFramesPerSecond;  // Longer than nuc.expert.answer_s.
  Start();
  Frames(kFramesPerSecond);
  Trigger(1);
  Frames(3 * kFramesPerSecond);
  EXPECT_FALSE(AnswerTo(1));
  Frames(3);
  ASSERT_TRUE(AnswerTo(1));
  EXPECT_EQ(AnswerTo(1)->outcome, CommandOutcome::kFailed) << "it may still be done";
  EXPECT_THAT(AnswerTo(1)->text, HasSubstr("did not answer within 3.0 s"));
  EXPECT_EQ(Frames(3 * kFramesPerSecond).state, NucState::kIdle) << "the late answer is ignored";
}

TEST_F(NucControlTest, ACameraThatTakesNoOrdersIsScannedWithAtOnce) {
  options_.mutable_nuc()->set_before_scan(true);
  camera_.control_answer = FailedPrecondition("cannot be told to correct itself");
  camera_.answers_after_reads = 4;
  Start();
  EXPECT_FALSE(Frames(5).valid);
  EXPECT_TRUE(Frames(kFramesPerSecond / 4).valid);
}

TEST_F(NucControlTest, TheEndOfTheSourceAnswersWhoWaits) {
  camera_.answers_after_reads = 1000;
  Start();
  Frames(kFramesPerSecond);
  Trigger(1);
  Frames(2);
  control_->End();
  ASSERT_TRUE(AnswerTo(1));
  EXPECT_EQ(AnswerTo(1)->text, "the source has ended");
}

}  // namespace
}  // namespace isotherm

// What becomes of commands on their way through the edge's pipeline.

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>
#include <vector>

#include "edge/pipeline/testing/edge_pipeline_fixture.h"

namespace isotherm {
namespace {

class EdgeCommandsTest : public EdgePipelineFixture {
 protected:
  std::vector<CommandResult> AwaitAnswers(std::size_t count) {
    while (publisher_.answers().size() < count) {
      pipeline_->AnswerCommands();
      std::this_thread::yield();
    }
    return publisher_.answers();
  }
  static CommandResult Find(const std::vector<CommandResult>& answers, std::uint64_t number) {
    const auto found = std::ranges::find(answers, number, &CommandResult::number);
    return found == answers.end() ? CommandResult{} : *found;
  }
};

TEST_F(EdgeCommandsTest, EveryCommandIsAnswered) {
  publisher_.commands = {{.number = 1, .kind = CommandKind::kTriggerNuc},
                         {.number = 2,
                          .kind = CommandKind::kSetPublishPolicy,
                          .publish_policy = PublishPolicy::kLossless}};
  Start("d");
  const std::vector<CommandResult> answers = AwaitAnswers(2);
  EXPECT_EQ(Find(answers, 1).outcome, CommandOutcome::kRefused) << "there is no thermal camera";
  EXPECT_FALSE(Find(answers, 1).text.empty());
  EXPECT_EQ(Find(answers, 2).outcome, CommandOutcome::kDone);
  EXPECT_EQ(publisher_.policy(), PublishPolicy::kLossless);
}

TEST_F(EdgeCommandsTest, OrdersOfScansAreLeftToWhoRunsThem) {
  publisher_.commands = {{.number = 1, .kind = CommandKind::kStopScan},
                         {.number = 2, .kind = CommandKind::kSetPublishPolicy},
                         {.number = 3, .kind = CommandKind::kStartScan}};
  Start("d");
  AwaitAnswers(1);
  std::vector<Command> orders = pipeline_->TakeScanOrders();
  while (orders.size() < 2) {
    pipeline_->AnswerCommands();
    for (const Command& order : pipeline_->TakeScanOrders()) orders.push_back(order);
    std::this_thread::yield();
  }
  EXPECT_EQ(orders[0].number, 1U);
  EXPECT_EQ(orders[1].number, 3U);
  EXPECT_TRUE(pipeline_->TakeScanOrders().empty());
  EXPECT_EQ(publisher_.answers().size(), 1U);
}

TEST_F(EdgeCommandsTest, AMarkIsRecordedAtTheTimeOfTheNewestFrame) {
  publisher_.commands = {{.number = 1, .kind = CommandKind::kMark, .text = "left burner"},
                         {.number = 2, .kind = CommandKind::kMark}};
  publisher_.Hold();  // The source waits for room, and does not end.
  Start("1000*t");
  while (counters_.Get(Sensor::kThermal).captured < 3) std::this_thread::yield();
  const auto answers = AwaitAnswers(2);
  EXPECT_EQ(Find(answers, 1).outcome, CommandOutcome::kDone) << Find(answers, 1).text;
  EXPECT_EQ(Find(answers, 2).outcome, CommandOutcome::kRefused);
  EXPECT_EQ(Find(answers, 2).text, "a mark needs a text");
  const std::vector<ScanMark> marks = pipeline_->marks();
  ASSERT_EQ(marks.size(), 1U);
  EXPECT_EQ(marks[0].text, "left burner");
  publisher_.Release();
  const auto is_its_frame_sent = [&] {
    return std::ranges::any_of(publisher_.thermal(), [&](const EncodedThermalFrame& frame) {
      return frame.header.capture_time == marks[0].time;
    });
  };
  while (!is_its_frame_sent()) std::this_thread::yield();  // The test's time limit is the bound.
  EXPECT_TRUE(pipeline_->Stop().ok());
  EXPECT_EQ(std::ranges::count_if(recording_.log,
                                  [&](const RecordedLog& line) {
                                    return line.text == "mark: left burner" &&
                                           line.time == marks[0].time;
                                  }),
            1);
}

TEST_F(EdgeCommandsTest, AMarkThatIsNoUtf8IsMadeReadable) {
  publisher_.commands = {{.number = 1,
                          .kind = CommandKind::kMark,
                          .text = "Br\xfc"
                                  "cke"}};
  Start("1000000*t", false);
  while (counters_.Get(Sensor::kThermal).captured < 3) std::this_thread::yield();
  EXPECT_EQ(AwaitAnswers(1)[0].outcome, CommandOutcome::kDone);
  EXPECT_TRUE(pipeline_->Stop().ok());
  ASSERT_EQ(pipeline_->marks().size(), 1U);
  EXPECT_EQ(pipeline_->marks()[0].text, "Br\\xfccke");
}

TEST_F(EdgeCommandsTest, TheNewestMarksAreTold) {
  for (std::uint64_t i = 1; i <= 10; ++i) {
    publisher_.commands.push_back(
        {.number = i, .kind = CommandKind::kMark, .text = std::to_string(i)});
  }
  Start("1000000*t", false);
  while (counters_.Get(Sensor::kThermal).captured < 3) std::this_thread::yield();
  AwaitAnswers(10);
  EXPECT_TRUE(pipeline_->Stop().ok());
  ASSERT_EQ(pipeline_->marks().size(), kMaxMarks);
  EXPECT_EQ(pipeline_->marks().front().text, "3");
  EXPECT_EQ(pipeline_->marks().back().text, "10");
}

TEST_F(EdgeCommandsTest, CommandsThatAreTooManyAreAnsweredToo) {
  constexpr std::uint64_t kCommands = 50;
  for (std::uint64_t i = 1; i <= kCommands; ++i)
    publisher_.commands.push_back({.number = i, .kind = CommandKind::kSetPublishPolicy});
  Start("1000000*t", false);
  const auto answers = AwaitAnswers(kCommands);
  EXPECT_TRUE(pipeline_->Stop().ok());
  for (std::uint64_t i = 1; i <= kCommands; ++i) {
    const CommandResult answer = Find(answers, i);
    EXPECT_TRUE(answer.outcome == CommandOutcome::kDone ||
                answer.text == "too many commands at once; send it again")
        << answer.text;
  }
}

TEST_F(EdgeCommandsTest, ANucThatIsAskedForReachesTheCamera) {
  control_answer_ = OkStatus();
  publisher_.commands = {{.number = 1, .kind = CommandKind::kTriggerNuc}};
  // More than the test waits for; unpaced playback waits for the queues.
  Start("1000000*t", false);
  const CommandResult answer = Find(AwaitAnswers(1), 1);
  // Asked before the first frame came, or after.
  if (answer.outcome == CommandOutcome::kDone) {
    EXPECT_EQ(answer.text, "the camera has the order");
  } else {
    EXPECT_EQ(answer.text, "no thermal frame has come yet");
  }
  EXPECT_TRUE(pipeline_->Stop().ok());
  const auto triggers = std::ranges::count_if(camera_->controls, [](const CameraControl& control) {
    return std::holds_alternative<TriggerNuc>(control);
  });
  EXPECT_EQ(triggers > 0, answer.outcome == CommandOutcome::kDone);
}

TEST_F(EdgeCommandsTest, WithoutACameraToCommandNucCommandsAreRefusedWithAReason) {
  options_.mutable_source()->set_kind(REPLAY);
  publisher_.commands = {
      {.number = 1, .kind = CommandKind::kTriggerNuc},
      {.number = 2, .kind = CommandKind::kHoldNuc, .hold_s = 5.0},
      {.number = 3, .kind = CommandKind::kSetNucPolicy, .nuc_policy = NucPolicy::kManual}};
  Start("1000000*t", false);
  for (const CommandResult& answer : AwaitAnswers(3)) {
    EXPECT_EQ(answer.outcome, CommandOutcome::kRefused);
    EXPECT_EQ(answer.text, "a recording is played: there is no shutter to command");
  }
  EXPECT_TRUE(pipeline_->Stop().ok());
  EXPECT_TRUE(camera_->controls.empty());
}

}  // namespace
}  // namespace isotherm

// What the ground orders while the line of edge_pipeline.cc runs.

#include <fmt/format.h>

#include <string>
#include <utility>

#include "common/base/log.h"
#include "common/base/printable.h"
#include "common/recording/recording.h"
#include "edge/pipeline/edge_pipeline.h"

namespace isotherm {

void EdgePipeline::ServeNucCommands() {
  while (nuc_commands_.size() > 0) nuc_.Execute(*nuc_commands_.Pop({}));
  nuc_.TakeCameraAnswers();
  for (CommandResult& answer : nuc_.TakeAnswers()) nuc_answers_.Push(std::move(answer), {});
}

void EdgePipeline::AnswerCommands() {
  while (commands_.size() > 0) Execute(*commands_.Pop({}));
  while (nuc_answers_.size() > 0) Answer(*nuc_answers_.Pop({}));
  // Nobody serves these any more.
  while (source_ended_ && nuc_commands_.size() > 0) {
    Answer({nuc_commands_.Pop({})->number, CommandOutcome::kRefused, "the source has ended"});
  }
}

void EdgePipeline::Answer(const CommandResult& result) {
  const Status answered = publisher_.Answer(result);
  if (!answered.ok()) {
    LOG(Edge, Warning) << "command not answered: " << answered.message();
  }
}

void EdgePipeline::Execute(const Command& command) {
  switch (command.kind) {
    case CommandKind::kSetPublishPolicy:
      publisher_.SetPolicy(command.publish_policy);
      return Answer({command.number, CommandOutcome::kDone, ""});
    case CommandKind::kTriggerNuc:
    case CommandKind::kSetNucPolicy:
    case CommandKind::kHoldNuc:
      static_cast<void>(nuc_commands_.Push(command, {}));
      return;
    case CommandKind::kStartScan:
    case CommandKind::kStopScan:
      return scan_orders_.push_back(command);
    case CommandKind::kMark:
      return Answer(Mark(command));
  }
}

CommandResult EdgePipeline::Mark(const Command& command) {
  const auto refuse = [&](const char* why) {
    return CommandResult{command.number, CommandOutcome::kRefused, why};
  };
  if (command.text.empty()) return refuse("a mark needs a text");
  if (source_ended_) return refuse("no scan is under way");
  const CaptureTime time = CaptureTimeFromNanoseconds(newest_capture_ns_);
  if (time == CaptureTime{}) return refuse("no frame has come yet");
  // Whoever wrote it: recordings hold UTF-8 only.
  const std::string text = Printable(command.text);
  if (text.size() > kMaxMarkBytes) return refuse("the text of a mark is too long");
  if (marks_.size() == kMaxMarks) marks_.erase(marks_.begin());
  marks_.push_back({time, text});
  LOG(Edge, Info) << "marked: " << text;
  const bool is_recorded = spool_ && spool_->status().problem.empty();
  if (spool_) marks_to_record_.Push({time, "info", kMarkPrefix + text}, {});
  return {command.number, CommandOutcome::kDone,
          fmt::format("marked at the capture time {:.3f} s{}", ToSeconds(time.time_since_epoch()),
                      is_recorded ? "" : "; nothing is recorded on the rig at present")};
}

std::vector<Command> EdgePipeline::TakeScanOrders() { return std::exchange(scan_orders_, {}); }

}  // namespace isotherm

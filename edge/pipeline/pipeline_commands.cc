// What the ground orders while the line of edge_pipeline.cc runs.

#include <utility>

#include "common/base/log.h"
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
  }
}

std::vector<Command> EdgePipeline::TakeScanOrders() { return std::exchange(scan_orders_, {}); }

}  // namespace isotherm

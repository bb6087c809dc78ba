#include "ground/recording_loop.h"

#include <utility>

#include "common/base/log.h"

namespace isotherm {

void RecordingLoop::Run(ItemQueue& queue, const std::stop_token& stop) {
  while (std::optional<Item> item = queue.Pop(stop)) {
    std::visit([this](const auto& value) { Handle(value); }, *item);
  }
  End();
}

void RecordingLoop::Handle(const SessionStart& start) {
  End();
  promise_ = start.recording_promise;
  if (!options_.live().record()) return;
  Result<std::unique_ptr<ScanRecorder>> recorder =
      ScanRecorder::Create(start.folder / "scan.mcap", options_);
  if (!recorder) {
    LOG(Ground, Error) << "not recording: " << recorder.error().message();
    status_ = recorder.error();
    return;
  }
  recorder_ = std::move(*recorder);
  session_ = start.rig.session;
  recorder_->Write(start.rig);
}

void RecordingLoop::Handle(const Feedback& feedback) {
  // The reconstruction may be behind, and still speak of the session before.
  if (recorder_ && feedback.session == session_) recorder_->Write(feedback);
}

void RecordingLoop::Handle(const ClockAccount& clock) {
  if (recorder_ && clock.session == session_) recorder_->Write(clock);
}

void RecordingLoop::End() {
  RecordingOutcome outcome;
  if (recorder_) {
    outcome.status = recorder_->Close();
    outcome.stats = recorder_->stats();
    if (!outcome.status.ok()) status_ = outcome.status;
    recorder_.reset();
  }
  if (promise_) {
    promise_->set_value(outcome);
    promise_.reset();
  }
}

}  // namespace isotherm

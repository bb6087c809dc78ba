#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <stop_token>

#include "ground/ground_options.pb.h"
#include "ground/scan_recorder.h"
#include "ground/session_item.h"

namespace isotherm {

/// Records one session after the other. Thread-bound to the recording thread.
class RecordingLoop {
 public:
  explicit RecordingLoop(const GroundOptions& options) : options_(options) {}

  /// Until stop is requested and the queue is empty.
  void Run(ItemQueue& queue, const std::stop_token& stop);
  /// The last failure.
  const Status& status() const { return status_; }

 private:
  void Handle(const SessionStart& start);
  void Handle(const SessionAccount& /*account*/) { End(); }
  void Handle(const Feedback& feedback);
  void Handle(const ClockAccount& clock);
  template <typename Frame>
  void Handle(const Frame& frame) {
    if (recorder_) recorder_->Write(frame);
  }
  void End();

  const GroundOptions& options_;
  std::unique_ptr<ScanRecorder> recorder_;
  std::uint64_t session_ = 0;
  std::shared_ptr<std::promise<RecordingOutcome>> promise_;
  Status status_;
};

}  // namespace isotherm

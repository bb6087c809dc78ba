#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/messages/messages.h"
#include "common/recording/recording.h"
#include "edge/nuc/image_watch.h"
#include "edge/nuc/nuc_supervisor.h"
#include "edge/source/frame_source.h"

namespace isotherm {

class EdgeOptions;

/// Joins the NUC supervisor with the camera that it follows and commands, and with the operator's
/// commands. Those are answered with what the camera says to the order that they lead to. What
/// happens is logged and kept for the recording. Thread-bound to the thread that reads the source.
class NucControl {
 public:
  /// `source` must outlive it.
  NucControl(const EdgeOptions& options, FrameSource& source);

  /// Advances to a thermal frame captured at `time`, and gives the camera its order if one is due.
  NucStatus Process(const RawFrame& frame, CaptureTime time);

  /// Takes a command about the NUC; the answer comes with TakeAnswers, at once or when the camera
  /// has answered.
  void Execute(const Command& command);
  /// Takes what the camera has answered since the last call.
  void TakeCameraAnswers();
  /// Since the last call.
  std::vector<CommandResult> TakeAnswers() { return std::exchange(answers_, {}); }
  std::vector<RecordedLog> TakeLog() { return std::exchange(log_, {}); }
  /// The source has ended: commands that wait for the camera's answer have failed.
  void End();

  NucReport Report() const;

 private:
  void GiveOrder(NucOrder order, CaptureTime time);
  void OnCameraAnswer(NucOrder order, const Status& answer);
  /// The camera is taken to refuse an order that it has not answered at `time`, in time.
  void GiveUpIfUnanswered(CaptureTime time);
  void Answer(std::uint64_t number, CommandOutcome outcome, std::string text);
  void LogNotices();

  FrameSource& source_;
  NucSupervisor supervisor_;
  ImageWatch images_;
  NucStatus status_;
  ThermalHousekeeping housekeeping_;
  const Nanoseconds patience_;               ///< Time that the camera has for an answer.
  std::optional<CaptureTime> triggered_at_;  ///< An order that the camera has not answered yet.
  int answers_too_late_ = 0;                 ///< Still to come, and not waited for any more.
  std::vector<std::uint64_t> waiting_;       ///< Commands that the camera's next answer answers.
  std::vector<CommandResult> answers_;
  std::vector<RecordedLog> log_;
};

}  // namespace isotherm

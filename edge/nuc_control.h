#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/recording/recording.h"
#include "common/transport/messages.h"
#include "edge/nuc/nuc_supervisor.h"
#include "edge/nuc/picture_watch.h"
#include "edge/source/frame_source.h"

namespace isotherm {

class EdgeOptions;

/// Joins the NUC supervisor with the camera that it follows and commands, and with the operator's
/// commands. What happens is logged and kept for the recording. Thread-bound to the thread that
/// reads the source.
class NucControl {
 public:
  /// `source` must outlive it.
  NucControl(const EdgeOptions& options, FrameSource& source);

  /// Advances to a thermal frame captured at `time`, and gives the camera its order if one is due.
  NucStatus Process(const RawFrame& frame, CaptureTime time);

  /// Takes a command about the NUC; the answer comes with TakeAnswers, at once or after the next
  /// frames.
  void Obey(const Command& command);
  /// Since the last call.
  std::vector<CommandResult> TakeAnswers() { return std::exchange(answers_, {}); }
  std::vector<RecordedLog> TakeLog() { return std::exchange(log_, {}); }
  /// The source has ended: commands that wait for a frame are refused.
  void End();

  NucReport Report() const;

 private:
  void Pass(NucOrder order);
  void Answer(std::uint64_t number, const Status& status, std::string text);
  void Tell();

  FrameSource& source_;
  NucSupervisor supervisor_;
  PictureWatch pictures_;
  NucStatus status_;
  ThermalHousekeeping housekeeping_;
  std::vector<std::uint64_t> waiting_;  ///< Commands that the next order answers.
  std::vector<CommandResult> answers_;
  std::vector<RecordedLog> log_;
};

}  // namespace isotherm

#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "common/base/status.h"
#include "common/messages/messages.h"
#include "common/recording/recording.h"
#include "ground/options/ground_options.pb.h"
#include "ground/subscriber/received_frame.h"
#include "ground/subscriber/session_counters.h"

namespace isotherm {

/// Writes what arrives during one session into `scan.mcap`. A disk that fills up ends the
/// recording, not the scan: what was written stays readable and the rest is counted.
/// Thread-compatible.
class ScanRecorder {
 public:
  static Result<std::unique_ptr<ScanRecorder>> Create(const std::filesystem::path& path,
                                                      const GroundOptions& options);

  void Write(const RigDescription& rig);
  void Write(const ReceivedDepth& depth);
  void Write(const ReceivedThermal& thermal);
  void Write(const Feedback& feedback);
  void Write(const ExternalOdometrySample& sample);
  /// Keeps what is known of the rig's clock, and writes what changed in kind: synchronisation,
  /// steps, alarm.
  void Write(const SessionClock& clock);
  /// Hands what was written so far to the operating system.
  void Flush() { Note(writer_->Flush()); }
  /// Writes index and footer. The first error of the recording, or ok. Idempotent.
  Status Close();

  RecordingStats stats() const { return writer_->stats(); }
  /// The first error so far, or ok.
  const Status& status() const { return first_error_; }

 private:
  explicit ScanRecorder(std::unique_ptr<RecordingWriter> writer) : writer_(std::move(writer)) {}
  void Note(const Status& status);
  void WriteClockMetadata();

  std::unique_ptr<RecordingWriter> writer_;
  Status first_error_;
  std::optional<SessionClock> clock_;  ///< The newest.
};

}  // namespace isotherm

#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <utility>

#include "common/recording/quota_watch.h"
#include "common/time/clock.h"
#include "common/time/thread_progress.h"
#include "ground/options/ground_options.pb.h"
#include "ground/service/recording_queue.h"
#include "ground/service/scan_board.h"
#include "ground/service/scan_recorder.h"
#include "ground/service/session_item.h"

namespace isotherm {

/// Records one session after the other, and leaves room on the disk for the results: the file ends
/// when no more than these are expected to take is free, and another is begun when twice that is.
/// It also ends when everything in the output folder takes live.quota_gb.
/// Thread-bound to the recording thread.
class RecordingLoop {
 public:
  /// Says how large a folder's disk is and how much of it is free; nullopt if nobody can tell.
  using LookAtSpace =
      std::function<std::optional<std::filesystem::space_info>(const std::filesystem::path&)>;

  RecordingLoop(const GroundOptions& options, const Clock& clock, const ScanBoard& board,
                ThreadProgress& progress, LookAtSpace look_at_space = SpaceOfDisk)
      : options_(options),
        clock_(clock),
        board_(board),
        progress_(progress),
        look_at_space_(std::move(look_at_space)) {}

  /// Records until stop is requested and the queue is empty.
  void Run(RecordingQueue& queue, const std::stop_token& stop);
  /// Returns the newest failure of all sessions. Not while it runs.
  const Status& status() const { return status_; }

 private:
  void Handle(const SessionStart& start);
  void Handle(const RigDescription& rig);
  void Handle(const SessionCounters& /*counters*/) { End(); }
  void Handle(const Feedback& feedback);
  void Handle(const SessionClock& clock);
  void Handle(const SessionMark& mark);
  void Handle(const ExternalOdometrySample& sample);
  void Handle(const ReceivedDepth& frame) { HandleFrame(frame, Sensor::kDepth); }
  void Handle(const ReceivedThermal& frame) { HandleFrame(frame, Sensor::kThermal); }
  template <typename Frame>
  void HandleFrame(const Frame& frame, Sensor sensor);
  static std::optional<std::filesystem::space_info> SpaceOfDisk(
      const std::filesystem::path& folder);
  /// Returns what all files below a folder take, bytes.
  /// nullopt if it changes meanwhile.
  static std::optional<std::uint64_t> FolderSize(const std::filesystem::path& folder);
  /// Looks from time to time how much is free, and whether that is for the results.
  void LookAtDisk();
  /// Returns what a disk of so many bytes keeps free, or the quota.
  std::uint64_t ReserveBytes(std::uint64_t capacity) const;
  std::uint64_t QuotaReserveBytes() const;
  /// Says once that it is not long until the recording ends.
  void WarnInTime();
  void StopForReserve(std::uint64_t free_bytes, std::uint64_t reserve_bytes);
  /// Returns where a frame goes; there is a recorder_.
  ScanRecorder& RecorderOf(bool is_late);
  /// Enters what was written so far into the recording's progress.
  void Enter();
  void End();

  const GroundOptions& options_;
  const Clock& clock_;
  const ScanBoard& board_;
  ThreadProgress& progress_;
  const LookAtSpace look_at_space_;
  SessionStart start_;
  std::unique_ptr<ScanRecorder> recorder_;
  std::unique_ptr<ScanRecorder> late_recorder_;  ///< Null before the first late frame.
  std::optional<QuotaWatch> quota_;              ///< Begins anew with each session.
  bool is_quota_first_ = false;                  ///< It ends before the disk is full.
  bool has_warned_ = false;                      ///< In this session.
  bool nearly_full_ = false;                     ///< The space that is free is for the results.
  bool flushed_ = true;
  SteadyTime opened_{};
  SteadyTime next_look_{};
  Status status_;
};

}  // namespace isotherm

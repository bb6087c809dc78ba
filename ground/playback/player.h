#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "common/base/mutex.h"
#include "common/recording/recording.h"
#include "common/time/clock.h"
#include "ground/console/console_feed.h"
#include "ground/options/ground_options.pb.h"
#include "ground/service/live_scan.h"

namespace isotherm {

/// Plays a recording: its frames are reconstructed when their time has come, at 0.25 to 8 times the
/// speed at which they were taken, or as fast as that goes. Going back begins anew. Control() and
/// state() are thread-safe; the rest is bound to the thread that plays.
class Player {
 public:
  /// `clock` and `feed` must outlive it. Fails for a recording without calibration or depth.
  static Result<std::unique_ptr<Player>> Open(const Clock& clock, const GroundOptions& options,
                                              const std::filesystem::path& recording,
                                              ConsoleFeed& feed);

  /// Does what is due. Returns how long there is nothing to do.
  Nanoseconds Step();

  void Control(const live::PlaybackControl& control);
  live::Playback state() const;

 private:
  Player(const Clock& clock, const GroundOptions& options, const std::filesystem::path& recording,
         ConsoleFeed& feed, std::unique_ptr<RecordingReader> reader, Rig rig);

  void TakeControl();
  /// Begins the scan anew.
  Status Restart();
  /// Where a frame is on the time line, seconds from the start.
  double PositionOf(CaptureTime time) const { return ToSeconds(time - start_); }
  /// The steady time at which a position is due.
  SteadyTime DueTime(double position_s) const;
  /// Frames count from here at the present speed.
  void Rebase();
  bool ReadNext();
  void Play(const RecordedItem& item);
  void Play(const RecordedDepth& recorded);
  void Play(const RecordedThermal& recorded);
  void GiveFeedback();

  const Clock& clock_;
  const GroundOptions options_;
  const std::filesystem::path recording_;
  ConsoleFeed& feed_;
  std::unique_ptr<RecordingReader> reader_;
  const Rig rig_;
  const CaptureTime start_;
  const double duration_s_;
  std::unique_ptr<LiveScan> scan_;
  std::optional<RecordedItem> next_;
  double next_s_ = 0.0;
  bool is_at_end_ = false;
  double position_s_ = 0.0;
  double base_position_s_ = 0.0;
  SteadyTime base_time_;
  std::optional<double> seek_to_s_;  ///< On the way there.

  mutable Mutex mutex_;
  live::Playback state_ GUARDED_BY(mutex_);
  live::PlaybackControl wanted_ GUARDED_BY(mutex_);
  bool is_wanted_ GUARDED_BY(mutex_) = false;
};

}  // namespace isotherm

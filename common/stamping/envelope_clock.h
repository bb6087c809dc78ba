#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/stamping/envelope_line.h"
#include "common/stamping/median_clock.h"
#include "common/stamping/stamp.h"
#include "common/time/time_types.h"

namespace isotherm {

/// See TimestamperOptions.
struct EnvelopeOptions {
  int median_window = 15;           ///< Frames; with less, the median is used.
  double window_s = 30.0;           ///< The estimate rests on one to two times this.
  double max_skew_ppm = 200.0;      ///< The most that the camera's clock drifts.
  double max_slew_ppm = 200.0;      ///< By which the estimate may change beyond that.
  double early_limit_s = 0.005;     ///< A frame earlier than this is from another counter.
  double residual_limit_s = 0.010;  ///< Frames all later than this are not synchronised.
  double residual_window_s = 2.0;   ///< For this long.
  double relearn_after_s = 10.0;    ///< Then the estimate is given up.
};

/// Relates one camera's ticks to the edge's wall clock by the frames that were held up least: the
/// line along which these arrive (EnvelopeLine) is the camera's offset and skew plus the shortest
/// transport delay. Of every `median_window` frames the one that was held up least counts.
///
///   warm-up     until there are `median_window` frames: their median (eq. 5.4), less what the
///               median is above the line if that is known from before a reset
///   reset       ticks that go backwards, or ahead of what arrival says: starts again at that frame
///   slew        the estimate moves by at most max_slew_ppm beyond the skew, faster only until it
///               has caught up with the line once after the start
///   residual    all frames of residual_window_s far above the line: the camera's clock jumped or
///               drifts too much. Stamps are not synchronised, and after relearn_after_s the
///               estimate starts again
///
/// Pure: no clock inside. Thread-compatible.
class EnvelopeClock {
 public:
  explicit EnvelopeClock(const EnvelopeOptions& options);

  Stamp Process(DeviceTicks ticks, CaptureTime arrival);

  /// The camera was opened again: the next frame's ticks are of another counter.
  void BeginCounter();

  /// Times that the estimate started again: counter reset or jump, and given up.
  std::uint64_t resets() const { return resets_; }
  std::uint64_t relearned() const { return relearned_; }
  /// There are enough frames for a line.
  bool warm() const { return line_.ready(); }
  /// The estimate has caught up with a line of many frames.
  bool settled() const { return caught_up_; }
  /// Drift of the camera's clock against the computer's, positive = the camera's is slow.
  double skew_ppm() const { return 1e6 * line_.slope(); }

 private:
  /// x: the camera's time since the first frame after the start, seconds; y: arrival - ticks, less
  /// that of the first frame, seconds.
  using Sample = EnvelopeLine::Point;

  bool IsFromAnotherCounter(DeviceTicks ticks, CaptureTime arrival) const;
  Sample Relative(DeviceTicks ticks, CaptureTime arrival) const;
  void Restart();
  void Add(const Sample& sample);
  /// The stamp while there are too few frames for a line.
  Stamp WarmUp(double now_s);
  /// Moves the estimate towards the line, as far as it may.
  void Follow(double now_s);
  Stamp MakeStamp(double now_s) const;
  CaptureTime StampTime(double now_s) const;
  void WatchResidual(bool synchronised, double now_s);
  /// Least that the frames of residual_window_s are above the line; 0 before there are this many.
  double Floor(double now_s) const;
  double Sigma(double now_s) const;

  const EnvelopeOptions options_;
  DeviceTicks first_ticks_{};
  CaptureTime first_arrival_{};
  std::optional<DeviceTicks> last_ticks_;
  std::deque<Sample> recent_;  ///< Samples of residual_window_s, and one before.
  EnvelopeLine line_;
  SlidingMedian median_;
  double median_excess_s_ = 0.0;  ///< How far the median lies above the line.
  double estimate_s_ = 0.0;       ///< At estimated_at_s_.
  double estimated_at_s_ = 0.0;
  bool caught_up_ = false;
  std::optional<double> off_since_s_;
  std::uint64_t resets_ = 0;
  std::uint64_t relearned_ = 0;
};

}  // namespace isotherm

#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <variant>

#include "common/frame/frame.h"

namespace isotherm {

/// Puts depth and thermal frames, which arrive on two streams, into one order by capture time, so
/// that a live scan and its recording are processed alike. A frame is released once the other
/// stream has reached its time.
///
/// A stream that stops must not stop the other: when `max_held` frames wait for it, it counts as
/// stalled and is not waited for until it delivers again. (Frames, not seconds: under back-pressure
/// or in fast replay the streams are seconds apart in capture time without either having stopped.)
/// A frame older than what was already released is refused and counted. Reads no clock.
/// Thread-compatible.
class Assembler {
 public:
  using Frame = std::variant<DepthFramePtr, ThermalFramePtr>;

  /// `expects_thermal` is false for a rig without a thermal camera: nothing is ever held back then.
  explicit Assembler(bool expects_thermal, std::size_t max_held = 96)
      : max_held_(max_held), thermal_stalled_(!expects_thermal) {}

  void Add(DepthFramePtr frame);
  void Add(ThermalFramePtr frame);
  /// The next frame in capture-time order; nullopt if more must arrive first. At equal times depth
  /// comes first.
  std::optional<Frame> Pop();
  /// The same at the end of the streams: waits for nothing.
  std::optional<Frame> Flush();

  std::uint64_t refused_late() const { return refused_late_; }
  std::size_t waiting() const { return depth_.size() + thermal_.size(); }

 private:
  std::optional<Frame> PopEarliest();

  const std::size_t max_held_;
  std::deque<DepthFramePtr> depth_;
  std::deque<ThermalFramePtr> thermal_;
  std::optional<CaptureTime> newest_depth_, newest_thermal_, released_;
  bool depth_stalled_ = false;
  bool thermal_stalled_;
  std::uint64_t refused_late_ = 0;
};

}  // namespace isotherm

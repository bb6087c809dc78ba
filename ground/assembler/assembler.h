#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <variant>

#include "common/frame/frame.h"

namespace isotherm {

/// Puts depth and thermal frames, which arrive on two streams, into one order by capture time, so that a live scan
/// and its recording are processed alike. A frame is released once the other stream has reached its time, or has
/// fallen behind by more than the longest wait. Reads no clock: waiting is measured in capture time. A frame older
/// than what was already released is refused and counted. Thread-compatible.
class Assembler {
 public:
  using Frame = std::variant<DepthFramePtr, ThermalFramePtr>;

  /// `max_wait` bounds what is held back, and with it memory.
  explicit Assembler(Nanoseconds max_wait) : max_wait_(max_wait) {}

  void Add(DepthFramePtr frame);
  void Add(ThermalFramePtr frame);
  /// The next frame in capture-time order; nullopt if more must arrive first. At equal times depth comes first.
  std::optional<Frame> Pop();
  /// The same at the end of the streams: waits for nothing.
  std::optional<Frame> Flush();

  std::uint64_t refused_late() const { return refused_late_; }
  std::size_t waiting() const { return depth_.size() + thermal_.size(); }

 private:
  std::optional<Frame> PopEarliest();

  const Nanoseconds max_wait_;
  std::deque<DepthFramePtr> depth_;
  std::deque<ThermalFramePtr> thermal_;
  std::optional<CaptureTime> newest_depth_, newest_thermal_, released_;
  std::uint64_t refused_late_ = 0;
};

}  // namespace isotherm
